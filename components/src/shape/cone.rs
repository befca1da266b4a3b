//! `Cone(radius: 1, height: 2)`: a solid cone that stands on y = 0, exact; with a `top` radius, its stump.
//!
//! Texture coordinates of the side: u once around Oy, 0 at −x going through +z, as on a sphere; v from the base, 0, to
//! the top, 1. Base and top carry the whole image in a square about the axis.

use crate::{
    describe::{Describe, Fault},
    math,
    primitive::{Cost, Degenerate, Extent, Hit, Primitive, Surface},
    space::{Bounds, Ray},
};
use bevy_ecs::prelude::*;
use core::f64::consts::PI;
use glam::{DAffine3, DVec2, DVec3};

/// A solid cone or its stump about Oy, from y = 0 up.
#[derive(Component, Clone, Debug, PartialEq, Describe)]
#[describe(check = Self::agrees)]
pub struct Cone {
    /// Radius of the base, object units.
    #[describe(not_negative, required)]
    pub radius: f64,
    /// Radius at the top, object units; 0 for a point.
    #[describe(not_negative)]
    pub top: f64,
    /// Height, object units.
    #[describe(positive, required)]
    pub height: f64,
}

impl Default for Cone {
    fn default() -> Self {
        Self { radius: 1.0, top: 0.0, height: 1.0 }
    }
}

impl Cone {
    /// Whether the fields go together.
    fn agrees(&self) -> Result<(), Fault> {
        if self.radius == 0.0 && self.top == 0.0 {
            return Err(Fault::new("radius", "more than 0 here or at the `top`"));
        }
        Ok(())
    }
}

/// A cone, its stump or a cylinder as the inner loop sees it.
#[derive(Clone, Debug)]
pub struct PackedCone {
    radius: f64,
    height: f64,
    /// By how much the radius grows with every unit of height.
    slope: f64,
    top: f64,
    object_from_world: DAffine3,
    world_from_object: DAffine3,
    /// Of a point of the surface, world units.
    error: f64,
}

/// Parts of the surface.
const SIDE: u32 = 0;
const BASE: u32 = 1;
const TOP: u32 = 2;

/// Where a line enters and leaves a convex body, and through which parts.
#[derive(Clone, Copy, Debug)]
struct Span {
    enter: (f64, u32),
    leave: (f64, u32),
}

impl Span {
    /// The part of the line in both bodies, if any; through the part of `self` where they agree.
    fn and(self, other: Self) -> Option<Self> {
        let enter = if other.enter.0 > self.enter.0 { other.enter } else { self.enter };
        let leave = if other.leave.0 < self.leave.0 { other.leave } else { self.leave };
        (enter.0 <= leave.0).then_some(Self { enter, leave })
    }
}

impl PackedCone {
    /// A cone from its radii at y = 0 and at its height.
    pub(super) fn place(
        Cone { radius, top, height }: Cone,
        world_from_object: &DAffine3,
    ) -> Result<(Extent, Self), Degenerate> {
        let all = DVec3::new(radius, top, height);
        if !(all.is_finite() && all.cmpge(DVec3::ZERO).all() && height > 0.0 && radius + top > 0.0) {
            return Err(Degenerate(format!(
                "its radii and height are not numbers above zero: {radius}, {top}, {height}"
            )));
        }
        let widest = if radius > top { radius } else { top };
        let bounds = Bounds { min: DVec3::new(-widest, 0.0, -widest), max: DVec3::new(widest, height, widest) };
        let bounds = bounds.transformed(world_from_object);
        if !(bounds.min.is_finite() && bounds.max.is_finite() && (widest * widest).is_finite()) {
            return Err(Degenerate("it is larger than numbers are".into()));
        }
        let packed = Self {
            radius,
            height,
            slope: (top - radius) / height,
            top,
            object_from_world: world_from_object.inverse(),
            world_from_object: *world_from_object,
            error: Surface::rounding(bounds.min.abs().max(bounds.max.abs()).max_element()),
        };
        Ok((Extent::Bounded(bounds), packed))
    }

    /// The part of a line between the planes of base and top.
    fn slab(&self, ray: &Ray) -> Option<Span> {
        let (y, dy) = (ray.origin.y, ray.direction.y);
        if dy == 0.0 {
            let always = Span { enter: (f64::NEG_INFINITY, BASE), leave: (f64::INFINITY, TOP) };
            return (y >= 0.0 && y <= self.height).then_some(always);
        }
        let (base, top) = ((-y / dy, BASE), ((self.height - y) / dy, TOP));
        Some(if dy > 0.0 { Span { enter: base, leave: top } } else { Span { enter: top, leave: base } })
    }

    /// The part of a line inside the unbounded cone: `x² + z² <= (radius + slope·y)²`, that is `a·t² + 2b·t + c <= 0`, on
    /// the side of the tip where the body is.
    fn side(&self, ray: &Ray) -> Option<Span> {
        let Ray { origin: o, direction: d } = *ray;
        let reach = self.radius + self.slope * o.y;
        let grows = self.slope * d.y;
        let a = d.x * d.x + d.z * d.z - grows * grows;
        let b = o.x * d.x + o.z * d.z - reach * grows;
        let c = o.x * o.x + o.z * o.z - reach * reach;
        let always = Span { enter: (f64::NEG_INFINITY, SIDE), leave: (f64::INFINITY, SIDE) };
        let square = b * b - a * c;
        if a > 0.0 {
            if square < 0.0 {
                return None;
            }
            let (near, far) = roots(a, b, c, square.sqrt());
            return Some(Span { enter: (near, SIDE), leave: (far, SIDE) });
        }
        if a == 0.0 && b == 0.0 {
            // Along the side of a cylinder.
            return (c <= 0.0).then_some(always);
        }
        // Steeper than the side: the line comes out of one half of the double cone, or goes into it, for good. Without a
        // root, which only rounding brings about, it goes through the tip.
        let (near, far) = roots(a, b, c, if square > 0.0 { square.sqrt() } else { 0.0 });
        let into = if a == 0.0 { b < 0.0 } else { grows > 0.0 };
        // As steep as the side: the other root is infinitely far.
        let (near, far) = if a == 0.0 { (-c / (2.0 * b), -c / (2.0 * b)) } else { (near, far) };
        Some(if into { Span { enter: (far, SIDE), ..always } } else { Span { leave: (near, SIDE), ..always } })
    }
}

/// The roots of `a·t² + 2b·t + c`, the lesser first, without cancellation; `root` is that of `b² − a·c`.
fn roots(a: f64, b: f64, c: f64, root: f64) -> (f64, f64) {
    let q = if b < 0.0 { root - b } else { -root - b };
    if q == 0.0 {
        return (0.0, 0.0);
    }
    let (t0, t1) = (q / a, c / q);
    if t0 < t1 { (t0, t1) } else { (t1, t0) }
}

impl Primitive for Cone {
    type Packed = PackedCone;

    fn pack(&self, world_from_object: &DAffine3) -> Result<(Extent, PackedCone), Degenerate> {
        PackedCone::place(self.clone(), world_from_object)
    }

    #[inline]
    fn hit(packed: &PackedCone, ray: &Ray, t_max: f64, cost: &mut Cost) -> Option<Hit> {
        cost.primitives += 1;
        let ray = ray.transformed(&packed.object_from_world);
        // From the point of the line that is nearest to the middle of the body, so that nothing cancels far away.
        let middle = DVec3::Y * (0.5 * packed.height);
        let shift = (middle - ray.origin).dot(ray.direction) / ray.direction.length_squared();
        let near = Ray { origin: ray.at(shift), ..ray };
        let span = packed.side(&near)?.and(packed.slab(&near)?)?;
        let (t, part) = if shift + span.enter.0 > 0.0 { span.enter } else { span.leave };
        let t = shift + t;
        (t > 0.0 && t <= t_max).then_some(Hit { t, part })
    }

    fn surface(packed: &PackedCone, ray: &Ray, hit: Hit) -> Surface {
        let local = ray.transformed(&packed.object_from_world).at(hit.t);
        let flat = DVec2::new(local.x, local.z);
        let uv = if hit.part == SIDE {
            let out = flat.normalize_or(DVec2::X);
            let u = 0.5 + math::atan2(-out.y, out.x) / (2.0 * PI);
            DVec2::new(u, local.y.clamp(0.0, packed.height) / packed.height)
        } else {
            let (radius, up) = if hit.part == TOP { (packed.top, 1.0) } else { (packed.radius, -1.0) };
            // Seen from outside, as the top and bottom of a box.
            let unit = if radius > 0.0 { flat / radius } else { DVec2::ZERO };
            DVec2::new(0.5 + 0.5 * unit.x, 0.5 - 0.5 * up * unit.y)
        };
        Surface { uv, ..Self::surface_without_uv(packed, ray, hit) }
    }

    fn surface_without_uv(packed: &PackedCone, ray: &Ray, hit: Hit) -> Surface {
        let mut local = ray.transformed(&packed.object_from_world).at(hit.t);
        let outward = if hit.part == SIDE {
            local.y = local.y.clamp(0.0, packed.height);
            let out = DVec2::new(local.x, local.z).normalize_or(DVec2::X);
            let radius = packed.radius + packed.slope * local.y;
            (local.x, local.z) = (out.x * radius, out.y * radius);
            DVec3::new(out.x, -packed.slope, out.y)
        } else {
            let (y, up) = if hit.part == TOP { (packed.height, 1.0) } else { (0.0, -1.0) };
            local.y = y;
            DVec3::Y * up
        };
        let normal = (packed.object_from_world.matrix3.transpose() * outward).normalize_or(DVec3::Y);
        Surface {
            point: packed.world_from_object.transform_point3(local),
            normal,
            shading_normal: normal,
            uv: DVec2::ZERO,
            slot: 0,
            error: packed.error,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;
    use glam::DMat3;

    fn packed(radius: f64, top: f64, height: f64, placement: DAffine3) -> PackedCone {
        Cone { radius, top, height }.pack(&placement).expect("a cone").1
    }

    fn trace(cone: &PackedCone, origin: DVec3, direction: DVec3) -> Option<Hit> {
        Cone::hit(cone, &Ray { origin, direction }, f64::INFINITY, &mut Cost::default())
    }

    #[test]
    fn closed_forms_on_the_axis_and_across_it() {
        let cone = packed(1.0, 0.0, 2.0, DAffine3::IDENTITY);
        assert_eq!(trace(&cone, DVec3::Y * 5.0, DVec3::NEG_Y).map(|hit| hit.t), Some(3.0), "the tip");
        assert_eq!(trace(&cone, DVec3::Y * -5.0, DVec3::Y), Some(Hit { t: 5.0, part: BASE }));
        assert_eq!(trace(&cone, DVec3::new(-5.0, 1.0, 0.0), DVec3::X), Some(Hit { t: 4.5, part: SIDE }));
        assert_eq!(trace(&cone, DVec3::Y, DVec3::X), Some(Hit { t: 0.5, part: SIDE }), "from inside");
        assert_eq!(trace(&cone, DVec3::new(0.25, 5.0, 0.0), DVec3::NEG_Y).map(|hit| hit.t), Some(3.5));
        assert_eq!(trace(&cone, DVec3::new(0.0, 3.0, -5.0), DVec3::Z), None, "over the tip, in the other half");
        let stump = packed(1.0, 3.0, 1.0, DAffine3::IDENTITY);
        assert_eq!(trace(&stump, DVec3::new(2.0, 5.0, 0.0), DVec3::NEG_Y), Some(Hit { t: 4.0, part: TOP }));
        assert_eq!(trace(&stump, DVec3::new(2.0, -5.0, 0.0), DVec3::Y), Some(Hit { t: 5.5, part: SIDE }));
        let pipe = packed(1.0, 1.0, 1.0, DAffine3::IDENTITY);
        assert_eq!(trace(&pipe, DVec3::new(1.0, 5.0, 0.0), DVec3::NEG_Y).map(|hit| hit.t), Some(4.0), "in the side");
    }

    #[test]
    fn a_cone_larger_than_numbers_has_no_surface() {
        let huge = Cone { radius: f64::MAX, top: 0.0, height: 1.0 };
        assert!(huge.pack(&DAffine3::from_scale(DVec3::splat(3.0))).is_err());
        assert!(Cone { radius: 1e38, ..huge }.pack(&DAffine3::IDENTITY).is_ok());
    }

    #[test]
    fn normals_stand_on_both_tangents() {
        let sheared = DAffine3::from_mat3(
            DMat3::from_rotation_x(0.9) * DMat3::from_diagonal(DVec3::new(1.0, 0.4, 1.7)) * DMat3::from_rotation_z(0.5),
        );
        let mut random = SplitMix64::new(4);
        for (radius, top, height) in [(1.0, 0.0, 2.0), (0.05, 0.0, 3.0), (0.3, 2.0, 0.5), (0.01, 0.01, 3.0)] {
            let cone = packed(radius, top, height, sheared);
            let mut sides = 0;
            for _ in 0..2000 {
                let mut number = |reach: f64| reach * (2.0 * random.unit() - 1.0);
                let within = DVec3::new(number(radius + top), 0.5 * height + number(height), number(radius + top));
                let toward = sheared.transform_point3(within);
                let origin = 5.0 * DVec3::new(number(1.0), number(1.0), number(1.0));
                let ray = Ray { origin, direction: toward - origin };
                let Some(hit) = Cone::hit(&cone, &ray, f64::INFINITY, &mut Cost::default()) else { continue };
                let surface = Cone::surface(&cone, &ray, hit);
                let local = sheared.inverse().transform_point3(surface.point);
                // Around the axis and along the side, or two ways in the plane of base and top.
                let out = DVec3::new(local.x, 0.0, local.z).normalize();
                let along = out * ((top - radius) / height) + DVec3::Y;
                let tangents = if hit.part == SIDE { [out.cross(DVec3::Y), along] } else { [DVec3::X, DVec3::Z] };
                sides += u32::from(hit.part == SIDE);
                for tangent in tangents.map(|tangent| sheared.transform_vector3(tangent).normalize()) {
                    let sine = surface.normal.dot(tangent).abs();
                    assert!(sine < 1e-11, "{radius} {top} {ray:?}: {sine:e}");
                }
            }
            assert!(sides > 400, "{sides}");
        }
    }

    #[test]
    fn rays_as_steep_as_the_side() {
        let cone = packed(1.0, 0.0, 1.0, DAffine3::IDENTITY);
        let steep = DVec3::new(1.0, -1.0, 0.0);
        // Parallel to the side at +x, half a unit below it: in through the side at −x, out through the base.
        let hit = trace(&cone, DVec3::new(-1.5, 2.0, 0.0), steep).expect("a hit");
        assert!((hit.t - 1.25).abs() < 1e-15 && hit.part == SIDE, "{hit:?}");
        assert_eq!(trace(&cone, DVec3::new(-0.25, 0.5, 0.0), steep), Some(Hit { t: 0.5, part: BASE }));
        assert_eq!(trace(&cone, DVec3::new(-0.5, 2.0, 0.0), steep), None, "half a unit above it");
    }

    /// Whether a point is inside by more than `margin`, outside by more than it, or neither.
    fn inside(cone: &Cone, p: DVec3, margin: f64) -> Option<bool> {
        let radius = cone.radius + (cone.top - cone.radius) * p.y / cone.height;
        let gaps = [p.y, cone.height - p.y, radius - (p.x * p.x + p.z * p.z).sqrt()];
        let least = gaps.into_iter().fold(f64::INFINITY, f64::min);
        (least.abs() > margin).then_some(least > 0.0)
    }

    #[test]
    fn before_a_hit_is_outside_and_after_it_inside() {
        let mut random = SplitMix64::new(3);
        let (mut hits, mut misses) = (0, 0);
        for cone in [(1.0, 0.0, 2.0), (1.0, 1.0, 1.0), (0.3, 2.0, 0.5), (0.0, 1.0, 1.0)] {
            let cone = Cone { radius: cone.0, top: cone.1, height: cone.2 };
            let (_, packed) = cone.pack(&DAffine3::IDENTITY).expect("a cone");
            for _ in 0..5000 {
                let mut point = |reach: f64| DVec3::from_array([(); 3].map(|()| reach * (2.0 * random.unit() - 1.0)));
                let origin = point(4.0);
                let ray = Ray { origin, direction: point(1.5) - origin };
                let first = Cone::hit(&packed, &ray, f64::INFINITY, &mut Cost::default());
                let begins_inside = inside(&cone, origin, 0.0) == Some(true);
                // What the point says anywhere along the ray must agree with what the hits say.
                let second = first.and_then(|hit| {
                    let after = Ray { origin: ray.at(hit.t + 1e-9), ..ray };
                    Cone::hit(&packed, &after, f64::INFINITY, &mut Cost::default()).map(|next| hit.t + 1e-9 + next.t)
                });
                for step in 0..100 {
                    let t = f64::from(step) * 0.03;
                    let crossed = [first.map(|hit| hit.t), second].into_iter().flatten().filter(|at| *at < t).count();
                    let expected = begins_inside ^ (crossed % 2 == 1);
                    let found = inside(&cone, ray.at(t), 1e-7);
                    assert!(found.is_none_or(|found| found == expected), "{cone:?} {ray:?} at {t}");
                }
                match first {
                    Some(hit) => {
                        hits += 1;
                        let surface = Cone::surface(&packed, &ray, hit);
                        assert!((surface.point - ray.at(hit.t)).length() <= surface.error, "{ray:?}");
                        assert!((surface.normal.dot(ray.direction) > 0.0) == begins_inside, "{ray:?}");
                    }
                    None => misses += 1,
                }
            }
        }
        assert!(hits > 3000 && misses > 3000, "{hits} {misses}");
    }

    #[test]
    fn no_ray_slips_through_the_rim() {
        let cone = packed(1.0, 0.5, 1.0, DAffine3::IDENTITY);
        let mut random = SplitMix64::new(8);
        for n in 0..100_000 {
            let (sin, cos) = math::sin_cos_degrees(360.0 * random.unit());
            let rim = if n % 2 == 0 { DVec3::new(cos, 0.0, sin) } else { DVec3::new(0.5 * cos, 1.0, 0.5 * sin) };
            let within =
                DVec3::new(0.3 * (random.unit() - 0.5), 0.2 + 0.6 * random.unit(), 0.3 * (random.unit() - 0.5));
            let origin = rim + (rim - within) * (3.0 * random.unit());
            let hit = trace(&cone, origin, within - origin).expect("the ray goes inside");
            assert!(hit.t <= 1.0, "{hit:?}");
        }
    }

    #[test]
    fn far_and_scaled_cones_keep_their_digits() {
        for exponent in 0..10 {
            let distance = 3.0 * math::pow(10.0, f64::from(exponent));
            let placement = DAffine3::from_translation(DVec3::new(distance, 0.0, 0.0));
            let cone = packed(1.0, 0.0, 2.0, placement);
            let hit = trace(&cone, DVec3::Y, DVec3::X).expect("a hit");
            assert!((hit.t - (distance - 0.5)).abs() <= 8.0 * f64::EPSILON * distance, "{distance}: {hit:?}");
        }
        let wide = packed(1.0, 0.0, 2.0, DAffine3::from_scale(DVec3::new(3.0, 1.0, 1.0)));
        assert_eq!(trace(&wide, DVec3::new(-5.0, 1.0, 0.0), DVec3::X).map(|hit| hit.t), Some(3.5));
    }
}
