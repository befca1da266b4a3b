//! `ConeLight(position: (0, 5, 0), direction: (0, -1, 0), angle: 30)`: a light that shines into a cone.

use super::{Illumination, Lamp, Light};
use crate::{choice, color::Rgb, describe::Describe, math};
use bevy_ecs::prelude::*;
use glam::{DAffine3, DVec2, DVec3};

choice! {
    /// How the light of a cone falls off toward its edge.
    pub enum FallOff {
        /// Not at all: it is the same everywhere inside.
        #[default]
        None,
        /// Linearly with the angle, from full on the axis to zero at the edge.
        Linear,
    }
}

/// A light that shines from one point into a cone and nowhere else.
#[derive(Component, Clone, Debug, PartialEq, Describe)]
pub struct ConeLight {
    /// The apex, object space.
    pub position: DVec3,
    /// The axis, the way the light goes, object space; any length but zero.
    #[describe(nonzero)]
    pub direction: DVec3,
    /// Angle between axis and edge, degrees; the edge itself is lit.
    #[describe(positive, at_most(180.0))]
    pub angle: f64,
    /// How the light falls off toward the edge.
    pub fall_off: FallOff,
    /// On the axis, linear RGB.
    #[describe(not_negative)]
    pub intensity: Rgb,
    /// Whether things cast shadows in this light.
    pub shadows: bool,
}

impl Default for ConeLight {
    fn default() -> Self {
        Self {
            position: DVec3::ZERO,
            direction: DVec3::NEG_Y,
            angle: 30.0,
            fall_off: FallOff::None,
            intensity: Rgb::ONE,
            shadows: true,
        }
    }
}

impl Light for ConeLight {
    type Packed = Self;

    fn pack(&self, world_from_object: &DAffine3) -> Self {
        Self {
            position: world_from_object.transform_point3(self.position),
            direction: world_from_object.transform_vector3(self.direction).normalize(),
            ..self.clone()
        }
    }
}

impl Lamp for ConeLight {
    fn illuminate(&self, point: DVec3, _: DVec2) -> Option<Illumination> {
        let to_light = self.position - point;
        if to_light == DVec3::ZERO {
            return None;
        }
        // From sine and cosine: exact near the axis, where the cosine alone says little.
        let sine = to_light.cross(self.direction).length();
        let degrees = math::atan2(sine, -to_light.dot(self.direction)).to_degrees();
        if degrees > self.angle {
            return None;
        }
        let share = match self.fall_off {
            FallOff::None => 1.0,
            FallOff::Linear => 1.0 - degrees / self.angle,
        };
        let intensity = self.intensity * share;
        Some(Illumination { to_light, distance: 1.0, intensity, shadows: self.shadows })
    }

    fn brightest(&self) -> Option<Rgb> {
        Some(self.intensity)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(cone: &ConeLight, degrees: f64) -> f64 {
        let (sin, cos) = math::sin_cos_degrees(degrees);
        let point = DVec3::new(3.0 * sin, -3.0 * cos, 0.0);
        cone.illuminate(point, DVec2::ZERO).map_or(0.0, |light| light.intensity.x)
    }

    #[test]
    fn is_even_inside_and_dark_outside() {
        let cone = ConeLight { angle: 20.0, ..ConeLight::default() };
        assert_eq!([at(&cone, 0.0), at(&cone, 19.99), at(&cone, 20.01), at(&cone, 180.0)], [1.0, 1.0, 0.0, 0.0]);
    }

    #[test]
    fn falls_off_linearly_with_the_angle() {
        let cone = ConeLight { angle: 40.0, fall_off: FallOff::Linear, ..ConeLight::default() };
        for degrees in [0.0, 1e-6, 10.0, 20.0, 30.0, 39.9] {
            assert!((at(&cone, degrees) - (1.0 - degrees / 40.0)).abs() < 1e-14, "{degrees}");
        }
        assert!(at(&cone, 40.0) < 1e-14);
    }
}
