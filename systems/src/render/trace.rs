//! One pixel: the trees of rays that start with those through it.

use super::{
    Counts, Key,
    antialias::Pixels,
    budget::Cut,
    footprint::Beside,
    interior::Interiors,
    observe::{Forward, Observer, Way},
    view_rays::ViewRays,
    wave::Wave,
};
use crate::snapshot::Snapshot;
use smallvec::SmallVec;
use snell_components::{
    color::Rgb,
    lanes,
    method::Methods,
    packet::{Mask, PACKET, each, set_vector, vector_of},
    primitive::Cost,
    settings::Settings,
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
pub(super) struct Pending<B> {
    pub ray: Ray,
    pub beside: B,
    /// What its light is multiplied by in the pixel.
    pub weight: Rgb,
    /// How many surfaces lie between it and the camera.
    pub depth: u32,
    /// The number of the clear bodies it goes through.
    pub inside: u32,
    /// In nanometres; none for white light.
    pub wavelength: Option<f64>,
    pub key: Key,
}

/// What comes back along a ray.
#[derive(Clone, Copy)]
pub(super) struct Brought {
    pub light: Rgb,
    /// The object it meets first.
    pub object: Option<u32>,
    /// The most that what was cut could have added to a channel; 0 without an error.
    pub cut_bound: f64,
}

/// A ray through a point of the picture, in pixels from its upper left corner.
pub(super) struct Start<B> {
    pub x: f64,
    pub y: f64,
    pub beside: B,
    pub key: Key,
}

/// The tree of rays that starts with one through the picture, as far as it was walked, but for what the [`Wave`] holds.
///
/// It is walked with a stack of its own, the mirrored branch of a surface before the transmitted one, and every
/// contribution is added to one sum in that order: no depth overflows, and the sum is the same every time.
pub(super) struct Tree<'a, B: Beside> {
    pub cut: Cut<'a>,
    /// What runs beside the ray in the wave, and what is known of it at the surface met.
    pub beside: B,
    pub met: Option<B::Met>,
    /// The next ray after the one in the wave, by its place in [`Walk::below`], or [`NONE`].
    next: u32,
}

/// The place of no ray.
const NONE: u32 = u32::MAX;

/// Some trees that are walked side by side.
pub(super) struct Walk<'a, 'w, B: Beside, O> {
    pub snapshot: &'a Snapshot,
    pub methods: &'a Methods,
    pub trees: SmallVec<[Tree<'a, B>; 1]>,
    pub interiors: Interiors<'a>,
    /// Rays put off, each with the place of the one after it in its tree.
    below: Vec<(Pending<B>, u32)>,
    /// The first place that is free again, and from there as in a tree.
    free: u32,
    /// The trees that have rays below.
    waiting: Mask,
    /// Whether any lamp is sampled.
    pub samples_lamps: bool,
    pub wave: &'w mut Wave,
    pub counts: &'w mut Counts,
    pub observer: &'w mut O,
}

/// The light that comes back along some rays, at most as many as a packet holds.
///
/// Their trees are walked side by side: at every step one ray of each, all of them together, and then the rays from
/// where they met something to each lamp. No tree knows of the others, so each comes about as it would alone.
pub(super) fn light_along<B: Beside, O: Observer>(
    snapshot: &Snapshot,
    starts: impl Iterator<Item = Start<B>>,
    methods: &Methods,
    wave: &mut Wave,
    counts: &mut Counts,
    observer: &mut O,
    brought: &mut Vec<Brought>,
) {
    let trees = SmallVec::with_capacity(starts.size_hint().0);
    let interiors = Interiors::new(&snapshot.inside);
    let (below, free, waiting) = (vec![], NONE, 0);
    let samples_lamps = snapshot.lights.sampling.iter().any(Option::is_some);
    let mut walk =
        Walk { snapshot, methods, trees, interiors, below, free, waiting, samples_lamps, wave, counts, observer };
    let mut rays = walk.begin(starts);
    while rays != 0 {
        walk.search(rays);
        let met = walk.arrive(rays);
        let by_material = walk.wave.by_material(met.shaded);
        walk.shade(&by_material);
        rays = met.onward | walk.go_on(&by_material);
        let next = walk.waiting & !rays;
        rays |= next;
        each(next).for_each(|i| walk.take_next(i));
    }
    brought.extend(walk.trees.iter().enumerate().map(|(i, tree)| {
        let cut_bound = tree.cut.bound();
        walk.counts.cut_bound = walk.counts.cut_bound.max(cut_bound);
        Brought { light: vector_of(&walk.wave.sum, i), object: walk.wave.first[i], cut_bound }
    }));
}

impl<B: Beside, O: Observer> Walk<'_, '_, B, O> {
    /// Takes the first ray of each tree; tells which there are.
    fn begin(&mut self, starts: impl Iterator<Item = Start<B>>) -> Mask {
        let Self { snapshot, trees, wave, observer, .. } = self;
        let mut places = [[0.0; PACKET]; 2];
        let cut = Cut::of(snapshot);
        let mut rays = 0;
        for (i, Start { x, y, beside, key }) in starts.enumerate() {
            (places[0][i], places[1][i]) = (x, y);
            trees.push(Tree { cut, beside, met: None, next: NONE });
            wave.begin(i, key);
            rays |= 1 << i;
        }
        let Settings { width, height, .. } = snapshot.settings;
        lanes::run(ViewRays { wave, rays, places: &places, view: &snapshot.view, size: (width, height) });
        wave.packet.check(rays);
        if O::WATCHES {
            for i in each(rays) {
                let (way, ray, weight) = (Way::Camera, wave.packet.ray(i), Rgb::ONE);
                observer.put_forward(&Forward { way, ray: &ray, share: weight, weight, wavelength: None });
            }
        }
        wave.enclosed = if snapshot.inside.is_empty() { 0 } else { rays };
        rays
    }

    /// Finds what the rays meet first.
    fn search(&mut self, rays: Mask) {
        let Self { snapshot, methods, wave: Wave { packet, bests, .. }, .. } = self;
        let mut cost = Cost::default();
        if rays.is_power_of_two() {
            let i = rays.trailing_zeros() as usize;
            bests.set(i, snapshot.geometry.nearest(&packet.ray(i), f64::INFINITY, methods, &mut cost));
        } else {
            packet.check(rays);
            bests.begin(rays, f64::INFINITY);
            snapshot.geometry.nearest_packet(packet, rays, methods, bests, &mut cost);
        }
        self.counts.add(cost);
    }

    /// Puts a ray of a tree off until those put forward later were traced.
    pub(super) fn put_off(&mut self, i: usize, ray: Pending<B>) {
        let next = &mut self.trees[i].next;
        let kept = (ray, *next);
        if let Some(place) = self.below.get_mut(self.free as usize) {
            (*next, self.free) = (self.free, place.1);
            *place = kept;
        } else {
            *next = self.below.len() as u32;
            self.below.push(kept);
        }
        self.waiting |= 1 << i;
    }

    /// Takes the next ray of a tree into the wave.
    fn take_next(&mut self, i: usize) {
        let place = self.trees[i].next;
        let (ray, after) = &mut self.below[place as usize];
        let (ray, after) = (*ray, core::mem::replace(after, self.free));
        (self.free, self.trees[i].next) = (place, after);
        if after == NONE {
            self.waiting &= !(1 << i);
        }
        self.put(i, ray);
    }

    /// Puts a ray of a tree into the wave.
    pub(super) fn put(&mut self, i: usize, ray: Pending<B>) {
        let Pending { ray, beside, weight, depth, inside, wavelength, key } = ray;
        let wave = &mut *self.wave;
        self.trees[i].beside = beside;
        wave.packet.set(i, &ray);
        set_vector(&mut wave.weight, i, weight);
        (wave.depth[i], wave.inside[i], wave.wavelength[i], wave.key[i]) = (depth, inside, wavelength, key);
        wave.enclosed = wave.enclosed & !(1 << i) | Mask::from(!self.interiors.get(inside).is_empty()) << i;
    }
}
