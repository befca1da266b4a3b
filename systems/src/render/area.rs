//! Lamps with an area: the mean over many looks to parts of them.

use super::{
    Key,
    budget::lamp_error,
    footprint::Beside,
    observe::{Look, Observer},
    point::{Arriving, Point, short_of_the_light},
    trace::Walk,
};
use crate::snapshot::{Effect, Snapshot};
use core::ops::Range;
use snell_components::{
    color::Rgb,
    light::{Lamp, Sampling},
    packet::{Mask, PACKET, Packet, PerRay, each, set_vector, vector_of},
    primitive::Cost,
    space::Ray,
};

impl<B: Beside, O: Observer> Walk<'_, '_, B, O> {
    /// Adds the light of a lamp with an area, by its number, at a point.
    pub(super) fn sample(&mut self, i: usize, number: u32, lamp: &dyn Lamp, sampling: Sampling) {
        let Some(asks) = self.asks(i) else { return };
        let point = self.wave.point(i, self.snapshot);
        let mut weight = self.wave.weight_of(i);
        if matches!(asks, Effect::Diffuse(_)) {
            weight *= vector_of(&self.wave.light.tint, i);
        }
        let error = lamp_error(self.snapshot, weight).unwrap_or(sampling.error);
        let key = point.key.child(number);
        let block = |samples: Range<u32>| self.look_at_parts(i, &point, number, lamp, (key, samples), &asks);
        let (mean, reached) = mean_over(Sampling { error, ..sampling }, block);
        self.counts.undersampled += u64::from(!reached);
        let lamps = &mut self.wave.light.looks.lamps;
        set_vector(lamps, i, vector_of(lamps, i) + mean);
        self.observer.lamp(number, mean);
    }

    /// Looks from a point to some parts of a lamp, together; gives what each brings, where it brings anything.
    fn look_at_parts(
        &mut self,
        i: usize,
        point: &Point<'_>,
        number: u32,
        lamp: &dyn Lamp,
        (key, samples): (Key, Range<u32>),
        asks: &Effect,
    ) -> [Option<Rgb>; BLOCK as usize] {
        let Snapshot { geometry, parted, settings, .. } = self.snapshot;
        let start = vector_of(&self.wave.light.looks.packet.origins, i);
        let Parts { packet, end } = &mut self.wave.parts;
        let mut lights = [None; BLOCK as usize];
        let mut arriving = [const { None }; BLOCK as usize];
        let mut casting: Mask = 0;
        for (n, sample) in samples.clone().enumerate() {
            let Some(light) = lamp.illuminate(start, key.sample(sample)) else { continue };
            lights[n] = Some(light);
            arriving[n] = point.facing(&light);
            if let Some(Arriving { length, .. }) = arriving[n]
                && light.shadows
                && settings.shadows
            {
                let ray = Ray { origin: start, direction: light.to_light };
                packet.set(n, &ray);
                end[n] = short_of_the_light(&ray, length, light.distance);
                casting |= 1 << n;
            }
        }
        let mut cost = Cost::default();
        self.counts.shadow += u64::from(casting.count_ones());
        let opaque = parted.as_ref().map_or(&**geometry, |parted| &parted.opaque);
        let blocked = opaque.blocked_packet(packet, casting, end, self.methods, &mut cost);
        each(blocked).for_each(|n| arriving[n].iter_mut().for_each(|arriving| arriving.weaken(Rgb::ZERO)));
        if let Some(parted) = parted {
            let rest = casting & !blocked;
            let mut dimmed = parted.clear.blocked_packet(packet, rest, end, self.methods, &mut cost);
            if self.wave.enclosed >> i & 1 != 0 {
                dimmed = rest;
            }
            let (through, inside) = (&mut self.wave.through, self.wave.inside[i]);
            for n in each(dimmed) {
                let distance = lights[n].map_or(f64::INFINITY, |light| light.distance);
                through.begin(n, &packet.ray(n), end[n], distance, inside);
            }
            let (clear, materials) = (&parted.clear, &self.snapshot.materials);
            through.go(dimmed, clear, materials, self.methods, &mut self.interiors, self.counts);
            for n in each(dimmed) {
                let visible = vector_of(&through.visible, n);
                arriving[n].iter_mut().for_each(|arriving| arriving.weaken(visible));
            }
        }
        self.counts.add(cost);
        let mut brought = [None; BLOCK as usize];
        for n in 0..samples.len() {
            if O::WATCHES {
                let visible = arriving[n].as_ref().map(|arriving| arriving.visible);
                self.observer.looked(&Look { lamp: number, from: start, light: lights[n].as_ref(), visible });
            }
            let arriving = arriving[n].as_ref().filter(|arriving| arriving.visible != Rgb::ZERO);
            brought[n] = arriving.map(|arriving| point.term(asks, arriving));
        }
        brought
    }
}

/// Rays from one point to parts of a lamp.
pub(super) struct Parts {
    packet: Packet,
    /// Where each ends: see [`short_of_the_light`].
    end: PerRay,
}

impl Default for Parts {
    fn default() -> Self {
        Self { packet: Packet::default(), end: [0.0; PACKET] }
    }
}

/// Samples in a block; a block is the least that is taken.
const BLOCK: u32 = 16;

/// Mean of a term over a lamp with an area.
///
/// Blocks of samples are taken until the standard error of their mean, from the spread of the blocks' means, is below
/// the error asked for, or there may be no more; told with the mean is whether the error was reached. If the first block
/// is all dark, the lamp is taken to be hidden: what shows less than a sixteenth of it may be missed.
fn mean_over(sampling: Sampling, mut brought: impl FnMut(Range<u32>) -> [Option<Rgb>; BLOCK as usize]) -> (Rgb, bool) {
    let (mut sum, mut squares) = (Rgb::ZERO, Rgb::ZERO);
    let mut blocks = 0;
    let (mut dark, mut reached) = (true, false);
    while blocks * BLOCK < sampling.most {
        let len = BLOCK.min(sampling.most - blocks * BLOCK);
        let mut block = Rgb::ZERO;
        for light in brought(blocks * BLOCK..blocks * BLOCK + len).into_iter().flatten() {
            block += light;
            dark = false;
        }
        let mean = block / f64::from(len);
        sum += mean;
        squares += mean * mean;
        blocks += 1;
        let n = f64::from(blocks);
        // Of the mean of n blocks; squared on both sides.
        let variance = ((squares - sum * sum / n) / (n * (n - 1.0))).max_element();
        reached = dark || blocks >= 3 && variance <= sampling.error * sampling.error;
        if reached {
            break;
        }
    }
    (sum / f64::from(blocks), reached)
}
