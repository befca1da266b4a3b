//! `Cylinder(radius: 1, height: 2)`: a solid cylinder that stands on y = 0, exact; textured as a [`Cone`].

use super::cone::{Cone, PackedCone};
use crate::{
    describe::Describe,
    primitive::{Cost, Degenerate, Extent, Hit, Primitive, Surface},
    space::Ray,
};
use bevy_ecs::prelude::*;
use glam::DAffine3;

/// A solid cylinder about Oy, from y = 0 up.
#[derive(Component, Clone, Debug, PartialEq, Describe)]
pub struct Cylinder {
    /// Radius, object units.
    #[describe(positive, required)]
    pub radius: f64,
    /// Height, object units.
    #[describe(positive, required)]
    pub height: f64,
}

impl Default for Cylinder {
    fn default() -> Self {
        Self { radius: 1.0, height: 1.0 }
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
