//! `PointLight(position: (0, 5, 0))`: a light that shines from one point in all directions.

use super::{Illumination, Lamp, Light};
use crate::{color::Rgb, describe::Describe};
use bevy_ecs::prelude::*;
use glam::{DAffine3, DVec2, DVec3};

/// A light that shines from one point in all directions.
#[derive(Component, Clone, Debug, PartialEq, Describe)]
pub struct PointLight {
    /// Where it shines from, object space.
    #[describe(required)]
    pub position: DVec3,
    /// Linear RGB.
    #[describe(not_negative)]
    pub intensity: Rgb,
    /// Whether things cast shadows in this light.
    pub shadows: bool,
}

impl PointLight {
    /// A white light of intensity 1.
    #[must_use]
    pub fn at(position: impl Into<DVec3>) -> Self {
        Self { position: position.into(), ..Self::default() }
    }
}

impl Default for PointLight {
    fn default() -> Self {
        Self { position: DVec3::ZERO, intensity: Rgb::ONE, shadows: true }
    }
}

impl Light for PointLight {
    type Packed = Self;

    fn pack(&self, world_from_object: &DAffine3) -> Self {
        Self { position: world_from_object.transform_point3(self.position), ..self.clone() }
    }
}

impl Lamp for PointLight {
    #[inline(always)]
    fn illuminate(&self, point: DVec3, _: DVec2) -> Option<Illumination> {
        let to_light = self.position - point;
        (to_light != DVec3::ZERO).then_some(Illumination {
            to_light,
            distance: 1.0,
            intensity: self.intensity,
            shadows: self.shadows,
        })
    }

    fn as_point(&self) -> Option<&PointLight> {
        Some(self)
    }

    fn brightest(&self) -> Option<Rgb> {
        Some(self.intensity)
    }
}
