//! `Checker(odd: 0.2, frequency: 4)`: squares of two colours in turn.

use super::{Footprint, Pattern, ROUNDED, Texture, TexturePoint};
use crate::{
    color::Rgb,
    describe::Describe,
    lanes::{self, Job, Lanes, vector},
    math,
    packet::{Mask, Vectors, four, groups},
    surfaces::Surfaces,
};
use bevy_ecs::prelude::*;
use glam::DVec2;
use std::sync::Arc;

/// Squares of two colours in turn, in texture coordinates.
#[derive(Component, Clone, Debug, PartialEq, Describe)]
pub struct Checker {
    /// Colour of the square at the origin, linear RGB.
    #[describe(not_negative)]
    pub even: Rgb,
    /// Colour of its neighbours, linear RGB.
    #[describe(not_negative)]
    pub odd: Rgb,
    /// Squares per unit of u and v.
    #[describe(positive)]
    pub frequency: f64,
    /// Whether the mean colour of what a ray stands for is shown, not that of the point.
    pub filtered: bool,
}

impl Default for Checker {
    fn default() -> Self {
        Self { even: Rgb::ONE, odd: Rgb::ZERO, frequency: 1.0, filtered: false }
    }
}

impl Texture for Checker {
    fn pack(&self) -> Option<Arc<dyn Pattern>> {
        Some(Arc::new(self.clone()))
    }
}

impl Pattern for Checker {
    fn color(&self, at: &TexturePoint) -> Rgb {
        let square = at.uv * self.frequency;
        if self.filtered {
            let share = (0.5 + 0.5 * mean(square, at.footprint, self.frequency)).clamp(0.0, 1.0);
            return self.even * share + self.odd * (1.0 - share);
        }
        // Halves keep the parity without converting a far coordinate to an integer.
        let half = (math::floor(square.x) + math::floor(square.y)) * 0.5;
        if half == math::floor(half) { self.even } else { self.odd }
    }

    fn color_packet(&self, surfaces: &Surfaces, rays: Mask, colors: &mut Vectors) {
        // What stands for no more than its point is that of the point, filtered or not.
        lanes::run(Squares { checker: self, surfaces, rays, colors });
    }

    fn filters(&self) -> bool {
        self.filtered
    }

    fn brightest(&self) -> Option<Rgb> {
        let brighter = self.even.max(self.odd);
        Some(if self.filtered { brighter * ROUNDED } else { brighter })
    }
}

/// The colours at the points of some rays.
struct Squares<'a> {
    checker: &'a Checker,
    surfaces: &'a Surfaces,
    rays: Mask,
    colors: &'a mut Vectors,
}

impl Job for Squares<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let Self { checker, surfaces, rays, colors } = self;
        let [even, odd] = [vector::splat(l, checker.even), vector::splat(l, checker.odd)];
        let frequency = l.d_splat(checker.frequency);
        for (group, which) in groups(rays) {
            let x = l.d_floor(l.d_mul(l.d_load(four(&surfaces.uv[0], group)), frequency));
            let y = l.d_floor(l.d_mul(l.d_load(four(&surfaces.uv[1], group)), frequency));
            let half = l.d_mul(l.d_add(x, y), l.d_splat(0.5));
            let is_even = vector::equal(l, half, l.d_floor(half));
            vector::store(l, vector::select(l, is_even, even, odd), which, colors, group);
        }
    }
}

/// Mean over a footprint of the board that is 1 on even squares and −1 on odd ones.
///
/// The board is the product of a square wave of each coordinate, so its mean over a rectangle is a product, too. The
/// rectangle is that with the second moments of the footprint along u and v.
fn mean(square: DVec2, footprint: Footprint, frequency: f64) -> f64 {
    let [a, b] = footprint.uv.map(|side| side * frequency);
    mean_of_wave(square.x, (a.x * a.x + b.x * b.x).sqrt()) * mean_of_wave(square.y, (a.y * a.y + b.y * b.y).sqrt())
}

/// Mean over an interval about `x` of the wave that is 1 and −1 in turn on unit intervals, 1 from 0 to 1.
fn mean_of_wave(x: f64, width: f64) -> f64 {
    if !width.is_finite() {
        return 0.0;
    }
    // By the period, so that far from the origin nothing cancels.
    let x = x - 2.0 * math::floor(0.5 * x);
    // Narrower than rounding: the point itself.
    if width < 1e-9 {
        return if x < 1.0 { 1.0 } else { -1.0 };
    }
    (integral_of_wave(x + 0.5 * width) - integral_of_wave(x - 0.5 * width)) / width
}

/// Integral from 0 to `x` of the same wave: a triangle wave.
fn integral_of_wave(x: f64) -> f64 {
    let x = x - 2.0 * math::floor(0.5 * x);
    if x < 1.0 { x } else { 2.0 - x }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(u: f64, v: f64) -> TexturePoint {
        TexturePoint { uv: DVec2::new(u, v), ..TexturePoint::default() }
    }

    #[test]
    fn the_checkerboard_alternates_across_the_origin() {
        for filtered in [false, true] {
            let checker = Checker { filtered, ..Checker::default() };
            let at = |u, v| checker.color(&at(u, v)).x;
            assert_eq!(
                [at(0.5, 0.5), at(-0.5, 0.5), at(-0.5, -0.5), at(1.5, 0.5), at(1e9 + 0.5, 0.5)],
                [1.0, 0.0, 1.0, 0.0, 1.0]
            );
        }
    }

    #[test]
    fn filtered_it_shows_the_share_of_the_rectangle_that_is_even() {
        let checker = Checker { filtered: true, frequency: 2.0, ..Checker::default() };
        let shown = |u: f64, v: f64, width: f64, height: f64| {
            let uv = [DVec2::new(width, 0.0), DVec2::new(0.0, height)];
            checker.color(&TexturePoint { footprint: Footprint { uv, ..Footprint::default() }, ..at(u, v) }).x
        };
        // Within a square; over an edge, a corner and several squares.
        assert_eq!(shown(0.25, 0.25, 0.4, 0.3), 1.0);
        assert_eq!(shown(0.5, 0.25, 0.2, 0.1), 0.5);
        assert!((shown(0.45, 0.25, 0.2, 0.1) - 0.75).abs() < 1e-15);
        assert_eq!(shown(0.5, 0.5, 0.2, 0.2), 0.5);
        assert!((shown(0.25, 0.25, 1.5, 0.1) - 1.0 / 3.0).abs() < 1e-15);
        assert_eq!(shown(7.3, -9.8, 100.0, 0.1), 0.5);
        assert_eq!(shown(0.1, 0.1, f64::INFINITY, 0.1), 0.5);
        // Against the sum over a fine grid.
        for (u, v, width, height) in [(0.13, 0.77, 0.9, 0.35), (-3.21, 8.4, 2.3, 1.7), (1e6 + 0.3, 0.2, 0.6, 0.8)] {
            let n = 500;
            let point = |i: u32, size: f64| ((f64::from(i) + 0.5) / f64::from(n) - 0.5) * size;
            let plain = Checker { filtered: false, ..checker.clone() };
            let sum: f64 =
                (0..n * n).map(|i| plain.color(&at(u + point(i % n, width), v + point(i / n, height))).x).sum();
            let mean = sum / f64::from(n * n);
            assert!((shown(u, v, width, height) - mean).abs() < 3e-3, "{u}, {v}: {mean}");
        }
    }
}
