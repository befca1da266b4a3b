//! How far one picture is from another, and whether they are alike.

mod comparison;
mod flip;
mod shown;

pub use comparison::{Comparison, Level, Pixel};
pub use flip::{PIXELS_PER_DEGREE, flip};
pub use shown::shown;

use crate::render::Picture;
use serde::{Deserialize, Serialize};

/// The difference between a picture and a reference, in linear light but for FLIP.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Difference {
    /// Root of the mean square over all channels.
    pub rmse: f64,
    /// Mean FLIP error, 0 to 1: how different the pictures look.
    pub flip: f64,
    /// Largest difference of a channel.
    pub max: f64,
    /// Share of pixels of which some channel is off by more than 1/255.
    pub beyond: f64,
}

/// The least difference that counts as visible, in linear light.
const VISIBLE: f64 = 1.0 / 255.0;

impl Difference {
    /// The difference of a picture from a reference; nothing if the sizes differ or there are no pixels.
    #[must_use]
    pub fn between(reference: &Picture, test: &Picture) -> Option<Self> {
        let map = flip(reference, test)?;
        let count = map.len() as f64;
        let (mut squares, mut max, mut beyond) = (0.0, 0.0f64, 0u64);
        for (a, b) in reference.pixels.iter().zip(&test.pixels) {
            let off = [0, 1, 2].map(|i| (f64::from(a[i]) - f64::from(b[i])).abs());
            let largest = off[0].max(off[1]).max(off[2]);
            squares += off.iter().map(|off| off * off).sum::<f64>();
            max = max.max(largest);
            beyond += u64::from(largest > VISIBLE);
        }
        (count > 0.0).then(|| Self {
            rmse: (squares / (3.0 * count)).sqrt(),
            flip: map.iter().sum::<f64>() / count,
            max,
            beyond: beyond as f64 / count,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_pixel_of_many_is_told() {
        let reference = Picture::black(10, 10);
        let mut test = reference.clone();
        test.pixels[37] = [0.0, 0.5, 0.0];
        let difference = Difference::between(&reference, &test).expect("of one size");
        assert_eq!((difference.max, difference.beyond), (0.5, 0.01));
        assert!((difference.rmse - (0.25f64 / 300.0).sqrt()).abs() < 1e-15 && difference.flip > 0.0);
        test.pixels[37] = [0.0, 1.0 / 256.0, 0.0];
        assert_eq!(Difference::between(&reference, &test).map(|difference| difference.beyond), Some(0.0));
        assert!(Difference::between(&reference, &Picture::black(10, 9)).is_none());
    }
}
