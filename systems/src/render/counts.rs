//! What a render did, in numbers that do not depend on the machine.

use serde::{Deserialize, Serialize};
use snell_components::primitive::Cost;

/// Rays by kind, tests, and what was not followed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Rays from the camera.
    pub primary: u64,
    /// Rays mirrored at a surface.
    pub mirror: u64,
    /// Rays let through a surface.
    pub transmitted: u64,
    /// Rays toward a light; one that passes through transparent things counts at every surface.
    pub shadow: u64,
    /// Mirrored and transmitted rays not followed because they weigh less than the cut-off.
    pub cut: u64,
    /// Mirrored and transmitted rays not followed because they would exceed the depth.
    pub too_deep: u64,
    /// Pixels that were not finite numbers; they are shown black.
    pub not_finite: u64,
    /// Nodes of trees visited.
    pub nodes: u64,
    /// Shapes and triangles tested.
    pub primitives: u64,
}

impl Counts {
    /// All rays that were traced.
    #[must_use]
    pub fn rays(&self) -> u64 {
        self.primary + self.mirror + self.transmitted + self.shadow
    }

    pub(super) fn add(&mut self, cost: Cost) {
        self.nodes += cost.nodes;
        self.primitives += cost.primitives;
    }
}

impl core::ops::AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.primary += other.primary;
        self.mirror += other.mirror;
        self.transmitted += other.transmitted;
        self.shadow += other.shadow;
        self.cut += other.cut;
        self.too_deep += other.too_deep;
        self.not_finite += other.not_finite;
        self.nodes += other.nodes;
        self.primitives += other.primitives;
    }
}
