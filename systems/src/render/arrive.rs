//! Where rays arrive: the surfaces they meet, and what lies on both sides of them.

use super::{
    footprint::Beside,
    interior::{Crossing, transmittance},
    observe::{Added, Forward, Observer, Traced, Way},
    trace::Walk,
};
use crate::{
    accelerate::Intersection,
    snapshot::{MaterialOfObject, Snapshot},
};
use snell_components::{
    color::Rgb,
    packet::{Mask, each, set_vector},
    space::Ray,
};

/// What becomes of rays that were searched for.
pub(super) struct Met {
    /// Those that met a surface.
    pub shaded: Mask,
    /// Those that go on as if there were none.
    pub onward: Mask,
}

impl<B: Beside, O: Observer> Walk<'_, '_, B, O> {
    /// Takes rays to what they meet.
    pub(super) fn arrive(&mut self, rays: Mask) -> Met {
        let Snapshot { settings, geometry, materials, .. } = self.snapshot;
        let found = self.wave.bests.found(rays);
        each(rays & self.wave.enclosed).for_each(|i| self.absorb(i));
        if O::WATCHES {
            each(rays).for_each(|i| self.tell_traced(i));
        }
        self.wave.add_to_all(rays & !found, settings.background);
        if O::WATCHES {
            let added = Added::Background;
            each(rays & !found).for_each(|i| self.observer.added(added, self.wave.weight_of(i), settings.background));
        }

        let (mut textured, mut slotted) = (0, 0);
        for i in each(found) {
            match &materials.of_object[self.wave.bests.object(i) as usize] {
                MaterialOfObject::Whole(number) => {
                    self.wave.material[i] = *number;
                    textured |= Mask::from(materials.all[*number as usize].texture.is_some()) << i;
                }
                MaterialOfObject::Slots(_) => slotted |= 1 << i,
            }
        }
        let wave = &mut *self.wave;
        let asked = (found, textured | slotted);
        geometry.surfaces(&wave.packet, asked, &wave.bests, self.methods, &mut wave.surfaces);
        for i in each(slotted) {
            wave.material[i] = materials.number_at(wave.bests.object(i), wave.surfaces.slot[i]) as u32;
        }
        wave.turn(found);

        let mut met = Met { shaded: found, onward: 0 };
        wave.bounding = 0;
        if !materials.media.is_empty() {
            for i in each(found) {
                if !self.is_there(i) {
                    met.shaded &= !(1 << i);
                    met.onward |= 1 << i;
                }
            }
        }
        for i in each(met.shaded) {
            if self.wave.depth[i] == 0 {
                self.wave.first[i] = Some(self.wave.bests.object(i));
            }
            if B::RUNS {
                let point = self.wave.point(i, self.snapshot);
                let nearest = self.wave.bests.nearest(i);
                self.trees[i].met = nearest.map(|nearest| self.trees[i].beside.meet(&point, &nearest));
            }
        }
        met
    }

    /// Takes from the weight of a ray what the bodies on its way swallow.
    fn absorb(&mut self, i: usize) {
        let interior = self.interiors.get(self.wave.inside[i]);
        let travelled = self.wave.bests.nearest(i).map_or(f64::INFINITY, |met| met.hit.t);
        let left = transmittance(interior.medium(&self.snapshot.materials), travelled);
        let weight = self.wave.weight_of(i) * left;
        set_vector(&mut self.wave.weight, i, weight);
    }

    fn tell_traced(&mut self, i: usize) {
        let ray = self.wave.packet.ray(i);
        let surface = |met| Intersection::new(met, self.snapshot.geometry.surface(met, &ray, self.methods));
        let met = self.wave.bests.nearest(i).as_ref().map(surface);
        self.observer.traced(&Traced { met: met.as_ref(), weight: self.wave.weight_of(i) });
    }

    /// Whether the surface that a ray met is there: it is not if it lies inside a body that counts before its own. The
    /// ray then goes on behind it.
    fn is_there(&mut self, i: usize) -> bool {
        let (materials, wave) = (&self.snapshot.materials, &mut *self.wave);
        let object = wave.bests.object(i);
        if materials.medium(object).is_none() {
            return true;
        }
        let crossing = self.interiors.cross(wave.inside[i], object, wave.entering >> i & 1 != 0, materials);
        wave.bounding |= 1 << i;
        wave.crossing[i] = crossing;
        let Crossing { sides, beyond, encloses, .. } = *self.interiors.crossing(crossing);
        if sides.is_some() {
            return true;
        }
        wave.inside[i] = beyond;
        wave.enclosed = wave.enclosed & !(1 << i) | Mask::from(encloses) << i;
        let Ray { direction, .. } = wave.packet.ray(i);
        let ray = Ray { origin: wave.surfaces.get(i).departure(direction, wave.bests.limit[i]), direction };
        wave.packet.set(i, &ray);
        let (way, share, weight, wavelength) = (Way::Onward, Rgb::ONE, wave.weight_of(i), wave.wavelength[i]);
        self.observer.put_forward(&Forward { way, ray: &ray, share, weight, wavelength });
        false
    }
}
