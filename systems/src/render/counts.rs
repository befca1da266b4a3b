//! What a render did, in numbers that do not depend on the machine.
//!
//! Counts of nodes and tests depend on which rays are traced together, and so, by a little, on tiles and region.

use serde::{Deserialize, Serialize};
use snell_components::primitive::Cost;

/// Rays by kind, tests, and what was not followed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Counts {
    /// Rays from the camera.
    pub primary: u64,
    /// Rays mirrored at a surface.
    pub mirror: u64,
    /// Rays let through a surface.
    pub transmitted: u64,
    /// Rays toward a light; one that nothing opaque blocks counts again at every transparent surface it passes.
    pub shadow: u64,
    /// Mirrored and transmitted rays not followed because they weigh less than the cut-off, or bring too little for the
    /// error of the setting.
    pub cut: u64,
    /// The most that the rays cut could have added to a channel of one ray through a pixel, which no pixel exceeds; 0
    /// without an error.
    #[serde(default)]
    pub cut_bound: f64,
    /// Pixels that adaptive antialiasing halved.
    #[serde(default)]
    pub refined: u64,
    /// Pixels that were halved as often as is allowed before the error of the setting was reached.
    #[serde(default)]
    pub unresolved: u64,
    /// Lights with an area that were sampled as often as they allow before their error was reached.
    #[serde(default)]
    pub undersampled: u64,
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
        if other.cut_bound > self.cut_bound {
            self.cut_bound = other.cut_bound;
        }
        self.refined += other.refined;
        self.unresolved += other.unresolved;
        self.undersampled += other.undersampled;
        self.too_deep += other.too_deep;
        self.not_finite += other.not_finite;
        self.nodes += other.nodes;
        self.primitives += other.primitives;
    }
}
