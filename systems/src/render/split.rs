//! Clear surfaces that mirror and bend: four rays at once.

use super::{
    footprint::Beside,
    interior::Sides,
    observe::Observer,
    onward::{bending_four, mirrored_four},
    optics,
    trace::{Pending, Walk},
    wave::{Wave, departure},
};
use snell_components::{
    color::Rgb,
    lanes::{self, Job, Lanes, vector},
    packet::{Mask, PACKET, PerRay, Vectors, each, four, groups, set_vector, vector_of},
    space::Ray,
};

/// What becomes of rays at clear surfaces.
pub(super) struct Split {
    /// The index where each comes from over the one where it goes.
    eta: PerRay,
    /// The share of its light that is mirrored.
    reflected: PerRay,
    /// Where the bent rays start, and their directions; the mirrored ones stand in the packet.
    origins: Vectors,
    directions: Vectors,
}

impl Default for Split {
    fn default() -> Self {
        let none = [[0.0; PACKET]; 3];
        Self { eta: [1.0; PACKET], reflected: [0.0; PACKET], origins: none, directions: none }
    }
}

impl<B: Beside, O: Observer> Walk<'_, '_, B, O> {
    /// Puts the rays forward that go on from clear surfaces where mirror and refraction share a part of the light, and
    /// nothing else goes on; tells in which trees there are any.
    pub(super) fn split(&mut self, rays: Mask, part: Rgb) -> Mask {
        let mut onward = 0;
        let mut together = rays;
        for i in each(rays) {
            let bounds = self.wave.bounding >> i & 1 != 0;
            let sides = if bounds { self.interiors.crossing(self.wave.crossing[i]).sides } else { None };
            self.wave.split.eta[i] = sides.map_or(1.0, |Sides { before, after }| before.index / after.index);
            if sides.is_some_and(|Sides { before, after }| before.spectrum.is_some() || after.spectrum.is_some()) {
                together &= !(1 << i);
            }
        }
        let bent = lanes::run(SplitFour { wave: self.wave, rays: together });
        for i in each(rays) {
            let goes_on = if together >> i & 1 == 0 {
                self.go_on_alone(i)
            } else {
                self.go_on_split(i, part, bent >> i & 1 != 0)
            };
            onward |= Mask::from(goes_on) << i;
        }
        onward
    }

    /// Puts the two rays forward of which the mirrored one stands in the wave; tells whether any is followed.
    #[inline]
    fn go_on_split(&mut self, i: usize, part: Rgb, bends: bool) -> bool {
        let wave = &*self.wave;
        let Split { reflected, origins, directions, .. } = &wave.split;
        let (weight, depth, reflected, key) = (wave.weight_of(i), wave.depth[i], reflected[i], wave.key[i]);
        let mirrored = if bends { part * reflected } else { part };
        let mirrors = mirrored != Rgb::ZERO;
        let mut behind = None;
        let through = part * (1.0 - reflected);
        if bends && through != Rgb::ZERO {
            let ray = Ray { origin: vector_of(origins, i), direction: vector_of(directions, i) };
            let (inside, wavelength, beside) = (wave.inside[i], wave.wavelength[i], self.trees[i].beside);
            let bounds = wave.bounding >> i & 1 != 0;
            let inside = if bounds { self.interiors.crossing(wave.crossing[i]).beyond } else { inside };
            let weight = weight * through;
            if self.drops(i, weight, depth).is_none() {
                self.counts.transmitted += 1;
                let key = self.child(key, u32::from(mirrors));
                behind = Some(Pending { ray, beside, weight, depth: depth + 1, inside, wavelength, key });
            }
        }
        let weight = weight * mirrored;
        if mirrors && self.drops(i, weight, depth).is_none() {
            self.counts.mirror += 1;
            set_vector(&mut self.wave.weight, i, weight);
            self.wave.depth[i] = depth + 1;
            self.wave.key[i] = self.child(key, 0);
            if let Some(behind) = behind {
                self.put_off(i, behind);
            }
            return true;
        }
        let Some(behind) = behind else { return false };
        self.put(i, behind);
        true
    }
}

/// Mirrors and bends rays of a wave at clear surfaces; tells which are bent.
struct SplitFour<'a> {
    wave: &'a mut Wave,
    rays: Mask,
}

impl Job for SplitFour<'_> {
    type Output = Mask;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Mask {
        let Self { wave, rays } = self;
        let Wave { packet, surfaces, bests, split, .. } = wave;
        let (zero, one) = (l.d_splat(0.0), l.d_splat(1.0));
        let mut all = 0;
        for (group, which) in groups(rays) {
            let direction = vector::load(l, &packet.directions, group);
            let normal = vector::load(l, &surfaces.normal, group);
            let shading = vector::load(l, &surfaces.shading_normal, group);
            let eta = l.d_load(four(&split.eta, group));
            let bending = bending_four(l, direction, normal, shading);
            let reflected = optics::fresnel_four(l, vector::minus(l, vector::dot(l, direction, bending)), eta);

            let mirrored = mirrored_four(l, direction, normal, bending);
            let (mut bends, mut bent) = optics::refract_four(l, direction, bending, eta);
            let below = l.d_lt(vector::dot(l, bent, normal), zero);
            let wrong = bends & which & !below;
            if wrong != 0 {
                let (bends_there, bent_there) = optics::refract_four(l, direction, normal, eta);
                bends = bends & !wrong | bends_there & wrong;
                bent = vector::select(l, wrong, bent_there, bent);
            }
            bends &= l.d_lt(reflected, one) & which;
            all |= Mask::from(bends) << (4 * group);

            let origin = departure(l, surfaces, &bests.limit, mirrored, group);
            let behind = departure(l, surfaces, &bests.limit, bent, group);
            l.d_store_some(reflected, which, &mut split.reflected.as_chunks_mut().0[group]);
            vector::store(l, behind, bends, &mut split.origins, group);
            vector::store(l, bent, bends, &mut split.directions, group);
            vector::store(l, origin, which, &mut packet.origins, group);
            vector::store(l, mirrored, which, &mut packet.directions, group);
        }
        all
    }
}
