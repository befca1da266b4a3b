//! The rays of some trees at one step of their walk, as a structure of arrays.

use super::{Key, area::Parts, point::Point, shade::Light, split::Split, through::Through};
use crate::{accelerate::Bests, snapshot::Snapshot};
use smallvec::SmallVec;
use snell_components::{
    color::Rgb,
    lanes::{self, Job, Lanes, vector},
    packet::{Mask, PACKET, Packet, PerRay, Vectors, four, groups, set_vector, those, vector_of},
    primitive::OFFSET_ULPS,
    surfaces::Surfaces,
};

/// One ray at most of each tree, at the tree's number; and the sums of the trees.
///
/// Arithmetic is done for four rays at once, each operation as it would be for one ray.
pub(super) struct Wave {
    pub packet: Packet,
    /// What they met.
    pub bests: Bests,
    /// The surfaces there; the normals toward where the rays come from.
    pub surfaces: Surfaces,
    /// What the light of each is multiplied by in the pixel.
    pub weight: Vectors,
    /// How many surfaces lie between each and the camera.
    pub depth: [u32; PACKET],
    /// The number of the clear bodies that each goes through.
    pub inside: [u32; PACKET],
    /// Those that go through any.
    pub enclosed: Mask,
    /// In nanometres; none for white light.
    pub wavelength: [Option<f64>; PACKET],
    pub key: [Key; PACKET],
    /// The materials of what they met, by number.
    pub material: [u32; PACKET],
    /// Those that met a surface from outside.
    pub entering: Mask,
    /// Those whose surface bounds a medium.
    pub bounding: Mask,
    /// The numbers of how those cross it.
    pub crossing: [u32; PACKET],
    /// The light of each tree, as far as it is known.
    pub sum: Vectors,
    /// The object that the first ray of each tree met.
    pub first: [Option<u32>; PACKET],
    /// The light at the surfaces.
    pub light: Light,
    /// Looks from one point to parts of a lamp.
    pub parts: Parts,
    /// Rays toward a light through what is clear.
    pub through: Through,
    /// What becomes of rays at clear surfaces.
    pub split: Split,
}

impl Default for Wave {
    fn default() -> Self {
        let none = [[0.0; PACKET]; 3];
        Self {
            packet: Packet::default(),
            bests: Bests::default(),
            surfaces: Surfaces::default(),
            weight: none,
            depth: [0; PACKET],
            inside: [0; PACKET],
            enclosed: 0,
            wavelength: [None; PACKET],
            key: [Key::of_pixel(0, 0, 0); PACKET],
            material: [0; PACKET],
            entering: 0,
            bounding: 0,
            crossing: [0; PACKET],
            sum: none,
            first: [None; PACKET],
            light: Light::default(),
            parts: Parts::default(),
            through: Through::default(),
            split: Split::default(),
        }
    }
}

impl Wave {
    /// Begins a tree, but for the ray.
    pub(super) fn begin(&mut self, i: usize, key: Key) {
        set_vector(&mut self.weight, i, Rgb::ONE);
        set_vector(&mut self.sum, i, Rgb::ZERO);
        (self.depth[i], self.inside[i], self.wavelength[i], self.key[i], self.first[i]) = (0, 0, None, key, None);
    }

    pub(super) fn weight_of(&self, i: usize) -> Rgb {
        vector_of(&self.weight, i)
    }

    /// Adds light to the sum of a tree.
    pub(super) fn add(&mut self, i: usize, light: Rgb) {
        let sum = vector_of(&self.sum, i) + light;
        set_vector(&mut self.sum, i, sum);
    }

    /// Where a ray met a surface, for what is worked out for it alone.
    pub(super) fn point<'a>(&self, i: usize, snapshot: &'a Snapshot) -> Point<'a> {
        Point {
            snapshot,
            direction: vector_of(&self.packet.directions, i),
            travelled: self.bests.limit[i],
            surface: self.surfaces.get(i),
            material: &snapshot.materials.all[self.material[i] as usize],
            entering: self.entering >> i & 1 != 0,
            key: self.key[i],
        }
    }

    /// The materials that some rays met, and which of them met each.
    pub(super) fn by_material(&self, rays: Mask) -> SmallVec<[(usize, Mask); 4]> {
        let mut groups = SmallVec::new();
        let mut rest = rays;
        while rest != 0 {
            let material = self.material[rest.trailing_zeros() as usize];
            let of = those(rest, |i| self.material[i] == material);
            groups.push((material as usize, of));
            rest &= !of;
        }
        groups
    }

    /// Adds the same light, times the weight of each, for some rays.
    pub(super) fn add_to_all(&mut self, rays: Mask, light: Rgb) {
        lanes::run(AddToAll { wave: self, rays, light });
    }

    /// Turns the normals of the surfaces toward where the rays come from.
    pub(super) fn turn(&mut self, rays: Mask) {
        self.entering = lanes::run(Turn { wave: self, rays });
    }
}

/// See [`Wave::add_to_all`].
struct AddToAll<'a> {
    wave: &'a mut Wave,
    rays: Mask,
    light: Rgb,
}

impl Job for AddToAll<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let Self { wave, rays, light } = self;
        let light = vector::splat(l, light);
        for (group, which) in groups(rays) {
            let light = vector::mul(l, vector::load(l, &wave.weight, group), light);
            let sum = vector::add(l, vector::load(l, &wave.sum, group), light);
            vector::store(l, sum, which, &mut wave.sum, group);
        }
    }
}

/// See [`Wave::turn`]; tells which rays come from outside.
struct Turn<'a> {
    wave: &'a mut Wave,
    rays: Mask,
}

impl Job for Turn<'_> {
    type Output = Mask;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Mask {
        let Self { wave, rays } = self;
        let Wave { packet, surfaces, .. } = wave;
        let mut entering = 0;
        for (group, which) in groups(rays) {
            let normal = vector::load(l, &surfaces.normal, group);
            let cosine = vector::dot(l, normal, vector::load(l, &packet.directions, group));
            let inward = l.d_lt(cosine, l.d_splat(0.0));
            entering |= Mask::from(inward & which) << (4 * group);
            let away = which & !inward;
            if away != 0 {
                let shading = vector::load(l, &surfaces.shading_normal, group);
                vector::store(l, vector::neg(l, normal), away, &mut surfaces.normal, group);
                vector::store(l, vector::neg(l, shading), away, &mut surfaces.shading_normal, group);
            }
        }
        entering
    }
}

/// [`snell_components::primitive::Surface::departure`] of four rays.
#[inline(always)]
pub(super) fn departure<L: Lanes>(
    l: L,
    surfaces: &Surfaces,
    travelled: &PerRay,
    direction: vector::Four<L>,
    group: usize,
) -> vector::Four<L> {
    let (point, normal) = (vector::load(l, &surfaces.point, group), vector::load(l, &surfaces.normal, group));
    let reach = l.d_add(vector::reach(l, point), l.d_load(four(travelled, group)));
    let rounding = l.d_mul(l.d_splat(OFFSET_ULPS * f64::EPSILON), reach);
    let step = l.d_add(l.d_load(four(&surfaces.error, group)), rounding);
    let below = vector::dot(l, normal, direction);
    let step = l.d_if_lt(below, l.d_splat(0.0), vector::minus(l, step), step);
    vector::add(l, point, vector::times(l, normal, step))
}
