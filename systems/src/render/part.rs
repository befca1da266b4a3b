//! Parts of a pixel that is halved, and what their corners bring.

use super::antialias::{STEPS, Seen};
use snell_components::color::Rgb;

/// A square part of a pixel: its upper left corner in steps of the lattice, and how often the pixel was halved.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Part {
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) level: u32,
}

impl Part {
    pub(super) fn pixel(x: u32, y: u32) -> Self {
        Self { x: x * STEPS, y: y * STEPS, level: 0 }
    }

    pub(super) fn size(self) -> u32 {
        STEPS >> self.level
    }

    /// Share of the pixel; a power of two, so that products with it are exact.
    pub(super) fn area(self) -> f64 {
        1.0 / f64::from(1u32 << (2 * self.level))
    }

    pub(super) fn corners(self) -> [[u32; 2]; 4] {
        let Self { x, y, .. } = self;
        let (right, low) = (x + self.size(), y + self.size());
        [[x, y], [right, y], [x, low], [right, low]]
    }

    pub(super) fn middle(self) -> [u32; 2] {
        [self.x + self.size() / 2, self.y + self.size() / 2]
    }

    pub(super) fn quarters(self) -> [Self; 4] {
        let [right, low] = self.middle();
        let level = self.level + 1;
        [[self.x, self.y], [right, self.y], [self.x, low], [right, low]].map(|[x, y]| Self { x, y, level })
    }
}

/// What the corners of a part bring.
pub(super) struct Four(pub(super) [Seen; 4]);

impl Four {
    pub(super) fn same_object(&self) -> bool {
        self.0.iter().all(|corner| corner.object == self.0[0].object)
    }

    /// Whether they show one object and differ by no more than this.
    pub(super) fn are_alike(&self, contrast: f64) -> bool {
        self.same_object() && self.contrast() <= contrast
    }

    pub(super) fn mean(&self) -> Rgb {
        self.0.iter().fold(Rgb::ZERO, |sum, corner| sum + corner.light) * 0.25
    }

    /// Largest difference of a channel; infinite if some is not a finite number.
    pub(super) fn contrast(&self) -> f64 {
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| self.0[i].light);
        let contrast = (a.max(b).max(c.max(d)) - a.min(b).min(c.min(d))).max_element();
        if [a, b, c, d].iter().all(|light| light.is_finite()) { contrast } else { f64::INFINITY }
    }
}
