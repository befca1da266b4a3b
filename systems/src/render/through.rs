//! Light through clear bodies on its way to surfaces.

use super::{
    Counts,
    interior::{Interiors, Sides, transmittance},
    optics,
    point::{short_of_the_light, straight_eta},
};
use crate::{
    accelerate::{Bests, Geometry},
    snapshot::{Effect, Materials},
};
use glam::DVec3;
use snell_components::{
    color::Rgb,
    method::Methods,
    packet::{Mask, PACKET, Packet, PerRay, Vectors, each, set_vector, those, vector_of},
    primitive::Cost,
    space::Ray,
    surfaces::Surfaces,
};

/// Rays toward lights with nothing opaque in the way: every transparent surface weakens the light, as do the bodies it
/// goes through. The rays go straight, even where a view ray would bend.
pub(super) struct Through {
    packet: Packet,
    /// How far each is yet to go, short of the light.
    rest: PerRay,
    /// Where the lights are, and the ways there at first.
    ends: Vectors,
    toward: Vectors,
    /// The numbers of the bodies that each goes through.
    inside: [u32; PACKET],
    bests: Bests,
    surfaces: Surfaces,
    /// The share that gets through.
    pub visible: Vectors,
}

impl Default for Through {
    fn default() -> Self {
        let none = [[0.0; PACKET]; 3];
        Self {
            packet: Packet::default(),
            rest: [0.0; PACKET],
            ends: none,
            toward: none,
            inside: [0; PACKET],
            bests: Bests::default(),
            surfaces: Surfaces::default(),
            visible: none,
        }
    }
}

impl Through {
    /// Takes a ray that has so far to go to a light at a distance, through some bodies.
    pub(super) fn begin(&mut self, i: usize, ray: &Ray, rest: f64, distance: f64, inside: u32) {
        self.packet.set(i, ray);
        (self.rest[i], self.inside[i]) = (rest, inside);
        set_vector(&mut self.ends, i, ray.at(distance));
        set_vector(&mut self.toward, i, ray.direction);
        set_vector(&mut self.visible, i, Rgb::ONE);
    }

    /// Takes some rays, which have begun, through all that is clear.
    pub(super) fn go<'a>(
        &mut self,
        rays: Mask,
        clear: &Geometry,
        materials: &'a Materials,
        methods: &Methods,
        interiors: &mut Interiors<'a>,
        counts: &mut Counts,
    ) {
        let mut cost = Cost::default();
        let mut rays = rays;
        while rays != 0 {
            let Self { packet, rest, bests, surfaces, .. } = self;
            bests.begin_within(rays, rest);
            clear.nearest_packet(packet, rays, methods, bests, &mut cost);
            let met = those(bests.found(rays), |i| bests.limit[i] < rest[i]);
            clear.surfaces(packet, (met, 0), bests, methods, surfaces);
            for i in each(rays) {
                if !self.step(i, met >> i & 1 != 0, materials, interiors) {
                    rays &= !(1 << i);
                    continue;
                }
                counts.shadow += 1;
            }
        }
        counts.add(cost);
    }

    /// Takes a ray to what it met, if anything, and beyond; tells whether it goes on.
    fn step<'a>(&mut self, i: usize, met: bool, materials: &'a Materials, interiors: &mut Interiors<'a>) -> bool {
        let mut ray = self.packet.ray(i);
        let mut visible: Rgb = vector_of(&self.visible, i);
        let length = ray.direction.length();
        let interior = interiors.get(self.inside[i]);
        let t = if met { self.bests.limit[i] } else { self.rest[i] };
        if !interior.is_empty() {
            visible *= transmittance(interior.medium(materials), t * length);
        }
        if met {
            visible *= self.passes(i, &ray, materials, interiors);
        }
        set_vector(&mut self.visible, i, visible);
        if !met {
            return false;
        }
        ray.origin = self.surfaces.get(i).departure(ray.direction, t * length);
        if self.rest[i].is_finite() {
            // Toward the same end from the new start.
            ray.direction = vector_of(&self.ends, i) - ray.origin;
            self.rest[i] = short_of_the_light(&ray, ray.direction.length(), 1.0);
            // The step away from the surface may pass the light: turning back would go on for ever.
            if ray.direction.dot(vector_of(&self.toward, i)) <= 0.0 {
                return false;
            }
        }
        self.packet.set(i, &ray);
        visible != Rgb::ZERO
    }

    /// Share of the light that the surface which a ray met lets through on a straight way; notes the bodies entered and
    /// left.
    fn passes<'a>(&mut self, i: usize, ray: &Ray, materials: &'a Materials, interiors: &mut Interiors<'a>) -> Rgb {
        let normal: DVec3 = vector_of(&self.surfaces.normal, i);
        let cosine = normal.dot(ray.direction) / ray.direction.length();
        let object = self.bests.object(i);
        let mut eta = 1.0;
        if materials.medium(object).is_some() {
            let crossing = interiors.cross(self.inside[i], object, cosine < 0.0, materials);
            let crossing = interiors.crossing(crossing);
            self.inside[i] = crossing.beyond;
            let Some(Sides { before, after }) = crossing.sides else { return Rgb::ONE };
            eta = straight_eta(before.index, after.index);
        }
        materials.at(object, self.surfaces.slot[i]).effects.iter().fold(Rgb::ZERO, |sum, effect| {
            sum + match *effect {
                Effect::Through(strength) | Effect::Refract(strength) => strength,
                Effect::Split(part) => part * (1.0 - optics::fresnel(cosine.abs(), eta)),
                Effect::Ambient(_) | Effect::Diffuse(_) | Effect::Glossy { .. } | Effect::Mirror(_) => Rgb::ZERO,
            }
        })
    }
}
