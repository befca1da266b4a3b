//! Writes down what a render tells of a pixel.

use super::tree::{Contribution, DroppedRay, LampLight, Met, Sample, Share, Start, Term, Thing, TracedRay};
use crate::{
    render::{Added, Dropped, Forward, Look, Observer, Traced, Way},
    snapshot::{Effect, Snapshot},
};
use core::mem;
use snell_components::{color::Rgb, light::Illumination, method::Methods, primitive::Cost, space::Ray};

/// Most things told to stand before a light.
const MOST_IN_THE_WAY: usize = 8;

pub(super) struct Recorder<'a> {
    snapshot: &'a Snapshot,
    samples: Vec<Sample>,
    shares: Vec<Share>,
    /// Rays put forward and not traced yet.
    waiting: Vec<Start>,
    /// Of the lamp being looked at.
    looks: Looks,
    /// Of the term being added up.
    lamps: Vec<LampLight>,
}

#[derive(Default)]
struct Looks {
    count: u32,
    unlit: u32,
    facing_away: u32,
    hidden: u32,
    visible: Rgb,
    in_the_way: Vec<Thing>,
}

impl<'a> Recorder<'a> {
    pub(super) fn new(snapshot: &'a Snapshot) -> Self {
        Self { snapshot, samples: vec![], shares: vec![], waiting: vec![], looks: Looks::default(), lamps: vec![] }
    }

    /// The samples with their sums, and how they are added.
    pub(super) fn finish(mut self) -> (Vec<Sample>, Vec<Share>) {
        for sample in &mut self.samples {
            sample.light = sample.sum().to_array();
        }
        (self.samples, self.shares)
    }

    fn sample(&mut self) -> Option<&mut Sample> {
        self.samples.last_mut()
    }

    fn ray(&mut self) -> Option<&mut TracedRay> {
        self.sample()?.rays.last_mut()
    }

    fn start(&self, ray: &Forward<'_>) -> Start {
        let from = self.samples.last().and_then(|sample| sample.rays.iter().enumerate().next_back());
        Start {
            parent: from.map(|(number, _)| number),
            way: ray.way,
            effect: from.and_then(|(_, from)| self.effect(from, ray)),
            origin: ray.ray.origin.to_array(),
            direction: ray.ray.direction.to_array(),
            share: ray.share.to_array(),
            weight: ray.weight.to_array(),
            wavelength: ray.wavelength,
        }
    }

    /// The effect of the material at the end of `from` that sends a ray.
    fn effect(&self, from: &TracedRay, ray: &Forward<'_>) -> Option<Thing> {
        let material = &self.snapshot.materials.all[from.met.as_ref()?.material_number];
        let sends = |effect: &&Effect| match (ray.way, effect) {
            (Way::Mirrored, Effect::Mirror(_) | Effect::Split(_)) => true,
            // Beside what is let through straight, a clear body may split the light.
            (Way::Transmitted, Effect::Through(share)) => *share == ray.share,
            (Way::Transmitted, Effect::Refract(_) | Effect::Split(_)) => true,
            _ => false,
        };
        let tags = tags(material.effects.iter().find(sends)?);
        Some(Thing { component: tags.first().copied(), tags, ..from.met.as_ref()?.material.clone() })
    }

    /// The objects between a point and a light, up to one that lets nothing through.
    fn in_the_way(&self, look: &Look<'_>, light: &Illumination) -> Vec<Thing> {
        let Snapshot { geometry, materials, names, .. } = self.snapshot;
        let mut things: Vec<Thing> = vec![];
        let mut ray = Ray { origin: look.from, direction: light.to_light };
        let end = ray.at(light.distance);
        let mut rest = light.distance;
        while things.len() < MOST_IN_THE_WAY {
            let met = geometry.closest(&ray, rest, &Methods::default(), &mut Cost::default());
            let Some(met) = met.filter(|met| met.t < rest) else { break };
            let thing = Thing::entity(names.get(met.object as usize).and_then(Option::as_ref));
            // Bodies show a front and a back.
            if !things.contains(&thing) {
                things.push(thing);
            }
            if !materials.at(met.object, met.surface.slot).is_transparent() {
                break;
            }
            ray.origin = met.surface.departure(ray.direction, met.t * ray.direction.length());
            if rest.is_finite() {
                ray.direction = end - ray.origin;
                rest = 1.0;
                if ray.direction.dot(light.to_light) <= 0.0 {
                    break;
                }
            }
        }
        things
    }
}

impl Observer for Recorder<'_> {
    fn sample(&mut self) {
        self.samples.push(Sample::default());
    }

    fn shared(&mut self, number: u32, share: f64) {
        self.shares.push(Share { sample: number as usize, share });
    }

    fn put_forward(&mut self, ray: &Forward<'_>) {
        let start = self.start(ray);
        self.waiting.push(start);
    }

    fn traced(&mut self, traced: &Traced<'_>) {
        let Snapshot { materials, names, .. } = self.snapshot;
        let met = traced.met.map(|met| {
            let surface = &met.surface;
            let material_number = materials.number_at(met.object, surface.slot);
            Met {
                object: Thing::entity(names.get(met.object as usize).and_then(Option::as_ref)),
                material: Thing::entity(materials.names.get(material_number).and_then(Option::as_ref)),
                material_number,
                distance: met.t,
                point: surface.point.to_array(),
                normal: surface.normal.to_array(),
                shading_normal: surface.shading_normal.to_array(),
                uv: surface.uv.to_array(),
                from_outside: false,
            }
        });
        let Some(start) = self.waiting.pop() else { return };
        let met = met.map(|met| {
            let cosine: f64 = met.normal.iter().zip(&start.direction).map(|(n, d)| n * d).sum();
            Met { from_outside: cosine < 0.0, ..met }
        });
        let Some(sample) = self.sample() else { return };
        let parent = start.parent.and_then(|parent| sample.rays.get(parent));
        let depth = parent.map_or(0, |parent| parent.depth + usize::from(start.way != Way::Onward));
        let weight_at_end = traced.weight.to_array();
        sample.rays.push(TracedRay { start, depth, weight_at_end, met, terms: vec![], dropped: vec![] });
    }

    fn looked(&mut self, look: &Look<'_>) {
        let blocked = look.light.filter(|_| look.visible.is_some_and(|visible| visible != Rgb::ONE));
        let in_the_way = blocked.filter(|_| self.looks.in_the_way.is_empty()).map(|light| self.in_the_way(look, light));
        let looks = &mut self.looks;
        looks.count += 1;
        looks.in_the_way.extend(in_the_way.into_iter().flatten());
        match (look.light, look.visible) {
            (None, _) => looks.unlit += 1,
            (_, None) => looks.facing_away += 1,
            (_, Some(visible)) => {
                looks.hidden += u32::from(visible == Rgb::ZERO);
                looks.visible += visible;
            }
        }
    }

    fn lamp(&mut self, lamp: u32, light: Rgb) {
        let Looks { count, unlit, facing_away, hidden, visible, in_the_way } = mem::take(&mut self.looks);
        let traced = count - unlit - facing_away;
        let label = self.snapshot.lights.labels.get(lamp as usize);
        let entity = Thing::entity(label.and_then(|(name, _)| name.as_ref()));
        self.lamps.push(LampLight {
            lamp: Thing { component: label.map(|(_, tag)| *tag), ..entity },
            light: light.to_array(),
            looks: count,
            unlit,
            facing_away,
            hidden,
            visible: (traced > 0).then(|| (visible / f64::from(traced)).to_array()),
            in_the_way,
        });
    }

    fn term(&mut self, effect: &Effect, factor: Rgb, light: Rgb) {
        let lamps = mem::take(&mut self.lamps);
        let Some(ray) = self.ray() else { return };
        let material = ray.met.as_ref().map(|met| met.material.clone()).unwrap_or_default();
        let tags = tags(effect);
        ray.terms.push(Term {
            effect: Thing { component: tags.first().copied(), tags, ..material },
            factor: factor.to_array(),
            light: light.to_array(),
            amount: (factor * light).to_array(),
            lamps,
        });
    }

    fn added(&mut self, what: Added, weight: Rgb, light: Rgb) {
        let Some(sample) = self.sample() else { return };
        let ray = sample.rays.len().saturating_sub(1);
        let amount = (weight * light).to_array();
        sample.contributions.push(Contribution {
            ray,
            what,
            weight: weight.to_array(),
            light: light.to_array(),
            amount,
        });
    }

    fn dropped(&mut self, ray: &Forward<'_>, why: Dropped) {
        let start = self.start(ray);
        if let Some(ray) = self.ray() {
            ray.dropped.push(DroppedRay { start, why });
        }
    }
}

/// Tags of the components that give an effect.
fn tags(effect: &Effect) -> &'static [&'static str] {
    match effect {
        Effect::Ambient(_) => &["Ambient"],
        Effect::Diffuse(_) => &["Diffuse"],
        Effect::Glossy { .. } => &["Highlight"],
        Effect::Mirror(_) => &["Mirror", "Dielectric"],
        Effect::Through(_) => &["Opacity", "Transmission"],
        Effect::Refract(_) => &["Transmission"],
        Effect::Split(_) => &["Dielectric"],
    }
}
