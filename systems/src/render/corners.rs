//! What rays through the corners of pixels and of their parts brought.

use super::{
    antialias::{STEPS, Seen},
    rows::Rows,
};
use std::collections::BTreeMap;

/// What rays through corners brought, as long as another pixel of the row or the rows below may want it.
#[derive(Default)]
pub(super) struct Corners {
    /// The pixel at hand.
    pixel: Option<(u32, u32)>,
    /// Of pixels, by column and row: wanted by all pixels up to the one after the next.
    of_pixels: Rows<Seen>,
    /// Of parts, on the upper edge of the row, by `x`.
    upper: BTreeMap<u32, Seen>,
    /// Of parts, on the lower edge of the row, by `x`.
    lower: BTreeMap<u32, Seen>,
    /// Of parts, between them, in this pixel and on its edge.
    inside: BTreeMap<(u32, u32), Seen>,
}

impl Corners {
    /// Forgets what is of no use for a pixel and those after it, to the right and below.
    pub(super) fn begin(&mut self, x: u32, y: u32) {
        let same_row = self.pixel.is_some_and(|(_, row)| row == y);
        if !same_row {
            let next_row = self.pixel.is_some_and(|(_, row)| row + 1 == y);
            let lower = core::mem::take(&mut self.lower);
            self.upper = if next_row { lower } else { BTreeMap::new() };
            self.of_pixels.forget_above(y.saturating_sub(1));
        }
        self.inside.retain(|(at, _), _| same_row && *at == x * STEPS);
        self.pixel = Some((x, y));
    }

    pub(super) fn get(&self, x: u32, y: u32) -> Option<Seen> {
        match self.place(x, y) {
            Place::OfPixel => return self.of_pixels.get(x / STEPS, y / STEPS),
            Place::Upper => self.upper.get(&x),
            Place::Lower => self.lower.get(&x),
            Place::Inside => self.inside.get(&(x, y)),
        }
        .copied()
    }

    pub(super) fn keep(&mut self, x: u32, y: u32, seen: Seen) {
        match self.place(x, y) {
            Place::OfPixel => self.of_pixels.keep(x / STEPS, y / STEPS, seen),
            Place::Upper => drop(self.upper.insert(x, seen)),
            Place::Lower => drop(self.lower.insert(x, seen)),
            Place::Inside => drop(self.inside.insert((x, y), seen)),
        }
    }

    fn place(&self, x: u32, y: u32) -> Place {
        match self.pixel {
            _ if (x | y).is_multiple_of(STEPS) => Place::OfPixel,
            Some((_, row)) if y == row * STEPS => Place::Upper,
            Some((_, row)) if y == (row + 1) * STEPS => Place::Lower,
            _ => Place::Inside,
        }
    }
}

enum Place {
    OfPixel,
    Upper,
    Lower,
    Inside,
}
