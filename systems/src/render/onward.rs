//! Rays that go on from surfaces: mirrored, let through and bent.

use super::{
    Key,
    footprint::Beside,
    interior::Sides,
    observe::{Added, Dropped, Forward, Observer, Way},
    optics,
    point::{Point, straight_eta},
    trace::{Pending, Walk},
    wave::{Wave, departure},
};
use crate::snapshot::Effect;
use glam::DVec3;
use smallvec::SmallVec;
use snell_components::{
    color::Rgb,
    lanes::{self, Job, Lanes, vector},
    packet::{Mask, each, groups, those},
    space::Ray,
};

impl<B: Beside, O: Observer> Walk<'_, '_, B, O> {
    /// Puts the rays forward that go on from surfaces; tells in which trees there are any.
    pub(super) fn go_on(&mut self, by_material: &[(usize, Mask)]) -> Mask {
        let mut onward = 0;
        for &(material, rays) in by_material {
            let material = &self.snapshot.materials.all[material];
            if !material.goes_on() {
                continue;
            }
            onward |= match material.alone_goes_on() {
                Some(Effect::Mirror(share)) if !O::WATCHES && !B::RUNS => self.mirror(rays, *share),
                Some(Effect::Split(part)) if !O::WATCHES && !B::RUNS && self.snapshot.settings.refraction => {
                    self.split(rays, *part)
                }
                _ => those(rays, |i| self.go_on_alone(i)),
            };
        }
        onward
    }

    /// Mirrors rays where nothing else goes on.
    fn mirror(&mut self, rays: Mask, share: Rgb) -> Mask {
        lanes::run(Mirror { wave: self.wave, rays, share });
        let mut onward = 0;
        for i in each(rays) {
            let depth = self.wave.depth[i];
            if self.drops(i, self.wave.weight_of(i), depth).is_none() {
                self.counts.mirror += 1;
                self.wave.depth[i] = depth + 1;
                self.wave.key[i] = self.child(self.wave.key[i], 0);
                onward |= 1 << i;
            }
        }
        onward
    }

    /// Why a ray of some weight, which would go on from a surface at some depth, is not followed, if it is not; adds what
    /// it is taken to bring.
    #[inline]
    pub(super) fn drops(&mut self, i: usize, weight: Rgb, depth: u32) -> Option<Dropped> {
        let settings = &self.snapshot.settings;
        if depth >= settings.depth {
            self.counts.too_deep += 1;
            self.wave.add(i, weight * beyond_depth(settings.background));
            return Some(Dropped::TooDeep);
        }
        let cut = self.trees[i].cut.drops(weight, settings.depth - depth - 1);
        self.counts.cut += u64::from(cut);
        cut.then_some(Dropped::Cut)
    }

    /// The key of the `n`th ray that goes on; matters only where lamps are sampled.
    #[inline]
    pub(super) fn child(&self, key: Key, n: u32) -> Key {
        // Lights count from zero up, branches from the top down.
        if self.samples_lamps { key.child(u32::MAX - n) } else { key }
    }

    /// Puts the rays forward that go on from where one ray met a surface; tells whether any is followed.
    pub(super) fn go_on_alone(&mut self, i: usize) -> bool {
        let wave = &*self.wave;
        let point = wave.point(i, self.snapshot);
        let (weight, depth, wavelength) = (wave.weight_of(i), wave.depth[i], wave.wavelength[i]);
        let before = wave.inside[i];
        let crossing = (wave.bounding >> i & 1 != 0).then(|| self.interiors.crossing(wave.crossing[i]));
        let (sides, beyond) = crossing.map_or((None, before), |crossing| (crossing.sides, crossing.beyond));
        let branches = point.branches(sides, wavelength);
        let mut top = None;
        for (n, branch) in branches.iter().enumerate().rev() {
            let weight = weight * branch.share;
            let origin = point.surface.departure(branch.direction, point.travelled);
            let ray = Ray { origin, direction: branch.direction };
            let Branch { way, share, wavelength, .. } = *branch;
            let forward = Forward { way, ray: &ray, share, weight, wavelength };
            if let Some(why) = self.drops(i, weight, depth) {
                self.observer.dropped(&forward, why);
                if why == Dropped::TooDeep {
                    let light = beyond_depth(self.snapshot.settings.background);
                    self.observer.added(Added::BeyondDepth, weight, light);
                }
                continue;
            }
            self.observer.put_forward(&forward);
            let inside = if way == Way::Mirrored {
                self.counts.mirror += 1;
                before
            } else {
                self.counts.transmitted += 1;
                beyond
            };
            let key = self.child(point.key, n as u32);
            let tree = &self.trees[i];
            let beside = tree.met.as_ref().map_or(tree.beside, |met| B::go_on(met, &point, branch));
            let next = Pending { ray, beside, weight, depth: depth + 1, inside, wavelength, key };
            if let Some(before) = top.replace(next) {
                self.put_off(i, before);
            }
        }
        let Some(top) = top else { return false };
        self.put(i, top);
        true
    }
}

/// [`Point::bending_normal`] of four rays.
#[inline(always)]
pub(super) fn bending_four<L: Lanes>(
    l: L,
    direction: vector::Four<L>,
    normal: vector::Four<L>,
    shading: vector::Four<L>,
) -> vector::Four<L> {
    let toward = l.d_lt(vector::dot(l, shading, direction), l.d_splat(0.0));
    vector::select(l, toward, shading, normal)
}

/// [`Point::mirrored`] of four rays.
#[inline(always)]
pub(super) fn mirrored_four<L: Lanes>(
    l: L,
    direction: vector::Four<L>,
    normal: vector::Four<L>,
    bending: vector::Four<L>,
) -> vector::Four<L> {
    let mirrored = optics::reflect_four(l, direction, bending);
    let above = l.d_lt(l.d_splat(0.0), vector::dot(l, mirrored, normal));
    match above {
        0b1111 => mirrored,
        _ => vector::select(l, above, mirrored, optics::reflect_four(l, direction, normal)),
    }
}

/// Mirrors the rays of a wave at their surfaces, as [`Point::mirrored`], with a share of their light.
struct Mirror<'a> {
    wave: &'a mut Wave,
    rays: Mask,
    share: Rgb,
}

impl Job for Mirror<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let Self { wave, rays, share } = self;
        let Wave { packet, surfaces, bests, weight, .. } = wave;
        for (group, which) in groups(rays) {
            let direction = vector::load(l, &packet.directions, group);
            let normal = vector::load(l, &surfaces.normal, group);
            let shading = vector::load(l, &surfaces.shading_normal, group);
            let bending = bending_four(l, direction, normal, shading);
            let mirrored = mirrored_four(l, direction, normal, bending);
            let origin = departure(l, surfaces, &bests.limit, mirrored, group);
            vector::store(l, origin, which, &mut packet.origins, group);
            vector::store(l, mirrored, which, &mut packet.directions, group);
            let shared = vector::mul(l, vector::load(l, weight, group), vector::splat(l, share));
            vector::store(l, shared, which, weight, group);
        }
    }
}

/// What a ray beyond the depth limit is taken to bring: grey, with the mean brightness of the background's components.
/// Black would make deep reflections darker than what they mirror.
pub(crate) fn beyond_depth(background: Rgb) -> Rgb {
    Rgb::splat((background.x + background.y + background.z) / 3.0)
}

/// A ray that goes on from a surface.
pub(super) struct Branch {
    pub way: Way,
    /// The index where the ray comes from over the one where it goes; 1 where it does not bend.
    pub eta: f64,
    /// Unit.
    pub direction: DVec3,
    /// Share of its light that leaves toward the viewer; not zero.
    share: Rgb,
    /// In nanometres; none for white light.
    wavelength: Option<f64>,
}

type Branches = SmallVec<[Branch; 2]>;

impl Point<'_> {
    /// The rays that go on from here, in the order in which they are traced.
    fn branches(&self, sides: Option<Sides<'_>>, wavelength: Option<f64>) -> Branches {
        let mut branches = Branches::new();
        let mut add = |way, eta, direction, share: Rgb, wavelength| {
            if share != Rgb::ZERO {
                branches.push(Branch { way, eta, direction, share, wavelength });
            }
        };
        for effect in &self.material.effects {
            match *effect {
                Effect::Mirror(share) => add(Way::Mirrored, 1.0, self.mirrored(), share, wavelength),
                Effect::Through(share) => add(Way::Transmitted, 1.0, self.direction, share, wavelength),
                Effect::Refract(strength) => self.each_line(sides, wavelength, |eta, color, wavelength| {
                    if let Some(direction) = self.refracted(eta) {
                        add(Way::Transmitted, eta, direction, strength * color, wavelength);
                    }
                }),
                Effect::Split(part) => {
                    let cosine = -self.direction.dot(self.bending_normal());
                    // White light is mirrored as one, by the index of its middle.
                    let reflected = self.reflected(cosine, eta_of(sides, wavelength));
                    let mut mirrored = part * reflected;
                    let mut lines: SmallVec<[_; 1]> = SmallVec::new();
                    self.each_line(sides, wavelength, |eta, color, wavelength| {
                        let share = part * (1.0 - reflected) * color;
                        match self.refracted(eta).filter(|_| reflected < 1.0) {
                            Some(direction) => lines.push((eta, direction, share, wavelength)),
                            // Beyond the critical angle of this wavelength.
                            None => mirrored += share,
                        }
                    });
                    let mirrored = if lines.is_empty() { part } else { mirrored };
                    add(Way::Mirrored, 1.0, self.mirrored(), mirrored, wavelength);
                    for (eta, direction, share, wavelength) in lines {
                        add(Way::Transmitted, eta, direction, share, wavelength);
                    }
                }
                Effect::Ambient(_) | Effect::Diffuse(_) | Effect::Glossy { .. } => {}
            }
        }
        branches
    }

    /// Calls `each` with the ratio of indices, the colour and the wavelength of every line into which the surface splits
    /// the ray: a single one, unless the ray is white and a medium disperses.
    fn each_line(
        &self,
        sides: Option<Sides<'_>>,
        wavelength: Option<f64>,
        mut each: impl FnMut(f64, Rgb, Option<f64>),
    ) {
        let spectrum = sides.and_then(|sides| sides.after.spectrum.as_ref().or(sides.before.spectrum.as_ref()));
        match spectrum {
            Some(spectrum) if wavelength.is_none() && self.snapshot.settings.refraction => {
                for (wavelength, color) in &spectrum.lines {
                    each(eta_of(sides, Some(*wavelength)), *color, Some(*wavelength));
                }
            }
            _ => each(eta_of(sides, wavelength), Rgb::ONE, wavelength),
        }
    }

    /// Share of the light that is reflected.
    fn reflected(&self, cosine: f64, eta: f64) -> f64 {
        // A way that does not bend knows no critical angle.
        let eta = if self.snapshot.settings.refraction { eta } else { straight_eta(eta, 1.0) };
        optics::fresnel(cosine, eta)
    }
}

/// The index where the ray comes from over the one where it goes.
fn eta_of(sides: Option<Sides<'_>>, wavelength: Option<f64>) -> f64 {
    sides.map_or(1.0, |Sides { before, after }| before.index_at(wavelength) / after.index_at(wavelength))
}
