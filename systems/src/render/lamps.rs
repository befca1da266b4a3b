//! What lamps bring to the points where rays met surfaces, and shadows.

use super::{
    footprint::Beside,
    observe::{Look, Observer},
    optics,
    shade::asked_of_lamps,
    trace::Walk,
    wave::Wave,
};
use crate::snapshot::{Effect, Lights, Snapshot};
use glam::{DVec2, DVec3};
use snell_components::{
    color::Rgb,
    lanes::{self, Job, Lanes, vector},
    light::{Lamp, PointLight},
    math,
    packet::{Mask, PACKET, Packet, PerRay, Vectors, each, four, groups, set_vector, vector_of},
    primitive::{Cost, OFFSET_ULPS},
};

/// Looks from points of surfaces to a lamp.
pub(super) struct Looks {
    /// From where rays to lights start to the lamp: the directions of any length.
    pub packet: Packet,
    /// Where the lamp stands on each way.
    distance: PerRay,
    /// Where each way ends: before the rounding error of a surface that the lamp stands on, which must not hide it.
    end: PerRay,
    /// Unit, toward the lamp.
    toward: Vectors,
    /// Of the angle to the shading normal.
    cosine: PerRay,
    /// What shines, where it is not the same for all.
    intensity: Vectors,
    /// The share that gets through what is clear, where that is told.
    visible: Vectors,
    /// Sum over the lamps asked so far.
    pub lamps: Vectors,
}

impl Default for Looks {
    fn default() -> Self {
        let (none, number) = ([[0.0; PACKET]; 3], [0.0; PACKET]);
        Self {
            packet: Packet::default(),
            distance: number,
            end: number,
            toward: none,
            cosine: number,
            intensity: none,
            visible: none,
            lamps: none,
        }
    }
}

/// What came of looks to a lamp.
#[derive(Clone, Copy)]
struct Lit {
    /// The points that the lamp lights.
    lit: Mask,
    /// Those whose surfaces face it, lit or not.
    facing: Mask,
    /// The intensity, where it is the same for all.
    intensity: Option<Rgb>,
    /// Those to which not all gets through.
    dimmed: Mask,
}

impl<B: Beside, O: Observer> Walk<'_, '_, B, O> {
    /// Asks all lamps for the light at some points; each adds them up in their order.
    pub(super) fn ask_lamps(&mut self, asking: Mask, by_material: &[(usize, Mask)]) {
        let Lights { lamps, points, sampling, .. } = &*self.snapshot.lights;
        for (((lamp, plain), sampling), number) in lamps.iter().zip(points).zip(sampling).zip(0..) {
            if let Some(sampling) = *sampling {
                each(asking).for_each(|i| self.sample(i, number, &**lamp, sampling));
                continue;
            }
            let seen = self.look(&**lamp, plain.as_ref(), asking);
            for &(material, rays) in by_material {
                let lit = seen.lit & rays;
                if lit != 0
                    && let Some(asks) = asked_of_lamps(&self.snapshot.materials.all[material])
                {
                    lanes::run(Term { wave: self.wave, rays: lit, asks, seen });
                }
            }
            if O::WATCHES {
                each(asking).for_each(|i| self.tell_look(i, number, &**lamp, seen));
            }
        }
    }

    /// Looks from some points to a lamp without area.
    fn look(&mut self, lamp: &dyn Lamp, plain: Option<&PointLight>, asking: Mask) -> Lit {
        let Snapshot { geometry, parted, settings, .. } = self.snapshot;
        let mut shining = asking;
        let mut casting = Mask::MAX;
        if let Some(plain) = plain {
            casting = if plain.shadows { casting } else { 0 };
        } else {
            for i in each(asking) {
                let Looks { packet, distance, intensity, .. } = &mut self.wave.light.looks;
                match lamp.illuminate(vector_of(&packet.origins, i), DVec2::ZERO) {
                    Some(light) => {
                        set_vector(&mut packet.directions, i, light.to_light);
                        set_vector(intensity, i, light.intensity);
                        distance[i] = light.distance;
                        casting &= !(Mask::from(!light.shadows) << i);
                    }
                    None => shining &= !(1 << i),
                }
            }
        }
        let position = plain.map(|plain| plain.position);
        let facing = lanes::run(Facing { wave: self.wave, rays: shining, position });
        let mut seen = Lit { lit: facing, facing, intensity: plain.map(|plain| plain.intensity), dimmed: 0 };
        let casting = if settings.shadows { casting & facing } else { 0 };
        if casting == 0 {
            return seen;
        }
        let mut cost = Cost::default();
        let Looks { packet, end, .. } = &mut self.wave.light.looks;
        packet.check(casting);
        self.counts.shadow += u64::from(casting.count_ones());
        let opaque = parted.as_ref().map_or(&**geometry, |parted| &parted.opaque);
        seen.lit &= !opaque.blocked_packet(packet, casting, end, self.methods, &mut cost);
        if let Some(parted) = parted {
            let rest = casting & seen.lit;
            seen.dimmed = parted.clear.blocked_packet(packet, rest, end, self.methods, &mut cost);
            seen.dimmed |= rest & self.wave.enclosed;
        }
        self.counts.add(cost);
        if seen.dimmed != 0 {
            self.see_through(&mut seen, position.is_some());
        }
        seen
    }

    /// What gets through clear bodies, where any stand in the way.
    fn see_through(&mut self, seen: &mut Lit, is_point: bool) {
        let Snapshot { parted: Some(parted), materials, .. } = self.snapshot else { return };
        let Wave { light, through, inside, .. } = &mut *self.wave;
        let Looks { packet, end, distance, visible, .. } = &mut light.looks;
        let dimmed = seen.lit & seen.dimmed;
        for i in each(dimmed) {
            let distance = if is_point { 1.0 } else { distance[i] };
            through.begin(i, &packet.ray(i), end[i], distance, inside[i]);
        }
        through.go(dimmed, &parted.clear, materials, self.methods, &mut self.interiors, self.counts);
        for i in each(seen.lit) {
            let left = if dimmed >> i & 1 != 0 { vector_of(&through.visible, i) } else { Rgb::ONE };
            set_vector(visible, i, left);
            seen.lit &= !(Mask::from(left == Rgb::ZERO) << i);
        }
    }

    fn tell_look(&mut self, i: usize, number: u32, lamp: &dyn Lamp, seen: Lit) {
        let point = self.wave.point(i, self.snapshot);
        let Looks { packet, visible, .. } = &self.wave.light.looks;
        let from = vector_of(&packet.origins, i);
        let light = lamp.illuminate(from, DVec2::ZERO);
        let within = |mask: Mask| mask >> i & 1 != 0;
        let visible = match () {
            () if !within(seen.lit) => Rgb::ZERO,
            () if seen.dimmed == 0 => Rgb::ONE,
            () => vector_of(visible, i),
        };
        let look = Look { lamp: number, from, light: light.as_ref(), visible: within(seen.facing).then_some(visible) };
        self.observer.looked(&look);
        let arriving = light.and_then(|light| point.facing(&light)).filter(|_| within(seen.lit));
        let brought = match (arriving, self.asks(i)) {
            (Some(mut arriving), Some(asks)) => {
                arriving.weaken(visible);
                point.term(&asks, &arriving)
            }
            _ => Rgb::ZERO,
        };
        self.observer.lamp(number, brought);
    }

    /// The term that the surface asks of lamps, in its colour unless that is multiplied later.
    pub(super) fn asks(&self, i: usize) -> Option<Effect> {
        let material = &self.snapshot.materials.all[self.wave.material[i] as usize];
        asked_of_lamps(material).map(|asks| match *asks {
            Effect::Glossy { highlight, exponent, .. } => {
                Effect::Glossy { diffuse: vector_of(&self.wave.light.tint, i), highlight, exponent }
            }
            asks => asks,
        })
    }
}

/// Which of some points face a lamp without area, and the way to it; `position` is that of a point light, for others
/// directions and distances are there.
struct Facing<'a> {
    wave: &'a mut Wave,
    rays: Mask,
    position: Option<DVec3>,
}

impl Job for Facing<'_> {
    type Output = Mask;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Mask {
        let Self { wave, rays, position } = self;
        let Wave { surfaces, light, .. } = wave;
        let looks = &mut light.looks;
        let mut all = 0;
        for (group, which) in groups(rays) {
            let start = vector::load(l, &looks.packet.origins, group);
            let (to_lamp, distance) = match position {
                Some(position) => (vector::sub(l, vector::splat(l, position), start), l.d_splat(1.0)),
                None => {
                    let directions = vector::load(l, &looks.packet.directions, group);
                    (directions, l.d_load(four(&looks.distance, group)))
                }
            };
            let length = l.d_sqrt(vector::dot(l, to_lamp, to_lamp));
            let toward = vector::times(l, to_lamp, l.d_div(l.d_splat(1.0), length));
            let cosine = vector::dot(l, vector::load(l, &surfaces.shading_normal, group), toward);
            let facing = l.d_lt(l.d_splat(0.0), cosine) & which;
            if facing == 0 {
                continue;
            }
            all |= Mask::from(facing) << (4 * group);
            let reach = l.d_add(vector::reach(l, start), l.d_mul(length, distance));
            let rounding = l.d_mul(l.d_splat(OFFSET_ULPS * f64::EPSILON), reach);
            let end = l.d_sub(distance, l.d_div(rounding, length));
            // What stands infinitely far away has no rounding.
            let end = l.d_if_lt(distance, l.d_splat(f64::INFINITY), end, distance);
            vector::store(l, toward, facing, &mut looks.toward, group);
            l.d_store_some(cosine, facing, &mut looks.cosine.as_chunks_mut().0[group]);
            l.d_store_some(end, facing, &mut looks.end.as_chunks_mut().0[group]);
            if position.is_some() {
                vector::store(l, to_lamp, facing, &mut looks.packet.directions, group);
            }
        }
        all
    }
}

/// Adds the term of a lamp at some points that it lights, all of one material.
struct Term<'a> {
    wave: &'a mut Wave,
    rays: Mask,
    asks: &'a Effect,
    seen: Lit,
}

impl Job for Term<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let Self { wave, rays, asks, seen } = self;
        let Wave { packet, surfaces, light, .. } = wave;
        for (group, which) in groups(rays) {
            let looks = &mut light.looks;
            let mut intensity = match seen.intensity {
                Some(intensity) => vector::splat(l, intensity),
                None => vector::load(l, &looks.intensity, group),
            };
            if seen.dimmed != 0 {
                intensity = vector::mul(l, intensity, vector::load(l, &looks.visible, group));
            }
            let cosine = l.d_load(four(&looks.cosine, group));
            let term = match *asks {
                Effect::Glossy { highlight, exponent, .. } => {
                    let normal = vector::load(l, &surfaces.shading_normal, group);
                    let toward = vector::load(l, &looks.toward, group);
                    let mirrored = optics::reflect_four(l, vector::neg(l, toward), normal);
                    let aligned = vector::dot(l, mirrored, vector::load(l, &packet.directions, group));
                    // Where the mirrored light points away from the viewer there is no highlight, whatever the exponent.
                    let mut shine = [0.0; 4];
                    l.d_store(vector::minus(l, aligned), &mut shine);
                    for (lane, shine) in shine.iter_mut().enumerate() {
                        *shine = if which >> lane & 1 != 0 && *shine > 0.0 { math::pow(*shine, exponent) } else { 0.0 };
                    }
                    let diffuse = vector::times(l, vector::load(l, &light.tint, group), cosine);
                    let highlight = vector::times(l, vector::splat(l, highlight), l.d_load(&shine));
                    vector::mul(l, vector::add(l, diffuse, highlight), intensity)
                }
                _ => vector::times(l, intensity, cosine),
            };
            let sum = vector::add(l, vector::load(l, &looks.lamps, group), term);
            vector::store(l, sum, which, &mut looks.lamps, group);
        }
    }
}
