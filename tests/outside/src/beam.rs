//! `Beam(position: (0, 5, 0), direction: (0, -1, 0), radius: 1)`: parallel light, as from a searchlight.

use snell::prelude::*;

#[derive(Component, Clone)]
pub struct Beam {
    position: DVec3,
    direction: DVec3,
    radius: f64,
    intensity: Rgb,
}

impl Default for Beam {
    fn default() -> Self {
        Self { position: DVec3::ZERO, direction: DVec3::NEG_Y, radius: 1.0, intensity: Rgb::ONE }
    }
}

impl Describe for Beam {
    const TAG: &'static str = "Beam";

    fn describe(&mut self, fields: &mut dyn FieldVisitor) {
        fields.field("position", Value::Vector(&mut self.position), Spec::any("middle of the lamp, object space"));
        let direction = Spec::any("the way the light goes, object space").nonzero();
        fields.field("direction", Value::Vector(&mut self.direction), direction);
        fields.field("radius", Value::Number(&mut self.radius), Spec::positive("of the beam, world units").required());
        fields.field("intensity", Value::Color(&mut self.intensity), Spec::not_negative("linear RGB"));
    }
}

impl Light for Beam {
    type Packed = Self;

    fn pack(&self, world_from_object: &DAffine3) -> Self {
        let position = world_from_object.transform_point3(self.position);
        let direction = world_from_object.transform_vector3(self.direction).normalize_or(DVec3::NEG_Y);
        Self { position, direction, ..self.clone() }
    }
}

impl Lamp for Beam {
    fn illuminate(&self, point: DVec3, _sample: DVec2) -> Option<Illumination> {
        let way = point - self.position;
        let along = way.dot(self.direction);
        let off = (way - self.direction * along).length();
        let to_light = -self.direction * along;
        let shines = along > 0.0 && off <= self.radius;
        shines.then_some(Illumination { to_light, distance: 1.0, intensity: self.intensity, shadows: true })
    }

    fn brightest(&self) -> Option<Rgb> {
        Some(self.intensity)
    }
}
