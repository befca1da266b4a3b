//! Linear light → sRGB levels.

use super::Format;
use crate::render::Picture;
use rayon::prelude::*;
use snell_components::color::{linear_from_srgb, srgb_from_linear};

/// The picture sRGB-encoded in 8 bits, rounded to nearest; light beyond 0..=1 is clamped.
#[must_use]
pub fn srgb8(picture: &Picture) -> Vec<[u8; 3]> {
    let encode = |channel: f32| level(channel, f64::from(u8::MAX)) as u8;
    picture.pixels.par_iter().map(|pixel| pixel.map(encode)).collect()
}

/// The picture sRGB-encoded in 16 bits, rounded to nearest; light beyond 0..=1 is clamped.
#[must_use]
pub fn srgb16(picture: &Picture) -> Vec<[u16; 3]> {
    let encode = |channel: f32| level(channel, f64::from(u16::MAX)) as u16;
    picture.pixels.par_iter().map(|pixel| pixel.map(encode)).collect()
}

/// The level out of `0..=max` that shows some linear light; a whole number once its fraction is cut off.
fn level(linear: f32, max: f64) -> f64 {
    srgb_from_linear(f64::from(linear)) * max + 0.5
}

/// The picture as a file of a format gives it back, but for the rounding of what lies beyond white.
#[must_use]
pub fn as_read(picture: &Picture, format: Format) -> Picture {
    let linear = |level: u16, white: u16| linear_from_srgb(f64::from(level) / f64::from(white)) as f32;
    let pixels = match format {
        Format::Png8 => {
            srgb8(picture).into_iter().map(|levels| levels.map(|level| linear(level.into(), 255))).collect()
        }
        Format::Png16 => {
            srgb16(picture).into_iter().map(|levels| levels.map(|level| linear(level, u16::MAX))).collect()
        }
        Format::Exr => picture.pixels.clone(),
    };
    Picture { pixels, ..*picture }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_survives_linear_f32() {
        let level16 = |level: u16| linear_from_srgb(f64::from(level) / 65535.0) as f32;
        let mut picture = Picture::black(65536, 1);
        for (level, pixel) in (0..=u16::MAX).zip(&mut picture.pixels) {
            *pixel = [level16(level); 3];
        }
        let expected: Vec<_> = (0..=u16::MAX).map(|level| [level; 3]).collect();
        assert_eq!(srgb16(&picture), expected);
        // 257 × 255 = 65535: the 8-bit levels are every 257th.
        for (level, at) in (0..=u8::MAX).zip((0..).step_by(257)) {
            assert_eq!(srgb8(&picture)[at], [level; 3]);
        }
    }

    #[test]
    fn light_beyond_the_range_is_clamped() {
        let picture = Picture { width: 1, height: 1, pixels: vec![[-1.0, f32::INFINITY, f32::NAN]] };
        assert_eq!(srgb8(&picture), [[0, 255, 0]]);
        assert_eq!(srgb16(&picture), [[0, 65535, 0]]);
    }
}
