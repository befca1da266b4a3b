//! Lights: the contract, and the ambient, point and directional ones.
//!
//! A new kind of light is one component with two trait impls, [`Describe`] and [`Light`], and one registration call.
//! Light does not fall off with distance, as in the Whitted model.

use crate::{
    color::Rgb,
    describe::{Describe, FieldVisitor, Spec, Value},
};
use bevy_ecs::{component::Mutable, prelude::*};
use glam::{DAffine3, DVec3};

/// A light that shines from somewhere.
pub trait Light: Describe + Component<Mutability = Mutable> {
    /// The form the render reads, world space.
    type Packed: Lamp;

    /// Makes the packed form of the light placed by `world_from_object`.
    fn pack(&self, world_from_object: &DAffine3) -> Self::Packed;
}

/// A light as the render sees it.
pub trait Lamp: Send + Sync + 'static {
    /// The light that arrives at `point`; none where the lamp does not shine.
    fn illuminate(&self, point: DVec3) -> Option<Illumination>;
}

/// Light arriving at a point, unless something stands in the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illumination {
    /// From the point to the lamp; any length but zero.
    pub to_light: DVec3,
    /// Where the lamp stands on the ray from the point along `to_light`: what is beyond casts no shadow.
    pub distance: f64,
    /// Linear RGB.
    pub intensity: Rgb,
}

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

/// A light that shines from one point in all directions.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct PointLight {
    /// Object space.
    pub position: DVec3,
    /// Linear RGB.
    pub intensity: Rgb,
}

impl Default for PointLight {
    fn default() -> Self {
        Self { position: DVec3::ZERO, intensity: Rgb::ONE }
    }
}

impl Describe for PointLight {
    const TAG: &'static str = "PointLight";

    fn describe(&mut self, fields: &mut dyn FieldVisitor) {
        fields.field("position", Value::Vector(&mut self.position), Spec::any("object space"));
        fields.field("intensity", Value::Color(&mut self.intensity), Spec::not_negative("linear RGB"));
    }
}

impl Light for PointLight {
    type Packed = Self;

    fn pack(&self, world_from_object: &DAffine3) -> Self {
        Self { position: world_from_object.transform_point3(self.position), ..self.clone() }
    }
}

impl Lamp for PointLight {
    fn illuminate(&self, point: DVec3) -> Option<Illumination> {
        let to_light = self.position - point;
        (to_light != DVec3::ZERO).then_some(Illumination { to_light, distance: 1.0, intensity: self.intensity })
    }
}

/// A light so far away that its rays are parallel.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct DirectionalLight {
    /// The way the light goes, object space; any length but zero.
    pub direction: DVec3,
    /// Linear RGB.
    pub intensity: Rgb,
}

impl Default for DirectionalLight {
    fn default() -> Self {
        Self { direction: DVec3::NEG_Y, intensity: Rgb::ONE }
    }
}

impl Describe for DirectionalLight {
    const TAG: &'static str = "DirectionalLight";

    fn describe(&mut self, fields: &mut dyn FieldVisitor) {
        let about = "the way the light goes, object space";
        fields.field("direction", Value::Vector(&mut self.direction), Spec::any(about).required().nonzero());
        fields.field("intensity", Value::Color(&mut self.intensity), Spec::not_negative("linear RGB"));
    }
}

impl Light for DirectionalLight {
    type Packed = Self;

    fn pack(&self, world_from_object: &DAffine3) -> Self {
        Self { direction: world_from_object.transform_vector3(self.direction).normalize(), ..self.clone() }
    }
}

impl Lamp for DirectionalLight {
    fn illuminate(&self, _: DVec3) -> Option<Illumination> {
        Some(Illumination { to_light: -self.direction, distance: f64::INFINITY, intensity: self.intensity })
    }
}
