//! The camera: a pinhole before a screen.

use crate::describe::{Describe, Fault, FieldVisitor, Spec, Value};
use bevy_ecs::prelude::*;
use glam::DVec3;

/// A pinhole camera: rays start at the position and pass through the centres of the screen's pixels.
///
/// Without `target` and `direction` it looks along −z of its object space.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct Camera {
    /// The pinhole, object space.
    pub position: DVec3,
    /// A point in the middle of the picture, object space.
    pub target: Option<DVec3>,
    /// The way the camera looks, object space; in place of `target`.
    pub direction: Option<DVec3>,
    /// The way that is up in the picture, object space; need not be perpendicular to the view.
    pub up: DVec3,
    /// Degrees by which the camera is turned about its view, clockwise seen from behind: the picture turns the other way.
    pub roll: f64,
    /// Vertical angle of view in degrees.
    pub field_of_view: f64,
    /// Distance of the screen in screen heights; in place of `field_of_view`, which is `2·atan(1 / 2d)`.
    pub screen_distance: Option<f64>,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            position: DVec3::ZERO,
            target: None,
            direction: None,
            up: DVec3::Y,
            roll: 0.0,
            field_of_view: 45.0,
            screen_distance: None,
        }
    }
}

impl Describe for Camera {
    const TAG: &'static str = "Camera";

    fn describe(&mut self, fields: &mut dyn FieldVisitor) {
        fields.field("position", Value::Vector(&mut self.position), Spec::any("the pinhole").required());
        fields.field("target", Value::OptionalVector(&mut self.target), Spec::any("a point in the picture's middle"));
        fields.field("direction", Value::OptionalVector(&mut self.direction), Spec::any("the way it looks").nonzero());
        fields.field("up", Value::Vector(&mut self.up), Spec::any("the way that is up").nonzero());
        fields.field("roll", Value::Number(&mut self.roll), Spec::any("turn about the view, degrees clockwise"));
        let fov = Spec {
            range: crate::describe::Range { min: 0.0, max: 179.9, min_inclusive: false },
            ..Spec::any("vertical angle of view, degrees")
        };
        fields.field("field_of_view", Value::Number(&mut self.field_of_view), fov);
        let distance = Spec::positive("distance of the screen in screen heights; in place of field_of_view");
        fields.field("screen_distance", Value::OptionalNumber(&mut self.screen_distance), distance);
    }

    fn check(&self) -> Result<(), Fault> {
        if self.target.is_some() && self.direction.is_some() {
            return Err(Fault::new("direction", "either `target` or `direction`, not both"));
        }
        if self.target == Some(self.position) {
            return Err(Fault::new("target", "a point other than `position`"));
        }
        Ok(())
    }
}

impl Camera {
    /// The way the camera looks, object space; any length but zero.
    #[must_use]
    pub fn view(&self) -> DVec3 {
        self.target.map(|target| target - self.position).or(self.direction).unwrap_or(DVec3::NEG_Z)
    }
}
