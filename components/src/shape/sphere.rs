//! `Sphere(radius: 1)`: a sphere about the origin of its object space; an ellipsoid when scaled unevenly.
//!
//! Texture coordinates: u runs once around Oy, 0 at −x going through +z; v runs from the lowest point, 0, to the
//! highest, 1.

use crate::{
    describe::Describe,
    lanes::{self, Job, Lanes, vector},
    math,
    method::{Methods, Precision, SphereTest},
    packet::{self, Hits, Mask, Packet, PerRay, four},
    primitive::{Cost, Degenerate, Extent, Hit, OFFSET_ULPS, Primitive, Surface, surface_alone},
    real::{self, Real, Vector},
    space::{BoundingSphere, Bounds, Ray},
    surfaces::{Meeting, Surfaces},
};
use bevy_ecs::prelude::*;
use core::f64::consts::PI;
use glam::{DAffine3, DMat3, DVec2, DVec3};

/// A sphere about the origin of its object space.
#[derive(Component, Clone, Debug, PartialEq, Describe)]
pub struct Sphere {
    /// Radius, object units.
    #[describe(positive, required)]
    pub radius: f64,
}

impl Default for Sphere {
    fn default() -> Self {
        Self { radius: 1.0 }
    }
}

/// A sphere as the inner loop sees it.
#[derive(Clone, Debug)]
pub struct PackedSphere {
    /// World space for a ball, object space for an ellipsoid.
    center: DVec3,
    radius: f64,
    /// What tests of balls do not need stands apart, so that they find more balls in the caches.
    form: Form,
}

/// What the placement of a sphere makes of it.
#[derive(Clone, Debug)]
enum Form {
    /// The map turns world directions into the sphere's own, for texture coordinates.
    Ball(Box<DMat3>),
    Ellipsoid(Box<Ellipsoid>),
}

#[derive(Clone, Debug)]
struct Ellipsoid {
    object_from_world: DAffine3,
    world_from_object: DAffine3,
}

impl PackedSphere {
    /// Unit normal and point nearest to `p`, in the space of `center`.
    fn project(&self, p: DVec3) -> (DVec3, DVec3) {
        let normal = (p - self.center).normalize_or(DVec3::Y);
        (normal, self.center + normal * self.radius)
    }

    #[inline(always)]
    fn hit_by(
        &self,
        root: impl Fn(DVec3, f64, &Ray, f64) -> Option<f64>,
        ray: &Ray,
        t_max: f64,
        cost: &mut Cost,
    ) -> Option<Hit> {
        cost.primitives += 1;
        let t = match &self.form {
            Form::Ball(_) => root(self.center, self.radius, ray, t_max),
            Form::Ellipsoid(maps) => root(self.center, self.radius, &ray.transformed(&maps.object_from_world), t_max),
        };
        t.map(|t| Hit { t, part: 0 })
    }
}

/// The nearest hit of a sphere with `0 < t <= t_max`.
///
/// The discriminant comes from the perpendicular foot of the centre on the ray and the nearer root from `c/q`, so that
/// neither cancels however far or large the sphere (Haines, Günther, Akenine-Möller: Precision Improvements for
/// Ray/Sphere Intersection, Ray Tracing Gems 7; `c` as a product after the same chapter's remark on huge spheres).
#[must_use]
#[inline(always)]
pub fn nearest_root<R: Real>(center: DVec3, radius: f64, ray: &Ray, t_max: f64) -> Option<f64> {
    let d: Vector<R> = real::vector(ray.direction);
    let f = real::minus(real::vector(ray.origin), real::vector(center));
    let radius = R::of(radius);
    let a = real::dot(d, d);
    let b = -real::dot(f, d);
    let foot = real::plus(f, real::times(d, b / a));
    let gap = radius * radius - real::dot(foot, foot);
    if gap < R::ZERO {
        return None;
    }
    let distance = real::dot(f, f).sqrt();
    let c = (distance - radius) * (distance + radius);
    let root = (a * gap).sqrt();
    let q = if b < R::ZERO { b - root } else { b + root };
    // `q` is zero only for a ray tangent at its own origin.
    let (t0, t1) = if q == R::ZERO { (R::ZERO, R::ZERO) } else { (c / q, q / a) };
    nearer(t0, t1, t_max)
}

/// [`nearest_root`] in `f64` of four rays: which are hit, and at what distances.
#[inline(always)]
fn nearest_roots<L: Lanes>(
    lanes: L,
    center: DVec3,
    radius: f64,
    [origins, directions]: [[&[f64; 4]; 3]; 2],
    t_max: &[f64; 4],
) -> (u32, L::D) {
    let l = lanes;
    let [x, y, z] = [l.d_load(directions[0]), l.d_load(directions[1]), l.d_load(directions[2])];
    let fx = l.d_sub(l.d_load(origins[0]), l.d_splat(center.x));
    let fy = l.d_sub(l.d_load(origins[1]), l.d_splat(center.y));
    let fz = l.d_sub(l.d_load(origins[2]), l.d_splat(center.z));
    let (zero, radius) = (l.d_splat(0.0), l.d_splat(radius));
    let a = vector::dot(l, [x, y, z], [x, y, z]);
    // Nothing cancels in a changed sign: −b for b.
    let minus_b = vector::dot(l, [fx, fy, fz], [x, y, z]);
    let step = l.d_div(minus_b, a);
    let foot = [l.d_sub(fx, l.d_mul(x, step)), l.d_sub(fy, l.d_mul(y, step)), l.d_sub(fz, l.d_mul(z, step))];
    let gap = l.d_sub(l.d_mul(radius, radius), vector::dot(l, foot, foot));
    let missed = l.d_lt(gap, zero);
    if missed == 0b1111 {
        return (0, zero);
    }
    let distance = l.d_sqrt(vector::dot(l, [fx, fy, fz], [fx, fy, fz]));
    let c = l.d_mul(l.d_sub(distance, radius), l.d_add(distance, radius));
    let root = l.d_sqrt(l.d_mul(a, gap));
    let b = l.d_sub(zero, minus_b);
    let q = l.d_if_lt(b, zero, l.d_sub(b, root), l.d_add(b, root));
    let (t0, t1) = (l.d_div(c, q), l.d_div(q, a));
    let (near, far) = (l.d_if_lt(t0, t1, t0, t1), l.d_if_lt(t0, t1, t1, t0));
    let t = l.d_if_lt(zero, near, near, far);
    let hit = l.d_lt(zero, t) & l.d_le(t, l.d_load(t_max)) & l.d_lt(zero, l.d_abs(q));
    (hit & !missed, t)
}

/// The test of a ball with some rays of a packet; tells which hit up to `t_max`, and where if that is asked for.
struct Roots<'a> {
    center: DVec3,
    radius: f64,
    packet: &'a Packet,
    rays: Mask,
    t_max: &'a PerRay,
    t: Option<&'a mut PerRay>,
}

impl Job for Roots<'_> {
    type Output = Mask;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Mask {
        let Self { center, radius, packet, rays, t_max, mut t } = self;
        let mut met = 0;
        for (group, which) in packet::groups(rays) {
            let t_max = four(t_max, group);
            let (hit, distances) = nearest_roots(lanes, center, radius, packet.four(group), t_max);
            let hit = match &mut t {
                Some(t) => {
                    lanes.d_store(distances, &mut t.as_chunks_mut().0[group]);
                    hit
                }
                None => hit & lanes.d_lt(distances, lanes.d_load(t_max)),
            };
            met |= Mask::from(hit & which) << (4 * group);
        }
        met
    }
}

/// The nearest hit with `0 < t <= t_max` by the quadratic as textbooks have it: the discriminant cancels for spheres
/// that are far away or large, and the nearer root from within or near the surface.
#[must_use]
#[inline]
pub fn naive_root<R: Real>(center: DVec3, radius: f64, ray: &Ray, t_max: f64) -> Option<f64> {
    let d: Vector<R> = real::vector(ray.direction);
    let f = real::minus(real::vector(ray.origin), real::vector(center));
    let (radius, two) = (R::of(radius), R::ONE + R::ONE);
    let a = real::dot(d, d);
    let b = two * real::dot(f, d);
    let c = real::dot(f, f) - radius * radius;
    let discriminant = b * b - two * two * a * c;
    if discriminant < R::ZERO {
        return None;
    }
    let root = discriminant.sqrt();
    nearer((-b - root) / (two * a), (-b + root) / (two * a), t_max)
}

/// The lesser of two distances that is more than zero.
#[inline]
fn nearer<R: Real>(t0: R, t1: R, t_max: f64) -> Option<f64> {
    let (near, far) = if t0 < t1 { (t0, t1) } else { (t1, t0) };
    let t = if near > R::ZERO { near } else { far }.to_f64();
    (t > 0.0 && t <= t_max).then_some(t)
}

impl Primitive for Sphere {
    type Packed = PackedSphere;

    fn pack(&self, world_from_object: &DAffine3) -> Result<(Extent, PackedSphere), Degenerate> {
        if !(self.radius > 0.0 && self.radius.is_finite()) {
            return Err(Degenerate(format!("its radius is not a number above zero: {}", self.radius)));
        }
        if !(self.radius * self.radius).is_finite() {
            return Err(Degenerate(format!("its radius is too large, the square is not finite: {}", self.radius)));
        }
        let object_from_world = world_from_object.inverse();
        if let Some(scale) = uniform_scale(&world_from_object.matrix3) {
            let (center, radius) = (world_from_object.translation, self.radius * scale);
            let margin = 8.0 * f64::EPSILON * (radius + center.abs().max_element());
            let bounds = Bounds { min: center - radius, max: center + radius }.widened(margin);
            let form = Form::Ball(Box::new(object_from_world.matrix3));
            return Ok((Extent::Bounded(bounds), PackedSphere { center, radius, form }));
        }
        // Half-extent of an ellipsoid along each world axis: the norm of that row of the matrix.
        let m = world_from_object.matrix3.transpose();
        let half = DVec3::new(m.x_axis.length(), m.y_axis.length(), m.z_axis.length()) * self.radius;
        let center = world_from_object.translation;
        let bounds = Bounds { min: center - half, max: center + half };
        let margin = 64.0 * f64::EPSILON * (half + center.abs()).max_element();
        let maps = Ellipsoid { object_from_world, world_from_object: *world_from_object };
        let form = Form::Ellipsoid(Box::new(maps));
        Ok((Extent::Bounded(bounds.widened(margin)), PackedSphere { center: DVec3::ZERO, radius: self.radius, form }))
    }

    #[inline(always)]
    fn hit(packed: &PackedSphere, ray: &Ray, t_max: f64, cost: &mut Cost) -> Option<Hit> {
        packed.hit_by(nearest_root::<f64>, ray, t_max, cost)
    }

    fn hit_with(packed: &PackedSphere, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> Option<Hit> {
        let root = match (with.sphere, with.precision) {
            (SphereTest::Robust, Precision::F64) => nearest_root::<f64>,
            (SphereTest::Robust, Precision::F32) => nearest_root::<f32>,
            (SphereTest::Naive, Precision::F64) => naive_root::<f64>,
            (SphereTest::Naive, Precision::F32) => naive_root::<f32>,
        };
        packed.hit_by(root, ray, t_max, cost)
    }

    #[inline]
    fn hit_packet(
        packed: &PackedSphere,
        packet: &Packet,
        rays: Mask,
        t_max: &PerRay,
        hits: &mut Hits,
        cost: &mut Cost,
    ) -> Mask {
        let PackedSphere { center, radius, .. } = *packed;
        match packed.form {
            Form::Ball(_) if rays.count_ones() > 1 => {
                cost.primitives += u64::from(rays.count_ones());
                let met = lanes::run(Roots { center, radius, packet, rays, t_max, t: Some(&mut hits.t) });
                packet::each(met).for_each(|i| hits.part[i] = 0);
                met
            }
            _ => packet::hit_each(rays, hits, |i| Self::hit(packed, &packet.ray(i), t_max[i], cost)),
        }
    }

    #[inline]
    fn blocks_packet(packed: &PackedSphere, packet: &Packet, rays: Mask, t_max: &PerRay, cost: &mut Cost) -> Mask {
        let PackedSphere { center, radius, .. } = *packed;
        match packed.form {
            Form::Ball(_) if rays.count_ones() > 1 => {
                cost.primitives += u64::from(rays.count_ones());
                lanes::run(Roots { center, radius, packet, rays, t_max, t: None })
            }
            _ => packet::those(rays, |i| Self::blocks(packed, &packet.ray(i), t_max[i], cost)),
        }
    }

    fn surface(packed: &PackedSphere, ray: &Ray, hit: Hit) -> Surface {
        let surface = Self::surface_without_uv(packed, ray, hit);
        let local = match &packed.form {
            Form::Ball(object_from_world) => (**object_from_world * surface.normal).normalize_or(DVec3::Y),
            Form::Ellipsoid(maps) => packed.project(ray.transformed(&maps.object_from_world).at(hit.t)).0,
        };
        Surface { uv: sphere_uv(local), ..surface }
    }

    fn surface_without_uv(packed: &PackedSphere, ray: &Ray, hit: Hit) -> Surface {
        let (point, normal, reach) = match &packed.form {
            Form::Ball(_) => {
                let (normal, point) = packed.project(ray.at(hit.t));
                (point, normal, packed.center.abs().max_element() + packed.radius)
            }
            Form::Ellipsoid(maps) => {
                let (local, at) = packed.project(ray.transformed(&maps.object_from_world).at(hit.t));
                let normal = (maps.object_from_world.matrix3.transpose() * local).normalize_or(DVec3::Y);
                let m = maps.world_from_object;
                let reach = m.translation.abs().max_element() + packed.radius * largest_axis(&m.matrix3);
                (m.transform_point3(at), normal, reach)
            }
        };
        let error = Surface::rounding(reach);
        Surface { point, normal, shading_normal: normal, uv: DVec2::ZERO, slot: 0, error }
    }

    fn surface_packet(spheres: &[PackedSphere], met: &Meeting<'_>, surfaces: &mut Surfaces) {
        let mut balls = 0;
        for i in packet::each(met.rays) {
            let sphere = &spheres[met.shape[i] as usize];
            match sphere.form {
                Form::Ball(_) => balls |= 1 << i,
                Form::Ellipsoid(_) => {
                    let (ray, _, hit) = met.of(i);
                    surface_alone::<Self>(sphere, &ray, hit, met.textured >> i & 1 != 0, i, surfaces);
                }
            }
        }
        lanes::run(Balls { spheres, met, balls, surfaces });
        for i in packet::each(balls & met.textured) {
            if let Form::Ball(object_from_world) = &spheres[met.shape[i] as usize].form {
                let normal = packet::vector_of(&surfaces.normal, i);
                surfaces.set_uv(i, sphere_uv((**object_from_world * normal).normalize_or(DVec3::Y)));
            }
        }
    }

    fn bounding_sphere(packed: &PackedSphere, bounds: &Bounds) -> BoundingSphere {
        match packed.form {
            Form::Ball(_) => BoundingSphere::about(packed.center, [packed.center + DVec3::X * packed.radius]),
            Form::Ellipsoid(_) => BoundingSphere::of_bounds(bounds),
        }
    }
}

/// The surfaces of balls that some rays met, but for texture coordinates.
struct Balls<'a> {
    spheres: &'a [PackedSphere],
    met: &'a Meeting<'a>,
    balls: Mask,
    surfaces: &'a mut Surfaces,
}

impl Job for Balls<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let Self { spheres, met, balls, surfaces } = self;
        let up = vector::splat(l, DVec3::Y);
        for (group, which) in packet::groups(balls) {
            // Their centres, and their radii.
            let mut of = [[0.0; 4]; 4];
            for lane in 0..4 {
                if which >> lane & 1 != 0 {
                    let PackedSphere { center, radius, .. } = &spheres[met.shape[4 * group + lane] as usize];
                    (of[0][lane], of[1][lane], of[2][lane], of[3][lane]) = (center.x, center.y, center.z, *radius);
                }
            }
            let center = [l.d_load(&of[0]), l.d_load(&of[1]), l.d_load(&of[2])];
            let radius = l.d_load(&of[3]);
            let way = vector::times(l, vector::load(l, &met.packet.directions, group), l.d_load(four(met.t, group)));
            let reached = vector::add(l, vector::load(l, &met.packet.origins, group), way);
            let normal = vector::unit_or(l, vector::sub(l, reached, center), up);
            let point = vector::add(l, center, vector::times(l, normal, radius));
            let reach = l.d_add(vector::reach(l, center), radius);
            let error = l.d_mul(l.d_splat(OFFSET_ULPS * f64::EPSILON), reach);
            vector::store(l, point, which, &mut surfaces.point, group);
            vector::store(l, normal, which, &mut surfaces.normal, group);
            vector::store(l, normal, which, &mut surfaces.shading_normal, group);
            vector::store(l, vector::splat(l, DVec3::ZERO), which, &mut surfaces.lift, group);
            l.d_store_some(error, which, &mut surfaces.error.as_chunks_mut().0[group]);
            for lane in 0..4 {
                if which >> lane & 1 != 0 {
                    surfaces.slot[4 * group + lane] = 0;
                }
            }
        }
    }
}

/// Texture coordinates where a unit vector from the centre, object space, meets a sphere.
pub(crate) fn sphere_uv(outward: DVec3) -> DVec2 {
    let u = 0.5 + math::atan2(-outward.z, outward.x) / (2.0 * PI);
    DVec2::new(u, 1.0 - math::acos(outward.y) / PI)
}

/// The one factor by which a matrix scales every direction, if there is one up to rounding.
fn uniform_scale(m: &DMat3) -> Option<f64> {
    let gram = m.transpose() * *m;
    let square = gram.x_axis.x;
    let rest = gram - DMat3::from_diagonal(DVec3::splat(square));
    let off = [rest.x_axis, rest.y_axis, rest.z_axis].map(|c| c.abs().max_element());
    let largest = if off[0] > off[1] { off[0] } else { off[1] };
    let largest = if largest > off[2] { largest } else { off[2] };
    (largest <= 32.0 * f64::EPSILON * square).then(|| square.sqrt())
}

fn largest_axis(m: &DMat3) -> f64 {
    let squares = [m.x_axis.length_squared(), m.y_axis.length_squared(), m.z_axis.length_squared()];
    squares.into_iter().fold(0.0, f64::max).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trace(sphere: &PackedSphere, origin: DVec3, direction: DVec3) -> Option<f64> {
        Sphere::hit(sphere, &Ray { origin, direction }, f64::INFINITY, &mut Cost::default()).map(|h| h.t)
    }

    fn packed(radius: f64, placement: DAffine3) -> PackedSphere {
        Sphere { radius }.pack(&placement).expect("a sphere").1
    }

    #[test]
    fn far_and_huge_spheres_keep_their_digits() {
        for exponent in 0..12 {
            let distance = math::pow(10.0, f64::from(exponent)) * 3.0;
            let sphere = packed(1.0, DAffine3::from_translation(DVec3::Z * distance));
            let t = trace(&sphere, DVec3::new(0.5, 0.0, 0.0), DVec3::Z).expect("a hit");
            let exact = distance - 0.75f64.sqrt();
            assert!((t - exact).abs() <= 4.0 * f64::EPSILON * distance, "{distance}: {t} against {exact}");
        }
        let globe = packed(1e12, DAffine3::from_translation(DVec3::Y * -1e12));
        let t = trace(&globe, DVec3::Y, DVec3::NEG_Y).expect("a hit");
        assert!((t - 1.0).abs() < 1e-3, "one above a sphere of 1e12: {t}");
    }

    #[test]
    fn from_inside_the_far_side_is_hit() {
        let sphere = packed(2.0, DAffine3::IDENTITY);
        assert_eq!(trace(&sphere, DVec3::ZERO, DVec3::X), Some(2.0));
        assert_eq!(trace(&sphere, DVec3::X * 5.0, DVec3::X), None);
        assert_eq!(trace(&sphere, DVec3::X * -5.0, DVec3::X * 0.5), Some(6.0));
    }

    #[test]
    fn uneven_scale_makes_an_ellipsoid() {
        let sphere = packed(1.0, DAffine3::from_scale(DVec3::new(3.0, 1.0, 1.0)));
        let ray = Ray { origin: DVec3::X * 10.0, direction: DVec3::NEG_X };
        let hit = Sphere::hit(&sphere, &ray, f64::INFINITY, &mut Cost::default()).expect("a hit");
        assert_eq!(hit.t, 7.0);
        let surface = Sphere::surface(&sphere, &ray, hit);
        assert_eq!((surface.point, surface.normal), (DVec3::X * 3.0, DVec3::X));
    }
}
