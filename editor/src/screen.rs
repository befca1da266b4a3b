//! What is on the screen: pixels as a monitor shows them, and which rows are new.

use snell::{Picture, Region, systems::image::srgb8};
use std::ops::Range;

/// A picture in sRGB, 8 bits.
#[derive(Default)]
pub struct Screen {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green and blue, row by row.
    pub pixels: Vec<[u8; 3]>,
    /// Rows that changed since they were last taken.
    dirty: Range<u32>,
}

/// Linear light as the screen shows it: the same levels as in a PNG file.
#[must_use]
pub fn encode(pixels: &[[f32; 3]]) -> Vec<[u8; 3]> {
    srgb8(&Picture { width: pixels.len() as u32, height: 1, pixels: pixels.to_vec() })
}

impl Screen {
    /// Takes the size of a picture and shows a coarse one stretched over it.
    pub fn stretch(&mut self, (width, height): (u32, u32), (columns, rows): (u32, u32), coarse: &[[u8; 3]]) {
        (self.width, self.height) = (width, height);
        self.pixels.resize(width as usize * height as usize, [0; 3]);
        let column = |x: u32| (u64::from(x) * u64::from(columns) / u64::from(width)) as usize;
        for (y, row) in (0..height).zip(self.pixels.chunks_mut(width.max(1) as usize)) {
            let from = (u64::from(y) * u64::from(rows) / u64::from(height)) as usize * columns as usize;
            for (x, pixel) in (0..width).zip(row) {
                *pixel = coarse[from + column(x)];
            }
        }
        self.dirty = 0..height;
    }

    /// Shows a part of the picture; what does not fit is dropped.
    pub fn paste(&mut self, region: Region, part: &[[u8; 3]]) {
        if !region.fits(self.width, self.height) {
            return;
        }
        for (y, row) in (region.y..).zip(part.chunks_exact(region.width as usize)) {
            let at = y as usize * self.width as usize + region.x as usize;
            self.pixels[at..at + row.len()].copy_from_slice(row);
        }
        let rows = region.y..region.y + region.height;
        self.dirty =
            if self.dirty.is_empty() { rows } else { self.dirty.start.min(rows.start)..self.dirty.end.max(rows.end) };
    }

    /// The rows that changed since this was last called.
    pub fn take_dirty(&mut self) -> Range<u32> {
        std::mem::take(&mut self.dirty)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coarse_picture_fills_the_screen_and_tiles_go_over_it() {
        let mut screen = Screen::default();
        screen.stretch((5, 4), (2, 1), &[[1; 3], [2; 3]]);
        assert_eq!(screen.pixels[..5], [[1; 3], [1; 3], [1; 3], [2; 3], [2; 3]]);
        assert_eq!(screen.take_dirty(), 0..4);
        screen.paste(Region { x: 3, y: 1, width: 2, height: 2 }, &[[7; 3]; 4]);
        screen.paste(Region { x: 4, y: 3, width: 2, height: 2 }, &[[9; 3]; 4]);
        assert_eq!(screen.pixels.iter().filter(|pixel| **pixel == [7; 3]).count(), 4);
        assert!(!screen.pixels.contains(&[9; 3]));
        assert_eq!((screen.take_dirty(), screen.take_dirty()), (1..3, 0..0));
    }
}
