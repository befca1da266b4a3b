//! `Stripes(a: 1, b: (0.8, 0.1, 0.1), width: 0.25)`: stripes across u.

use snell::{components::math, prelude::*};
use std::sync::Arc;

#[derive(Component, Clone, Debug)]
pub struct Stripes {
    a: Rgb,
    b: Rgb,
    width: f64,
}

impl Default for Stripes {
    fn default() -> Self {
        Self { a: Rgb::ONE, b: Rgb::ZERO, width: 0.1 }
    }
}

impl Describe for Stripes {
    const TAG: &'static str = "Stripes";

    fn describe(&mut self, fields: &mut dyn FieldVisitor) {
        fields.field("a", Value::Color(&mut self.a), Spec::not_negative("stripe at zero, linear RGB"));
        fields.field("b", Value::Color(&mut self.b), Spec::not_negative("the next stripe, linear RGB"));
        fields.field("width", Value::Number(&mut self.width), Spec::positive("of a stripe, units of u"));
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
