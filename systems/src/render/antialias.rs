//! How rays are placed in a pixel, and what its light is made of.

use super::{
    Counts, Key,
    footprint::{Beside, Neighbours},
    observe::Observer,
    trace::light_along,
};
use crate::snapshot::Snapshot;
use snell_components::{
    color::Rgb,
    method::Methods,
    settings::{Antialias, MAX_SUBDIVISIONS, Settings},
};
use std::collections::{BTreeMap, BinaryHeap};

/// Pixels of one snapshot.
///
/// Corners are shared by the pixels that meet there: what a ray through a corner brings is kept for the pixel to the
/// right and the row below. It depends on the corner alone, so what is kept changes the cost, never a bit.
pub(super) struct Pixels<'a, O> {
    snapshot: &'a Snapshot,
    methods: &'a Methods,
    pub(super) counts: &'a mut Counts,
    observer: &'a mut O,
    corners: Corners,
    /// Rays traced so far.
    traced: u32,
}

/// What a ray through a point of the picture brings.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen {
    light: Rgb,
    /// The object it meets first.
    object: Option<u32>,
    /// Which ray it was: the first, second, …
    number: u32,
}

/// Steps of the lattice of corners in a pixel: the middle of the smallest part lies on it.
const STEPS: u32 = 1 << (MAX_SUBDIVISIONS + 1);

impl<'a, O: Observer> Pixels<'a, O> {
    pub(super) fn new(
        snapshot: &'a Snapshot,
        methods: &'a Methods,
        counts: &'a mut Counts,
        observer: &'a mut O,
    ) -> Self {
        Self { snapshot, methods, counts, observer, corners: Corners::default(), traced: 0 }
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
                let pixel = Part { x: x * STEPS, y: y * STEPS, level: 0 };
                let before = self.traced;
                let mut light = Rgb::ZERO;
                if settings.error > 0.0 {
                    self.add_within_error(settings, pixel, &mut light);
                } else {
                    self.add_halved(settings, pixel, &mut light);
                }
                // The corners and the middle are at most five rays.
                self.counts.refined += u64::from(self.traced - before > 5);
                light
            }
        }
    }

    /// The mean over `n` by `n` rays, column by column.
    #[inline(always)]
    fn grid(&mut self, n: u32, x: u32, y: u32) -> Rgb {
        let share = 1.0 / f64::from(n * n);
        let place = |i: u32| (f64::from(i) + 0.5) / f64::from(n) - 0.5;
        let mut sum = Rgb::ZERO;
        for i in 0..n * n {
            let (dx, dy) = (place(i / n), place(i % n));
            let (px, py) = (f64::from(x) + 0.5 + dx, f64::from(y) + 0.5 + dy);
            let seen = self.through(px, py, 1.0 / f64::from(n), Key::of_pixel(x, y, i));
            self.add(&seen, share, &mut sum);
        }
        sum
    }

    /// What a ray through a point of the picture brings, in pixels from its upper left corner; `spacing` is the distance
    /// to the next ray.
    fn through(&mut self, x: f64, y: f64, spacing: f64, key: Key) -> Seen {
        let snapshot = self.snapshot;
        let ray = snapshot.view.ray(x, y, snapshot.settings.width, snapshot.settings.height);
        self.counts.primary += 1;
        self.observer.sample();
        let number = self.traced;
        self.traced += 1;
        let (light, object) = if snapshot.materials.any_filtered {
            let beside = Neighbours::start(snapshot, x, y, spacing);
            light_along(snapshot, ray, beside, key, self.methods, self.counts, self.observer)
        } else {
            light_along(snapshot, ray, (), key, self.methods, self.counts, self.observer)
        };
        Seen { light, object, number }
    }

    fn add(&mut self, seen: &Seen, share: f64, sum: &mut Rgb) {
        *sum += seen.light * share;
        self.observer.shared(seen.number, share);
    }

    /// Adds the light of a part of a pixel (Whitted: An Improved Illumination Model for Shaded Display, 1980).
    ///
    /// A part whose corners are alike, and show the same object, has their mean; one whose corners are not is halved
    /// both ways. A part that is not halved any further has the light of its middle and not its corners' mean: the mean
    /// would blur every edge that runs along corners, where all pixels beside it would be off by the same.
    fn add_halved(&mut self, settings: &Settings, part: Part, sum: &mut Rgb) {
        let corners = self.corners(part);
        if corners.same_object() && corners.contrast() <= settings.contrast {
            self.add_mean(&corners, part.area(), sum);
        } else if part.level == settings.subdivisions {
            let [x, y] = part.middle();
            let seen = self.at(x, y, part.size());
            self.add(&seen, part.area(), sum);
        } else {
            part.quarters().into_iter().for_each(|part| self.add_halved(settings, part, sum));
        }
    }

    /// Adds the light of a pixel, halved where that tells most until the error of the setting is kept.
    ///
    /// A part with an edge in it has the light of a ray through a random point: the errors of parts are independent, so
    /// their variances add up. The pixel is done when two standard errors are below the share of the error that is for
    /// this.
    fn add_within_error(&mut self, settings: &Settings, pixel: Part, sum: &mut Rgb) {
        // Half of the error, as two standard errors, and of their square one half: the other is for lights.
        let allowed = settings.error * settings.error / 32.0;
        let first = self.measured(pixel, settings.error, 0);
        let mut variance = first.variance();
        let mut measured = 1;
        let mut finest = vec![];
        let mut parts = BinaryHeap::from([first]);
        while variance > allowed {
            let Some(widest) = parts.pop() else {
                self.counts.unresolved += 1;
                break;
            };
            if widest.part.level == settings.subdivisions {
                finest.push(widest);
                continue;
            }
            variance -= widest.variance();
            for quarter in widest.part.quarters() {
                let quarter = self.measured(quarter, settings.error, measured);
                measured += 1;
                variance += quarter.variance();
                parts.push(quarter);
            }
        }
        for Measured { part, look, .. } in finest.into_iter().chain(parts.into_sorted_vec()) {
            match look {
                Look::Plane(corners) => self.add_mean(&corners, part.area(), sum),
                Look::Curved(corners, middle) => {
                    // Exact for polynomials of the second degree.
                    self.add_mean(&corners, part.area() / 3.0, sum);
                    self.add(&middle, part.area() * 2.0 / 3.0, sum);
                }
                Look::Edge => {
                    let seen = self.somewhere_in(part);
                    self.add(&seen, part.area(), sum);
                }
            }
        }
    }

    fn add_mean(&mut self, corners: &Four, area: f64, sum: &mut Rgb) {
        corners.0.iter().for_each(|corner| self.add(corner, 0.25 * area, sum));
    }

    /// Looks at a part as closely as the error asks for.
    fn measured(&mut self, part: Part, error: f64, number: u32) -> Measured {
        let corners = self.corners(part);
        let contrast = corners.contrast();
        if corners.same_object() && contrast <= LITTLE * error {
            return Measured { part, spread: contrast * part.area(), look: Look::Plane(corners), number };
        }
        // If the part is halved its middle is a corner of all quarters.
        let [x, y] = part.middle();
        let middle = self.corner(x, y);
        let off = (middle.light - corners.mean()).abs().max_element();
        if corners.same_object() && middle.object == corners.0[0].object && off <= contrast * BENT {
            return Measured { part, spread: off * part.area(), look: Look::Curved(corners, middle), number };
        }
        // Where objects of the same light meet there may be more to see than the corners show.
        let contrast = contrast.max(off).max(error);
        Measured { part, spread: contrast * part.area(), look: Look::Edge, number }
    }

    /// What a ray through a random point of a part brings.
    fn somewhere_in(&mut self, part: Part) -> Seen {
        let [x, y] = part.middle();
        let key = key(x, y);
        let (at, size) = (key.child(0).sample(0), f64::from(part.size()));
        let point = |corner: u32, share: f64| (f64::from(corner) + size * share) / f64::from(STEPS);
        self.through(point(part.x, at.x), point(part.y, at.y), size / f64::from(STEPS), key)
    }

    fn corners(&mut self, part: Part) -> Four {
        Four(part.corners().map(|[x, y]| self.corner(x, y)))
    }

    /// What a ray through a point of the lattice brings, kept or traced.
    fn corner(&mut self, x: u32, y: u32) -> Seen {
        if let Some(seen) = self.corners.get(x, y) {
            return seen;
        }
        // The size of the largest part that has this corner, so that all parts see the same through it.
        let size = STEPS.min(1u32.checked_shl((x | y).trailing_zeros()).unwrap_or(STEPS));
        let seen = self.at(x, y, size);
        self.corners.keep(x, y, seen);
        seen
    }

    fn at(&mut self, x: u32, y: u32, spacing: u32) -> Seen {
        let in_pixels = |steps: u32| f64::from(steps) / f64::from(STEPS);
        self.through(in_pixels(x), in_pixels(y), in_pixels(spacing), key(x, y))
    }
}

/// The key of a ray through a point of the lattice.
fn key(x: u32, y: u32) -> Key {
    Key::of_pixel(x / STEPS, y / STEPS, (x % STEPS) | ((y % STEPS) * STEPS))
}

/// Contrast that is not looked into, as a share of the error.
const LITTLE: f64 = 0.25;

/// How far the middle may lie from the plane through the corners, as a share of their contrast, for light without an
/// edge: an edge puts it off by a quarter or more.
const BENT: f64 = 0.125;

/// A square part of a pixel: its upper left corner in steps of the lattice, and how often the pixel was halved.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Part {
    x: u32,
    y: u32,
    level: u32,
}

impl Part {
    fn size(self) -> u32 {
        STEPS >> self.level
    }

    /// Share of the pixel; a power of two, so that products with it are exact.
    fn area(self) -> f64 {
        1.0 / f64::from(1u32 << (2 * self.level))
    }

    fn corners(self) -> [[u32; 2]; 4] {
        let Self { x, y, .. } = self;
        let (right, low) = (x + self.size(), y + self.size());
        [[x, y], [right, y], [x, low], [right, low]]
    }

    fn middle(self) -> [u32; 2] {
        [self.x + self.size() / 2, self.y + self.size() / 2]
    }

    fn quarters(self) -> [Self; 4] {
        let [right, low] = self.middle();
        let level = self.level + 1;
        [[self.x, self.y], [right, self.y], [self.x, low], [right, low]].map(|[x, y]| Self { x, y, level })
    }
}

/// What the corners of a part bring.
struct Four([Seen; 4]);

impl Four {
    fn same_object(&self) -> bool {
        self.0.iter().all(|corner| corner.object == self.0[0].object)
    }

    fn mean(&self) -> Rgb {
        self.0.iter().fold(Rgb::ZERO, |sum, corner| sum + corner.light) * 0.25
    }

    /// Largest difference of a channel; infinite if some is not a finite number.
    fn contrast(&self) -> f64 {
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| self.0[i].light);
        let contrast = (a.max(b).max(c.max(d)) - a.min(b).min(c.min(d))).max_element();
        if [a, b, c, d].iter().all(|light| light.is_finite()) { contrast } else { f64::INFINITY }
    }
}

/// A part, and how much of the pixel's light is open in it.
struct Measured {
    part: Part,
    /// Share of the pixel's light that the part may be off by.
    spread: f64,
    look: Look,
    /// Decides between equal spreads.
    number: u32,
}

/// How the light of a part goes.
enum Look {
    /// Hardly any change.
    Plane(Four),
    /// Smoothly, with the middle near the plane through the corners.
    Curved(Four, Seen),
    /// Anyhow.
    Edge,
}

impl Measured {
    /// Of the light of one ray through a random point, the edge being anywhere: `p·(1 − p)` is one sixth on average.
    fn variance(&self) -> f64 {
        self.spread * self.spread / 6.0
    }
}

impl Ord for Measured {
    fn cmp(&self, other: &Self) -> core::cmp::Ordering {
        self.spread.total_cmp(&other.spread).then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for Measured {
    fn partial_cmp(&self, other: &Self) -> Option<core::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Measured {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Measured {}

/// What rays through corners brought, as long as another pixel of the row or the next row may want it.
#[derive(Default)]
struct Corners {
    /// The pixel at hand.
    pixel: Option<(u32, u32)>,
    /// On the upper edge of the row, by `x`.
    upper: BTreeMap<u32, Seen>,
    /// On the lower edge of the row, by `x`.
    lower: BTreeMap<u32, Seen>,
    /// Between them, in this pixel and on its edge.
    inside: BTreeMap<(u32, u32), Seen>,
}

impl Corners {
    /// Forgets what is of no use for a pixel and those after it, to the right and below.
    fn begin(&mut self, x: u32, y: u32) {
        let same_row = self.pixel.is_some_and(|(_, row)| row == y);
        if !same_row {
            let next_row = self.pixel.is_some_and(|(_, row)| row + 1 == y);
            let lower = core::mem::take(&mut self.lower);
            self.upper = if next_row { lower } else { BTreeMap::new() };
        }
        self.inside.retain(|(at, _), _| same_row && *at == x * STEPS);
        self.pixel = Some((x, y));
    }

    fn get(&self, x: u32, y: u32) -> Option<Seen> {
        match self.edge(y) {
            Edge::Upper => self.upper.get(&x),
            Edge::Lower => self.lower.get(&x),
            Edge::Neither => self.inside.get(&(x, y)),
        }
        .copied()
    }

    fn keep(&mut self, x: u32, y: u32, seen: Seen) {
        match self.edge(y) {
            Edge::Upper => self.upper.insert(x, seen),
            Edge::Lower => self.lower.insert(x, seen),
            Edge::Neither => self.inside.insert((x, y), seen),
        };
    }

    fn edge(&self, y: u32) -> Edge {
        match self.pixel {
            Some((_, row)) if y == row * STEPS => Edge::Upper,
            Some((_, row)) if y == (row + 1) * STEPS => Edge::Lower,
            _ => Edge::Neither,
        }
    }
}

enum Edge {
    Upper,
    Lower,
    Neither,
}
