//! One pixel: the trees of rays that start with those through it.

use super::{
    Counts, Key,
    antialias::Pixels,
    budget::Cut,
    footprint::Beside,
    interior::{Interiors, Sides},
    observe::{Forward, Observer, Way},
    wave::Wave,
};
use crate::snapshot::Snapshot;
use smallvec::SmallVec;
use snell_components::{
    color::Rgb,
    method::Methods,
    packet::{Mask, each, set_vector, vector_of},
    primitive::Cost,
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

/// The tree of rays that starts with one through the picture, as far as it was walked, but for what the [`Wave`] holds.
///
/// It is walked with a stack of its own, the mirrored branch of a surface before the transmitted one, and every
/// contribution is added to one sum in that order: no depth overflows, and the sum is the same every time.
pub(super) struct Tree<'a, B: Beside> {
    pub cut: Cut<'a>,
    pub interiors: Interiors<'a>,
    /// What runs beside the ray in the wave, and what is known of it at the surface met.
    pub beside: B,
    pub met: Option<B::Met>,
    /// What lies on both sides of the surface met; none if it bounds no medium.
    pub sides: Option<Sides<'a>>,
    /// Rays after the one in the wave, the next one last.
    pub below: Vec<Pending<B>>,
}

/// Some trees that are walked side by side.
pub(super) struct Walk<'a, 'w, B: Beside, O> {
    pub snapshot: &'a Snapshot,
    pub methods: &'a Methods,
    pub trees: SmallVec<[Tree<'a, B>; 1]>,
    /// Trees that have rays below the one in the wave.
    pub waiting: Mask,
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
    let mut walk = Walk { snapshot, methods, trees, waiting: 0, wave, counts, observer };
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
        let mut rays = 0;
        for (i, Start { ray, beside, key }) in starts.enumerate() {
            let (way, weight) = (Way::Camera, Rgb::ONE);
            observer.put_forward(&Forward { way, ray: &ray, share: weight, weight, wavelength: None });
            trees.push(Tree {
                cut: Cut::of(snapshot),
                interiors: Interiors::new(&snapshot.inside),
                beside,
                met: None,
                sides: None,
                below: vec![],
            });
            wave.begin(i, &ray, key);
            rays |= 1 << i;
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

    /// Takes the next ray of a tree into the wave.
    fn take_next(&mut self, i: usize) {
        if let Some(next) = self.trees[i].below.pop() {
            self.put(i, next);
        }
        if self.trees[i].below.is_empty() {
            self.waiting &= !(1 << i);
        }
    }

    /// Puts a ray of a tree into the wave.
    pub(super) fn put(&mut self, i: usize, ray: Pending<B>) {
        let Pending { ray, beside, weight, depth, inside, wavelength, key } = ray;
        let (tree, wave) = (&mut self.trees[i], &mut *self.wave);
        tree.beside = beside;
        wave.packet.set(i, &ray);
        set_vector(&mut wave.weight, i, weight);
        (wave.depth[i], wave.inside[i], wave.wavelength[i], wave.key[i]) = (depth, inside, wavelength, key);
        wave.enclosed = wave.enclosed & !(1 << i) | Mask::from(!tree.interiors.get(inside).is_empty()) << i;
    }
}
