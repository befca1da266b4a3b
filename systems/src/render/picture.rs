//! The picture as the render makes it: linear light.

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// A rectangle of pixels; `x` to the right and `y` down from the picture's upper left corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Region {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Region {
    /// A whole picture.
    #[must_use]
    pub fn whole(width: u32, height: u32) -> Self {
        Self { x: 0, y: 0, width, height }
    }

    /// Count of pixels.
    #[must_use]
    pub fn area(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Whether the region has pixels and lies within a picture.
    #[must_use]
    pub fn fits(&self, width: u32, height: u32) -> bool {
        let end = |start: u32, len: u32| u64::from(start) + u64::from(len);
        self.area() > 0 && end(self.x, self.width) <= u64::from(width) && end(self.y, self.height) <= u64::from(height)
    }
}

/// Pixels of linear light, row by row from the upper left; pixels not drawn are black.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Linear red, green and blue.
    pub pixels: Vec<[f32; 3]>,
}

impl Picture {
    /// A black picture.
    #[must_use]
    pub fn black(width: u32, height: u32) -> Self {
        Self { width, height, pixels: vec![[0.0; 3]; width as usize * height as usize] }
    }

    /// The pixel in a column and row, if there is one.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> Option<[f32; 3]> {
        (x < self.width && y < self.height).then(|| self.pixels[y as usize * self.width as usize + x as usize])
    }

    /// The part within a region, if that lies within the picture.
    #[must_use]
    pub fn crop(&self, region: Region) -> Option<Self> {
        region.fits(self.width, self.height).then(|| {
            let row = |y: u32| {
                let start = (region.y + y) as usize * self.width as usize + region.x as usize;
                &self.pixels[start..start + region.width as usize]
            };
            let pixels = (0..region.height).flat_map(row).copied().collect();
            Self { width: region.width, height: region.height, pixels }
        })
    }

    /// Copies a smaller picture into this one, its corner at a column and row; what does not fit is dropped.
    pub fn paste(&mut self, part: &Self, x: u32, y: u32) {
        let width = part.width.min(self.width.saturating_sub(x)) as usize;
        for row in 0..part.height.min(self.height.saturating_sub(y)) {
            let from = row as usize * part.width as usize;
            let to = (y + row) as usize * self.width as usize + x as usize;
            self.pixels[to..to + width].copy_from_slice(&part.pixels[from..from + width]);
        }
    }

    /// SHA-256 over width, height (`u32`, little-endian) and all channels (`f32`, little-endian) of the linear pixels,
    /// in hexadecimal: equal exactly if the pictures are.
    #[must_use]
    pub fn hash(&self) -> String {
        let mut hasher = Sha256::new();
        hasher.update(self.width.to_le_bytes());
        hasher.update(self.height.to_le_bytes());
        for channel in self.pixels.iter().flatten() {
            hasher.update(channel.to_le_bytes());
        }
        hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_bit_changes_the_hash() {
        let picture = Picture::black(3, 2);
        let mut other = picture.clone();
        other.pixels[5][2] = f32::from_bits(1);
        assert_ne!(picture.hash(), other.hash());
        assert_ne!(picture.hash(), Picture::black(2, 3).hash());
    }

    #[test]
    fn what_is_pasted_can_be_cropped_again() {
        let mut picture = Picture::black(5, 4);
        let mut part = Picture::black(2, 2);
        part.pixels[3] = [1.0, 2.0, 3.0];
        picture.paste(&part, 3, 1);
        assert_eq!(picture.pixel(4, 2), Some([1.0, 2.0, 3.0]));
        assert_eq!(picture.crop(Region { x: 3, y: 1, width: 2, height: 2 }), Some(part));
        assert_eq!(picture.crop(Region { x: 4, y: 1, width: 2, height: 2 }), None);
    }
}
