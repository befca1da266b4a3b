//! How rays are placed in a pixel, and what its light is made of.

use super::{
    Counts, Key, Region,
    corners::Corners,
    footprint::neighbours,
    observe::Observer,
    part::{Four, Part},
    rows::Rows,
    trace::{Brought, Start, light_along},
    wave::Wave,
};
use crate::snapshot::Snapshot;
use snell_components::{
    color::Rgb,
    method::Methods,
    settings::{Antialias, MAX_SUBDIVISIONS, Settings},
};
use std::collections::BTreeMap;

/// Pixels of one snapshot.
///
/// Corners are shared by the pixels that meet there: what a ray through a corner brings is kept for the pixel to the
/// right and the row below. It depends on the corner alone, so what is kept changes the cost, never a bit.
pub(super) struct Pixels<'a, O> {
    pub(super) snapshot: &'a Snapshot,
    methods: &'a Methods,
    pub(super) counts: &'a mut Counts,
    observer: &'a mut O,
    pub(super) corners: Corners,
    /// What the middles of parts of the pixel at hand bring that will be wanted.
    pub(super) middles: BTreeMap<[u32; 2], Seen>,
    /// Whether things change between the corners of a pixel.
    changing: Rows<bool>,
    /// What is drawn row by row, if that is known: rays that will be wanted are traced together.
    pub(super) ahead: Option<Region>,
    /// Rays traced so far.
    pub(super) traced: u32,
    wave: Box<Wave>,
    pub(super) brought: Vec<Brought>,
}

/// What a ray through a point of the picture brings.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    pub(super) light: Rgb,
    /// The object it meets first.
    pub(super) object: Option<u32>,
    /// The most that what was cut behind it could have added.
    pub(super) cut_bound: f64,
    /// Which ray it was: the first, second, …
    pub(super) number: u32,
}

/// Where the `i`th of `n` by `n` rays goes through a pixel, from its middle.
pub(super) fn in_pixel(n: u32, i: u32) -> (f64, f64) {
    let place = |i: u32| (f64::from(i) + 0.5) / f64::from(n) - 0.5;
    (place(i / n), place(i % n))
}

/// Steps of the lattice of corners in a pixel: the middle of the smallest part lies on it.
pub(super) const STEPS: u32 = 1 << (MAX_SUBDIVISIONS + 1);

impl<'a, O: Observer> Pixels<'a, O> {
    pub(super) fn new(
        snapshot: &'a Snapshot,
        methods: &'a Methods,
        counts: &'a mut Counts,
        observer: &'a mut O,
    ) -> Self {
        Self {
            snapshot,
            methods,
            counts,
            observer,
            corners: Corners::default(),
            middles: BTreeMap::new(),
            changing: Rows::default(),
            ahead: None,
            traced: 0,
            wave: Box::default(),
            brought: vec![],
        }
    }

    /// The linear light of a pixel: a function of snapshot and coordinates.
    pub(super) fn light(&mut self, x: u32, y: u32) -> Rgb {
        let settings = &self.snapshot.settings;
        match settings.antialias {
            Antialias::Off => self.grid(1, x, y),
            Antialias::Four => self.grid(2, x, y),
            Antialias::Grid => self.grid(settings.grid, x, y),
            Antialias::Adaptive => {
                self.corners.begin(x, y);
                self.changing.forget_above(y.saturating_sub(1));
                self.look_ahead(x, y);
                let pixel = Part::pixel(x, y);
                let mut light = Rgb::ZERO;
                let halved = if settings.error > 0.0 {
                    self.add_within_error(settings, pixel, &mut light)
                } else {
                    self.add_halved(settings, pixel, &mut light)
                };
                self.counts.refined += u64::from(halved);
                light
            }
        }
    }

    /// The mean over `n` by `n` rays, column by column.
    #[inline(always)]
    fn grid(&mut self, n: u32, x: u32, y: u32) -> Rgb {
        let share = 1.0 / f64::from(n * n);
        let mut sum = Rgb::ZERO;
        for i in 0..n * n {
            let (dx, dy) = in_pixel(n, i);
            let (px, py) = (f64::from(x) + 0.5 + dx, f64::from(y) + 0.5 + dy);
            let seen = self.through(px, py, 1.0 / f64::from(n), Key::of_pixel(x, y, i));
            self.add(&seen, share, &mut sum);
        }
        sum
    }

    /// What a ray through a point of the picture brings, in pixels from its upper left corner; `spacing` is the distance
    /// to the next ray.
    pub(super) fn through(&mut self, x: f64, y: f64, spacing: f64, key: Key) -> Seen {
        self.observer.sample();
        let number = self.traced;
        self.brought.clear();
        self.trace(core::iter::once((x, y, spacing, key)));
        let [Brought { light, object, cut_bound }] = self.brought[..] else { unreachable!("one ray") };
        Seen { light, object, cut_bound, number }
    }

    /// Adds what rays through some points of the picture bring, at most as many as a packet holds, to what was brought;
    /// each with the distance to the next rays.
    pub(super) fn trace(&mut self, points: impl Iterator<Item = (f64, f64, f64, Key)>) {
        let Self { snapshot, methods, counts, observer, wave, brought, .. } = self;
        let before = brought.len();
        if snapshot.materials.any_filtered {
            let starts = points.map(|(x, y, spacing, key)| {
                let beside = neighbours(snapshot, x, y, spacing);
                Start { x, y, beside, key }
            });
            light_along(snapshot, starts, methods, wave, counts, *observer, brought);
        } else {
            let starts = points.map(|(x, y, _, key)| Start { x, y, beside: (), key });
            light_along(snapshot, starts, methods, wave, counts, *observer, brought);
        }
        let traced = brought.len() - before;
        self.traced += traced as u32;
        self.counts.primary += traced as u64;
    }

    pub(super) fn add(&mut self, seen: &Seen, share: f64, sum: &mut Rgb) {
        *sum += seen.light * share;
        self.observer.shared(seen.number, share);
    }

    /// Adds the light of a part of a pixel (Whitted: An Improved Illumination Model for Shaded Display, 1980); tells
    /// whether it was halved.
    ///
    /// A part whose corners are alike, and show the same object, has their mean; one whose corners are not is halved
    /// both ways, as is a pixel beside one whose corners are not. A part that is not halved any further has the light of
    /// its middle and not its corners' mean: the mean would blur every edge that runs along corners, where all pixels
    /// beside it would be off by the same.
    fn add_halved(&mut self, settings: &Settings, part: Part, sum: &mut Rgb) -> bool {
        let corners = self.corners(part);
        let alike = corners.are_alike(settings.contrast);
        let last = part.level == settings.subdivisions;
        if alike && (last || part.level > 0 || !self.changes_beside(part, settings.contrast)) {
            self.add_mean(&corners, part.area(), sum);
            false
        } else if last {
            let [x, y] = part.middle();
            let seen = self.middles.remove(&[x, y]).unwrap_or_else(|| self.at(x, y, part.size()));
            self.add(&seen, part.area(), sum);
            false
        } else {
            if part.level == 0 {
                self.look_into(settings, part);
            }
            for part in part.quarters() {
                self.add_halved(settings, part, sum);
            }
            true
        }
    }

    /// Whether things change between the corners of a pixel beside this one: what is thinner than a pixel may miss the
    /// corners here and not those there.
    pub(super) fn changes_beside(&mut self, pixel: Part, contrast: f64) -> bool {
        let Settings { width, height, .. } = self.snapshot.settings;
        let (x, y) = (pixel.x / STEPS, pixel.y / STEPS);
        let around = |at: u32, len: u32| at.saturating_sub(1)..(at + 2).min(len);
        around(y, height).any(|y| around(x, width).any(|x| self.changes_in(x, y, contrast)))
    }

    fn changes_in(&mut self, x: u32, y: u32, contrast: f64) -> bool {
        if let Some(changing) = self.changing.get(x, y) {
            return changing;
        }
        let changing = !self.corners(Part::pixel(x, y)).are_alike(contrast);
        self.changing.keep(x, y, changing);
        changing
    }

    fn add_mean(&mut self, corners: &Four, area: f64, sum: &mut Rgb) {
        corners.0.iter().for_each(|corner| self.add(corner, 0.25 * area, sum));
    }

    pub(super) fn corners(&mut self, part: Part) -> Four {
        Four(part.corners().map(|[x, y]| self.corner(x, y)))
    }

    /// What a ray through a point of the lattice brings, kept or traced.
    pub(super) fn corner(&mut self, x: u32, y: u32) -> Seen {
        if let Some(seen) = self.corners.get(x, y) {
            return seen;
        }
        let seen = self.at(x, y, spacing_at(x, y));
        self.corners.keep(x, y, seen);
        seen
    }

    fn at(&mut self, x: u32, y: u32, spacing: u32) -> Seen {
        let (x, y, spacing, key) = ray_through(x, y, spacing);
        self.through(x, y, spacing, key)
    }
}

/// The size of the largest part that has this corner, so that all parts see the same through it.
pub(super) fn spacing_at(x: u32, y: u32) -> u32 {
    STEPS.min(1u32.checked_shl((x | y).trailing_zeros()).unwrap_or(STEPS))
}

/// The ray through a point of the lattice: where it goes through the picture, in pixels, the distance to the next rays,
/// and its key.
pub(super) fn ray_through(x: u32, y: u32, spacing: u32) -> (f64, f64, f64, Key) {
    let in_pixels = |steps: u32| f64::from(steps) / f64::from(STEPS);
    (in_pixels(x), in_pixels(y), in_pixels(spacing), key(x, y))
}

/// The key of a ray through a point of the lattice.
pub(super) fn key(x: u32, y: u32) -> Key {
    Key::of_pixel(x / STEPS, y / STEPS, (x % STEPS) | ((y % STEPS) * STEPS))
}
