//! How much of a surface a ray stands for, for textures that filter.
//!
//! Two rays run beside every ray, a small part of a pixel to its right and below it. What lies between them and the ray,
//! scaled up again, is the ray's footprint: ray differentials (Igehy: Tracing Ray Differentials, 1999) as differences.
//! They search for nothing. At a surface that their ray meets they cross its tangent plane and are mirrored and bent by
//! the very code that does it to the ray, so that curved shapes and interpolated normals spread or gather the footprint,
//! and a shape from outside need not know of any of this.
//!
//! Where no texture filters, `()` stands in for the two rays, and nothing of all this is compiled into the walk.

use super::{observe::Way, onward::Branch, point::Point};
use crate::{
    accelerate::{Geometry, Nearest},
    snapshot::Snapshot,
};
use glam::{DVec2, DVec3};
use snell_components::{math, primitive::Surface, space::Ray, texture::Footprint};

/// How far beside its ray a neighbour runs, as a part of the distance to the next ray of the picture.
const STEP: f64 = 1.0 / 4096.0;

/// What runs beside a ray.
pub(super) trait Beside: Copy {
    /// Whether anything does.
    const RUNS: bool;

    /// What is known where the ray met a surface.
    type Met: Copy;

    /// At the surface that the ray met.
    fn meet(self, point: &Point<'_>, met: &Nearest) -> Self::Met;

    /// How much of the surface the ray stands for.
    fn footprint(met: &Self::Met, surface: &Surface) -> Footprint;

    /// Beside a ray that goes on from the surface.
    fn go_on(met: &Self::Met, point: &Point<'_>, branch: &Branch) -> Self;
}

impl Beside for () {
    const RUNS: bool = false;

    type Met = ();

    fn meet(self, _: &Point<'_>, _: &Nearest) {}

    fn footprint(&(): &(), _: &Surface) -> Footprint {
        Footprint::default()
    }

    fn go_on(&(): &(), _: &Point<'_>, _: &Branch) {}
}

/// The two rays; none where one was lost: it does not reach the tangent plane, or is mirrored where its ray is bent.
pub(super) type Neighbours = [Option<Ray>; 2];

/// Beside the ray through a point of the picture, in pixels; `spacing` is the distance to the next rays, in pixels.
pub(super) fn neighbours(snapshot: &Snapshot, x: f64, y: f64, spacing: f64) -> Neighbours {
    let Snapshot { view, settings, .. } = snapshot;
    let step = STEP * spacing;
    [(x + step, y), (x, y + step)].map(|(x, y)| Some(view.ray(x, y, settings.width, settings.height)))
}

impl Beside for Neighbours {
    const RUNS: bool = true;

    /// Directions of the two rays, and the surface where they cross its tangent plane.
    type Met = [Option<(DVec3, Surface)>; 2];

    fn meet(self, point: &Point<'_>, met: &Nearest) -> Self::Met {
        if !point.material.is_filtered() && !point.material.goes_on() {
            return [None; 2];
        }
        self.map(|ray| Some((ray?.direction, surface_beside(&point.snapshot.geometry, point, met, &ray?)?)))
    }

    fn footprint(met: &Self::Met, surface: &Surface) -> Footprint {
        let apart = met.map(|met| {
            met.map_or((DVec2::INFINITY, DVec3::INFINITY), |(_, beside)| {
                let [u, v] = (beside.uv - surface.uv).to_array().map(across_a_seam);
                (DVec2::new(u, v) / STEP, (beside.point - surface.point) / STEP)
            })
        });
        Footprint { uv: apart.map(|(uv, _)| uv), point: apart.map(|(_, point)| point) }
    }

    fn go_on(met: &Self::Met, point: &Point<'_>, branch: &Branch) -> Self {
        met.map(|met| {
            let (direction, surface) = met?;
            let beside = Point { direction, surface, ..*point };
            let direction =
                if branch.way == Way::Mirrored { beside.mirrored() } else { beside.refracted(branch.eta)? };
            // As the ray itself, so that both leave alike.
            let ray = Ray { origin: surface.departure(branch.direction, point.travelled), direction };
            ray.is_valid().then_some(ray)
        })
    }
}

/// The surface where a ray beside that of `point` crosses its tangent plane, its normals turned as those of the point.
fn surface_beside(geometry: &Geometry, point: &Point<'_>, met: &Nearest, ray: &Ray) -> Option<Surface> {
    let Surface { normal, point: at, .. } = point.surface;
    let t = normal.dot(at - ray.origin) / normal.dot(ray.direction);
    if !t.is_finite() {
        return None;
    }
    let mut surface = geometry.beside(met, ray, t);
    if !point.entering {
        surface.normal = -surface.normal;
        surface.shading_normal = -surface.shading_normal;
    }
    Some(surface)
}

/// A step of a texture coordinate without the jump by one that it makes at the seam of a sphere.
fn across_a_seam(step: f64) -> f64 {
    let rest = step - math::floor(step + 0.5);
    // Far away on a plane a step may truly be so large.
    if step.abs() < 1.5 && rest.abs() < 0.0625 { rest } else { step }
}
