//! Light → levels of 8 and 16 bits.

use super::Format;
use crate::render::Picture;
use rayon::prelude::*;
use snell_components::color::Encoding;

/// The picture in 8 bits, rounded to nearest; light beyond 0..=1 is clamped.
#[must_use]
pub fn levels8(picture: &Picture, encoding: Encoding) -> Vec<[u8; 3]> {
    let encode = |channel: f32| level(channel, encoding, f64::from(u8::MAX)) as u8;
    picture.pixels.par_iter().map(|pixel| pixel.map(encode)).collect()
}

/// The picture in 16 bits, rounded to nearest; light beyond 0..=1 is clamped.
#[must_use]
pub fn levels16(picture: &Picture, encoding: Encoding) -> Vec<[u16; 3]> {
    let encode = |channel: f32| level(channel, encoding, f64::from(u16::MAX)) as u16;
    picture.pixels.par_iter().map(|pixel| pixel.map(encode)).collect()
}

/// The picture sRGB-encoded in 8 bits, as [`levels8`].
#[must_use]
pub fn srgb8(picture: &Picture) -> Vec<[u8; 3]> {
    levels8(picture, Encoding::Srgb)
}

/// The picture sRGB-encoded in 16 bits, as [`levels16`].
#[must_use]
pub fn srgb16(picture: &Picture) -> Vec<[u16; 3]> {
    levels16(picture, Encoding::Srgb)
}

/// The level out of `0..=max` that shows some light; a whole number once its fraction is cut off.
fn level(light: f32, encoding: Encoding, max: f64) -> f64 {
    encoding.encode(f64::from(light)) * max + 0.5
}

/// The picture as a file of a format gives it back, but for the rounding of what lies beyond white.
#[must_use]
pub fn as_read(picture: &Picture, format: Format, encoding: Encoding) -> Picture {
    let linear = |level: u16, white: u16| encoding.decode(f64::from(level) / f64::from(white)) as f32;
    let pixels = match format {
        Format::Png8 => {
            let levels = levels8(picture, encoding).into_iter();
            levels.map(|levels| levels.map(|level| linear(level.into(), 255))).collect()
        }
        Format::Png16 => {
            let levels = levels16(picture, encoding).into_iter();
            levels.map(|levels| levels.map(|level| linear(level, u16::MAX))).collect()
        }
        Format::Exr => picture.pixels.clone(),
    };
    Picture { pixels, ..*picture }
}

#[cfg(test)]
mod tests {
    use super::*;
    use snell_components::color::linear_from_srgb;

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
    fn raw_levels_are_the_numbers() {
        let picture = Picture { width: 1, height: 1, pixels: vec![[0.5, 100.0 / 255.0, 1.0]] };
        assert_eq!(levels8(&picture, Encoding::Raw), [[128, 100, 255]]);
        assert_eq!(levels16(&picture, Encoding::Raw), [[32768, 25700, 65535]]);
    }

    #[test]
    fn light_beyond_the_range_is_clamped() {
        let picture = Picture { width: 1, height: 1, pixels: vec![[-1.0, f32::INFINITY, f32::NAN]] };
        assert_eq!(srgb8(&picture), [[0, 255, 0]]);
        assert_eq!(srgb16(&picture), [[0, 65535, 0]]);
        assert_eq!(levels8(&picture, Encoding::Raw), [[0, 255, 0]]);
    }
}
