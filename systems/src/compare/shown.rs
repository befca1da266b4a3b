//! A picture of a difference.

use crate::{image::srgb8, render::Picture};
use snell_components::{color::linear_from_srgb, math};

/// Where and how much two pictures differ: the expected one, dark and grey, and on it every pixel that differs, blue if
/// only by less than an 8-bit level, else from yellow, one level, to red, all of them. Pixels that only one of the
/// pictures has are magenta.
#[must_use]
pub fn shown(expected: &Picture, actual: &Picture) -> Picture {
    let (width, height) = (expected.width.max(actual.width), expected.height.max(actual.height));
    let levels = [expected, actual].map(srgb8);
    let mut shown = Picture::black(width, height);
    for (at, out) in shown.pixels.iter_mut().enumerate() {
        let (x, y) = (at as u32 % width, at as u32 / width);
        let [a, b] = [expected, actual].map(|picture| picture.pixel(x, y));
        let level = |picture: usize, columns: u32| levels[picture].get(y as usize * columns as usize + x as usize);
        *out = match (a, b) {
            (Some(a), Some(b)) if a.map(f32::to_bits) == b.map(f32::to_bits) => dimmed(a),
            (Some(_), Some(_)) => {
                let levels = level(0, expected.width).zip(level(1, actual.width));
                let channels = levels.into_iter().flat_map(|(a, b)| a.iter().zip(b));
                heat(channels.map(|(a, b)| a.abs_diff(*b)).max().unwrap_or_default())
            }
            _ => [1.0, 0.0, 1.0],
        };
    }
    shown
}

fn dimmed([r, g, b]: [f32; 3]) -> [f32; 3] {
    let grey = 0.25 * (0.2126 * r + 0.7152 * g + 0.0722 * b);
    [if grey.is_finite() { grey.clamp(0.0, 0.25) } else { 0.0 }; 3]
}

/// The colour of a difference in 8-bit levels; every doubling is as far as the one before.
fn heat(levels: u8) -> [f32; 3] {
    if levels == 0 {
        return [0.1, 0.3, 1.0];
    }
    let share = math::log2(f64::from(levels)) / math::log2(255.0);
    [1.0, linear_from_srgb(0.9 * (1.0 - share)) as f32, 0.0]
}
