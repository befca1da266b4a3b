//! Rays that go on from surfaces: mirrored, let through and bent.

use super::{
    footprint::Beside,
    interior::Sides,
    observe::{Added, Dropped, Forward, Observer, Way},
    optics,
    point::{Point, straight_eta},
    trace::{Pending, Walk},
    wave::{Wave, departure, reflect},
};
use crate::snapshot::Effect;
use glam::DVec3;
use smallvec::SmallVec;
use snell_components::{
    color::Rgb,
    lanes::{self, Job, Lanes, vector},
    packet::{Mask, each, groups},
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
            match material.mirror_alone() {
                Some(share) if !O::WATCHES && !B::RUNS => onward |= self.mirror(rays, share),
                _ => each(rays).for_each(|i| onward |= Mask::from(self.go_on_alone(i)) << i),
            }
        }
        onward
    }

    /// Mirrors rays where nothing else goes on.
    fn mirror(&mut self, rays: Mask, share: Rgb) -> Mask {
        let settings = &self.snapshot.settings;
        lanes::run(Mirror { wave: self.wave, rays, share });
        let mut onward = 0;
        for i in each(rays) {
            let weight = self.wave.weight_of(i);
            let depth = self.wave.depth[i];
            if depth >= settings.depth {
                self.counts.too_deep += 1;
                self.wave.add(i, weight * beyond_depth(settings.background));
            } else if self.trees[i].cut.drops(weight, settings.depth - depth - 1) {
                self.counts.cut += 1;
            } else {
                self.counts.mirror += 1;
                self.wave.depth[i] = depth + 1;
                self.wave.key[i] = self.wave.key[i].child(u32::MAX);
                onward |= 1 << i;
            }
        }
        onward
    }

    /// Puts the rays forward that go on from where one ray met a surface; tells whether there are any.
    fn go_on_alone(&mut self, i: usize) -> bool {
        let settings = &self.snapshot.settings;
        let (materials, wave) = (&self.snapshot.materials, &mut *self.wave);
        let point = wave.point(i, self.snapshot, self.methods);
        let (weight, depth, inside, wavelength) =
            (wave.weight_of(i), wave.depth[i], wave.inside[i], wave.wavelength[i]);
        let object = wave.bests.object(i);
        let branches = point.branches(self.trees[i].sides, wavelength);
        let mut beyond = None;
        let mut top = None;
        for (n, branch) in branches.iter().enumerate().rev() {
            let tree = &mut self.trees[i];
            let weight = weight * branch.share;
            let origin = point.surface.departure(branch.direction, point.travelled);
            let ray = Ray { origin, direction: branch.direction };
            let Branch { way, share, wavelength, .. } = *branch;
            let forward = Forward { way, ray: &ray, share, weight, wavelength };
            if depth >= settings.depth {
                self.counts.too_deep += 1;
                let light = beyond_depth(settings.background);
                wave.add(i, weight * light);
                self.observer.dropped(&forward, Dropped::TooDeep);
                self.observer.added(Added::BeyondDepth, weight, light);
            } else if tree.cut.drops(weight, settings.depth - depth - 1) {
                self.counts.cut += 1;
                self.observer.dropped(&forward, Dropped::Cut);
            } else {
                self.observer.put_forward(&forward);
                let inside = if way == Way::Mirrored {
                    self.counts.mirror += 1;
                    inside
                } else {
                    self.counts.transmitted += 1;
                    match beyond {
                        _ if materials.medium(object).is_none() => inside,
                        // The same for all lines of a spectrum.
                        Some(beyond) => beyond,
                        None => {
                            let across = tree.interiors.get(inside).across(object, point.entering);
                            *beyond.insert(tree.interiors.keep(across))
                        }
                    }
                };
                // Lights count from zero up, branches from the top down.
                let key = point.key.child(u32::MAX - n as u32);
                let beside = match &tree.met {
                    Some(met) => B::go_on(met, &point, branch),
                    None => tree.beside,
                };
                let next = Pending { ray, beside, weight, depth: depth + 1, inside, wavelength, key };
                if let Some(before) = top.replace(next) {
                    tree.below.push(before);
                    self.waiting |= 1 << i;
                }
            }
        }
        let Some(top) = top else { return false };
        self.put(i, top);
        true
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
        let zero = l.d_splat(0.0);
        for (group, which) in groups(rays) {
            let direction = vector::load(l, &packet.directions, group);
            let normal = vector::load(l, &surfaces.normal, group);
            let shading = vector::load(l, &surfaces.shading_normal, group);
            let toward = l.d_lt(vector::dot(l, shading, direction), zero);
            let mut mirrored = reflect(l, direction, vector::select(l, toward, shading, normal));
            let above = l.d_lt(zero, vector::dot(l, mirrored, normal));
            if above & which != which {
                mirrored = vector::select(l, above, mirrored, reflect(l, direction, normal));
            }
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
