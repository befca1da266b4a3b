//! Left out of the picture for a while.

use crate::describe::{Describe, FieldVisitor};
use bevy_ecs::prelude::*;

/// An entity that is not seen and does not shine, as if it had no shape and no light; what it carries stays.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hidden {}

impl Describe for Hidden {
    const TAG: &'static str = "Hidden";

    fn describe(&mut self, _: &mut dyn FieldVisitor) {}
}
