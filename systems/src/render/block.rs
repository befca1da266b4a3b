//! Squares of pixels whose rays are traced together.

use super::{
    Key, Region,
    antialias::{Pixels, in_pixel},
};
use smallvec::SmallVec;
use snell_components::{color::Rgb, packet::PACKET, settings::Antialias};

impl Pixels<'_, ()> {
    /// The edge of the squares of pixels that are drawn together.
    pub(super) fn edge(&self) -> u32 {
        let settings = &self.snapshot.settings;
        match settings.antialias {
            Antialias::Off => 8,
            Antialias::Four => 4,
            Antialias::Grid => (8 / settings.grid.max(1)).max(1),
            Antialias::Adaptive => 1,
        }
    }

    /// The linear light of some pixels, row by row: each as [`Pixels::light`] tells it.
    pub(super) fn lights(&mut self, region: Region, lights: &mut Vec<Rgb>) {
        lights.clear();
        let settings = &self.snapshot.settings;
        let n = match settings.antialias {
            Antialias::Off => 1,
            Antialias::Four => 2,
            Antialias::Grid => settings.grid,
            Antialias::Adaptive => {
                for i in 0..region.width * region.height {
                    lights.push(self.light(region.x + i % region.width, region.y + i / region.width));
                }
                return;
            }
        };
        let (each, share, spacing) = (n * n, 1.0 / f64::from(n * n), 1.0 / f64::from(n));
        self.brought.clear();
        let count = region.width * region.height * each;
        let places: SmallVec<[(f64, f64); 4]> = (0..each).map(|i| in_pixel(n, i)).collect();
        let (mut x, mut y, mut i) = (region.x, region.y, 0);
        for first in (0..count).step_by(PACKET) {
            let next = |_| {
                let (dx, dy) = places[i as usize];
                let point = (f64::from(x) + 0.5 + dx, f64::from(y) + 0.5 + dy, spacing, Key::of_pixel(x, y, i));
                i += 1;
                if i == each {
                    (x, i) = (x + 1, 0);
                }
                if x == region.x + region.width {
                    (x, y) = (region.x, y + 1);
                }
                point
            };
            self.trace((first..count.min(first + PACKET as u32)).map(next));
        }
        lights.extend(self.brought.chunks_exact(each as usize).map(|rays| {
            let mut sum = Rgb::ZERO;
            rays.iter().for_each(|ray| sum += ray.light * share);
            sum
        }));
    }
}
