//! Numbers and points that are the same in every run.

use glam::DVec3;
use snell_components::random::SplitMix64;

/// A reproducible stream of numbers.
#[derive(Clone)]
pub(crate) struct Random(SplitMix64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(SplitMix64::new(seed))
    }

    /// The stream of the n-th chunk of work under a seed.
    pub(crate) fn of_chunk(seed: u64, n: u64) -> Self {
        let mut mixed = Self::new(seed ^ n.wrapping_mul(0xd134_2543_de82_ef95));
        mixed.bits();
        mixed
    }

    /// The next 64 bits.
    pub(crate) fn bits(&mut self) -> u64 {
        self.0.bits()
    }

    /// From 0 to `n − 1`.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        self.0.below(n)
    }

    /// From 0 to 1, without 1.
    pub(crate) fn unit(&mut self) -> f64 {
        self.0.unit()
    }

    /// From −1 to 1.
    pub(crate) fn signed(&mut self) -> f64 {
        self.unit() * 2.0 - 1.0
    }

    /// In the cube from −1 to 1.
    pub(crate) fn cube(&mut self) -> DVec3 {
        let x = self.signed();
        let y = self.signed();
        DVec3::new(x, y, self.signed())
    }

    /// On the unit sphere.
    pub(crate) fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.cube();
            let square = v.length_squared();
            if square > 1e-4 && square <= 1.0 {
                return v / square.sqrt();
            }
        }
    }

    /// Whole coordinates from −`reach` to `reach`.
    pub(crate) fn lattice(&mut self, reach: usize) -> DVec3 {
        let mut whole = || self.below(2 * reach + 1) as f64 - reach as f64;
        let x = whole();
        let y = whole();
        DVec3::new(x, y, whole())
    }
}
