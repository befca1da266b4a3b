//! Light and colour: linear RGB in the renderer, sRGB only at the doors.

use crate::{choice, math};
use glam::DVec3;

/// Linear-light red, green and blue with the primaries of sRGB; 1 is display white.
pub type Rgb = DVec3;

choice! {
    /// What the numbers of colours in files mean: of images with 8 or 16 bits, of pictures, and of colours `"#rrggbb"`.
    pub enum Encoding {
        /// Light encoded for a screen (sRGB); the renderer computes with linear light.
        #[default]
        Srgb,
        /// The numbers that the renderer computes with.
        Raw,
    }
}

impl Encoding {
    /// The light that a number in 0..=1 means.
    #[must_use]
    pub fn decode(self, number: f64) -> f64 {
        match self {
            Self::Srgb => linear_from_srgb(number),
            Self::Raw => number,
        }
    }

    /// The number in 0..=1 that means some light; what is outside 0..=1 is clamped, NaN gives 0.
    #[must_use]
    pub fn encode(self, light: f64) -> f64 {
        match self {
            Self::Srgb => srgb_from_linear(light),
            Self::Raw if light.is_nan() => 0.0,
            Self::Raw => light.clamp(0.0, 1.0),
        }
    }
}

/// Linear light of an sRGB-encoded value in 0..=1 (IEC 61966-2-1).
#[must_use]
pub fn linear_from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { math::pow((encoded + 0.055) / 1.055, 2.4) }
}

/// sRGB encoding in 0..=1 of linear light (IEC 61966-2-1); values outside 0..=1 are clamped, NaN gives 0.
#[must_use]
pub fn srgb_from_linear(linear: f64) -> f64 {
    if linear <= 0.0 || linear.is_nan() {
        0.0
    } else if linear <= 0.003_130_8 {
        linear * 12.92
    } else if linear < 1.0 {
        1.055 * math::pow(linear, 1.0 / 2.4) - 0.055
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_survives_the_round_trip() {
        for byte in 0..=255u32 {
            let encoded = f64::from(byte) / 255.0;
            assert_eq!((srgb_from_linear(linear_from_srgb(encoded)) * 255.0 + 0.5) as u32, byte);
        }
        assert_eq!(srgb_from_linear(f64::NAN), 0.0);
        assert_eq!(srgb_from_linear(7.0), 1.0);
    }
}
