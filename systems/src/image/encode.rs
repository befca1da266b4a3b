//! Light → levels of 8 and 16 bits.

use super::Format;
use crate::render::Picture;
use rayon::prelude::*;
use snell_components::color::Encoding;
use std::sync::OnceLock;

/// The picture in 8 bits, rounded to nearest; light beyond 0..=1 is clamped.
#[must_use]
pub fn levels8(picture: &Picture, encoding: Encoding) -> Vec<[u8; 3]> {
    let pixels = picture.pixels.par_iter();
    match encoding {
        Encoding::Srgb => {
            let table = Srgb8::table();
            pixels.map(|pixel| pixel.map(|channel| table.level(channel))).collect()
        }
        Encoding::Raw => pixels.map(|pixel| pixel.map(|channel| level8(channel, encoding))).collect(),
    }
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

fn level8(light: f32, encoding: Encoding) -> u8 {
    level(light, encoding, f64::from(u8::MAX)) as u8
}

/// sRGB levels of 8 bits by a table, the very ones that the formula gives: for every short run of numbers the level of
/// its first, and where the next level begins.
struct Srgb8(Vec<(f32, u8)>);

impl Srgb8 {
    /// Below this all is black.
    const BLACK: f32 = 1.0 / 8192.0;

    /// Bits of a number that tell its place in a run. With 7 bits of the mantissa left, a run is so short that no two
    /// levels begin in it.
    const IN_RUN: u32 = f32::MANTISSA_DIGITS - 1 - 7;

    fn table() -> &'static Self {
        static TABLE: OnceLock<Srgb8> = OnceLock::new();
        TABLE.get_or_init(|| {
            let level = |bits: u32| level8(f32::from_bits(bits), Encoding::Srgb);
            let run = |light: f32| light.to_bits() >> Self::IN_RUN;
            let runs = run(Self::BLACK)..run(1.0);
            let of_run = |run: u32| {
                let (mut below, mut above) = (run << Self::IN_RUN, (run + 1) << Self::IN_RUN);
                let first = level(below);
                if level(above) > first {
                    while above - below > 1 {
                        let middle = below + (above - below) / 2;
                        *(if level(middle) > first { &mut above } else { &mut below }) = middle;
                    }
                }
                (f32::from_bits(above), first)
            };
            Self(runs.map(of_run).collect())
        })
    }

    #[inline]
    fn level(&self, light: f32) -> u8 {
        if light.is_nan() || light < Self::BLACK {
            return 0;
        }
        if light >= 1.0 {
            return u8::MAX;
        }
        let run = (light.to_bits() >> Self::IN_RUN) - (Self::BLACK.to_bits() >> Self::IN_RUN);
        let (next, level) = self.0[run as usize];
        level + u8::from(light >= next)
    }
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

    /// Levels rise with the light, so that where both agree on either side of every step, they agree everywhere.
    #[test]
    fn the_table_has_the_levels_of_the_formula() {
        let table = Srgb8::table();
        let check = |light: f32| assert_eq!(table.level(light), level8(light, Encoding::Srgb), "{light:e}");
        let mut levels = 0;
        for &(next, _) in &table.0 {
            for bits in next.to_bits() - 2..next.to_bits() + 3 {
                check(f32::from_bits(bits));
            }
            levels += u32::from(table.level(next) > table.level(f32::from_bits(next.to_bits() - 1)));
        }
        assert_eq!(levels, 255);
        for light in [f32::NAN, f32::NEG_INFINITY, -0.0, 0.0, 1e-45, Srgb8::BLACK, 0.003_130_8, 1.0, 2.0, f32::INFINITY]
        {
            check(light);
        }
        (0..=1u32 << 20).for_each(|n| check(n as f32 / (1u32 << 20) as f32));
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
