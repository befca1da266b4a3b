//! `AmbientLight(intensity: 0.3)`: light without direction.

use crate::{
    color::Rgb,
    describe::{Describe, FieldVisitor, Spec, Value},
};
use bevy_ecs::prelude::*;

/// Light without direction that reaches every point alike; the intensities of several add up.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct AmbientLight {
    /// Linear RGB.
    pub intensity: Rgb,
}

impl Default for AmbientLight {
    fn default() -> Self {
        Self { intensity: Rgb::ONE }
    }
}

impl Describe for AmbientLight {
    const TAG: &'static str = "AmbientLight";

    fn describe(&mut self, fields: &mut dyn FieldVisitor) {
        fields.field("intensity", Value::Color(&mut self.intensity), Spec::not_negative("linear RGB"));
    }
}
