//! Closed shapes: in and out in turn, and no way through.

use super::{
    Report,
    case::{Case, on_sphere},
};
use crate::render::Key;
use glam::DVec3;
use snell_components::{primitive::Primitive, space::Ray};

/// Rays followed through, and rays from inside, in every placement.
const RAYS: u32 = 600;

/// Silhouettes looked for, and rays about each.
const SILHOUETTES: u32 = 60;
const RAYS_ABOUT: u32 = 24;

/// Cosine below which a ray grazes.
const GRAZING: f64 = 1e-5;

/// No shape is crossed more often by a straight line; what is, does not end.
const MOST_CROSSINGS: usize = 10_000;

pub(super) fn check<P: Primitive>(case: &Case<P>, report: &mut Report) {
    let mut inside = vec![];
    for ray in case.rays(RAYS, 11).map(|ray| from_outside(case, &ray)) {
        match crossings(case, ray) {
            Err(what) => report.add("parity", &case.name, what),
            Ok(crossings) => inside.extend(crossings.chunks(2).filter_map(|pair| match pair {
                [a, b] if a.distance(*b) > 1e-3 * case.size => Some(0.5 * (*a + *b)),
                _ => None,
            })),
        }
    }
    if inside.is_empty() {
        report.add("leak", &case.name, "no ray found the inside");
        return;
    }
    check_leaks(case, &inside, report);
    check_silhouettes(case, &inside, report);
}

/// A ray on the same line that starts outside of the bounds.
fn from_outside<P: Primitive>(case: &Case<P>, ray: &Ray) -> Ray {
    let direction = ray.direction.normalize();
    let way = (case.center - ray.origin).dot(direction) - 3.0 * case.size;
    Ray { origin: ray.origin + direction * way, direction }
}

/// Where a ray from outside crosses the surface.
///
/// # Errors
/// The ray does not enter and leave in turn.
fn crossings<P: Primitive>(case: &Case<P>, start: Ray) -> Result<Vec<DVec3>, String> {
    let mut found = vec![];
    let mut ray = start;
    while let Some(hit) = case.hit(&ray, f64::INFINITY) {
        let surface = case.surface(&ray, hit);
        let cosine = surface.normal.dot(ray.direction);
        if cosine.abs() < GRAZING {
            // Rounding decides whether it is met, and on which side.
            return Ok(vec![]);
        }
        let enters = cosine < 0.0;
        if enters != (found.len() % 2 == 0) {
            let (number, word) = (found.len() + 1, if enters { "enters" } else { "leaves" });
            return Err(format!(
                "{start:?}: crossing {number}, at {}, {word} by its normal {}",
                surface.point, surface.normal
            ));
        }
        found.push(surface.point);
        if found.len() > MOST_CROSSINGS {
            return Err(format!("{start:?}: crosses the surface without end, at {}", surface.point));
        }
        ray.origin = surface.departure(ray.direction, hit.t * ray.direction.length());
    }
    if found.len() % 2 == 0 { Ok(found) } else { Err(format!("{start:?}: enters and does not leave, {found:?}")) }
}

/// Rays from inside in all directions.
fn check_leaks<P: Primitive>(case: &Case<P>, inside: &[DVec3], report: &mut Report) {
    for n in 0..RAYS {
        let key = Key::of_pixel(n, 12, 7);
        let origin = inside[(key.sample(20).x * inside.len() as f64) as usize];
        let ray = Ray { origin, direction: on_sphere(key) };
        if case.hit(&ray, f64::INFINITY).is_none() {
            report.add("leak", &case.name, format!("{ray:?}: starts inside and meets nothing"));
        }
    }
}

/// Rays from inside toward silhouettes, where surfaces end for one who looks from outside: they must meet the surface on
/// one side of them or the other.
fn check_silhouettes<P: Primitive>(case: &Case<P>, inside: &[DVec3], report: &mut Report) {
    for n in 0..SILHOUETTES {
        let key = Key::of_pixel(n, 13, 7);
        let Some(silhouette) = silhouette(case, key) else { continue };
        let start = inside[n as usize % inside.len()];
        for m in 0..RAYS_ABOUT {
            let place = on_sphere(key.child(4 + m));
            // From steps as small as rounding to a ten-thousandth of the shape.
            let reach = case.size * [0.0, 1e-15, 1e-12, 1e-8, 1e-4][m as usize % 5];
            let ray = Ray { origin: start, direction: silhouette + place * reach - start };
            if ray.is_valid() && case.hit(&ray, f64::INFINITY).is_none() {
                report.add("leak", &case.name, format!("{ray:?}: starts inside toward a silhouette and meets nothing"));
            }
        }
    }
}

/// A point where a line of sight just touches the shape: found by halving between one that hits and one that does not.
fn silhouette<P: Primitive>(case: &Case<P>, key: Key) -> Option<DVec3> {
    let origin = case.center + on_sphere(key) * 4.0 * case.size;
    let toward = |target: DVec3| Ray { origin, direction: (target - origin).normalize() };
    let hit = |target: DVec3| case.hit(&toward(target), f64::INFINITY);
    let (mut hits, mut misses) =
        (case.somewhere(key.child(1)), case.center + on_sphere(key.child(2)) * 2.0 * case.size);
    if hit(hits).is_none() || hit(misses).is_some() {
        return None;
    }
    let mut gap = f64::INFINITY;
    while hits.distance(misses) < gap {
        gap = hits.distance(misses);
        let middle = 0.5 * (hits + misses);
        if hit(middle).is_some() { hits = middle } else { misses = middle }
    }
    Some(toward(hits).at(hit(hits)?.t))
}
