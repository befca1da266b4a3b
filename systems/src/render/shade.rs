//! Light at the surfaces that rays met: the local terms of the Whitted sum.

use super::{
    footprint::Beside,
    lamps::Looks,
    observe::{Added, Observer},
    trace::Walk,
    wave::{Wave, departure},
};
use crate::snapshot::{Effect, Material};
use snell_components::{
    color::Rgb,
    lanes::{self, Job, Lanes, vector},
    packet::{Mask, PACKET, Vectors, each, groups, set_vector, vector_of},
    texture::{Pattern, TexturePoint},
};

/// The light at the points where the rays of a wave met surfaces, as far as it is known.
pub(super) struct Light {
    /// Sum of the terms that need no lamp.
    pub local: Vectors,
    /// What textures show there.
    color: Vectors,
    /// What Lambert's reflection is multiplied by: its strength in the colour of the surface.
    pub tint: Vectors,
    /// What the lamps bring.
    pub looks: Looks,
}

impl Default for Light {
    fn default() -> Self {
        let none = [[0.0; PACKET]; 3];
        Self { local: none, color: none, tint: none, looks: Looks::default() }
    }
}

/// The term that is asked of lamps.
pub(super) fn asked_of_lamps(material: &Material) -> Option<&Effect> {
    material.effects.iter().rfind(|effect| matches!(effect, Effect::Diffuse(_) | Effect::Glossy { .. }))
}

impl<B: Beside, O: Observer> Walk<'_, '_, B, O> {
    /// Adds the light at the surfaces that rays met, by material.
    pub(super) fn shade(&mut self, by_material: &[(usize, Mask)]) {
        let materials = &self.snapshot.materials.all;
        let mut asking = 0;
        for &(material, rays) in by_material {
            let material = &materials[material];
            if let Some(texture) = &material.texture
                && material.effects.first().is_some_and(Effect::is_light)
            {
                self.look_up_colors(rays, &**texture);
            }
            lanes::run(Begin { wave: self.wave, rays, material, ambient: self.snapshot.lights.ambient });
            if O::WATCHES {
                each(rays).for_each(|i| self.tell_ambient(i, material));
            }
            if asked_of_lamps(material).is_some() {
                asking |= rays;
            }
        }
        if asking != 0 {
            self.ask_lamps(asking, by_material);
        }
        for &(material, rays) in by_material {
            let asks = asked_of_lamps(&materials[material]);
            lanes::run(Finish { wave: self.wave, rays, asks });
            if O::WATCHES {
                each(rays).for_each(|i| self.tell_sum(i, asks));
            }
        }
    }

    fn look_up_colors(&mut self, rays: Mask, texture: &dyn Pattern) {
        let Wave { surfaces, light, .. } = &mut *self.wave;
        if !B::RUNS || !texture.filters() {
            texture.color_packet(surfaces, rays, &mut light.color);
            return;
        }
        for i in each(rays) {
            let surface = surfaces.get(i);
            let footprint = self.trees[i].met.map_or_else(Default::default, |met| B::footprint(&met, &surface));
            let at = TexturePoint { uv: surface.uv, point: surface.point, footprint };
            set_vector(&mut light.color, i, texture.color(&at));
        }
    }

    fn color_of(&self, i: usize, material: &Material) -> Rgb {
        match material.texture {
            Some(_) => material.color * vector_of(&self.wave.light.color, i),
            None => material.color,
        }
    }

    fn tell_ambient(&mut self, i: usize, material: &Material) {
        for effect in &material.effects {
            if let Effect::Ambient(strength) = *effect {
                self.observer.term(effect, strength * self.color_of(i, material), self.snapshot.lights.ambient);
            }
        }
    }

    fn tell_sum(&mut self, i: usize, asks: Option<&Effect>) {
        let Light { local, tint, looks, .. } = &self.wave.light;
        if let Some(effect) = asks {
            let factor = if matches!(effect, Effect::Diffuse(_)) { vector_of(tint, i) } else { Rgb::ONE };
            self.observer.term(effect, factor, vector_of(&looks.lamps, i));
        }
        self.observer.added(Added::Surface, self.wave.weight_of(i), vector_of(local, i));
    }
}

/// What surfaces of one material give without lamps, and what is to be asked of them.
struct Begin<'a> {
    wave: &'a mut Wave,
    rays: Mask,
    material: &'a Material,
    ambient: Rgb,
}

impl Job for Begin<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let Self { wave, rays, material, ambient } = self;
        let Wave { surfaces, bests, light, .. } = wave;
        for (group, which) in groups(rays) {
            let mut local = vector::splat(l, Rgb::ZERO);
            let mut color = vector::splat(l, material.color);
            if material.texture.is_some() {
                color = vector::mul(l, color, vector::load(l, &light.color, group));
            }
            for effect in &material.effects {
                match *effect {
                    Effect::Ambient(strength) => {
                        let factor = vector::mul(l, vector::splat(l, strength), color);
                        local = vector::add(l, local, vector::mul(l, factor, vector::splat(l, ambient)));
                    }
                    Effect::Diffuse(strength) | Effect::Glossy { diffuse: strength, .. } => {
                        let tint = vector::mul(l, vector::splat(l, strength), color);
                        vector::store(l, tint, which, &mut light.tint, group);
                        let normal = vector::load(l, &surfaces.normal, group);
                        let start = departure(l, surfaces, &bests.limit, normal, group);
                        let start = vector::add(l, start, vector::load(l, &surfaces.lift, group));
                        vector::store(l, start, which, &mut light.looks.packet.origins, group);
                        vector::store(l, vector::splat(l, Rgb::ZERO), which, &mut light.looks.lamps, group);
                    }
                    Effect::Mirror(_) | Effect::Through(_) | Effect::Refract(_) | Effect::Split(_) => break,
                }
            }
            vector::store(l, local, which, &mut light.local, group);
        }
    }
}

/// Adds all light at surfaces of one material to the sums of the trees, once the lamps were asked.
struct Finish<'a> {
    wave: &'a mut Wave,
    rays: Mask,
    asks: Option<&'a Effect>,
}

impl Job for Finish<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let Self { wave, rays, asks } = self;
        let Wave { weight, sum, light, .. } = wave;
        for (group, which) in groups(rays) {
            let mut local = vector::load(l, &light.local, group);
            if let Some(effect) = asks {
                let mut lamps = vector::load(l, &light.looks.lamps, group);
                if let Effect::Diffuse(_) = effect {
                    lamps = vector::mul(l, vector::load(l, &light.tint, group), lamps);
                }
                local = vector::add(l, local, lamps);
                vector::store(l, local, which, &mut light.local, group);
            }
            let added = vector::mul(l, vector::load(l, weight, group), local);
            vector::store(l, vector::add(l, vector::load(l, sum, group), added), which, sum, group);
        }
    }
}
