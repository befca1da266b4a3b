//! One pixel: the tree of rays that starts with it.

use super::{
    Counts, Key,
    antialias::Pixels,
    budget::Cut,
    footprint::Beside,
    interior::{self, Interiors, Sides},
    observe::{Added, Dropped, Forward, Observer, Traced, Way},
    optics,
    shade::{Local, Point, Shadows, ask_lamps, straight_eta},
};
use crate::{
    accelerate::{Bests, Intersection, Nearest},
    snapshot::{Effect, Snapshot},
};
use glam::DVec3;
use smallvec::SmallVec;
use snell_components::{
    color::Rgb,
    method::Methods,
    packet::Packet,
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

/// A ray through the picture.
pub(super) struct Start<B> {
    pub ray: Ray,
    pub beside: B,
    pub key: Key,
}

/// The tree of rays that starts with one through the picture, as far as it was walked.
///
/// It is walked with a stack of its own, the mirrored branch of a surface before the transmitted one, and every
/// contribution is added to one sum in that order: no depth overflows, and the sum is the same every time.
struct Tree<'a, B> {
    sum: Rgb,
    /// The object that the first ray met.
    first: Option<u32>,
    cut: Cut<'a>,
    interiors: Interiors<'a>,
    /// The top of the stack is kept apart: most rays have one follower at most.
    top: Option<Pending<B>>,
    below: Vec<Pending<B>>,
}

/// A ray at the surface it met.
struct Met<'a, B: Beside> {
    /// Which tree it belongs to.
    tree: usize,
    pending: Pending<B>,
    met: Nearest,
    /// What lies on both sides; none within if the surface bounds no medium.
    sides: Option<Sides<'a>>,
    bounds_medium: bool,
    beside: B::Met,
}

/// Room for the work on some rays at once, used again and again.
#[derive(Default)]
pub(super) struct Room {
    packet: Packet,
    bests: Bests,
    shadows: Shadows,
}

/// The light that comes back along some rays, at most as many as a packet holds.
///
/// Their trees are walked side by side: at every step one ray of each, all of them together, and then the rays from
/// where they met something to each lamp. No tree knows of the others, so each comes about as it would alone.
pub(super) fn light_along<B: Beside, O: Observer>(
    snapshot: &Snapshot,
    starts: impl Iterator<Item = Start<B>>,
    methods: &Methods,
    room: &mut Room,
    counts: &mut Counts,
    observer: &mut O,
    brought: &mut Vec<Brought>,
) {
    let count = starts.size_hint().0;
    let mut trees: SmallVec<[Tree<'_, B>; 1]> = SmallVec::with_capacity(count);
    for Start { ray, beside, key } in starts {
        let (way, weight) = (Way::Camera, Rgb::ONE);
        observer.put_forward(&Forward { way, ray: &ray, share: weight, weight, wavelength: None });
        trees.push(Tree {
            sum: Rgb::ZERO,
            first: None,
            cut: Cut::of(snapshot),
            interiors: Interiors::new(&snapshot.inside),
            top: Some(Pending { ray, beside, weight, depth: 0, inside: 0, wavelength: None, key }),
            below: vec![],
        });
    }
    let mut pending: SmallVec<[(usize, Pending<B>); 1]> = SmallVec::with_capacity(count);
    let mut met: SmallVec<[Met<'_, B>; 1]> = SmallVec::with_capacity(count);
    let mut points: SmallVec<[Point<'_>; 1]> = SmallVec::with_capacity(count);
    let mut locals: SmallVec<[Local; 1]> = SmallVec::with_capacity(count);
    loop {
        pending.clear();
        pending.extend(trees.iter_mut().enumerate().filter_map(|(n, tree)| Some((n, tree.next()?))));
        if pending.is_empty() {
            break;
        }
        search(snapshot, &pending, methods, room, counts);
        met.clear();
        points.clear();
        locals.clear();
        for (i, (n, pending)) in pending.drain(..).enumerate() {
            let nearest = room.bests.nearest(i);
            if let Some((at, point)) = trees[n].arrive(n, pending, nearest, snapshot, methods, observer) {
                locals.push(point.begin(|| B::footprint(&at.beside, &point.surface), observer));
                met.push(at);
                points.push(point);
            }
        }
        let around = |i: usize| {
            let Met { tree, pending: Pending { weight, inside, .. }, .. } = met[i];
            (weight, trees[tree].interiors.get(inside))
        };
        ask_lamps(snapshot, &points, &mut locals, around, &mut room.shadows, counts, observer);
        for ((at, point), local) in met.iter().zip(&points).zip(&locals) {
            let local = point.finish(local, observer);
            trees[at.tree].go_on(at, point, local, snapshot, counts, observer);
        }
    }
    brought.extend(trees.iter().map(|tree| {
        let cut_bound = tree.cut.bound();
        counts.cut_bound = counts.cut_bound.max(cut_bound);
        Brought { light: tree.sum, object: tree.first, cut_bound }
    }));
}

/// Finds what some rays meet first.
fn search<B>(
    snapshot: &Snapshot,
    pending: &[(usize, Pending<B>)],
    methods: &Methods,
    room: &mut Room,
    counts: &mut Counts,
) {
    let Room { packet, bests, .. } = room;
    let mut cost = Cost::default();
    if let [(_, Pending { ray, .. })] = pending {
        bests.set(0, snapshot.geometry.nearest(ray, f64::INFINITY, methods, &mut cost));
    } else {
        packet.clear();
        for (_, Pending { ray, .. }) in pending {
            packet.push(ray);
        }
        bests.begin(packet.len(), f64::INFINITY);
        snapshot.geometry.nearest_packet(packet, methods, bests, &mut cost);
    }
    counts.add(cost);
}

impl<'a, B: Beside> Tree<'a, B> {
    /// The ray to be traced next.
    #[inline(always)]
    fn next(&mut self) -> Option<Pending<B>> {
        match self.top.take() {
            None => self.below.pop(),
            next => next,
        }
    }

    /// Takes a ray to what it meets; the surface there, if it is to be shaded.
    #[inline(always)]
    fn arrive<'p, O: Observer>(
        &mut self,
        tree: usize,
        mut pending: Pending<B>,
        met: Option<Nearest>,
        snapshot: &'p Snapshot,
        methods: &'p Methods,
        observer: &mut O,
    ) -> Option<(Met<'p, B>, Point<'p>)> {
        let Snapshot { settings, materials, .. } = snapshot;
        let Pending { ray, beside, depth, inside, wavelength, key, .. } = pending;
        let interior = self.interiors.get(inside);
        if !interior.is_empty() {
            let travelled = met.map_or(f64::INFINITY, |met| met.hit.t);
            pending.weight *= interior::transmittance(interior.medium(materials), travelled);
        }
        let weight = pending.weight;
        if O::WATCHES {
            let surface = |met| Intersection::new(met, snapshot.geometry.surface(met, &ray, methods));
            observer.traced(&Traced { met: met.as_ref().map(surface).as_ref(), weight });
        }
        let Some(met) = met else {
            self.sum += weight * settings.background;
            observer.added(Added::Background, weight, settings.background);
            return None;
        };
        let point = Point::new(snapshot, methods, &ray, &met, key);
        let sides = materials.medium(met.object).map(|_| interior.sides(met.object, point.entering, materials));
        if sides == Some(None) {
            // The surface lies inside a body that counts before its own: it is not there.
            let ray = Ray { origin: point.surface.departure(ray.direction, met.hit.t), direction: ray.direction };
            let across = interior.across(met.object, point.entering);
            let inside = self.interiors.keep(across);
            let (way, share) = (Way::Onward, Rgb::ONE);
            observer.put_forward(&Forward { way, ray: &ray, share, weight, wavelength });
            self.top = Some(Pending { ray, beside, weight, depth, inside, wavelength, key });
            return None;
        }
        if depth == 0 {
            self.first = Some(met.object);
        }
        let beside = beside.meet(&point, &met);
        let bounds_medium = sides.is_some();
        Some((Met { tree, pending, met, sides: sides.flatten(), bounds_medium, beside }, point))
    }

    /// Adds the light at a surface, and puts the rays forward that go on from there.
    #[inline(always)]
    fn go_on<O: Observer>(
        &mut self,
        at: &Met<'_, B>,
        point: &Point<'_>,
        local: Rgb,
        snapshot: &Snapshot,
        counts: &mut Counts,
        observer: &mut O,
    ) {
        let settings = &snapshot.settings;
        let Met { met, pending: Pending { weight, depth, inside, wavelength, key, .. }, .. } = *at;
        self.sum += weight * local;
        observer.added(Added::Surface, weight, local);
        if !point.material.goes_on() {
            return;
        }
        let (one, several);
        let branches: &[Branch] = match point.material.mirror_alone() {
            Some(share) => {
                one = [Branch { way: Way::Mirrored, eta: 1.0, direction: point.mirrored(), share, wavelength }];
                &one
            }
            None => {
                several = point.branches(at.sides, wavelength);
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
                self.sum += weight * light;
                observer.dropped(&forward, Dropped::TooDeep);
                observer.added(Added::BeyondDepth, weight, light);
            } else if self.cut.drops(weight, settings.depth - depth - 1) {
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
                        _ if !at.bounds_medium => inside,
                        // The same for all lines of a spectrum.
                        Some(beyond) => beyond,
                        None => {
                            let across = self.interiors.get(inside).across(met.object, point.entering);
                            *beyond.insert(self.interiors.keep(across))
                        }
                    }
                };
                // Lights count from zero up, branches from the top down.
                let key = key.child(u32::MAX - n as u32);
                let beside = B::go_on(&at.beside, point, branch);
                let next = Pending { ray, beside, weight, depth: depth + 1, inside, wavelength, key };
                if let Some(before) = self.top.replace(next) {
                    self.below.push(before);
                }
            }
        }
    }
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
