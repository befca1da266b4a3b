//! How the picture is taken: settings of the scene as a whole.

use crate::{
    choice,
    color::{Encoding, Rgb},
    describe::{Describe, Fault, FieldVisitor, Spec, Value},
    transform::{Transform, is_invertible},
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
    /// Rays across a pixel, and as many down, with [`Antialias::Grid`].
    pub grid: u32,
    /// How often a pixel is halved at most, with [`Antialias::Adaptive`].
    pub subdivisions: u32,
    /// By how much the corners of a part of a pixel differ in some channel for it to be halved, with
    /// [`Antialias::Adaptive`] and no `error`.
    pub contrast: f64,
    /// Whether things cast shadows.
    pub shadows: bool,
    /// Whether transmitted rays bend at the surface of bodies with an index; if not they go straight on.
    pub refraction: bool,
    /// What a ray sees that meets nothing, linear RGB.
    pub background: Rgb,
    /// Mirrored and transmitted rays whose weight in the pixel is below this in every channel are not followed. Without
    /// effect if there is an `error`.
    pub cutoff: f64,
    /// How much a channel of a pixel may differ from what the same scene gives without cutting rays and with ever more
    /// samples; 0: no such promise is made.
    ///
    /// One half is for rays that are not followed: it is never exceeded. What they do not use up is for the samples of lights
    /// with an area and of [`Antialias::Adaptive`], and is kept by two standard errors.
    pub error: f64,
    /// What the numbers of colours in files mean, and what is written into pictures.
    pub encoding: Encoding,
    /// Places the scene as a whole before the camera, which stays.
    pub transform: Transform,
    /// Whether `transform` places the lights as well; if not they stay, too.
    pub transform_lights: bool,
}

choice! {
    /// How rays are placed in a pixel.
    pub enum Antialias {
        /// One ray through the centre.
        #[default]
        Off,
        /// Four rays at ±¼ of the pixel about the centre; their mean counts.
        Four,
        /// Rays in rows and columns; their mean counts.
        Grid,
        /// Rays through the corners of the pixel, and more where these, or those of a pixel beside it, differ (Whitted 1980).
        Adaptive,
    }
}

/// Largest width and height.
pub const MAX_SIZE: u32 = 65_536;

/// Largest number of rays across a pixel.
pub const MAX_GRID: u32 = 64;

/// How often a pixel can be halved.
pub const MAX_SUBDIVISIONS: u32 = 7;

impl Default for Settings {
    fn default() -> Self {
        Self {
            width: 800,
            height: 600,
            depth: 8,
            antialias: Antialias::Off,
            grid: 4,
            subdivisions: 2,
            contrast: 0.05,
            shadows: true,
            refraction: true,
            background: Rgb::ZERO,
            cutoff: 0.001,
            error: 0.0,
            encoding: Encoding::Srgb,
            transform: Transform::default(),
            transform_lights: true,
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
        let grid = Spec::within(1.0, f64::from(MAX_GRID), "rays across a pixel, for `Grid`");
        fields.field("grid", Value::Integer(&mut self.grid), grid);
        let subdivisions =
            Spec::within(0.0, f64::from(MAX_SUBDIVISIONS), "how often a pixel is halved, for `Adaptive`");
        fields.field("subdivisions", Value::Integer(&mut self.subdivisions), subdivisions);
        let contrast = Spec::not_negative("difference of corners for which it is halved, for `Adaptive`");
        fields.field("contrast", Value::Number(&mut self.contrast), contrast);
        fields.field("shadows", Value::Bool(&mut self.shadows), Spec::any("whether things cast shadows"));
        let bends = Spec::any("whether transmitted rays bend; if not they go straight on");
        fields.field("refraction", Value::Bool(&mut self.refraction), bends);
        let background = Spec::not_negative("what a ray sees that meets nothing, linear RGB");
        fields.field("background", Value::Color(&mut self.background), background);
        let cutoff = Spec::within(0.0, 1.0, "weight below which mirrored and transmitted rays are not followed");
        fields.field("cutoff", Value::Number(&mut self.cutoff), cutoff);
        let error = Spec::within(0.0, 1.0, "error of a pixel's channels that may be made, linear; 0: no promise");
        fields.field("error", Value::Number(&mut self.error), error);
        let encoding = Spec::any("what the numbers of colours in files mean: encoded for a screen, or light itself");
        fields.field("encoding", Value::Choice(&mut self.encoding), encoding);
        let transform = Spec::any("steps that place the scene as a whole before the camera");
        fields.field("transform", Value::Steps(&mut self.transform.0), transform);
        let lights = Spec::any("whether those place the lights as well");
        fields.field("transform_lights", Value::Bool(&mut self.transform_lights), lights);
    }

    fn check(&self) -> Result<(), Fault> {
        if is_invertible(&self.transform.matrix()) {
            Ok(())
        } else {
            Err(Fault::new("transform", Transform::MUST_BE_UNDONE))
        }
    }
}
