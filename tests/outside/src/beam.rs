//! `Beam(position: (0, 5, 0), direction: (0, -1, 0), radius: 1)`: parallel light, as from a searchlight.

use snell::prelude::*;

#[derive(Component, Clone, Describe)]
pub struct Beam {
    /// Middle of the lamp, object space.
    position: DVec3,
    /// The way the light goes, object space.
    #[describe(nonzero)]
    direction: DVec3,
    /// Radius of the beam, world units.
    #[describe(positive, required)]
    radius: f64,
    /// Linear RGB.
    #[describe(not_negative)]
    intensity: Rgb,
}

impl Default for Beam {
    fn default() -> Self {
        Self { position: DVec3::ZERO, direction: DVec3::NEG_Y, radius: 1.0, intensity: Rgb::ONE }
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
