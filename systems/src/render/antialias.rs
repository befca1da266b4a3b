//! How rays are placed in a pixel, and what its light is made of.

use super::{
    Counts, Key, Region,
    budget::variance_for_pixels,
    corners::Corners,
    footprint::{Beside, Neighbours},
    observe::Observer,
    rows::Rows,
    trace::{Brought, Start, light_along},
    wave::Wave,
};
use crate::snapshot::Snapshot;
use glam::DVec2;
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
    fn through(&mut self, x: f64, y: f64, spacing: f64, key: Key) -> Seen {
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
                let beside = Neighbours::start(snapshot, x, y, spacing);
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

    fn add(&mut self, seen: &Seen, share: f64, sum: &mut Rgb) {
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
    fn changes_beside(&mut self, pixel: Part, contrast: f64) -> bool {
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

    /// Adds the light of a pixel, halved where that tells most until the error of the setting is kept; tells whether it
    /// was halved.
    ///
    /// A part with an edge in it has the light of a ray through a random point: the errors of parts are independent, so
    /// their variances add up. The pixel is done when two standard errors are within what the error leaves.
    fn add_within_error(&mut self, settings: &Settings, pixel: Part, sum: &mut Rgb) -> bool {
        let error = settings.error;
        let first = self.measured(pixel, error, 0);
        let mut measured = 1;
        let (mut contrast, mut cut_bound) = (first.contrast, first.cut_bound);
        let (mut variance, mut edges) = (first.variance, first.edge_area());
        let mut finest = vec![];
        let mut parts = BinaryHeap::from([first]);
        let mut doubted = false;
        loop {
            let count = parts.len() + finest.len();
            let beside = count == 1 && edges == 0.0 && settings.subdivisions > 0;
            let beside = beside && self.changes_beside(pixel, BESIDE * error);
            let tangled = edges > TANGLED && count >= 16;
            if tangled && !doubted {
                doubted = true;
                let doubt = |part: Measured| part.doubted(contrast, error);
                parts = parts.into_vec().into_iter().map(doubt).collect();
                variance = parts.iter().map(|part| part.variance).sum();
            }
            if !beside && variance <= variance_for_pixels(self.snapshot, cut_bound) {
                break;
            }
            let Some(widest) = parts.pop() else {
                self.counts.unresolved += 1;
                break;
            };
            if widest.part.level == settings.subdivisions {
                finest.push(widest);
                continue;
            }
            variance -= widest.variance;
            edges -= widest.edge_area();
            self.look_at_parts(&widest.part.quarters());
            for quarter in widest.part.quarters() {
                let mut quarter = self.measured(quarter, error, measured);
                if tangled {
                    quarter = quarter.doubted(contrast, error);
                }
                measured += 1;
                contrast = contrast.max(quarter.contrast);
                cut_bound = cut_bound.max(quarter.cut_bound);
                variance += quarter.variance;
                edges += quarter.edge_area();
                parts.push(quarter);
            }
        }
        finest.extend(parts.into_sorted_vec());
        let points: Vec<Option<InPart>> = finest.iter().map(|measured| self.point_in(measured)).collect();
        let mut terms = vec![];
        for sharp in [true, false] {
            terms.clear();
            for (measured, point) in finest.iter().zip(&points) {
                measured.terms(point.as_ref(), sharp, &mut terms);
            }
            // Differences may lead below zero, where no light is.
            if terms.iter().map(|(seen, share)| seen.light * *share).sum::<Rgb>().min_element() >= 0.0 {
                break;
            }
        }
        terms.iter().for_each(|(seen, share)| self.add(seen, *share, sum));
        finest.len() > 1
    }

    fn add_mean(&mut self, corners: &Four, area: f64, sum: &mut Rgb) {
        corners.0.iter().for_each(|corner| self.add(corner, 0.25 * area, sum));
    }

    /// Looks at a part as closely as the error asks for.
    fn measured(&mut self, part: Part, error: f64, number: u32) -> Measured {
        let corners = self.corners(part);
        let contrast = corners.contrast();
        let cut_bound = corners.0.iter().map(|corner| corner.cut_bound).fold(0.0, f64::max);
        let measured = |off: f64, share: f64, look| {
            let spread = off * part.area();
            Measured { part, variance: spread * spread * share, contrast, cut_bound, look, number }
        };
        if !corners.same_object() {
            // Where objects of the same light meet there may be more to see than the corners show.
            return measured(contrast.max(error), EDGE, Look::Edge(corners));
        }
        if contrast <= LITTLE * error {
            return measured(contrast, UNKNOWN, Look::Plane(corners));
        }
        // If the part is halved its middle is a corner of all quarters.
        let [x, y] = part.middle();
        let middle = self.corner(x, y);
        let off = (middle.light - corners.mean()).abs().max_element();
        if middle.object == corners.0[0].object && off <= contrast * BENT {
            return measured(off, UNKNOWN, Look::Curved(corners, middle));
        }
        measured(contrast.max(off).max(error), UNKNOWN, Look::Edge(corners))
    }

    /// A random point in a part with an edge.
    fn point_in(&mut self, measured: &Measured) -> Option<InPart> {
        let Measured { part, look: Look::Edge(_), .. } = measured else { return None };
        let [x, y] = part.middle();
        let key = key(x, y);
        let (at, size) = (key.child(0).sample(0), f64::from(part.size()));
        let point = |corner: u32, share: f64| (f64::from(corner) + size * share) / f64::from(STEPS);
        let seen = self.through(point(part.x, at.x), point(part.y, at.y), size / f64::from(STEPS), key);
        Some(InPart { at, seen })
    }

    pub(super) fn corners(&mut self, part: Part) -> Four {
        Four(part.corners().map(|[x, y]| self.corner(x, y)))
    }

    /// What a ray through a point of the lattice brings, kept or traced.
    fn corner(&mut self, x: u32, y: u32) -> Seen {
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
fn key(x: u32, y: u32) -> Key {
    Key::of_pixel(x / STEPS, y / STEPS, (x % STEPS) | ((y % STEPS) * STEPS))
}

/// Contrast that is not looked into, as a share of the error.
const LITTLE: f64 = 0.25;

/// Contrast of a pixel that has those beside it halved, as a multiple of the error: what a pixel may miss of it is less
/// than the half that two corners would show.
const BESIDE: f64 = 4.0;

/// Share of a pixel in parts with edges above which, at sixteen parts, it is taken to change everywhere: one straight edge
/// passes through 7 of 16.
const TANGLED: f64 = 0.5;

/// Mean square by which a random point in a part with an edge is off, as a share of the contrast squared, if what the
/// corners show is taken off: over straight edges anywhere, 0.071.
const EDGE: f64 = 1.0 / 12.0;

/// The same if the corners do not show it: the mean of `p·(1 − p)`.
const UNKNOWN: f64 = 1.0 / 6.0;

/// How far the middle may lie from the plane through the corners, as a share of their contrast, for light without an
/// edge: an edge puts it off by a quarter or more.
const BENT: f64 = 0.125;

/// A square part of a pixel: its upper left corner in steps of the lattice, and how often the pixel was halved.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Part {
    x: u32,
    y: u32,
    pub(super) level: u32,
}

impl Part {
    fn pixel(x: u32, y: u32) -> Self {
        Self { x: x * STEPS, y: y * STEPS, level: 0 }
    }

    pub(super) fn size(self) -> u32 {
        STEPS >> self.level
    }

    /// Share of the pixel; a power of two, so that products with it are exact.
    fn area(self) -> f64 {
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
pub(super) struct Four([Seen; 4]);

impl Four {
    fn same_object(&self) -> bool {
        self.0.iter().all(|corner| corner.object == self.0[0].object)
    }

    /// Whether they show one object and differ by no more than this.
    pub(super) fn are_alike(&self, contrast: f64) -> bool {
        self.same_object() && self.contrast() <= contrast
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
    /// Mean square by which the pixel's light may be off through this part.
    variance: f64,
    /// Of its corners.
    contrast: f64,
    /// The most that what was cut behind the corners could have added.
    cut_bound: f64,
    look: Look,
    /// Decides between equal variances.
    number: u32,
}

/// How the light of a part goes.
enum Look {
    /// Hardly any change.
    Plane(Four),
    /// Smoothly, with the middle near the plane through the corners.
    Curved(Four, Seen),
    /// Anyhow.
    Edge(Four),
}

/// A random point in a part.
struct InPart {
    /// Right and down in the part, 0 to 1.
    at: DVec2,
    seen: Seen,
}

impl Measured {
    /// Its area if there is an edge in it.
    fn edge_area(&self) -> f64 {
        if matches!(self.look, Look::Edge(_)) { self.part.area() } else { 0.0 }
    }

    /// The part in a pixel that changes nearly everywhere: that its corners are alike may be chance, and counts as an edge
    /// where, with the contrast of others, it could matter.
    fn doubted(mut self, contrast: f64, error: f64) -> Self {
        let spread = contrast * self.part.area();
        if spread > error {
            self.variance = self.variance.max(spread * spread * EDGE);
        }
        self
    }

    /// What the light of the part is made of; `sharp` takes the point as the difference from what the corners show at its
    /// place, which is nearer to the truth than the point alone.
    fn terms(&self, point: Option<&InPart>, sharp: bool, terms: &mut Vec<(Seen, f64)>) {
        let area = self.part.area();
        let mut mean = |corners: &Four, share: f64| terms.extend(corners.0.map(|corner| (corner, 0.25 * share)));
        match (&self.look, point) {
            (Look::Plane(corners), _) => mean(corners, area),
            (Look::Curved(corners, middle), _) => {
                // Exact for polynomials of the second degree.
                mean(corners, area / 3.0);
                terms.push((*middle, area * 2.0 / 3.0));
            }
            (Look::Edge(corners), Some(InPart { at, seen })) => {
                if sharp && corners.contrast().is_finite() {
                    let across = [1.0 - at.x, at.x];
                    let shares = [(1.0 - at.y), at.y].map(|down| across.map(|across| 0.25 - across * down));
                    terms.extend(
                        corners
                            .0
                            .into_iter()
                            .zip(shares.into_iter().flatten())
                            .map(|(corner, share)| (corner, area * share)),
                    );
                }
                terms.push((*seen, area));
            }
            (Look::Edge(_), None) => {}
        }
    }
}

impl Ord for Measured {
    fn cmp(&self, other: &Self) -> core::cmp::Ordering {
        self.variance.total_cmp(&other.variance).then(other.number.cmp(&self.number))
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
