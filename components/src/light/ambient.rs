//! `AmbientLight(intensity: 0.3)`: light without direction.

use crate::{color::Rgb, describe::Describe};
use bevy_ecs::prelude::*;

/// Light without direction that reaches every point alike; the intensities of several add up.
#[derive(Component, Clone, Debug, PartialEq, Describe)]
pub struct AmbientLight {
    /// Linear RGB.
    #[describe(not_negative)]
    pub intensity: Rgb,
}

impl AmbientLight {
    /// The same in every channel.
    #[must_use]
    pub fn grey(level: f64) -> Self {
        Self { intensity: Rgb::splat(level) }
    }
}

impl Default for AmbientLight {
    fn default() -> Self {
        Self { intensity: Rgb::ONE }
    }
}
