//! One point of a surface: what is worked out for its ray alone.

use super::{
    Counts, Key,
    interior::{self, Interior, Sides},
    optics,
};
use crate::{
    accelerate::Geometry,
    snapshot::{Effect, Material, Snapshot},
};
use glam::DVec3;
use snell_components::{
    color::Rgb,
    light::Illumination,
    math,
    method::Methods,
    primitive::{Cost, OFFSET_ULPS, Surface},
    space::Ray,
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
    /// Whether the ray comes from outside.
    pub entering: bool,
    pub key: Key,
}

/// A light at a point, as the terms need it.
pub(super) struct Arriving {
    /// Unit, toward the light.
    pub direction: DVec3,
    /// Of the way to the light as its lamp tells it.
    pub length: f64,
    /// Of the angle to the shading normal; more than zero.
    pub cosine: f64,
    /// What arrives after shadows, linear RGB.
    pub intensity: Rgb,
    /// The share that got through.
    pub visible: Rgb,
}

impl Arriving {
    pub(super) fn weaken(&mut self, visible: Rgb) {
        self.intensity *= visible;
        self.visible = visible;
    }
}

impl Point<'_> {
    /// The term that a light adds; `asks` has the colour of the surface in it, unless that is multiplied later.
    pub(super) fn term(&self, asks: &Effect, light: &Arriving) -> Rgb {
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
    pub(super) fn facing(&self, light: &Illumination) -> Option<Arriving> {
        let length = light.to_light.length();
        let direction = light.to_light * (1.0 / length);
        let cosine = self.surface.shading_normal.dot(direction);
        if cosine <= 0.0 || cosine.is_nan() {
            return None;
        }
        Some(Arriving { direction, length, cosine, intensity: light.intensity, visible: Rgb::ONE })
    }

    /// Share of a light that gets through all that is clear on the way along `ray`, up to `rest` of the `distance` to the
    /// light: every transparent surface weakens it, as do the bodies it goes through. The ray goes straight, even where a
    /// view ray would bend.
    #[inline(never)]
    pub(super) fn through_clear(
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

    /// The normal by which rays are mirrored and bent: the interpolated one, unless that faces away from the ray, as it
    /// may at the silhouette of a smoothed mesh.
    pub(super) fn bending_normal(&self) -> DVec3 {
        let Surface { normal, shading_normal, .. } = self.surface;
        if shading_normal.dot(self.direction) < 0.0 { shading_normal } else { normal }
    }

    /// The mirrored direction; at the true surface where the interpolated normal would send it below that.
    pub(super) fn mirrored(&self) -> DVec3 {
        let mirrored = optics::reflect(self.direction, self.bending_normal());
        if mirrored.dot(self.surface.normal) > 0.0 {
            mirrored
        } else {
            optics::reflect(self.direction, self.surface.normal)
        }
    }

    /// The refracted direction, if any; at the true surface where the interpolated normal would keep it above that.
    pub(super) fn refracted(&self, eta: f64) -> Option<DVec3> {
        if !self.snapshot.settings.refraction {
            return Some(self.direction);
        }
        let refracted = optics::refract(self.direction, self.bending_normal(), eta)?;
        if refracted.dot(self.surface.normal) < 0.0 {
            Some(refracted)
        } else {
            optics::refract(self.direction, self.surface.normal, eta)
        }
    }
}

/// The ratio of indices for Fresnel's equations on a way that does not bend: the angle is taken to be the one on the
/// thinner side, as it is there in truth on entry and exit alike, so that nothing is totally reflected.
pub(super) fn straight_eta(before: f64, after: f64) -> f64 {
    if before < after { before / after } else { after / before }
}

/// Where the way to a light at `distance` ends: before the rounding error of a surface that the light stands on, which
/// must not hide it. `length` is that of the ray's direction.
pub(super) fn short_of_the_light(ray: &Ray, length: f64, distance: f64) -> f64 {
    if distance.is_infinite() {
        return distance;
    }
    let reach = ray.origin.abs().max_element() + length * distance;
    distance - OFFSET_ULPS * f64::EPSILON * reach / length
}
