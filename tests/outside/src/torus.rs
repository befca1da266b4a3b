//! `Torus(major: 1, minor: 0.3)`: a ring about Oy.

use snell::{components::math, prelude::*};

#[derive(Component, Clone, Default)]
pub struct Torus {
    pub major: f64,
    pub minor: f64,
}

impl Describe for Torus {
    const TAG: &'static str = "Torus";

    fn describe(&mut self, fields: &mut dyn FieldVisitor) {
        fields.field("major", Value::Number(&mut self.major), Spec::within(1e-9, 1e9, "of the ring").required());
        fields.field("minor", Value::Number(&mut self.minor), Spec::within(1e-9, 1e9, "of the tube").required());
    }
}

impl Torus {
    /// Distance to the tube, object units.
    fn distance(&self, p: DVec3) -> f64 {
        let ring = (p.x * p.x + p.z * p.z).sqrt() - self.major;
        (ring * ring + p.y * p.y).sqrt() - self.minor
    }
}

#[derive(Clone)]
pub struct Packed {
    torus: Torus,
    object_from_world: DAffine3,
    world_from_object: DAffine3,
}

impl Primitive for Torus {
    type Packed = Packed;

    fn pack(&self, world_from_object: &DAffine3) -> Result<(Extent, Packed), Degenerate> {
        let reach = DVec3::new(self.major + self.minor, self.minor, self.major + self.minor) * (1.0 + 1e-9);
        let bounds = Bounds { min: -reach, max: reach }.transformed(world_from_object);
        let (object_from_world, world_from_object) = (world_from_object.inverse(), *world_from_object);
        Ok((Extent::Bounded(bounds), Packed { torus: self.clone(), object_from_world, world_from_object }))
    }

    fn hit(packed: &Packed, ray: &Ray, t_max: f64, cost: &mut Cost) -> Option<Hit> {
        cost.primitives += 1;
        let (torus, local) = (&packed.torus, ray.transformed(&packed.object_from_world));
        let length = local.direction.length();
        let side = torus.distance(local.origin).signum();
        let beyond = local.origin.length() + torus.major + 2.0 * torus.minor;
        // March by the distance to the surface until the side changes, then bisect.
        let (mut before, mut t) = (0.0, 0.0);
        while t * length < beyond && before < t_max {
            let distance = torus.distance(local.at(t)) * side;
            if distance < 0.0 {
                for _ in 0..60 {
                    let middle = 0.5 * (before + t);
                    let same_side = torus.distance(local.at(middle)) * side >= 0.0;
                    (before, t) = if same_side { (middle, t) } else { (before, middle) };
                }
                return (t > 0.0 && t <= t_max).then_some(Hit { t, part: 0 });
            }
            before = t;
            t += distance.max(1e-7 * torus.minor) / length;
        }
        None
    }

    fn surface(packed: &Packed, ray: &Ray, hit: Hit) -> Surface {
        let local = packed.object_from_world.transform_point3(ray.at(hit.t));
        let ring = DVec3::new(local.x, 0.0, local.z).normalize_or(DVec3::X) * packed.torus.major;
        let outward = (local - ring).normalize_or(DVec3::Y);
        let point = packed.world_from_object.transform_point3(ring + outward * packed.torus.minor);
        let normal = (packed.object_from_world.matrix3.transpose() * outward).normalize_or(DVec3::Y);
        let around = math::atan2(local.z, local.x) / core::f64::consts::TAU;
        let error = Surface::rounding(packed.world_from_object.transform_vector3(ring).length() * 2.0);
        Surface { point, normal, shading_normal: normal, uv: DVec2::new(around, 0.0), slot: 0, error }
    }
}
