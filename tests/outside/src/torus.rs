//! `Torus(major: 1, minor: 0.3)`: a ring about Oy.

use snell::{components::math, prelude::*};

#[derive(Component, Clone, Default, Describe)]
#[describe(check = Self::is_ring)]
pub struct Torus {
    /// Radius of the ring, object units.
    #[describe(within(1e-9, 1e9), required)]
    pub major: f64,
    /// Radius of the tube, object units.
    #[describe(within(1e-9, 1e9), required)]
    pub minor: f64,
}

impl Torus {
    fn is_ring(&self) -> Result<(), Fault> {
        let is = self.minor <= self.major && self.minor >= 1e-6 * self.major;
        is.then_some(()).ok_or_else(|| Fault::new("minor", "from a millionth of `major` to `major`"))
    }

    /// Distance to the tube, object units; less than zero inside.
    fn distance(&self, p: DVec3) -> f64 {
        let ring = (p.x * p.x + p.z * p.z).sqrt() - self.major;
        (ring * ring + p.y * p.y).sqrt() - self.minor
    }
}

impl Primitive for Torus {
    /// The ring, and the maps from the world to its object space and back.
    type Packed = (Torus, DAffine3, DAffine3);

    fn pack(&self, world_from_object: &DAffine3) -> Result<(Extent, Self::Packed), Degenerate> {
        self.check()?;
        let reach = DVec3::new(self.major + self.minor, self.minor, self.major + self.minor) * (1.0 + 1e-9);
        let bounds = Bounds { min: -reach, max: reach }.transformed(world_from_object);
        Ok((Extent::Bounded(bounds), (self.clone(), world_from_object.inverse(), *world_from_object)))
    }

    fn hit((torus, object_from_world, _): &Self::Packed, ray: &Ray, t_max: f64, cost: &mut Cost) -> Option<Hit> {
        cost.primitives += 1;
        let local = ray.transformed(object_from_world);
        let length = local.direction.length();
        let side = torus.distance(local.origin).signum();
        let end = t_max.min((local.origin.length() + torus.major + 2.0 * torus.minor) / length);
        // March by the distance to the surface until the side changes, then bisect. Grazing rays take many steps.
        let (mut before, mut t) = (0.0, 0.0);
        for _ in 0..100_000 {
            let distance = torus.distance(local.at(t)) * side;
            if distance < 0.0 {
                for _ in 0..60 {
                    let middle = 0.5 * (before + t);
                    let same_side = torus.distance(local.at(middle)) * side >= 0.0;
                    (before, t) = if same_side { (middle, t) } else { (before, middle) };
                }
                return (t <= t_max).then_some(Hit { t, part: 0 });
            }
            (before, t) = (t, t + distance.max(1e-7 * torus.minor) / length);
            if before > end {
                break;
            }
        }
        None
    }

    fn surface((torus, object_from_world, world_from_object): &Self::Packed, ray: &Ray, hit: Hit) -> Surface {
        let local = object_from_world.transform_point3(ray.at(hit.t));
        let out = DVec3::new(local.x, 0.0, local.z).normalize_or(DVec3::X);
        let ring = out * torus.major;
        let outward = (local - ring).normalize_or(DVec3::Y);
        let point = world_from_object.transform_point3(ring + outward * torus.minor);
        let normal = (object_from_world.matrix3.transpose() * outward).normalize_or(DVec3::Y);
        let (around, across) = (math::atan2(local.z, local.x), math::atan2(outward.y, outward.dot(out)));
        let uv = DVec2::new(around, across) / core::f64::consts::TAU;
        let error = Surface::rounding(world_from_object.transform_vector3(ring).length() * 2.0);
        Surface { point, normal, shading_normal: normal, uv, slot: 0, error }
    }
}
