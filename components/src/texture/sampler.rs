//! What an image shows at a point, or in the mean around it.

use super::{Axes, Image, Pattern, ROUNDED, TexturePoint, Wrap, pyramid::Level};
use crate::{
    choice,
    color::{Encoding, Rgb},
    math,
};
use glam::DVec2;
use std::sync::Arc;

choice! {
    /// How the texels of an image are put together.
    pub enum Filter {
        /// The texel that holds the point.
        #[default]
        Nearest,
        /// Between the centres of the four texels around the point.
        Bilinear,
        /// The mean of what a ray stands for, taken as a square as wide as that is long: between two levels of the
        /// image's pyramid.
        Trilinear,
        /// The mean of what a ray stands for, by several lookups along its longer axis in the levels that suit the
        /// shorter one.
        Anisotropic,
    }
}

/// An image with all that its lookup needs.
#[derive(Clone, Debug)]
pub struct Sampler {
    image: Arc<Image>,
    encoding: Encoding,
    wrap: Wrap,
    filter: Filter,
    /// Level 1 and up, for filters that ask for them.
    pyramid: Arc<[Level]>,
}

/// Most lookups along the longer axis; a footprint that is longer still is taken to be wider.
const MOST_LOOKUPS: f64 = 16.0;

/// How wide the texels of the level are that stands for a width of 1. A lookup between texels and levels blurs, too:
/// against converged pictures of photographs, drawings and test patterns, on floors and by way of mirrors and glass,
/// the error is least near 0.7 (`tests/minification.rs`).
const WIDTH: f64 = 0.7;

/// The shade of what is not shown: the surface keeps its colour.
const NOTHING: Rgb = Rgb::ONE;

impl Sampler {
    /// A sampler of an image.
    #[must_use]
    pub fn new(image: Arc<Image>, encoding: Encoding, wrap: Wrap, filter: Filter) -> Self {
        let pyramid = match filter {
            Filter::Nearest | Filter::Bilinear => Arc::default(),
            Filter::Trilinear | Filter::Anisotropic => image.pyramid(encoding),
        };
        Self { image, encoding, wrap, filter, pyramid }
    }

    /// The texel that holds a point; v points up.
    #[must_use]
    pub fn nearest(&self, uv: DVec2) -> Rgb {
        let (width, height) = self.image.size();
        match (self.wrap.nearest(uv.x, width), self.wrap.nearest(uv.y, height)) {
            (Some(column), Some(row)) => self.texel(0, column, height - 1 - row),
            _ => NOTHING,
        }
    }

    /// Between the centres of the four texels of a level around a point; level 0 is the image itself.
    #[must_use]
    pub fn bilinear(&self, level: usize, uv: DVec2) -> Rgb {
        if !uv.is_finite() {
            return self.nearest(uv);
        }
        let (width, height) = self.size(level);
        let x = self.wrap.fold(uv.x) * f64::from(width) - 0.5;
        let y = self.wrap.fold(uv.y) * f64::from(height) - 0.5;
        let (left, below) = (math::floor(x), math::floor(y));
        let texel = |dx: i64, dy: i64| {
            let column = self.wrap.texel(left as i64 + dx, width);
            let row = self.wrap.texel(below as i64 + dy, height);
            match (column, row) {
                (Some(column), Some(row)) => self.texel(level, column, height - 1 - row),
                _ => NOTHING,
            }
        };
        let (x, y) = (x - left, y - below);
        between(between(texel(0, 0), texel(1, 0), x), between(texel(0, 1), texel(1, 1), x), y)
    }

    /// Between the two levels whose texels are next to `width` times as wide as those of the image.
    fn trilinear(&self, width: f64, uv: DVec2) -> Rgb {
        let last = self.pyramid.len();
        // Nothing is smaller than the image, nor larger than its last level.
        if width <= 1.0 {
            return self.bilinear(0, uv);
        }
        let level = math::log2(width);
        if level >= last as f64 {
            return self.bilinear(last, uv);
        }
        let lower = math::floor(level);
        let (sharp, blurred) = (self.bilinear(lower as usize, uv), self.bilinear(lower as usize + 1, uv));
        between(sharp, blurred, level - lower)
    }

    /// The mean over a parallelogram about a point.
    fn mean(&self, uv: DVec2, sides: [DVec2; 2]) -> Rgb {
        let size = self.image.size();
        let size = DVec2::new(f64::from(size.0), f64::from(size.1));
        let Some(Axes { major, longer, shorter }) = Axes::of(sides.map(|side| side * size)) else {
            return self.bilinear(self.pyramid.len(), uv);
        };
        if self.filter == Filter::Trilinear {
            return self.trilinear(longer * WIDTH, uv);
        }
        let shorter = shorter.max(longer / MOST_LOOKUPS).max(1.0);
        let lookups = math::floor(longer / shorter + 0.5).clamp(1.0, MOST_LOOKUPS);
        let step = major / (size * lookups);
        let mut sum = Rgb::ZERO;
        for i in 0..lookups as u32 {
            sum += self.trilinear(shorter * WIDTH, uv + step * (f64::from(i) + 0.5 - 0.5 * lookups));
        }
        sum / lookups
    }

    fn size(&self, level: usize) -> (u32, u32) {
        match level.checked_sub(1) {
            None => self.image.size(),
            Some(level) => self.pyramid[level].size(),
        }
    }

    #[inline]
    fn texel(&self, level: usize, column: u32, row: u32) -> Rgb {
        let texel = match level.checked_sub(1) {
            None => self.image.texel(column, row, self.encoding),
            Some(level) => self.pyramid[level].texel(column, row),
        };
        Rgb::from_array(texel.map(f64::from))
    }
}

/// From `a` to `b`; `a` itself at 0.
fn between(a: Rgb, b: Rgb, at: f64) -> Rgb {
    a + (b - a) * at
}

impl Pattern for Sampler {
    fn color(&self, at: &TexturePoint) -> Rgb {
        match self.filter {
            Filter::Nearest => self.nearest(at.uv),
            Filter::Bilinear => self.bilinear(0, at.uv),
            Filter::Trilinear | Filter::Anisotropic => self.mean(at.uv, at.footprint.uv),
        }
    }

    fn filters(&self) -> bool {
        matches!(self.filter, Filter::Trilinear | Filter::Anisotropic)
    }

    fn brightest(&self) -> Option<Rgb> {
        let image = Rgb::from_array(self.image.brightest(self.encoding).map(f64::from));
        let shown = if self.wrap == Wrap::Once { image.max(NOTHING) } else { image };
        Some(if self.filter == Filter::Nearest { shown } else { shown * ROUNDED })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::Footprint;

    const ALL: [Filter; 4] = [Filter::Nearest, Filter::Bilinear, Filter::Trilinear, Filter::Anisotropic];
    const WRAPS: [Wrap; 4] = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp, Wrap::Once];

    fn sampler(width: u32, texels: Vec<[f32; 3]>, wrap: Wrap, filter: Filter) -> Sampler {
        let height = texels.len() as u32 / width;
        let image = Image::new(width, height, texels).expect("an image");
        Sampler::new(Arc::new(image), Encoding::Srgb, wrap, filter)
    }

    fn point(u: f64, v: f64, width: f64) -> TexturePoint {
        let uv = [DVec2::new(width, 0.0), DVec2::new(0.0, width)];
        TexturePoint {
            uv: DVec2::new(u, v),
            footprint: Footprint { uv, ..Footprint::default() },
            ..TexturePoint::default()
        }
    }

    #[test]
    fn the_nearest_texel_is_the_one_that_holds_the_point() {
        let image = sampler(2, vec![[0.0; 3], [1.0; 3]], Wrap::Repeat, Filter::Nearest);
        for (u, value) in [(0.0, 0.0), (0.49, 0.0), (0.5, 1.0), (1.0, 0.0), (-1e-9, 1.0), (-0.25, 1.0), (7.75, 1.0)] {
            assert_eq!(image.nearest(DVec2::new(u, 0.5)).x, value, "{u}");
        }
    }

    #[test]
    fn rows_run_from_top_to_bottom() {
        for filter in ALL {
            let image = sampler(1, vec![[1.0; 3], [0.0; 3]], Wrap::Clamp, filter);
            let [upper, lower] = [0.75, 0.25].map(|v| image.color(&point(0.5, v, 0.0)).x);
            assert_eq!((upper, lower), (1.0, 0.0), "{filter:?}");
        }
    }

    #[test]
    fn at_the_centre_of_a_texel_every_filter_shows_that_texel() {
        let (width, height) = (8, 4);
        let value = |i: u32| [i as f32 * 0.3, 1.0 - i as f32 * 0.01, (i % 3) as f32];
        for (filter, wrap) in ALL.into_iter().flat_map(|filter| WRAPS.map(|wrap| (filter, wrap))) {
            let image = sampler(width, (0..width * height).map(value).collect(), wrap, filter);
            for i in 0..width * height {
                let (column, row) = (i % width, height - 1 - i / width);
                let (u, v) = ((f64::from(column) + 0.5) / 8.0, (f64::from(row) + 0.5) / 4.0);
                let found = image.color(&point(u, v, 0.0));
                assert_eq!(found, Rgb::from_array(value(i).map(f64::from)), "{filter:?} {wrap:?} {i}");
            }
        }
    }

    #[test]
    fn an_image_of_one_texel_has_its_colour_everywhere() {
        for filter in ALL {
            let image = sampler(1, vec![[0.25, 0.5, 0.75]], Wrap::Repeat, filter);
            for u in [0.0, 0.3, -7.9, 1e300, f64::NAN, f64::NEG_INFINITY] {
                for width in [0.0, 1e-9, 0.4, 1.0, 70.0, 1e200, f64::INFINITY, f64::NAN] {
                    let found = image.color(&point(u, 0.5, width));
                    assert!((found - Rgb::new(0.25, 0.5, 0.75)).length() < 1e-15, "{filter:?}: {found}");
                }
            }
        }
    }

    #[test]
    fn between_texels_the_change_is_even_and_goes_on_over_the_edges() {
        let shown = |wrap: Wrap, u: f64| {
            let image = sampler(4, [0.0, 1.0, 0.5, 0.25].map(|x| [x; 3]).to_vec(), wrap, Filter::Bilinear);
            image.color(&point(u, 0.5, 0.0)).x
        };
        for wrap in WRAPS {
            assert_eq!([shown(wrap, 0.25), shown(wrap, 0.3125), shown(wrap, 0.4375)], [0.5, 0.75, 0.875], "{wrap:?}");
        }
        // Half-way between the last texel and what follows: the first, itself, itself, nothing (white).
        let ends = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp, Wrap::Once].map(|wrap| shown(wrap, 1.0));
        assert_eq!(ends, [0.125, 0.25, 0.25, 0.625]);
        let beyond = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp, Wrap::Once].map(|wrap| shown(wrap, 1.375));
        assert_eq!(beyond, [1.0, 0.5, 0.25, 1.0]);
    }

    /// Squares of `size` texels, in an image of 64.
    fn squares(size: u32, filter: Filter) -> Sampler {
        let value = |i: u32| [if (i % 64 / size + i / 64 / size).is_multiple_of(2) { 1.0 } else { 0.0 }; 3];
        sampler(64, (0..64 * 64).map(value).collect(), Wrap::Repeat, filter)
    }

    #[test]
    fn the_level_is_the_logarithm_of_the_width() {
        for filter in [Filter::Trilinear, Filter::Anisotropic] {
            for level in 0..5 {
                // At the middle of a square, which is one texel of this level and grey in the next.
                let size = 1 << level;
                let image = squares(size, filter);
                let middle = 1.0 - 0.5 * f64::from(size) / 64.0;
                for part in [0.0, 0.25, 0.5, 0.999] {
                    let width = math::pow(2.0, f64::from(level) + part) / WIDTH / 64.0;
                    let found = image.color(&point(0.5 * f64::from(size) / 64.0, middle, width)).x;
                    assert!((found - (1.0 - 0.5 * part)).abs() < 1e-9, "{filter:?}, level {level} and {part}: {found}");
                }
                assert_eq!(image.color(&point(0.3, 0.3, 4.0)).x, 0.5);
            }
        }
    }

    #[test]
    fn along_a_narrow_footprint_only_that_is_blurred() {
        // Stripes along v: a footprint along v leaves them, one across blurs them.
        let stripes = |filter| {
            sampler(64, (0..64 * 64).map(|i| [f32::from(u8::from(i % 2 == 0)); 3]).collect(), Wrap::Repeat, filter)
        };
        let shown = |filter, wide: f64, tall: f64| {
            let uv = [DVec2::new(wide / 64.0, 0.0), DVec2::new(0.0, tall / 64.0)];
            let footprint = Footprint { uv, ..Footprint::default() };
            stripes(filter)
                .color(&TexturePoint { uv: DVec2::splat(0.5 / 64.0), footprint, ..TexturePoint::default() })
                .x
        };
        assert_eq!([shown(Filter::Anisotropic, 1.0, 12.0), shown(Filter::Trilinear, 1.0, 12.0)], [1.0, 0.5]);
        assert!((shown(Filter::Anisotropic, 12.0, 1.0) - 0.5).abs() < 1e-12);
        // Longer than all lookups reach, the width grows, too.
        assert_eq!(shown(Filter::Anisotropic, 1.0, 1000.0), 0.5);
    }
}
