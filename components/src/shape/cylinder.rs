//! `Cylinder(radius: 1, height: 2)`: a solid cylinder that stands on y = 0, exact; textured as a [`Cone`].

use super::cone::{Cone, PackedCone};
use crate::{
    describe::{Describe, FieldVisitor, Spec, Value},
    primitive::{Cost, Degenerate, Extent, Hit, Primitive, Surface},
    space::Ray,
};
use bevy_ecs::prelude::*;
use glam::DAffine3;

/// A solid cylinder about Oy, from y = 0 up.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct Cylinder {
    /// Object units.
    pub radius: f64,
    /// Object units.
    pub height: f64,
}

impl Default for Cylinder {
    fn default() -> Self {
        Self { radius: 1.0, height: 1.0 }
    }
}

impl Describe for Cylinder {
    const TAG: &'static str = "Cylinder";

    fn describe(&mut self, fields: &mut dyn FieldVisitor) {
        fields.field("radius", Value::Number(&mut self.radius), Spec::positive("radius, object units").required());
        fields.field("height", Value::Number(&mut self.height), Spec::positive("height, object units").required());
    }
}

impl Primitive for Cylinder {
    type Packed = PackedCone;

    fn pack(&self, world_from_object: &DAffine3) -> Result<(Extent, PackedCone), Degenerate> {
        PackedCone::place(Cone { radius: self.radius, top: self.radius, height: self.height }, world_from_object)
    }

    #[inline]
    fn hit(packed: &PackedCone, ray: &Ray, t_max: f64, cost: &mut Cost) -> Option<Hit> {
        Cone::hit(packed, ray, t_max, cost)
    }

    fn surface(packed: &PackedCone, ray: &Ray, hit: Hit) -> Surface {
        Cone::surface(packed, ray, hit)
    }

    fn surface_without_uv(packed: &PackedCone, ray: &Ray, hit: Hit) -> Surface {
        Cone::surface_without_uv(packed, ray, hit)
    }
}
