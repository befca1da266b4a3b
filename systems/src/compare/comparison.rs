//! Whether two pictures are alike: to the last bit, on a screen, to the eye.

use super::flip;
use crate::{image::srgb8, render::Picture};
use serde::Serialize;
use std::fmt;

/// How like two pictures must be.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Level {
    /// The same linear light, bit for bit.
    #[default]
    Exact,
    /// The same on a screen: of the 8-bit sRGB levels, none differs by more than `by`, and not more than `most` pixels
    /// differ at all.
    Pixels {
        /// Levels, of 255.
        by: u8,
        /// Pixels.
        most: usize,
    },
    /// The same to the eye: the mean FLIP error is not above this.
    Flip(f64),
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exact => f.write_str("exact bits"),
            Self::Pixels { by, most: usize::MAX } => write!(f, "8-bit levels that differ by at most {by}"),
            Self::Pixels { by, most } => {
                write!(f, "8-bit levels that differ by at most {by}, in at most {most} pixels")
            }
            Self::Flip(mean) => write!(f, "a mean FLIP error of at most {mean}"),
        }
    }
}

/// One pixel of two pictures.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pixel {
    /// Column.
    pub x: u32,
    /// Row.
    pub y: u32,
    /// Linear light: expected and actual.
    pub light: [[f32; 3]; 2],
    /// 8-bit sRGB levels: expected and actual.
    pub levels: [[u8; 3]; 2],
}

/// How a picture differs from an expected one.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Columns and rows of both, if they differ; then nothing else is known.
    pub sizes: Option<[(u32, u32); 2]>,
    /// Pixels whose linear light differs in any bit.
    pub bits: usize,
    /// The first of them, row by row.
    pub first: Option<Pixel>,
    /// Root of the mean square difference of linear light, over all channels.
    pub rms: f64,
    /// Pixels whose 8-bit levels differ.
    pub pixels: usize,
    /// The largest difference of an 8-bit level.
    pub largest: u8,
    /// The first pixel whose levels differ, row by row.
    pub first_shown: Option<Pixel>,
    /// Mean FLIP error, 0 to 1; 1 for pictures of different sizes.
    pub flip: f64,
    /// The pixel with the largest FLIP error, if any level differs: column, row and error.
    pub worst: Option<(u32, u32, f64)>,
}

impl Comparison {
    /// Compares a picture with an expected one.
    #[must_use]
    pub fn between(expected: &Picture, actual: &Picture) -> Self {
        let sizes = [expected, actual].map(|picture| (picture.width, picture.height));
        let mut this = Self {
            sizes: (sizes[0] != sizes[1]).then_some(sizes),
            bits: 0,
            first: None,
            rms: 0.0,
            pixels: 0,
            largest: 0,
            first_shown: None,
            flip: f64::from(u8::from(sizes[0] != sizes[1])),
            worst: None,
        };
        if this.sizes.is_some() {
            return this;
        }
        let levels = [expected, actual].map(srgb8);
        let light = expected.pixels.iter().zip(&actual.pixels);
        let mut squares = 0.0;
        for (at, ((a, b), (c, d))) in light.zip(levels[0].iter().zip(&levels[1])).enumerate() {
            if a.map(f32::to_bits) == b.map(f32::to_bits) {
                continue;
            }
            let (x, y) = (at as u32 % expected.width, at as u32 / expected.width);
            let pixel = Pixel { x, y, light: [*a, *b], levels: [*c, *d] };
            this.bits += 1;
            this.first.get_or_insert(pixel);
            squares += a.iter().zip(b).map(|(a, b)| f64::from(a - b) * f64::from(a - b)).sum::<f64>();
            if c != d {
                this.pixels += 1;
                this.largest = c.iter().zip(d).map(|(c, d)| c.abs_diff(*d)).fold(this.largest, u8::max);
                this.first_shown.get_or_insert(pixel);
            }
        }
        this.rms = (squares / (3 * expected.pixels.len()).max(1) as f64).sqrt();
        let errors = (this.pixels > 0).then(|| flip(expected, actual)).flatten().unwrap_or_default();
        let most = |most: Option<(usize, f64)>, next: (usize, f64)| match most {
            Some(most) if most.1 >= next.1 => Some(most),
            _ => Some(next),
        };
        let worst = errors.iter().copied().enumerate().fold(None, most);
        this.worst = worst.map(|(at, error)| (at as u32 % expected.width, at as u32 / expected.width, error));
        this.flip = errors.iter().sum::<f64>() / errors.len().max(1) as f64;
        this
    }

    /// Whether the pictures are as like as a level asks for.
    #[must_use]
    pub fn is_within(&self, level: Level) -> bool {
        self.sizes.is_none()
            && match level {
                Level::Exact => self.bits == 0,
                Level::Pixels { by, most } => self.largest <= by && self.pixels <= most,
                // A limit that is no number is met by nothing.
                Level::Flip(mean) => self.flip <= mean,
            }
    }
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some([(w, h), (width, height)]) = self.sizes {
            return write!(f, "sizes    {w}x{h} and {width}x{height} pixels");
        }
        write!(f, "bits     ")?;
        match self.first {
            None => return f.write_str("no pixel differs"),
            Some(Pixel { x, y, light: [a, b], .. }) => {
                writeln!(f, "{}, first {x},{y}: {a:?} and {b:?}", differ(self.bits))?;
            }
        }
        writeln!(f, "light    {:.3e} root mean square, linear", self.rms)?;
        match self.first_shown {
            None => write!(f, "levels   none of the 8-bit levels differs"),
            Some(Pixel { x, y, levels: [a, b], .. }) => {
                let pixels = differ(self.pixels);
                writeln!(f, "levels   {pixels}, by up to {} of 255, first {x},{y}: {a:?} and {b:?}", self.largest)?;
                let (x, y, most) = self.worst.unwrap_or_default();
                write!(f, "FLIP     {:.6} mean, {most:.4} at most, at {x},{y}", self.flip)
            }
        }
    }
}

fn differ(pixels: usize) -> String {
    if pixels == 1 { "1 pixel differs".into() } else { format!("{pixels} pixels differ") }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture() -> Picture {
        let pixels = (0..96u8).map(|i| [f32::from(i) / 96.0, 0.5, 0.25]).collect();
        Picture { width: 12, height: 8, pixels }
    }

    #[test]
    fn one_bit_of_one_pixel_is_found() {
        let (expected, mut actual) = (picture(), picture());
        assert!(Comparison::between(&expected, &actual).is_within(Level::Exact));
        actual.pixels[41][2] = f32::from_bits(actual.pixels[41][2].to_bits() + 1);
        let found = Comparison::between(&expected, &actual);
        assert!(!found.is_within(Level::Exact) && found.is_within(Level::Pixels { by: 0, most: 0 }));
        assert_eq!((found.bits, found.pixels, found.flip), (1, 0, 0.0));
        assert_eq!(found.first.map(|pixel| (pixel.x, pixel.y)), Some((5, 3)));
        // Zero has two signs.
        actual.pixels[41] = [-0.0; 3];
        let mut zero = actual.clone();
        zero.pixels[41] = [0.0; 3];
        assert_eq!(Comparison::between(&zero, &actual).bits, 1);
    }

    #[test]
    fn levels_count_pixels_and_steps() {
        let (expected, mut actual) = (picture(), picture());
        for at in [7, 50] {
            actual.pixels[at][1] = 0.51;
        }
        let found = Comparison::between(&expected, &actual);
        assert_eq!((found.bits, found.pixels), (2, 2));
        let by = found.largest;
        assert!(by > 0 && found.is_within(Level::Pixels { by, most: 2 }));
        assert!(
            !found.is_within(Level::Pixels { by: by - 1, most: 2 }) && !found.is_within(Level::Pixels { by, most: 1 })
        );
        assert!(found.flip > 0.0 && found.is_within(Level::Flip(found.flip)));
        assert!(!found.is_within(Level::Flip(found.flip * 0.99)) && !found.is_within(Level::Flip(f64::NAN)));
    }

    #[test]
    fn pictures_of_different_sizes_are_never_alike() {
        let found = Comparison::between(&picture(), &Picture::black(8, 12));
        assert_eq!(found.sizes, Some([(12, 8), (8, 12)]));
        for level in [Level::Exact, Level::Pixels { by: 255, most: usize::MAX }, Level::Flip(1.0)] {
            assert!(!found.is_within(level), "{level}");
        }
    }
}
