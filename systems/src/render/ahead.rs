//! Rays of adaptive antialiasing that will be wanted, nearly all of them, traced together before they are asked for.

use super::{
    antialias::{Pixels, STEPS, Seen, ray_through, spacing_at},
    observe::Observer,
    part::Part,
    trace::Brought,
};
use snell_components::{packet::PACKET, settings::Settings};

/// Rows of pixels whose corners are looked at together, and the edge of the squares in which that is done.
const ROWS: u32 = 8;

/// A point of the lattice of corners, and the distance to the next rays, both in steps.
type Place = ([u32; 2], u32);

impl<O: Observer> Pixels<'_, O> {
    /// At the first pixel of some rows, looks at the corners of all their pixels and of those beside.
    pub(super) fn look_ahead(&mut self, x: u32, y: u32) {
        let Some(region) = self.ahead else { return };
        if x != region.x || !(y - region.y).is_multiple_of(ROWS) {
            return;
        }
        let Settings { width, height, .. } = self.snapshot.settings;
        let rows = ROWS.min(region.y + region.height - y);
        // Pixels beside are looked at where a pixel may be halved.
        let more = u32::from(self.snapshot.settings.subdivisions > 0);
        let beside = |at: u32, len: u32, most: u32| (at.saturating_sub(more), (at + len + more).min(most));
        let ((left, right), (top, low)) = (beside(x, region.width, width), beside(y, rows, height));
        let mut corners = vec![];
        for square_y in (top..=low).step_by(ROWS as usize) {
            for square_x in (left..=right).step_by(ROWS as usize) {
                for y in square_y..=low.min(square_y + ROWS - 1) {
                    corners.extend((square_x..=right.min(square_x + ROWS - 1)).map(|x| [x * STEPS, y * STEPS]));
                }
            }
        }
        self.look_at_corners(&corners);
    }

    /// Looks at all corners and middles that halving a pixel asks for.
    pub(super) fn look_into(&mut self, settings: &Settings, pixel: Part) {
        if O::WATCHES {
            return;
        }
        let mut parts = vec![pixel];
        while let Some(Part { level, .. }) = parts.first() {
            let last = level + 1 == settings.subdivisions;
            let mut quarters: Vec<Part> = parts.iter().flat_map(|part| part.quarters()).collect();
            self.look_at_parts(&quarters);
            quarters.retain(|quarter| !self.corners(*quarter).are_alike(settings.contrast));
            parts = quarters;
            if last {
                let middles: Vec<Place> = parts.iter().map(|part| (part.middle(), part.size())).collect();
                self.look_at(&middles, |this, at, seen| {
                    this.middles.insert(at, seen);
                });
                return;
            }
        }
    }

    /// Looks at the corners of some parts.
    pub(super) fn look_at_parts(&mut self, parts: &[Part]) {
        if O::WATCHES {
            return;
        }
        let mut corners: Vec<[u32; 2]> = parts.iter().flat_map(|part| part.corners()).collect();
        corners.sort_unstable();
        corners.dedup();
        self.look_at_corners(&corners);
    }

    /// Looks at those corners of which nothing is known.
    fn look_at_corners(&mut self, corners: &[[u32; 2]]) {
        let wanted = corners.iter().filter(|[x, y]| self.corners.get(*x, *y).is_none());
        let wanted: Vec<Place> = wanted.map(|&[x, y]| ([x, y], spacing_at(x, y))).collect();
        self.look_at(&wanted, |this, [x, y], seen| this.corners.keep(x, y, seen));
    }

    /// Traces rays through some places, and keeps what each brings.
    fn look_at(&mut self, places: &[Place], mut keep: impl FnMut(&mut Self, [u32; 2], Seen)) {
        for places in places.chunks(PACKET) {
            let number = self.traced;
            self.brought.clear();
            self.trace(places.iter().map(|&([x, y], spacing)| ray_through(x, y, spacing)));
            for (n, (at, _)) in (0..).zip(places) {
                let Brought { light, object, cut_bound } = self.brought[n as usize];
                keep(self, *at, Seen { light, object, cut_bound, number: number + n });
            }
        }
    }
}
