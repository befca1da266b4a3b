//! Lamps with an area: the mean over many looks to parts of them.

use super::{
    Key,
    budget::lamp_error,
    footprint::Beside,
    observe::{Look, Observer},
    trace::Walk,
};
use crate::snapshot::Effect;
use glam::DVec2;
use snell_components::{
    color::Rgb,
    light::{Lamp, Sampling},
    packet::{set_vector, vector_of},
    space::Ray,
};

impl<B: Beside, O: Observer> Walk<'_, '_, B, O> {
    /// Adds the light of a lamp with an area, by its number, at a point.
    pub(super) fn sample(&mut self, i: usize, number: u32, lamp: &dyn Lamp, sampling: Sampling) {
        let Some(asks) = self.asks(i) else { return };
        let point = self.wave.point(i, self.snapshot, self.methods);
        let light = &self.wave.light;
        let start = vector_of(&light.looks.packet.origins, i);
        let mut weight = self.wave.weight_of(i);
        if matches!(asks, Effect::Diffuse(_)) {
            weight *= vector_of(&light.tint, i);
        }
        let interior = self.interiors.get(self.wave.inside[i]);
        let error = lamp_error(self.snapshot, weight).unwrap_or(sampling.error);
        let one = |sample| {
            let light = lamp.illuminate(start, sample);
            let arriving = light.as_ref().and_then(|light| {
                let mut arriving = point.facing(light)?;
                if light.shadows && self.snapshot.settings.shadows {
                    let ray = Ray { origin: start, direction: light.to_light };
                    let visible = point.visibility(ray, arriving.length, light.distance, interior, self.counts);
                    arriving.weaken(visible);
                }
                Some(arriving)
            });
            if O::WATCHES {
                let visible = arriving.as_ref().map(|arriving| arriving.visible);
                self.observer.looked(&Look { lamp: number, from: start, light: light.as_ref(), visible });
            }
            arriving.filter(|arriving| arriving.visible != Rgb::ZERO).map(|arriving| point.term(&asks, &arriving))
        };
        let (mean, reached) = mean_over(Sampling { error, ..sampling }, point.key.child(number), one);
        self.counts.undersampled += u64::from(!reached);
        let lamps = &mut self.wave.light.looks.lamps;
        set_vector(lamps, i, vector_of(lamps, i) + mean);
        self.observer.lamp(number, mean);
    }
}

/// Samples in a block; a block is the least that is taken.
const BLOCK: u32 = 16;

/// Mean of a term over a lamp with an area.
///
/// Blocks of samples are taken until the standard error of their mean, from the spread of the blocks' means, is below
/// the error asked for, or there may be no more; told with the mean is whether the error was reached. If the first block
/// is all dark, the lamp is taken to be hidden: what shows less than a sixteenth of it may be missed.
fn mean_over(sampling: Sampling, key: Key, mut one: impl FnMut(DVec2) -> Option<Rgb>) -> (Rgb, bool) {
    let (mut sum, mut squares) = (Rgb::ZERO, Rgb::ZERO);
    let mut blocks = 0;
    let (mut dark, mut reached) = (true, false);
    while blocks * BLOCK < sampling.most {
        let len = BLOCK.min(sampling.most - blocks * BLOCK);
        let mut block = Rgb::ZERO;
        for n in 0..len {
            if let Some(light) = one(key.sample(blocks * BLOCK + n)) {
                block += light;
                dark = false;
            }
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
