//! `Grain(a: 0.9, b: 0.4, size: 0.2)`: smooth noise in space; equal on every machine.

use snell::{components::math, prelude::*};
use std::sync::Arc;

#[derive(Component, Clone, Debug, Describe)]
pub struct Grain {
    /// One end of the colours, linear RGB.
    #[describe(not_negative)]
    a: Rgb,
    /// The other end, linear RGB.
    #[describe(not_negative)]
    b: Rgb,
    /// Size of a grain, world units.
    #[describe(positive)]
    size: f64,
}

impl Default for Grain {
    fn default() -> Self {
        Self { a: Rgb::ONE, b: Rgb::ZERO, size: 1.0 }
    }
}

impl Texture for Grain {
    fn pack(&self) -> Option<Arc<dyn Pattern>> {
        Some(Arc::new(self.clone()))
    }
}

impl Pattern for Grain {
    fn color(&self, at: &TexturePoint) -> Rgb {
        self.a + (self.b - self.a) * noise(at.point / self.size)
    }
}

/// Values at whole coordinates, 0 to 1, and smoothly between them.
fn noise(p: DVec3) -> f64 {
    let corner = DVec3::new(math::floor(p.x), math::floor(p.y), math::floor(p.z));
    let t = p - corner;
    let t = t * t * (DVec3::splat(3.0) - t * 2.0);
    let mut sum = 0.0;
    for i in 0..8 {
        let step = DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
        let share = step * t + (DVec3::ONE - step) * (DVec3::ONE - t);
        sum += value(corner + step) * share.x * share.y * share.z;
    }
    sum
}

/// A number from 0 to 1 that a whole point has by chance, always the same.
fn value(p: DVec3) -> f64 {
    let mut bits = 0u64;
    for coordinate in p.to_array() {
        // splitmix64.
        bits = (bits ^ coordinate as i64 as u64).wrapping_add(0x9e37_79b9_7f4a_7c15);
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^= bits >> 31;
    }
    (bits >> 11) as f64 / (1u64 << 53) as f64
}
