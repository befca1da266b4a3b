//! Light at one point of a surface: the local terms of the Whitted sum, and shadows.

use super::{
    Counts, Key,
    budget::lamp_error,
    interior::{self, Interior, Sides},
    observe::{Look, Observer},
    optics,
};
use crate::{
    accelerate::{Geometry, Nearest},
    snapshot::{Effect, Lights, Material, MaterialOfObject, Snapshot},
};
use glam::{DVec2, DVec3};
use snell_components::{
    color::Rgb,
    light::{Illumination, Lamp, Sampling},
    math,
    method::Methods,
    packet::{PACKET, Packet, PerRay, each},
    primitive::{Cost, OFFSET_ULPS, Surface},
    space::Ray,
    texture::{Footprint, TexturePoint},
};

/// A point to be shaded, its normals turned toward the viewer.
pub(super) struct Point<'a> {
    pub snapshot: &'a Snapshot,
    pub methods: &'a Methods,
    /// Unit direction of the ray that came here.
    pub direction: DVec3,
    /// How far the ray went, world units.
    pub travelled: f64,
    pub surface: Surface,
    pub material: &'a Material,
    /// From the point to where rays to lights start, beyond rounding: nothing where no normals are interpolated.
    pub lift: DVec3,
    /// Whether the ray comes from outside.
    pub entering: bool,
    pub key: Key,
}

impl<'a> Point<'a> {
    #[inline(always)]
    pub(super) fn new(snapshot: &'a Snapshot, methods: &'a Methods, ray: &Ray, met: &Nearest, key: Key) -> Self {
        let Snapshot { geometry, materials, .. } = snapshot;
        let (mut surface, material) = match &materials.of_object[met.object as usize] {
            MaterialOfObject::Whole(number) => {
                let material = &materials.all[*number as usize];
                let surface = match material.texture {
                    Some(_) => geometry.surface(met, ray, methods),
                    None => geometry.surface_without_uv(met, ray, methods),
                };
                (surface, material)
            }
            MaterialOfObject::Slots(_) => {
                let surface = geometry.surface(met, ray, methods);
                (surface, materials.at(met.object, surface.slot))
            }
        };
        let entering = surface.normal.dot(ray.direction) < 0.0;
        if !entering {
            surface.normal = -surface.normal;
            surface.shading_normal = -surface.shading_normal;
        }
        let (direction, travelled) = (ray.direction, met.hit.t);
        let smooth = surface.shading_normal != surface.normal;
        let lift = if smooth { geometry.lift(met, ray) } else { DVec3::ZERO };
        Self { snapshot, methods, direction, travelled, surface, material, lift, entering, key }
    }

    /// What the surface gives without lamps, and what is to be asked of them.
    #[inline]
    pub(super) fn begin<O: Observer>(&self, footprint: impl FnOnce() -> Footprint, observer: &mut O) -> Local {
        let mut local = Local { sum: Rgb::ZERO, asks: None, factor: Rgb::ONE, start: DVec3::ZERO, lamps: Rgb::ZERO };
        if !self.material.effects.first().is_some_and(Effect::is_light) {
            return local;
        }
        let color = self.color(footprint);
        for effect in &self.material.effects {
            match *effect {
                Effect::Ambient(strength) => {
                    let (factor, light) = (strength * color, self.snapshot.lights.ambient);
                    local.sum += factor * light;
                    observer.term(effect, factor, light);
                }
                Effect::Diffuse(strength) => {
                    local.factor = strength * color;
                    local.asks = Some(*effect);
                }
                Effect::Glossy { diffuse, highlight, exponent } => {
                    local.asks = Some(Effect::Glossy { diffuse: diffuse * color, highlight, exponent });
                }
                Effect::Mirror(_) | Effect::Through(_) | Effect::Refract(_) | Effect::Split(_) => break,
            }
        }
        if local.asks.is_some() {
            local.start = self.surface.departure(self.surface.normal, self.travelled) + self.lift;
        }
        local
    }

    /// Sum of the ambient, diffuse and highlight terms, once the lamps were asked.
    #[inline]
    pub(super) fn finish<O: Observer>(&self, local: &Local, observer: &mut O) -> Rgb {
        let Local { sum, asks, factor, lamps, .. } = *local;
        if asks.is_none() {
            return sum;
        }
        if O::WATCHES {
            // The last of the terms of light is the one that asked.
            if let Some(effect) = self.material.effects.iter().take_while(|effect| effect.is_light()).last() {
                observer.term(effect, factor, lamps);
            }
        }
        sum + factor * lamps
    }

    fn color(&self, footprint: impl FnOnce() -> Footprint) -> Rgb {
        let Material { color, texture, .. } = self.material;
        match texture {
            None => *color,
            Some(pattern) => {
                let Surface { uv, point, .. } = self.surface;
                *color * pattern.color(&TexturePoint { uv, point, footprint: footprint() })
            }
        }
    }

    /// The term that a light adds.
    #[inline(always)]
    fn term(&self, asks: &Effect, light: &Arriving) -> Rgb {
        match *asks {
            Effect::Glossy { diffuse, highlight, exponent } => {
                // Where the mirrored light points away from the viewer there is no highlight, whatever the exponent.
                let mirrored = optics::reflect(-light.direction, self.surface.shading_normal);
                let aligned = -mirrored.dot(self.direction);
                let shine = if aligned > 0.0 { math::pow(aligned, exponent) } else { 0.0 };
                (diffuse * light.cosine + highlight * shine) * light.intensity
            }
            _ => light.intensity * light.cosine,
        }
    }

    /// What would arrive of a light at the point, if it shines on this side and nothing is in the way.
    #[inline(always)]
    fn facing(&self, light: &Illumination) -> Option<Arriving> {
        let length = light.to_light.length();
        let direction = light.to_light * (1.0 / length);
        let cosine = self.surface.shading_normal.dot(direction);
        if cosine <= 0.0 || cosine.is_nan() {
            return None;
        }
        let Illumination { distance, intensity, .. } = *light;
        Some(Arriving { direction, length, distance, cosine, intensity, visible: Rgb::ONE })
    }

    /// Mean of the term of a lamp with an area; `weight` is what it is multiplied by in the pixel.
    fn sampled<O: Observer>(
        &self,
        number: u32,
        sampling: Sampling,
        (local, asks): (&Local, &Effect),
        weight: Rgb,
        interior: &Interior,
        counts: &mut Counts,
        observer: &mut O,
    ) -> Rgb {
        let lamp = &*self.snapshot.lights.lamps[number as usize];
        let weight = if matches!(asks, Effect::Diffuse(_)) { weight * local.factor } else { weight };
        let error = lamp_error(self.snapshot, weight).unwrap_or(sampling.error);
        let one = |sample| {
            let light = lamp.illuminate(local.start, sample);
            let arriving = light.as_ref().and_then(|light| {
                let mut arriving = self.facing(light)?;
                if self.casts(light) {
                    let ray = Ray { origin: local.start, direction: light.to_light };
                    arriving.weaken(self.visibility(ray, arriving.length, light.distance, interior, counts));
                }
                Some(arriving)
            });
            if O::WATCHES {
                let visible = arriving.as_ref().map(|arriving| arriving.visible);
                observer.looked(&Look { lamp: number, from: local.start, light: light.as_ref(), visible });
            }
            arriving.filter(|arriving| arriving.visible != Rgb::ZERO).map(|arriving| self.term(asks, &arriving))
        };
        let (mean, reached) = mean_over(Sampling { error, ..sampling }, self.key.child(number), one);
        counts.undersampled += u64::from(!reached);
        mean
    }

    #[inline(always)]
    fn casts(&self, light: &Illumination) -> bool {
        light.shadows && self.snapshot.settings.shadows
    }

    /// Share of a light that gets through to the start of `ray`, whose direction is so long, and which ends at the
    /// light: none if anything opaque is in between; else every transparent surface weakens it, as do the bodies it goes
    /// through. The ray goes straight, even where a view ray would bend.
    #[inline]
    fn visibility(&self, ray: Ray, length: f64, distance: f64, interior: &Interior, counts: &mut Counts) -> Rgb {
        let Snapshot { geometry, parted, .. } = self.snapshot;
        let mut cost = Cost::default();
        counts.shadow += 1;
        let rest = short_of_the_light(&ray, length, distance);
        let opaque = parted.as_ref().map_or(&**geometry, |parted| &parted.opaque);
        let blocked = opaque.blocked(&ray, rest, self.methods, &mut cost);
        counts.add(cost);
        match parted {
            _ if blocked => Rgb::ZERO,
            None => Rgb::ONE,
            Some(parted) => self.through_clear(&parted.clear, ray, rest, distance, interior, counts),
        }
    }

    /// Share of a light that gets through all that is clear on the way, up to `rest` of the `distance` to the light.
    #[inline(never)]
    fn through_clear(
        &self,
        clear: &Geometry,
        mut ray: Ray,
        mut rest: f64,
        distance: f64,
        interior: &Interior,
        counts: &mut Counts,
    ) -> Rgb {
        let materials = &self.snapshot.materials;
        let mut interior = interior.clone();
        let mut cost = Cost::default();
        let mut visible = Rgb::ONE;
        let end = ray.at(distance);
        let toward = ray.direction;
        while visible != Rgb::ZERO {
            let met = clear.nearest(&ray, rest, self.methods, &mut cost);
            let met = met.filter(|met| met.hit.t < rest);
            let length = ray.direction.length();
            if !interior.is_empty() {
                let t = met.map_or(rest, |met| met.hit.t);
                visible *= interior::transmittance(interior.medium(materials), t * length);
            }
            let Some(met) = met else { break };
            let surface = clear.surface_without_uv(&met, &ray, self.methods);
            visible *= self.passes(met.object, &surface, &ray, &mut interior);
            ray.origin = surface.departure(ray.direction, met.hit.t * length);
            if rest.is_finite() {
                // Toward the same end from the new start.
                ray.direction = end - ray.origin;
                rest = short_of_the_light(&ray, ray.direction.length(), 1.0);
                // The step away from the surface may pass the light: turning back would go on for ever.
                if ray.direction.dot(toward) <= 0.0 {
                    break;
                }
            }
            counts.shadow += u64::from(visible != Rgb::ZERO);
        }
        counts.add(cost);
        visible
    }

    /// Share of the light that a surface lets through on a straight way; notes the bodies entered and left.
    fn passes(&self, object: u32, surface: &Surface, ray: &Ray, interior: &mut Interior) -> Rgb {
        let materials = &self.snapshot.materials;
        let cosine = surface.normal.dot(ray.direction) / ray.direction.length();
        let entering = cosine < 0.0;
        let mut eta = 1.0;
        if materials.medium(object).is_some() {
            let sides = interior.sides(object, entering, materials);
            *interior = interior.across(object, entering);
            let Some(Sides { before, after }) = sides else { return Rgb::ONE };
            eta = straight_eta(before.index, after.index);
        }
        materials.at(object, surface.slot).effects.iter().fold(Rgb::ZERO, |sum, effect| {
            sum + match *effect {
                Effect::Through(strength) | Effect::Refract(strength) => strength,
                Effect::Split(part) => part * (1.0 - optics::fresnel(cosine.abs(), eta)),
                Effect::Ambient(_) | Effect::Diffuse(_) | Effect::Glossy { .. } | Effect::Mirror(_) => Rgb::ZERO,
            }
        })
    }
}

/// The ratio of indices for Fresnel's equations on a way that does not bend: the angle is taken to be the one on the
/// thinner side, as it is there in truth on entry and exit alike, so that nothing is totally reflected.
pub(super) fn straight_eta(before: f64, after: f64) -> f64 {
    if before < after { before / after } else { after / before }
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

/// A light at a point, as the terms need it.
struct Arriving {
    /// Unit, toward the light.
    direction: DVec3,
    /// Of the way to the light as its lamp tells it.
    length: f64,
    /// Where the light stands on that way.
    distance: f64,
    /// Of the angle to the shading normal; more than zero.
    cosine: f64,
    /// What arrives after shadows, linear RGB.
    intensity: Rgb,
    /// The share that got through.
    visible: Rgb,
}

impl Arriving {
    #[inline(always)]
    fn weaken(&mut self, visible: Rgb) {
        self.intensity *= visible;
        self.visible = visible;
    }
}

/// The light at a point as far as it is known.
pub(super) struct Local {
    /// Sum of the terms that are complete.
    sum: Rgb,
    /// The term that is asked of lamps, in its colour but for `factor`.
    asks: Option<Effect>,
    /// What the sum over the lamps is multiplied by.
    factor: Rgb,
    /// Where rays to lights start.
    start: DVec3,
    /// Sum over the lamps asked so far.
    lamps: Rgb,
}

/// Rays toward a lamp from several points, which are traced together.
#[derive(Default)]
pub(super) struct Shadows {
    packet: Packet,
    ends: Ends,
    /// What of the lamp arrives at each point.
    lights: Vec<Option<Arriving>>,
    /// The points of the rays.
    points: Vec<usize>,
}

struct Ends(PerRay);

impl Default for Ends {
    fn default() -> Self {
        Self([0.0; PACKET])
    }
}

/// What surrounds a point to be lit: its weight in the pixel, and the clear bodies that the ray came through.
pub(super) type Around<'a> = (Rgb, &'a Interior);

/// Asks all lamps for the light at some points, at most [`PACKET`]; each point adds them up in their order.
pub(super) fn ask_lamps<'a, O: Observer>(
    snapshot: &Snapshot,
    points: &[Point<'_>],
    locals: &mut [Local],
    around: impl Fn(usize) -> Around<'a>,
    shadows: &mut Shadows,
    counts: &mut Counts,
    observer: &mut O,
) {
    if locals.iter().all(|local| local.asks.is_none()) {
        return;
    }
    let Lights { lamps, points: plain, sampling, .. } = &*snapshot.lights;
    for (((lamp, plain), sampling), number) in lamps.iter().zip(plain).zip(sampling).zip(0..) {
        match (plain, *sampling) {
            (Some(lamp), _) => shadows.look(lamp, points, locals, &around, counts),
            (None, None) => shadows.look(&**lamp, points, locals, &around, counts),
            (None, Some(sampling)) => {
                for (i, (point, local)) in points.iter().zip(&mut *locals).enumerate() {
                    if let Some(asks) = local.asks {
                        let (weight, interior) = around(i);
                        let asks = (&*local, &asks);
                        let light = point.sampled(number, sampling, asks, weight, interior, counts, observer);
                        local.lamps += light;
                        observer.lamp(number, light);
                    }
                }
                continue;
            }
        }
        for ((point, local), arriving) in points.iter().zip(&mut *locals).zip(&shadows.lights) {
            let Some(asks) = &local.asks else { continue };
            if O::WATCHES {
                let light = lamp.illuminate(local.start, DVec2::ZERO);
                let visible = arriving.as_ref().map(|arriving| arriving.visible);
                observer.looked(&Look { lamp: number, from: local.start, light: light.as_ref(), visible });
            }
            let light = match arriving {
                Some(arriving) if arriving.visible != Rgb::ZERO => point.term(asks, arriving),
                _ => Rgb::ZERO,
            };
            local.lamps += light;
            observer.lamp(number, light);
        }
    }
}

impl Shadows {
    /// Asks a lamp without area for the light at some points.
    #[inline(always)]
    fn look<'a, L: Lamp + ?Sized>(
        &mut self,
        lamp: &L,
        points: &[Point<'_>],
        locals: &[Local],
        around: &impl Fn(usize) -> Around<'a>,
        counts: &mut Counts,
    ) {
        self.packet.clear();
        self.points.clear();
        self.lights.clear();
        for (i, (point, local)) in points.iter().zip(locals).enumerate() {
            if local.asks.is_none() {
                self.lights.push(None);
                continue;
            }
            let arriving = lamp.illuminate(local.start, DVec2::ZERO).and_then(|light| {
                let arriving = point.facing(&light)?;
                if point.casts(&light) {
                    let ray = Ray { origin: local.start, direction: light.to_light };
                    self.ends.0[self.packet.push(&ray)] = short_of_the_light(&ray, arriving.length, light.distance);
                    self.points.push(i);
                }
                Some(arriving)
            });
            self.lights.push(arriving);
        }
        let Some(Point { snapshot, methods, .. }) = points.first() else { return };
        let mut cost = Cost::default();
        let Snapshot { geometry, parted, .. } = snapshot;
        let opaque = parted.as_ref().map_or(&**geometry, |parted| &parted.opaque);
        let all = self.packet.all();
        counts.shadow += self.packet.len() as u64;
        let blocked = opaque.blocked_packet(&self.packet, all, &self.ends.0, methods, &mut cost);
        for n in each(blocked) {
            if let Some(arriving) = &mut self.lights[self.points[n]] {
                arriving.weaken(Rgb::ZERO);
            }
        }
        if let Some(parted) = parted {
            let clear = &parted.clear;
            let met = clear.blocked_packet(&self.packet, all & !blocked, &self.ends.0, methods, &mut cost);
            for n in each(all & !blocked) {
                let i = self.points[n];
                let (_, interior) = around(i);
                if met >> n & 1 == 0 && interior.is_empty() {
                    continue;
                }
                if let Some(arriving) = &mut self.lights[i] {
                    let (ray, end) = (self.packet.ray(n), self.ends.0[n]);
                    arriving.weaken(points[i].through_clear(clear, ray, end, arriving.distance, interior, counts));
                }
            }
        }
        counts.add(cost);
    }
}

/// Where the way to a light at `distance` ends: before the rounding error of a surface that the light stands on, which
/// must not hide it. `length` is that of the ray's direction.
#[inline]
fn short_of_the_light(ray: &Ray, length: f64, distance: f64) -> f64 {
    if distance.is_infinite() {
        return distance;
    }
    let reach = ray.origin.abs().max_element() + length * distance;
    distance - OFFSET_ULPS * f64::EPSILON * reach / length
}
