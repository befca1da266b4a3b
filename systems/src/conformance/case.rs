//! A shape in one placement, and the rays that it is tried with.

use super::{Report, watch::Watch};
use crate::render::Key;
use glam::{DAffine3, DVec3};
use snell_components::{
    primitive::{Cost, Extent, Hit, Primitive, Surface},
    space::{Bounds, Ray},
    transform::{Step, Transform},
};

pub(super) struct Case<P: Primitive> {
    pub name: String,
    pub packed: P::Packed,
    /// None if it is not bounded.
    pub bounds: Option<Bounds>,
    pub center: DVec3,
    /// Half the diagonal of the bounds; more than zero.
    pub size: f64,
    /// Maps the shape as it is to this placement.
    pub placed: DAffine3,
    watch: Watch,
}

/// Placements that shapes of a size are tried in.
fn placements(size: f64) -> [(&'static str, Vec<Step>); 6] {
    let sheared = vec![Step::RotateZ(30.0), Step::Scale(DVec3::new(1.0, 0.4, 1.7)), Step::RotateX(50.0)];
    [
        ("as it is", vec![]),
        ("small", vec![Step::Scale(DVec3::splat(1e-4))]),
        ("large", vec![Step::Scale(DVec3::splat(1e4))]),
        ("far away", vec![Step::RotateY(20.0), Step::Translate(DVec3::new(3e4, -7e4, 2e4) * size)]),
        ("mirrored", vec![Step::Scale(DVec3::new(-1.0, 1.0, 1.0)), Step::Translate(DVec3::new(0.3, 0.2, 0.1) * size)]),
        ("sheared", sheared),
    ]
}

impl<P: Primitive> Case<P> {
    /// The shape in all placements; those that cannot be packed are reported.
    pub(super) fn all(shape: &P, name: &str, watch: &Watch, report: &mut Report) -> Vec<Self> {
        let placed = |(placement, steps)| {
            let name = format!("{name}, {placement}");
            let world_from_object = Transform::new(steps).matrix();
            watch.asks(&name, None);
            match shape.pack(&world_from_object) {
                Ok((extent, packed)) => Self::new((name, watch), packed, extent, world_from_object, report),
                Err(why) => {
                    report.add("pack", &name, format!("cannot be packed: {}", why.0));
                    None
                }
            }
        };
        let size = match shape.pack(&DAffine3::IDENTITY) {
            Ok((Extent::Bounded(bounds), _)) => 0.5 * (bounds.max - bounds.min).length(),
            _ => 1.0,
        };
        placements(size).into_iter().filter_map(placed).collect()
    }

    fn new(
        (name, watch): (String, &Watch),
        packed: P::Packed,
        extent: Extent,
        placed: DAffine3,
        report: &mut Report,
    ) -> Option<Self> {
        let (bounds, center, size) = match extent {
            Extent::Unbounded => (None, placed.translation, placed.transform_vector3(DVec3::ONE).length()),
            Extent::Bounded(bounds) => {
                let in_order = bounds.min.is_finite() && bounds.max.is_finite() && bounds.min.cmple(bounds.max).all();
                if !in_order {
                    report.add("pack", &name, format!("bounds are not finite or not in order: {bounds:?}"));
                    return None;
                }
                let size = 0.5 * (bounds.max - bounds.min).length();
                (Some(bounds), 0.5 * (bounds.min + bounds.max), size.max(f64::MIN_POSITIVE))
            }
        };
        Some(Self { name, packed, bounds, center, size, placed, watch: watch.clone() })
    }

    pub(super) fn hit(&self, ray: &Ray, t_max: f64) -> Option<Hit> {
        self.watch.asks(&self.name, Some(ray));
        P::hit(&self.packed, ray, t_max, &mut Cost::default())
    }

    pub(super) fn surface(&self, ray: &Ray, hit: Hit) -> Surface {
        self.watch.asks(&self.name, Some(ray));
        P::surface(&self.packed, ray, hit)
    }

    /// What rounding may do to the point at `t`, world units.
    pub(super) fn rounding(&self, ray: &Ray, t: f64) -> f64 {
        let numbers = ray.origin.abs().max_element() + t * ray.direction.length();
        Surface::rounding(numbers + self.center.abs().max_element() + self.size)
    }

    /// A point in the bounds, or somewhat outside.
    pub(super) fn somewhere(&self, key: Key) -> DVec3 {
        let (a, b) = (key.sample(0), key.sample(1));
        // Not only within a flat shape's own plane.
        let least = DVec3::splat(0.05 * self.size);
        let reach = self.bounds.map_or(DVec3::splat(self.size), |bounds| (0.5 * (bounds.max - bounds.min)).max(least));
        self.center + reach * 1.05 * (DVec3::new(a.x, a.y, b.x) * 2.0 - 1.0)
    }

    /// Rays toward the shape: from everywhere around it, along the axes, and from within its bounds.
    pub(super) fn rays(&self, count: u32, purpose: u32) -> impl Iterator<Item = Ray> {
        (0..count).filter_map(move |n| {
            let key = Key::of_pixel(n, purpose, 7);
            let target = self.somewhere(key.child(1));
            let origin = match n % 4 {
                0 => self.somewhere(key.child(2)),
                1 => {
                    let axis = [DVec3::X, DVec3::Y, DVec3::Z][(n / 4 % 3) as usize];
                    target + axis * (if n % 8 < 4 { 4.0 } else { -4.0 }) * self.size
                }
                _ => self.center + on_sphere(key.child(3)) * 4.0 * self.size,
            };
            // Directions of any length are rays.
            let length = if n % 3 == 0 { 1.0 } else { 0.25 + 4.0 * key.sample(5).x };
            let ray = Ray { origin, direction: (target - origin).try_normalize()? * length };
            ray.is_valid().then_some(ray)
        })
    }
}

/// A unit vector.
pub(super) fn on_sphere(key: Key) -> DVec3 {
    // Points in the ball about zero, but not near its middle.
    (0..64)
        .map(|n| {
            let (a, b) = (key.sample(2 * n), key.sample(2 * n + 1));
            DVec3::new(a.x, a.y, b.x) * 2.0 - 1.0
        })
        .find(|p| (0.01..=1.0).contains(&p.length_squared()))
        .map_or(DVec3::Y, DVec3::normalize)
}
