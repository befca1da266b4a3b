//! One pixel: the tree of rays that starts with it.

use super::{Counts, optics, shade::Point};
use crate::{
    accelerate::Accelerator,
    snapshot::{Effect, Snapshot},
};
use glam::DVec3;
use smallvec::SmallVec;
use snell_components::{color::Rgb, primitive::Cost, settings::Antialias, space::Ray};

/// Where rays pass through a pixel, from its centre, in pixels.
fn samples(antialias: Antialias) -> &'static [(f64, f64)] {
    match antialias {
        Antialias::Off => &[(0.0, 0.0)],
        Antialias::Four => &[(-0.25, -0.25), (-0.25, 0.25), (0.25, -0.25), (0.25, 0.25)],
    }
}

/// The linear light of a pixel: a pure function of its arguments but for the counts.
#[must_use]
pub fn pixel(snapshot: &Snapshot, x: u32, y: u32, accelerator: Accelerator, counts: &mut Counts) -> Rgb {
    let settings = &snapshot.settings;
    let samples = samples(settings.antialias);
    let mut sum = Rgb::ZERO;
    for (dx, dy) in samples {
        let (x, y) = (f64::from(x) + 0.5 + dx, f64::from(y) + 0.5 + dy);
        counts.primary += 1;
        sum += light_along(snapshot, snapshot.view.ray(x, y, settings.width, settings.height), accelerator, counts);
    }
    sum / samples.len() as f64
}

/// A ray yet to be traced.
struct Pending {
    ray: Ray,
    /// What its light is multiplied by in the pixel.
    weight: Rgb,
    /// How many surfaces lie between it and the camera.
    depth: u32,
}

/// The light that comes back along a ray.
///
/// The tree of rays is walked with a stack of its own, the mirrored branch of a surface before the transmitted one, and
/// every contribution is added to one sum in that order: no depth overflows, and the sum is the same every time.
fn light_along(snapshot: &Snapshot, ray: Ray, accelerator: Accelerator, counts: &mut Counts) -> Rgb {
    let settings = &snapshot.settings;
    let mut sum = Rgb::ZERO;
    let mut pending: SmallVec<[Pending; 16]> = SmallVec::new();
    pending.push(Pending { ray, weight: Rgb::ONE, depth: 0 });
    while let Some(Pending { ray, weight, depth }) = pending.pop() {
        let mut cost = Cost::default();
        let met = snapshot.geometry.closest(&ray, f64::INFINITY, accelerator, &mut cost);
        counts.add(cost);
        let Some(met) = met else {
            sum += weight * settings.background;
            continue;
        };
        let point = Point::new(snapshot, accelerator, &ray, met);
        sum += weight * point.local(counts);

        let branches = point.branches();
        for Branch { kind, direction, share } in branches.into_iter().rev() {
            let weight = weight * share;
            if depth >= settings.depth {
                counts.too_deep += 1;
                sum += weight * beyond_depth(settings.background);
            } else if weight.max_element() < settings.cutoff {
                counts.cut += 1;
            } else {
                match kind {
                    Kind::Mirror => counts.mirror += 1,
                    Kind::Transmitted => counts.transmitted += 1,
                }
                let origin = point.surface.departure(direction, point.travelled);
                pending.push(Pending { ray: Ray { origin, direction }, weight, depth: depth + 1 });
            }
        }
    }
    sum
}

/// What a ray beyond the depth limit is taken to bring: grey, with the mean brightness of the background's components.
/// Black would make deep reflections darker than what they mirror.
fn beyond_depth(background: Rgb) -> Rgb {
    Rgb::splat((background.x + background.y + background.z) / 3.0)
}

/// What became of the light.
enum Kind {
    Mirror,
    Transmitted,
}

/// A ray that goes on from a surface.
struct Branch {
    kind: Kind,
    /// Unit.
    direction: DVec3,
    /// Share of its light that leaves toward the viewer; not zero.
    share: Rgb,
}

impl Point<'_> {
    /// The rays that go on from here, in the order in which they are traced.
    fn branches(&self) -> SmallVec<[Branch; 3]> {
        let mut branches = SmallVec::new();
        let mut add = |kind, direction, share: Rgb| {
            if share != Rgb::ZERO {
                branches.push(Branch { kind, direction, share });
            }
        };
        for effect in &self.material.effects {
            match *effect {
                Effect::Mirror(share) => add(Kind::Mirror, self.mirrored(), share),
                Effect::Through(share) => add(Kind::Transmitted, self.direction, share),
                Effect::Refract { strength, index } => {
                    if let Some(direction) = self.refracted(index) {
                        add(Kind::Transmitted, direction, strength);
                    }
                }
                Effect::Split { part, index } => {
                    let cosine = -self.direction.dot(self.surface.shading_normal);
                    let reflected = optics::fresnel(cosine, self.eta(index));
                    match self.refracted(index).filter(|_| reflected < 1.0) {
                        Some(direction) => {
                            add(Kind::Mirror, self.mirrored(), part * reflected);
                            add(Kind::Transmitted, direction, part * (1.0 - reflected));
                        }
                        None => add(Kind::Mirror, self.mirrored(), part),
                    }
                }
                Effect::Ambient(_) | Effect::Diffuse(_) | Effect::Glossy { .. } => {}
            }
        }
        branches
    }

    /// The index where the ray comes from over the one where it goes.
    fn eta(&self, index: f64) -> f64 {
        if self.entering { 1.0 / index } else { index }
    }

    /// The mirrored direction; at the true surface where the interpolated normal would send it below that.
    fn mirrored(&self) -> DVec3 {
        let mirrored = optics::reflect(self.direction, self.surface.shading_normal);
        if mirrored.dot(self.surface.normal) > 0.0 {
            mirrored
        } else {
            optics::reflect(self.direction, self.surface.normal)
        }
    }

    /// The refracted direction, if any; at the true surface where the interpolated normal would keep it above that.
    fn refracted(&self, index: f64) -> Option<DVec3> {
        let eta = self.eta(index);
        let refracted = optics::refract(self.direction, self.surface.shading_normal, eta)?;
        if refracted.dot(self.surface.normal) < 0.0 {
            Some(refracted)
        } else {
            optics::refract(self.direction, self.surface.normal, eta)
        }
    }
}
