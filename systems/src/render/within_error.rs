//! Pixels halved until an error is kept.

use super::{
    antialias::{Pixels, STEPS, Seen, key},
    budget::variance_for_pixels,
    observe::Observer,
    part::{Four, Part},
};
use glam::DVec2;
use snell_components::{color::Rgb, settings::Settings};
use std::collections::BinaryHeap;

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

impl<O: Observer> Pixels<'_, O> {
    /// Adds the light of a pixel, halved where that tells most until the error of the setting is kept; tells whether it
    /// was halved.
    ///
    /// A part with an edge in it has the light of a ray through a random point: the errors of parts are independent, so
    /// their variances add up. The pixel is done when two standard errors are within what the error leaves.
    pub(super) fn add_within_error(&mut self, settings: &Settings, pixel: Part, sum: &mut Rgb) -> bool {
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
