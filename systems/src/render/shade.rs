//! Light at one point of a surface: the local terms of the Whitted sum, and shadows.

use super::{Counts, optics};
use crate::{
    accelerate::{Accelerator, Intersection},
    snapshot::{Effect, Material, Snapshot},
};
use glam::DVec3;
use snell_components::{
    color::Rgb,
    math,
    primitive::{Cost, Surface},
    space::Ray,
    texture::TexturePoint,
};

/// A point to be shaded, its normals turned toward the viewer.
pub(super) struct Point<'a> {
    pub snapshot: &'a Snapshot,
    pub accelerator: Accelerator,
    /// Unit direction of the ray that came here.
    pub direction: DVec3,
    /// How far the ray went, world units.
    pub travelled: f64,
    pub surface: Surface,
    pub material: &'a Material,
    /// Whether the ray comes from outside.
    pub entering: bool,
}

impl<'a> Point<'a> {
    pub(super) fn new(snapshot: &'a Snapshot, accelerator: Accelerator, ray: &Ray, met: Intersection) -> Self {
        let mut surface = met.surface;
        let entering = surface.normal.dot(ray.direction) < 0.0;
        if !entering {
            surface.normal = -surface.normal;
            surface.shading_normal = -surface.shading_normal;
        }
        let material = snapshot.materials.at(met.object, surface.slot);
        Self { snapshot, accelerator, direction: ray.direction, travelled: met.t, surface, material, entering }
    }

    /// Sum of the ambient, diffuse and highlight terms.
    pub(super) fn local(&self, counts: &mut Counts) -> Rgb {
        let mut sum = Rgb::ZERO;
        for effect in &self.material.effects {
            sum += match *effect {
                Effect::Ambient(strength) => strength * self.color() * self.snapshot.lights.ambient,
                Effect::Diffuse(strength) => {
                    strength * self.color() * self.over_lights(counts, |light| light.intensity * light.cosine)
                }
                Effect::Glossy { diffuse, highlight, exponent } => {
                    let color = self.color();
                    self.over_lights(counts, |light| {
                        // Where the mirrored light points away from the viewer there is no highlight, whatever the
                        // exponent.
                        let aligned =
                            -optics::reflect(-light.direction, self.surface.shading_normal).dot(self.direction);
                        let shine = if aligned > 0.0 { math::pow(aligned, exponent) } else { 0.0 };
                        (diffuse * color * light.cosine + highlight * shine) * light.intensity
                    })
                }
                Effect::Mirror(_) | Effect::Through(_) | Effect::Refract { .. } | Effect::Split { .. } => Rgb::ZERO,
            };
        }
        sum
    }

    fn color(&self) -> Rgb {
        self.material.color_at(&TexturePoint { uv: self.surface.uv, point: self.surface.point })
    }

    /// Sum of a term over the lights that reach the point.
    fn over_lights(&self, counts: &mut Counts, term: impl Fn(&Arriving) -> Rgb) -> Rgb {
        let mut sum = Rgb::ZERO;
        let start = self.surface.departure(self.surface.normal, self.travelled);
        for lamp in &self.snapshot.lights.lamps {
            let Some(light) = lamp.illuminate(start) else { continue };
            let direction = light.to_light.normalize();
            let cosine = self.surface.shading_normal.dot(direction);
            if cosine <= 0.0 || cosine.is_nan() {
                continue;
            }
            let visible = if self.snapshot.settings.shadows {
                self.visibility(Ray { origin: start, direction: light.to_light }, light.distance, counts)
            } else {
                Rgb::ONE
            };
            if visible != Rgb::ZERO {
                sum += term(&Arriving { direction, cosine, intensity: light.intensity * visible });
            }
        }
        sum
    }

    /// Share of a light that gets through to the start of `ray`, which ends at the light: every transparent surface in
    /// between weakens it, the first opaque one ends it. The ray goes straight, even where a view ray would bend.
    fn visibility(&self, mut ray: Ray, distance: f64, counts: &mut Counts) -> Rgb {
        let Snapshot { geometry, materials, .. } = self.snapshot;
        let mut cost = Cost::default();
        let mut visible = Rgb::ONE;
        let mut rest = distance;
        if !materials.any_transparent {
            counts.shadow += 1;
            if geometry.blocked(&ray, rest, self.accelerator, &mut cost) {
                visible = Rgb::ZERO;
            }
        } else {
            let end = ray.at(distance);
            let length = ray.direction.length();
            while visible != Rgb::ZERO {
                counts.shadow += 1;
                let met = geometry.closest(&ray, rest, self.accelerator, &mut cost);
                let Some(met) = met.filter(|met| met.t < rest) else { break };
                visible *= passes(materials.at(met.object, met.surface.slot), &ray, &met.surface);
                ray.origin = met.surface.departure(ray.direction, met.t * length);
                if rest.is_finite() {
                    // Toward the same end from the new start.
                    ray.direction = end - ray.origin;
                    rest = 1.0;
                }
            }
        }
        counts.add(cost);
        visible
    }
}

/// A light at a point, as the terms need it.
struct Arriving {
    /// Unit, toward the light.
    direction: DVec3,
    /// Of the angle to the shading normal; more than zero.
    cosine: f64,
    /// What arrives after shadows, linear RGB.
    intensity: Rgb,
}

/// Share of the light that a surface lets through on a straight way.
fn passes(material: &Material, ray: &Ray, surface: &Surface) -> Rgb {
    material.effects.iter().fold(Rgb::ZERO, |sum, effect| {
        sum + match *effect {
            Effect::Through(strength) | Effect::Refract { strength, .. } => strength,
            Effect::Split { part, index } => {
                // The way bends in truth: the angle outside is the same on entry and exit, so it decides both.
                let cosine = (ray.direction.dot(surface.normal) / ray.direction.length()).abs();
                part * (1.0 - optics::fresnel(cosine, 1.0 / index))
            }
            _ => Rgb::ZERO,
        }
    })
}
