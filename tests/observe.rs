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
    /// Of the pixel.
    pixel: Rgb,
    /// Of the terms at the point.
    terms: Rgb,
    /// Of the lamps in a term.
    lamps: Rgb,
}

impl Observer for Sums {
    fn sample(&mut self) {
        self.samples.push(Rgb::ZERO);
    }

    fn shared(&mut self, sample: u32, share: f64) {
        self.pixel += self.samples[sample as usize] * share;
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

/// Draws a picture pixel by pixel, each under the eyes of an observer.
fn observed(snapshot: &Snapshot, name: &str) -> (Picture, Counts) {
    let Settings { width, height, .. } = snapshot.settings;
    let mut picture = Picture::black(width, height);
    let mut counts = Counts::default();
    for (i, place) in picture.pixels.iter_mut().enumerate() {
        let (x, y) = (i as u32 % width, i as u32 / width);
        let mut sums = Sums::default();
        let light = pixel_observed(snapshot, x, y, &Methods::default(), &mut counts, &mut sums);
        let bits = |light: Rgb| light.to_array().map(f64::to_bits);
        assert_eq!(bits(sums.pixel), bits(light), "{name}: {x}, {y}");
        *place = light.as_vec3().to_array();
    }
    (picture, counts)
}

#[test]
fn lamps_make_terms_and_terms_surfaces_and_surfaces_pixels() {
    for case in Case::all(Path::new("tests/golden")).expect("a folder of cases") {
        let mut renderer = Renderer::new();
        renderer.load(&case.scene).expect("a sound scene");
        let snapshot = renderer.snapshot().expect("a snapshot");
        let (picture, counts) = observed(&snapshot, &case.name);
        let (_, expected) = case.expected().expect("a golden picture");
        assert_eq!(picture.hash(), expected, "{}: an observer changes the picture", case.name);
        // Rays that are traced together visit other nodes.
        let rays = |counts: Counts| Counts { nodes: 0, primitives: 0, ..counts };
        assert_eq!(rays(counts), rays(render(&snapshot, &Options::default()).counts), "{}", case.name);
    }
}

#[test]
fn so_they_do_where_pixels_are_halved_and_an_error_is_promised() {
    for (name, error) in [("optics/mirror-and-glass", 0.0), ("light/soft-shadow", 0.1), ("texture/checkers", 0.02)] {
        let mut renderer = Renderer::new();
        renderer.load(format!("tests/golden/{name}.ron")).expect("a sound scene");
        let settings = &mut *renderer.settings();
        *settings = Settings { width: 24, height: 18, antialias: Antialias::Adaptive, error, ..settings.clone() };
        let snapshot = renderer.snapshot().expect("a snapshot");
        let (picture, _) = observed(&snapshot, name);
        assert!(picture == render(&snapshot, &Options::default()).picture, "{name}");
    }
}
