//! What an observer is told adds up, to the last bit, to what is drawn.

mod support {
    pub(crate) mod cases;
}

use snell::{
    prelude::*,
    systems::{
        render::{Added, Counts, Observer, pixel_observed},
        snapshot::Effect,
    },
};
use std::path::Path;
use support::cases::Case;

/// Adds up what it is told, level by level.
#[derive(Default)]
struct Sums {
    /// Of each ray through the pixel.
    samples: Vec<Rgb>,
    /// Of the terms at the point.
    terms: Rgb,
    /// Of the lamps in a term.
    lamps: Rgb,
}

impl Observer for Sums {
    fn sample(&mut self) {
        self.samples.push(Rgb::ZERO);
    }

    fn lamp(&mut self, _: u32, light: Rgb) {
        self.lamps += light;
    }

    fn term(&mut self, effect: &Effect, factor: Rgb, light: Rgb) {
        if !matches!(effect, Effect::Ambient(_)) {
            assert_eq!(std::mem::take(&mut self.lamps), light, "lamps of {effect:?}");
        }
        self.terms += factor * light;
    }

    fn added(&mut self, what: Added, weight: Rgb, light: Rgb) {
        if what == Added::Surface {
            assert_eq!(std::mem::take(&mut self.terms), light, "terms of a surface");
        }
        *self.samples.last_mut().expect("a sample") += weight * light;
    }
}

#[test]
fn lamps_make_terms_and_terms_surfaces_and_surfaces_pixels() {
    for case in Case::all(Path::new("tests/golden")).expect("a folder of cases") {
        let mut renderer = Renderer::new();
        renderer.load(&case.scene).expect("a sound scene");
        let snapshot = renderer.snapshot().expect("a snapshot");
        let Settings { width, height, .. } = snapshot.settings;
        let mut picture = Picture::black(width, height);
        let mut counts = Counts::default();
        for (i, place) in picture.pixels.iter_mut().enumerate() {
            let (x, y) = (i as u32 % width, i as u32 / width);
            let mut sums = Sums::default();
            let light = pixel_observed(&snapshot, x, y, Accelerator::Tree, &mut counts, &mut sums);
            let count = sums.samples.len() as f64;
            let sum = sums.samples.into_iter().fold(Rgb::ZERO, |sum, sample| sum + sample) / count;
            let bits = |light: Rgb| light.to_array().map(f64::to_bits);
            assert_eq!(bits(sum), bits(light), "{}: {x}, {y}", case.name);
            *place = light.as_vec3().to_array();
        }
        let (_, expected) = case.expected().expect("a golden picture");
        assert_eq!(picture.hash(), expected, "{}: an observer changes the picture", case.name);
        assert_eq!(counts, render(&snapshot, &Options::default()).counts, "{}", case.name);
    }
}
