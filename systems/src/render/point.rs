//! One point of a surface: what is worked out for its ray alone.

use super::{Key, optics};
use crate::snapshot::{Effect, Material, Snapshot};
use glam::DVec3;
use snell_components::{
    color::Rgb,
    light::Illumination,
    math,
    primitive::{OFFSET_ULPS, Surface},
    space::Ray,
};

/// A point to be shaded, its normals turned toward the viewer.
pub(super) struct Point<'a> {
    pub snapshot: &'a Snapshot,
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
