//! How the picture is taken: settings of the scene as a whole.

use crate::{
    choice,
    color::Rgb,
    describe::{Describe, FieldVisitor, Spec, Value},
};
use bevy_ecs::prelude::*;

/// The scene's settings.
#[derive(Resource, Clone, Debug, PartialEq)]
pub struct Settings {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// How many times a ray may be mirrored or let through, one after the other.
    pub depth: u32,
    /// How rays are placed in a pixel.
    pub antialias: Antialias,
    /// Whether things cast shadows.
    pub shadows: bool,
    /// Whether transmitted rays bend at the surface of bodies with an index; if not they go straight on.
    pub refraction: bool,
    /// What a ray sees that meets nothing, linear RGB.
    pub background: Rgb,
    /// Mirrored and transmitted rays whose weight in the pixel is below this in every channel are not followed.
    pub cutoff: f64,
}

choice! {
    /// How rays are placed in a pixel.
    pub enum Antialias {
        /// One ray through the centre.
        #[default]
        Off,
        /// Four rays at ±¼ of the pixel about the centre; their mean counts.
        Four,
    }
}

/// Largest width and height.
pub const MAX_SIZE: u32 = 65_536;

impl Default for Settings {
    fn default() -> Self {
        Self {
            width: 800,
            height: 600,
            depth: 8,
            antialias: Antialias::Off,
            shadows: true,
            refraction: true,
            background: Rgb::ZERO,
            cutoff: 0.001,
        }
    }
}

impl Describe for Settings {
    const TAG: &'static str = "Settings";

    fn describe(&mut self, fields: &mut dyn FieldVisitor) {
        let size = |about| Spec::within(1.0, f64::from(MAX_SIZE), about);
        fields.field("width", Value::Integer(&mut self.width), size("pixels across"));
        fields.field("height", Value::Integer(&mut self.height), size("pixels down"));
        let depth = Spec::within(0.0, 100_000.0, "mirrored and transmitted rays one after the other");
        fields.field("depth", Value::Integer(&mut self.depth), depth);
        fields.field("antialias", Value::Choice(&mut self.antialias), Spec::any("rays in a pixel"));
        fields.field("shadows", Value::Bool(&mut self.shadows), Spec::any("whether things cast shadows"));
        let bends = Spec::any("whether transmitted rays bend; if not they go straight on");
        fields.field("refraction", Value::Bool(&mut self.refraction), bends);
        let background = Spec::not_negative("what a ray sees that meets nothing, linear RGB");
        fields.field("background", Value::Color(&mut self.background), background);
        let cutoff = Spec::within(0.0, 1.0, "weight below which mirrored and transmitted rays are not followed");
        fields.field("cutoff", Value::Number(&mut self.cutoff), cutoff);
    }
}
