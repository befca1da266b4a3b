//! Squares of pixels whose rays are traced together.

use super::{
    Key, Region,
    antialias::{Pixels, in_grid},
};
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
        for first in (0..count).step_by(PACKET) {
            let rays = first..count.min(first + PACKET as u32);
            let point = |ray: u32| {
                let (pixel, i) = (ray / each, ray % each);
                let (x, y) = (region.x + pixel % region.width, region.y + pixel / region.width);
                let (px, py) = in_grid(n, x, y, i);
                (px, py, spacing, Key::of_pixel(x, y, i))
            };
            self.trace(rays.map(point));
        }
        lights.extend(self.brought.chunks_exact(each as usize).map(|rays| {
            let mut sum = Rgb::ZERO;
            rays.iter().for_each(|ray| sum += ray.light * share);
            sum
        }));
    }
}
