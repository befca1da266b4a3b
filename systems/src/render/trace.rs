//! One pixel: the tree of rays that starts with it.

use super::{
    Counts, Key,
    antialias::Pixels,
    budget::Cut,
    footprint::Beside,
    interior::{self, Interiors, Sides},
    observe::{Added, Dropped, Forward, Observer, Traced, Way},
    optics,
    shade::{Point, straight_eta},
};
use crate::{
    accelerate::Intersection,
    snapshot::{Effect, Snapshot},
};
use glam::DVec3;
use smallvec::SmallVec;
use snell_components::{
    color::Rgb,
    method::Methods,
    primitive::{Cost, Surface},
    space::Ray,
};

/// The linear light of a pixel: a pure function of its arguments but for the counts.
#[must_use]
pub fn pixel(snapshot: &Snapshot, x: u32, y: u32, methods: &Methods, counts: &mut Counts) -> Rgb {
    pixel_observed(snapshot, x, y, methods, counts, &mut ())
}

/// [`pixel`], to the last bit, while `observer` is told how it comes about.
#[must_use]
pub fn pixel_observed<O: Observer>(
    snapshot: &Snapshot,
    x: u32,
    y: u32,
    methods: &Methods,
    counts: &mut Counts,
    observer: &mut O,
) -> Rgb {
    Pixels::new(snapshot, methods, counts, observer).light(x, y)
}

/// A ray yet to be traced.
#[derive(Clone, Copy)]
struct Pending<B> {
    ray: Ray,
    beside: B,
    /// What its light is multiplied by in the pixel.
    weight: Rgb,
    /// How many surfaces lie between it and the camera.
    depth: u32,
    /// The number of the clear bodies it goes through.
    inside: u32,
    /// In nanometres; none for white light.
    wavelength: Option<f64>,
    key: Key,
}

/// What comes back along a ray.
pub(super) struct Brought {
    pub light: Rgb,
    /// The object it meets first.
    pub object: Option<u32>,
    /// The most that what was cut could have added to a channel; 0 without an error.
    pub cut_bound: f64,
}

/// The light that comes back along a ray.
///
/// The tree of rays is walked with a stack of its own, the mirrored branch of a surface before the transmitted one, and
/// every contribution is added to one sum in that order: no depth overflows, and the sum is the same every time.
pub(super) fn light_along<B: Beside, O: Observer>(
    snapshot: &Snapshot,
    ray: Ray,
    beside: B,
    key: Key,
    methods: &Methods,
    counts: &mut Counts,
    observer: &mut O,
) -> Brought {
    let Snapshot { settings, materials, .. } = snapshot;
    let mut sum = Rgb::ZERO;
    let mut first = None;
    let mut cut = Cut::of(snapshot);
    let mut interiors = Interiors::new(&snapshot.inside);
    let (way, weight) = (Way::Camera, Rgb::ONE);
    observer.put_forward(&Forward { way, ray: &ray, share: weight, weight, wavelength: None });
    // The top of the stack is kept apart: most rays have one follower at most.
    let mut top = Some(Pending { ray, beside, weight, depth: 0, inside: 0, wavelength: None, key });
    let mut below: SmallVec<[Pending<B>; 8]> = SmallVec::new();
    loop {
        let next = match top.take() {
            None => below.pop(),
            next => next,
        };
        let Some(Pending { ray, beside, mut weight, depth, inside, wavelength, key }) = next else { break };
        let mut cost = Cost::default();
        let met = snapshot.geometry.nearest(&ray, f64::INFINITY, methods, &mut cost);
        counts.add(cost);
        let interior = interiors.get(inside);
        if !interior.is_empty() {
            let travelled = met.map_or(f64::INFINITY, |met| met.hit.t);
            weight *= interior::transmittance(interior.medium(materials), travelled);
        }
        if O::WATCHES {
            let surface = |met| Intersection::new(met, snapshot.geometry.surface(met, &ray, methods));
            observer.traced(&Traced { met: met.as_ref().map(surface).as_ref(), weight });
        }
        let Some(met) = met else {
            sum += weight * settings.background;
            observer.added(Added::Background, weight, settings.background);
            continue;
        };
        let point = Point::new(snapshot, methods, &ray, &met, key);
        let sides = materials.medium(met.object).map(|_| interior.sides(met.object, point.entering, materials));
        if sides == Some(None) {
            // The surface lies inside a body that counts before its own: it is not there.
            let ray = Ray { origin: point.surface.departure(ray.direction, met.hit.t), direction: ray.direction };
            let across = interior.across(met.object, point.entering);
            let inside = interiors.keep(across);
            let (way, share) = (Way::Onward, Rgb::ONE);
            observer.put_forward(&Forward { way, ray: &ray, share, weight, wavelength });
            top = Some(Pending { ray, beside, weight, depth, inside, wavelength, key });
            continue;
        }
        if depth == 0 {
            first = Some(met.object);
        }
        let beside = beside.meet(&point, &met);
        let local = point.local(weight, interior, || B::footprint(&beside, &point.surface), counts, observer);
        sum += weight * local;
        observer.added(Added::Surface, weight, local);

        if !point.material.goes_on() {
            continue;
        }
        let (one, several);
        let branches: &[Branch] = match point.material.mirror_alone() {
            Some(share) => {
                one = [Branch { way: Way::Mirrored, eta: 1.0, direction: point.mirrored(), share, wavelength }];
                &one
            }
            None => {
                several = point.branches(sides.flatten(), wavelength);
                &several
            }
        };
        let mut beyond = None;
        for (n, branch) in branches.iter().enumerate().rev() {
            let weight = weight * branch.share;
            let origin = point.surface.departure(branch.direction, point.travelled);
            let ray = Ray { origin, direction: branch.direction };
            let Branch { way, share, wavelength, .. } = *branch;
            let forward = Forward { way, ray: &ray, share, weight, wavelength };
            if depth >= settings.depth {
                counts.too_deep += 1;
                let light = beyond_depth(settings.background);
                sum += weight * light;
                observer.dropped(&forward, Dropped::TooDeep);
                observer.added(Added::BeyondDepth, weight, light);
            } else if cut.drops(weight, settings.depth - depth - 1) {
                counts.cut += 1;
                observer.dropped(&forward, Dropped::Cut);
            } else {
                observer.put_forward(&forward);
                let inside = if way == Way::Mirrored {
                    counts.mirror += 1;
                    inside
                } else {
                    counts.transmitted += 1;
                    match beyond {
                        _ if sides.is_none() => inside,
                        // The same for all lines of a spectrum.
                        Some(beyond) => beyond,
                        None => {
                            let across = interiors.get(inside).across(met.object, point.entering);
                            *beyond.insert(interiors.keep(across))
                        }
                    }
                };
                // Lights count from zero up, branches from the top down.
                let key = key.child(u32::MAX - n as u32);
                let beside = B::go_on(&beside, &point, branch);
                let next = Pending { ray, beside, weight, depth: depth + 1, inside, wavelength, key };
                if let Some(before) = top.replace(next) {
                    below.push(before);
                }
            }
        }
    }
    let cut_bound = cut.bound();
    counts.cut_bound = counts.cut_bound.max(cut_bound);
    Brought { light: sum, object: first, cut_bound }
}

/// What a ray beyond the depth limit is taken to bring: grey, with the mean brightness of the background's components.
/// Black would make deep reflections darker than what they mirror.
pub(crate) fn beyond_depth(background: Rgb) -> Rgb {
    Rgb::splat((background.x + background.y + background.z) / 3.0)
}

/// A ray that goes on from a surface.
pub(super) struct Branch {
    pub way: Way,
    /// The index where the ray comes from over the one where it goes; 1 where it does not bend.
    pub eta: f64,
    /// Unit.
    pub direction: DVec3,
    /// Share of its light that leaves toward the viewer; not zero.
    share: Rgb,
    /// In nanometres; none for white light.
    wavelength: Option<f64>,
}

type Branches = SmallVec<[Branch; 2]>;

impl Point<'_> {
    /// The rays that go on from here, in the order in which they are traced.
    fn branches(&self, sides: Option<Sides<'_>>, wavelength: Option<f64>) -> Branches {
        let mut branches = Branches::new();
        let mut add = |way, eta, direction, share: Rgb, wavelength| {
            if share != Rgb::ZERO {
                branches.push(Branch { way, eta, direction, share, wavelength });
            }
        };
        for effect in &self.material.effects {
            match *effect {
                Effect::Mirror(share) => add(Way::Mirrored, 1.0, self.mirrored(), share, wavelength),
                Effect::Through(share) => add(Way::Transmitted, 1.0, self.direction, share, wavelength),
                Effect::Refract(strength) => self.each_line(sides, wavelength, |eta, color, wavelength| {
                    if let Some(direction) = self.refracted(eta) {
                        add(Way::Transmitted, eta, direction, strength * color, wavelength);
                    }
                }),
                Effect::Split(part) => {
                    let cosine = -self.direction.dot(self.bending_normal());
                    // White light is mirrored as one, by the index of its middle.
                    let reflected = self.reflected(cosine, eta_of(sides, wavelength));
                    let mut mirrored = part * reflected;
                    let mut lines: SmallVec<[_; 1]> = SmallVec::new();
                    self.each_line(sides, wavelength, |eta, color, wavelength| {
                        let share = part * (1.0 - reflected) * color;
                        match self.refracted(eta).filter(|_| reflected < 1.0) {
                            Some(direction) => lines.push((eta, direction, share, wavelength)),
                            // Beyond the critical angle of this wavelength.
                            None => mirrored += share,
                        }
                    });
                    let mirrored = if lines.is_empty() { part } else { mirrored };
                    add(Way::Mirrored, 1.0, self.mirrored(), mirrored, wavelength);
                    for (eta, direction, share, wavelength) in lines {
                        add(Way::Transmitted, eta, direction, share, wavelength);
                    }
                }
                Effect::Ambient(_) | Effect::Diffuse(_) | Effect::Glossy { .. } => {}
            }
        }
        branches
    }

    /// Calls `each` with the ratio of indices, the colour and the wavelength of every line into which the surface splits
    /// the ray: a single one, unless the ray is white and a medium disperses.
    fn each_line(
        &self,
        sides: Option<Sides<'_>>,
        wavelength: Option<f64>,
        mut each: impl FnMut(f64, Rgb, Option<f64>),
    ) {
        let spectrum = sides.and_then(|sides| sides.after.spectrum.as_ref().or(sides.before.spectrum.as_ref()));
        match spectrum {
            Some(spectrum) if wavelength.is_none() && self.snapshot.settings.refraction => {
                for (wavelength, color) in &spectrum.lines {
                    each(eta_of(sides, Some(*wavelength)), *color, Some(*wavelength));
                }
            }
            _ => each(eta_of(sides, wavelength), Rgb::ONE, wavelength),
        }
    }

    /// Share of the light that is reflected.
    fn reflected(&self, cosine: f64, eta: f64) -> f64 {
        // A way that does not bend knows no critical angle.
        let eta = if self.snapshot.settings.refraction { eta } else { straight_eta(eta, 1.0) };
        optics::fresnel(cosine, eta)
    }

    /// The normal by which rays are mirrored and bent: the interpolated one, unless that faces away from the ray, as it
    /// may at the silhouette of a smoothed mesh.
    fn bending_normal(&self) -> DVec3 {
        let Surface { normal, shading_normal, .. } = self.surface;
        if shading_normal.dot(self.direction) < 0.0 { shading_normal } else { normal }
    }

    /// The mirrored direction; at the true surface where the interpolated normal would send it below that.
    pub(super) fn mirrored(&self) -> DVec3 {
        let mirrored = optics::reflect(self.direction, self.bending_normal());
        if mirrored.dot(self.surface.normal) > 0.0 {
            mirrored
        } else {
            optics::reflect(self.direction, self.surface.normal)
        }
    }

    /// The refracted direction, if any; at the true surface where the interpolated normal would keep it above that.
    pub(super) fn refracted(&self, eta: f64) -> Option<DVec3> {
        if !self.snapshot.settings.refraction {
            return Some(self.direction);
        }
        let refracted = optics::refract(self.direction, self.bending_normal(), eta)?;
        if refracted.dot(self.surface.normal) < 0.0 {
            Some(refracted)
        } else {
            optics::refract(self.direction, self.surface.normal, eta)
        }
    }
}

/// The index where the ray comes from over the one where it goes.
fn eta_of(sides: Option<Sides<'_>>, wavelength: Option<f64>) -> f64 {
    sides.map_or(1.0, |Sides { before, after }| before.index_at(wavelength) / after.index_at(wavelength))
}
