//! `Plane()`: the unbounded plane through the origin of its object space, normal +y: a ground parallel to Oxz.
//!
//! Texture coordinates are the object-space x and −z, so an image repeats once per object unit.

use crate::{
    describe::Describe,
    lanes::{self, Job, Lanes, vector},
    packet::{self, Hits, Mask, Packet, PerRay, four},
    primitive::{Cost, Degenerate, Extent, Hit, Primitive, Surface},
    space::Ray,
    surfaces::{Meeting, Surfaces},
};
use bevy_ecs::prelude::*;
use glam::{DAffine3, DVec2, DVec3};

/// The unbounded plane y = 0 of its object space, facing +y.
#[derive(Component, Clone, Debug, Default, PartialEq, Describe)]
pub struct Plane {}

/// A plane as the inner loop sees it.
#[derive(Clone, Debug)]
pub struct PackedPlane {
    point: DVec3,
    normal: DVec3,
    object_from_world: DAffine3,
}

/// The test of a plane with some rays of a packet; tells which hit up to `t_max`, and where if that is asked for.
struct Crossings<'a> {
    plane: &'a PackedPlane,
    packet: &'a Packet,
    rays: Mask,
    t_max: &'a PerRay,
    t: Option<&'a mut PerRay>,
}

impl Job for Crossings<'_> {
    type Output = Mask;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Mask {
        let Self { plane: PackedPlane { point, normal, .. }, packet, rays, t_max, mut t } = self;
        let l = lanes;
        let [x, y, z] = [l.d_splat(normal.x), l.d_splat(normal.y), l.d_splat(normal.z)];
        let [px, py, pz] = [l.d_splat(point.x), l.d_splat(point.y), l.d_splat(point.z)];
        let mut met = 0;
        for (group, which) in packet::groups(rays) {
            let [o, d] = packet.four(group);
            let (dx, dy, dz) = (l.d_load(d[0]), l.d_load(d[1]), l.d_load(d[2]));
            let toward = l.d_add(l.d_add(l.d_mul(x, dx), l.d_mul(y, dy)), l.d_mul(z, dz));
            let (wx, wy, wz) = (l.d_sub(px, l.d_load(o[0])), l.d_sub(py, l.d_load(o[1])), l.d_sub(pz, l.d_load(o[2])));
            let away = l.d_add(l.d_add(l.d_mul(x, wx), l.d_mul(y, wy)), l.d_mul(z, wz));
            let (distances, limit) = (l.d_div(away, toward), l.d_load(four(t_max, group)));
            let zero = l.d_splat(0.0);
            let within = match &mut t {
                Some(t) => {
                    l.d_store(distances, &mut t.as_chunks_mut().0[group]);
                    l.d_le(distances, limit)
                }
                None => l.d_lt(distances, limit),
            };
            // A ray in or along the plane misses it.
            let hit = l.d_lt(zero, l.d_abs(toward)) & l.d_lt(zero, distances) & within;
            met |= Mask::from(hit & which) << (4 * group);
        }
        met
    }
}

/// The surface of a plane that some rays met.
struct MetPlane<'a> {
    plane: &'a PackedPlane,
    met: &'a Meeting<'a>,
    rays: Mask,
    surfaces: &'a mut Surfaces,
}

impl Job for MetPlane<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let Self { plane, met, rays, surfaces } = self;
        let normal = vector::splat(l, plane.normal);
        let error = l.d_splat(Surface::rounding(plane.point.abs().max_element()));
        for (group, which) in packet::groups(rays) {
            let way = vector::times(l, vector::load(l, &met.packet.directions, group), l.d_load(four(met.t, group)));
            let reached = vector::add(l, vector::load(l, &met.packet.origins, group), way);
            // Back onto the plane, as for a ray alone.
            let off = vector::dot(l, normal, vector::sub(l, vector::splat(l, plane.point), reached));
            let point = vector::add(l, reached, vector::times(l, normal, off));
            let [x, _, z] = vector::moved(l, &plane.object_from_world, point);
            vector::store(l, point, which, &mut surfaces.point, group);
            vector::store(l, normal, which, &mut surfaces.normal, group);
            vector::store(l, normal, which, &mut surfaces.shading_normal, group);
            vector::store(l, vector::splat(l, DVec3::ZERO), which, &mut surfaces.lift, group);
            l.d_store_some(error, which, &mut surfaces.error.as_chunks_mut().0[group]);
            l.d_store_some(x, which, &mut surfaces.uv[0].as_chunks_mut().0[group]);
            l.d_store_some(vector::minus(l, z), which, &mut surfaces.uv[1].as_chunks_mut().0[group]);
        }
        packet::each(rays).for_each(|i| surfaces.slot[i] = 0);
    }
}

impl Primitive for Plane {
    type Packed = PackedPlane;

    fn pack(&self, world_from_object: &DAffine3) -> Result<(Extent, PackedPlane), Degenerate> {
        let object_from_world = world_from_object.inverse();
        let normal = (object_from_world.matrix3.transpose() * DVec3::Y).normalize();
        let packed = PackedPlane { point: world_from_object.translation, normal, object_from_world };
        Ok((Extent::Unbounded, packed))
    }

    #[inline]
    fn hit(packed: &PackedPlane, ray: &Ray, t_max: f64, cost: &mut Cost) -> Option<Hit> {
        cost.primitives += 1;
        let toward = packed.normal.dot(ray.direction);
        // A ray in or along the plane misses it.
        if toward == 0.0 {
            return None;
        }
        let t = packed.normal.dot(packed.point - ray.origin) / toward;
        (t > 0.0 && t <= t_max).then_some(Hit { t, part: 0 })
    }

    fn hit_packet(
        packed: &PackedPlane,
        packet: &Packet,
        rays: Mask,
        t_max: &PerRay,
        hits: &mut Hits,
        cost: &mut Cost,
    ) -> Mask {
        cost.primitives += u64::from(rays.count_ones());
        let met = lanes::run(Crossings { plane: packed, packet, rays, t_max, t: Some(&mut hits.t) });
        packet::each(met).for_each(|i| hits.part[i] = 0);
        met
    }

    fn blocks_packet(packed: &PackedPlane, packet: &Packet, rays: Mask, t_max: &PerRay, cost: &mut Cost) -> Mask {
        cost.primitives += u64::from(rays.count_ones());
        lanes::run(Crossings { plane: packed, packet, rays, t_max, t: None })
    }

    fn surface(packed: &PackedPlane, ray: &Ray, hit: Hit) -> Surface {
        let reached = ray.at(hit.t);
        // Back onto the plane: at grazing angles `reached` is off by far more than an ulp.
        let point = reached + packed.normal * packed.normal.dot(packed.point - reached);
        let local = packed.object_from_world.transform_point3(point);
        Surface {
            point,
            normal: packed.normal,
            shading_normal: packed.normal,
            uv: DVec2::new(local.x, -local.z),
            slot: 0,
            error: Surface::rounding(packed.point.abs().max_element()),
        }
    }

    fn surface_packet(planes: &[PackedPlane], met: &Meeting<'_>, surfaces: &mut Surfaces) {
        let mut rest = met.rays;
        while rest != 0 {
            let plane = met.shape[rest.trailing_zeros() as usize];
            let rays = rest & met.with(plane);
            rest &= !rays;
            lanes::run(MetPlane { plane: &planes[plane as usize], met, rays, surfaces });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_hit_from_both_sides_and_never_along_itself() {
        let (extent, plane) = Plane {}.pack(&DAffine3::from_translation(DVec3::Y * 2.0)).expect("a plane");
        assert_eq!(extent, Extent::Unbounded);
        let t = |origin, direction| {
            Plane::hit(&plane, &Ray { origin, direction }, f64::INFINITY, &mut Cost::default()).map(|h| h.t)
        };
        assert_eq!(t(DVec3::Y * 5.0, DVec3::NEG_Y), Some(3.0));
        assert_eq!(t(DVec3::ZERO, DVec3::new(1.0, 0.5, 0.0)), Some(4.0));
        assert_eq!(t(DVec3::ZERO, DVec3::X), None);
        assert_eq!(t(DVec3::Y * 2.0, DVec3::Y), None);
    }
}
