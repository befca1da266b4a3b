//! Images as they are kept in memory: in the numbers of their file.

use super::pyramid::Level;
use crate::color::Encoding;
use std::sync::{Arc, LazyLock, OnceLock};

/// Pixels of an image, the first row on top.
#[derive(Clone, Debug)]
pub struct Image {
    width: u32,
    height: u32,
    texels: Texels,
    /// Smaller and smaller copies, by [`Encoding`]; made when they are first asked for.
    pyramids: [OnceLock<Arc<[Level]>>; 2],
}

/// Texels as the file had them.
#[derive(Clone, Debug, PartialEq)]
enum Texels {
    /// 0 to 255.
    Bytes(Vec<[u8; 3]>),
    /// 0 to 65535.
    Words(Vec<[u16; 3]>),
    /// Linear light.
    Floats(Vec<[f32; 3]>),
}

impl PartialEq for Image {
    fn eq(&self, other: &Self) -> bool {
        (self.width, self.height, &self.texels) == (other.width, other.height, &other.texels)
    }
}

impl Image {
    /// An image of linear light from its rows, the first on top; nothing unless there are `width` times `height` texels,
    /// at least one.
    #[must_use]
    pub fn new(width: u32, height: u32, texels: Vec<[f32; 3]>) -> Option<Self> {
        Self::of(width, height, texels.len(), Texels::Floats(texels))
    }

    /// An image of 8-bit numbers, which are sRGB-encoded unless the scene says otherwise; nothing as for [`Image::new`].
    #[must_use]
    pub fn from_bytes(width: u32, height: u32, texels: Vec<[u8; 3]>) -> Option<Self> {
        Self::of(width, height, texels.len(), Texels::Bytes(texels))
    }

    /// An image of 16-bit numbers, as [`Image::from_bytes`].
    #[must_use]
    pub fn from_words(width: u32, height: u32, texels: Vec<[u16; 3]>) -> Option<Self> {
        Self::of(width, height, texels.len(), Texels::Words(texels))
    }

    fn of(width: u32, height: u32, count: usize, texels: Texels) -> Option<Self> {
        let fits = count > 0 && count as u64 == u64::from(width) * u64::from(height);
        fits.then(|| Self { width, height, texels, pyramids: Default::default() })
    }

    /// Width and height in texels.
    #[must_use]
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// A texel, by column and row from the top, as `f32` of what `encoding` makes of it.
    ///
    /// # Panics
    /// If there is no such texel.
    #[must_use]
    #[inline]
    pub fn texel(&self, column: u32, row: u32, encoding: Encoding) -> [f32; 3] {
        let index = row as usize * self.width as usize + column as usize;
        match &self.texels {
            Texels::Bytes(texels) => {
                let table = &BYTES[encoding as usize];
                texels[index].map(|number| table[usize::from(number)])
            }
            Texels::Words(texels) => {
                let table = &WORDS[encoding as usize];
                texels[index].map(|number| table[usize::from(number)])
            }
            Texels::Floats(texels) => texels[index],
        }
    }

    /// The largest number of each channel, as [`Image::texel`] gives it.
    #[must_use]
    pub fn brightest(&self, encoding: Encoding) -> [f32; 3] {
        /// The largest of each channel, from the least there is.
        fn most<T: Copy + PartialOrd>(texels: &[[T; 3]], least: T) -> [T; 3] {
            let larger = |a: T, b: T| if b > a { b } else { a };
            texels.iter().fold([least; 3], |most, texel| core::array::from_fn(|i| larger(most[i], texel[i])))
        }
        // A larger number is never less light.
        match &self.texels {
            Texels::Bytes(texels) => most(texels, 0).map(|number| BYTES[encoding as usize][usize::from(number)]),
            Texels::Words(texels) => most(texels, 0).map(|number| WORDS[encoding as usize][usize::from(number)]),
            Texels::Floats(texels) => most(texels, 0.0),
        }
    }

    /// The copies of the image, each half as large as the one before, down to one texel; the first is half as large as
    /// the image.
    pub(super) fn pyramid(&self, encoding: Encoding) -> Arc<[Level]> {
        let make = || {
            let whole = |x, y| self.texel(x, y, encoding);
            let mut levels: Vec<Level> = vec![];
            while let Some(next) = match levels.last() {
                None => Level::half_of(self.size(), whole),
                Some(last) => Level::half_of(last.size(), |x, y| last.texel(x, y)),
            } {
                levels.push(next);
            }
            levels.into()
        };
        self.pyramids[encoding as usize].get_or_init(make).clone()
    }
}

/// What numbers of a file mean, by [`Encoding`].
type Meaning = [LazyLock<Box<[f32]>>; 2];

/// Of 8-bit numbers.
static BYTES: Meaning = [
    LazyLock::new(|| decoded(Encoding::Srgb, u8::MAX.into())),
    LazyLock::new(|| decoded(Encoding::Raw, u8::MAX.into())),
];

/// Of 16-bit numbers.
static WORDS: Meaning =
    [LazyLock::new(|| decoded(Encoding::Srgb, u16::MAX)), LazyLock::new(|| decoded(Encoding::Raw, u16::MAX))];

/// What every number from 0 to `most` means.
fn decoded(encoding: Encoding, most: u16) -> Box<[f32]> {
    (0..=most).map(|number| encoding.decode(f64::from(number) / f64::from(most)) as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::linear_from_srgb;

    #[test]
    fn an_image_has_as_many_texels_as_its_size_says() {
        assert!(Image::new(0, 0, vec![]).is_none() && Image::new(2, 2, vec![[0.0; 3]]).is_none());
        assert!(Image::new(3, 0, vec![]).is_none() && Image::from_bytes(0, 3, vec![]).is_none());
        assert!(Image::from_words(2, 1, vec![[0; 3]; 2]).is_some());
    }

    #[test]
    fn numbers_mean_what_the_encoding_says() {
        let bytes = Image::from_bytes(1, 1, vec![[0, 188, 255]]).expect("an image");
        assert_eq!(bytes.texel(0, 0, Encoding::Raw), [0.0, (188.0f64 / 255.0) as f32, 1.0]);
        assert_eq!(bytes.texel(0, 0, Encoding::Srgb), [0.0, linear_from_srgb(188.0 / 255.0) as f32, 1.0]);
        let words = Image::from_words(1, 1, vec![[0, 40_000, 65_535]]).expect("an image");
        assert_eq!(words.texel(0, 0, Encoding::Raw), [0.0, (40_000.0f64 / 65_535.0) as f32, 1.0]);
        let floats = Image::new(1, 1, vec![[0.5, 7.0, -1.0]]).expect("an image");
        for encoding in [Encoding::Raw, Encoding::Srgb] {
            assert_eq!(floats.texel(0, 0, encoding), [0.5, 7.0, -1.0]);
            assert_eq!(floats.brightest(encoding), [0.5, 7.0, 0.0]);
            assert_eq!(bytes.brightest(encoding), bytes.texel(0, 0, encoding));
            assert_eq!(words.brightest(encoding), words.texel(0, 0, encoding));
        }
    }
}
