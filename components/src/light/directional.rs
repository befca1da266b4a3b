//! `DirectionalLight(direction: (-1, -2, -1))`: a light so far away that its rays are parallel.

use super::{Illumination, Lamp, Light};
use crate::{color::Rgb, describe::Describe};
use bevy_ecs::prelude::*;
use glam::{DAffine3, DVec2, DVec3};

/// A light so far away that its rays are parallel.
#[derive(Component, Clone, Debug, PartialEq, Describe)]
pub struct DirectionalLight {
    /// The way the light goes, object space; any length but zero.
    #[describe(required, nonzero)]
    pub direction: DVec3,
    /// Linear RGB.
    #[describe(not_negative)]
    pub intensity: Rgb,
    /// Whether things cast shadows in this light.
    pub shadows: bool,
}

impl DirectionalLight {
    /// A white light of intensity 1 that goes a way.
    #[must_use]
    pub fn along(direction: impl Into<DVec3>) -> Self {
        Self { direction: direction.into(), ..Self::default() }
    }
}

impl Default for DirectionalLight {
    fn default() -> Self {
        Self { direction: DVec3::NEG_Y, intensity: Rgb::ONE, shadows: true }
    }
}

impl Light for DirectionalLight {
    type Packed = Self;

    fn pack(&self, world_from_object: &DAffine3) -> Self {
        Self { direction: world_from_object.transform_vector3(self.direction).normalize(), ..self.clone() }
    }
}

impl Lamp for DirectionalLight {
    fn illuminate(&self, _: DVec3, _: DVec2) -> Option<Illumination> {
        Some(Illumination {
            to_light: -self.direction,
            distance: f64::INFINITY,
            intensity: self.intensity,
            shadows: self.shadows,
        })
    }

    fn brightest(&self) -> Option<Rgb> {
        Some(self.intensity)
    }
}
