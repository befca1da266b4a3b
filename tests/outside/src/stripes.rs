//! `Stripes(a: 1, b: (0.8, 0.1, 0.1), width: 0.25)`: stripes across u.

use snell::{components::math, prelude::*};
use std::sync::Arc;

#[derive(Component, Clone, Debug, Describe)]
pub struct Stripes {
    /// Colour of the stripe at zero, linear RGB.
    #[describe(not_negative)]
    a: Rgb,
    /// Colour of the next stripe, linear RGB.
    #[describe(not_negative)]
    b: Rgb,
    /// Width of a stripe, units of u.
    #[describe(positive)]
    width: f64,
}

impl Default for Stripes {
    fn default() -> Self {
        Self { a: Rgb::ONE, b: Rgb::ZERO, width: 0.1 }
    }
}

impl Texture for Stripes {
    fn pack(&self) -> Option<Arc<dyn Pattern>> {
        Some(Arc::new(self.clone()))
    }
}

impl Pattern for Stripes {
    fn color(&self, at: &TexturePoint) -> Rgb {
        let half = math::floor(at.uv.x / self.width) * 0.5;
        if half == math::floor(half) { self.a } else { self.b }
    }

    fn brightest(&self) -> Option<Rgb> {
        Some(self.a.max(self.b))
    }
}
