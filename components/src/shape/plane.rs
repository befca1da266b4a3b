//! `Plane()`: the unbounded plane through the origin of its object space, normal +y: a ground parallel to Oxz.
//!
//! Texture coordinates are the object-space x and −z, so an image repeats once per object unit.

use crate::{
    describe::Describe,
    primitive::{Cost, Degenerate, Extent, Hit, Primitive, Surface},
    space::Ray,
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
