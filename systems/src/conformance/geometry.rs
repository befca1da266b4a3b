//! Hits, surfaces and normals.

use super::{Report, case::Case};
use crate::render::Key;
use glam::{DVec2, DVec3};
use snell_components::{
    method::Methods,
    packet::{Hits, Mask, PACKET, Packet, each, vector_of},
    primitive::{Cost, Hit, Primitive, Surface, surface_alone},
    space::Ray,
    surfaces::{Meeting, Surfaces},
};

/// Rays that a shape is tried with in every placement.
const RAYS: u32 = 1200;

/// Largest sine of the angle between a normal and what finite differences say.
const NORMAL_TOLERANCE: f64 = 1e-3;

pub(super) fn check<P: Primitive>(case: &Case<P>, report: &mut Report) {
    let mut hits = 0;
    for (n, ray) in (0..).zip(case.rays(RAYS, 1)) {
        let hit = check_nearest(case, &ray, Key::of_pixel(n, 2, 7), report);
        if let Some(hit) = hit {
            hits += 1;
            check_hit(case, &ray, hit, report);
        }
    }
    check_packets(case, report);
    if hits == 0 {
        report.add("bounds", &case.name, format!("none of {RAYS} rays into the bounds hits anything"));
    }
}

/// Rays together against the same rays alone, to the last bit, with limits before, at and behind what they hit.
fn check_packets<P: Primitive>(case: &Case<P>, report: &mut Report) {
    let rays: Vec<Ray> = case.rays(RAYS / 4, 3).collect();
    for (n, rays) in (0..).zip(rays.chunks(PACKET)) {
        let (mut packet, mut t_max) = (Packet::default(), [f64::INFINITY; PACKET]);
        // Not all of a packet are asked for.
        let asked = Key::of_pixel(n, 4, 7).child(n).sample(0).x.to_bits() | 1;
        for (i, ray) in rays.iter().enumerate() {
            let t = case.hit(ray, f64::INFINITY).map_or(1.0, |hit| hit.t);
            t_max[packet.push(ray)] = [f64::INFINITY, t, t.next_up(), t.next_down(), 0.5 * t][i % 5];
        }
        for asked in [packet.all(), packet.all() & asked, packet.all() & 0x8000_0400_0000_0010] {
            let (mut hits, mut cost) = (Hits::default(), Cost::default());
            let met = P::hit_packet(&case.packed, &packet, asked, &t_max, &mut hits, &mut cost);
            check_surfaces(case, &packet, met, &hits, report);
            let blocked = P::blocks_packet(&case.packed, &packet, asked, &t_max, &mut cost);
            for (i, ray) in rays.iter().enumerate() {
                let is = |mask: Mask| mask >> i & 1 == 1;
                let alone = case.hit(ray, t_max[i]).filter(|_| is(asked)).map(|hit| (hit.t.to_bits(), hit.part));
                let together = is(met).then(|| (hits.t[i].to_bits(), hits.part[i]));
                if together != alone {
                    let what = format!("{ray:?} up to {:?}: alone {alone:x?}, in a packet {together:x?}", t_max[i]);
                    report.add("packet", &case.name, what);
                }
                let alone = is(asked) && P::blocks(&case.packed, ray, t_max[i], &mut cost);
                if is(blocked) != alone {
                    let what = format!("{ray:?} up to {:?}: blocked alone {alone}, in a packet not so", t_max[i]);
                    report.add("packet", &case.name, what);
                }
            }
        }
    }
}

/// The surfaces that rays met together against those of the same rays alone, to the last bit.
fn check_surfaces<P: Primitive>(case: &Case<P>, packet: &Packet, met: Mask, hits: &Hits, report: &mut Report) {
    let textured = met & 0x5a5a_5a5a_0ff0_3333;
    let shape = [1; PACKET];
    let meeting = Meeting { packet, rays: met, textured, shape: &shape, t: &hits.t, part: &hits.part };
    // What others stand on is not to be touched.
    let other = Surface {
        point: DVec3::splat(1.25),
        normal: DVec3::X,
        shading_normal: DVec3::Z,
        uv: DVec2::splat(0.75),
        slot: 77,
        error: 3.0,
    };
    let mut surfaces = Surfaces::default();
    (0..PACKET).for_each(|i| surfaces.set(i, &other, DVec3::splat(0.5)));
    let mut expected = surfaces.clone();
    P::surface_packet(&[case.packed.clone(), case.packed.clone()], &meeting, &mut surfaces);
    for i in each(met) {
        let (ray, _, hit) = meeting.of(i);
        surface_alone::<P>(&case.packed, &ray, hit, textured >> i & 1 != 0, i, &mut expected);
    }
    for i in 0..PACKET {
        let asked = textured >> i & 1 != 0 || met >> i & 1 == 0;
        let numbers = |of: &Surfaces| {
            let Surface { point, normal, shading_normal, uv, slot, error } = of.get(i);
            let lift = vector_of(&of.lift, i);
            let uv = if asked { uv.to_array() } else { [0.0; 2] };
            let vectors = [point, normal, shading_normal, lift].map(|v| v.to_array().map(f64::to_bits));
            (vectors, uv.map(f64::to_bits), slot, error.to_bits())
        };
        if numbers(&surfaces) != numbers(&expected) {
            let (alone, together) = (expected.get(i), surfaces.get(i));
            let lifts = (vector_of(&expected.lift, i), vector_of(&surfaces.lift, i));
            let what = format!(
                "{:?}: the surface met alone is {alone:?}, in a packet {together:?}; lifts {lifts:?}",
                packet.ray(i)
            );
            report.add("packet", &case.name, what);
        }
    }
}

/// The nearest hit, if it is told alike in all ways.
fn check_nearest<P: Primitive>(case: &Case<P>, ray: &Ray, key: Key, report: &mut Report) -> Option<Hit> {
    let hit = case.hit(ray, f64::INFINITY);
    let exhaustive = P::hit_with(&case.packed, ray, f64::INFINITY, &Methods::BRUTE_FORCE, &mut Cost::default());
    let bits = |hit: Option<Hit>| hit.map(|hit| (hit.t.to_bits(), hit.part));
    if bits(hit) != bits(exhaustive) {
        report.add("nearest", &case.name, format!("{ray:?}: `hit` gives {hit:?}, without a tree {exhaustive:?}"));
    }
    let blocks = |t_max| P::blocks(&case.packed, ray, t_max, &mut Cost::default());
    if blocks(f64::INFINITY) != hit.is_some() {
        report.add("blocks", &case.name, format!("{ray:?}: `blocks` differs from `hit`, {hit:?}"));
    }
    let hit = hit?;
    if !(hit.t.is_finite() && hit.t > 0.0) {
        report.add("nearest", &case.name, format!("{ray:?}: the distance {} is not positive and finite", hit.t));
        return None;
    }
    if bits(case.hit(ray, hit.t)) != bits(Some(hit)) {
        report.add("nearest", &case.name, format!("{ray:?}: the hit {hit:?} is lost if `t_max` is its own distance"));
    }
    if blocks(hit.t) || !blocks(hit.t.next_up()) {
        report.add("blocks", &case.name, format!("{ray:?}: blocked exactly where it is hit, {hit:?}, must be not"));
    }
    for n in 0..3 {
        let limit = if n == 0 { hit.t.next_down() } else { hit.t * key.sample(n).x };
        if let Some(nearer) = case.hit(ray, limit) {
            let what = format!("{ray:?}: with `t_max` {limit:?} it hits {nearer:?}, without limit {hit:?}");
            report.add("nearest", &case.name, what);
        }
    }
    Some(hit)
}

fn check_hit<P: Primitive>(case: &Case<P>, ray: &Ray, hit: Hit, report: &mut Report) {
    let rounding = case.rounding(ray, hit.t);
    let at = ray.at(hit.t);
    if let Some(bounds) = case.bounds {
        let outside = (bounds.min - at).max(at - bounds.max).max_element();
        if outside > rounding {
            report.add("bounds", &case.name, format!("{ray:?}: the hit {at} lies {outside:e} outside of {bounds:?}"));
        }
    }
    let surface = case.surface(ray, hit);
    let Surface { point, normal, shading_normal, uv, error, .. } = surface;
    let off = point.distance(at);
    // Along a grazing ray the point and the surface may be far apart.
    let slope = (normal.dot(ray.direction).abs() / ray.direction.length()).max(1e-6);
    let unit = |v: DVec3| (v.length() - 1.0).abs() < 1e-9;
    let fault = if !(unit(normal) && unit(shading_normal)) {
        Some(format!("normals are not of length 1: {normal}, {shading_normal}"))
    } else if !(uv.is_finite() && error.is_finite() && error >= 0.0) {
        Some(format!("uv {uv} or error {error} is not a finite number"))
    } else if off.is_nan() || off * slope > error + rounding {
        Some(format!("the point {point} lies {off:e} from the hit, more than its error {error:e}"))
    } else {
        None
    };
    if let Some(fault) = fault {
        report.add("surface", &case.name, format!("{ray:?}: {fault}"));
        return;
    }
    let bare = Surface { uv, ..P::surface_without_uv(&case.packed, ray, hit) };
    if bare != surface {
        report.add(
            "surface",
            &case.name,
            format!("{ray:?}: without texture coordinates it is {bare:?}, not {surface:?}"),
        );
    }
    check_normal(case, ray, &surface, report);
    check_departure(case, ray, hit, &surface, report);
}

/// Compares the normal with the plane through the hits of neighbouring rays.
fn check_normal<P: Primitive>(case: &Case<P>, ray: &Ray, surface: &Surface, report: &mut Report) {
    let direction = ray.direction.normalize();
    // Hits of grazing rays are far apart.
    if surface.normal.dot(direction).abs() < 0.2 {
        return;
    }
    let u = direction.any_orthonormal_vector();
    let v = direction.cross(u);
    // Steps are as small as rounding allows: the smaller, the less is in reach beside the surface at hand.
    let least = 64.0 * f64::EPSILON * (ray.origin.abs().max_element() + case.center.abs().max_element() + case.size);
    let mut best: Option<(f64, DVec3)> = None;
    for share in [1e-3, 1e-4, 1e-5, 1e-6] {
        let step = (share * case.size).max(least / NORMAL_TOLERANCE);
        let neighbour = |offset: DVec3| {
            let ray = Ray { origin: ray.origin + offset, direction: ray.direction };
            let point = case.surface(&ray, case.hit(&ray, f64::INFINITY)?).point;
            // Those on another part of the surface tell nothing.
            (point.distance(surface.point) < 10.0 * step).then_some(point)
        };
        let [right, left] = [u * step, -u * step].map(neighbour);
        let [above, below] = [v * step, -v * step].map(neighbour);
        // From one side to the other the bend of the surface cancels. Beside an edge, one corner at least has its three
        // points on one side of it.
        let here = Some(surface.point);
        let corners = [(right, above), (right, below), (left, above), (left, below)];
        let along = corners.map(|(a, b)| (here, a, here, b));
        for (from, a, back, b) in [(left, right, below, above)].into_iter().chain(along) {
            let ways = from.zip(a).map(|(from, to)| to - from).zip(back.zip(b).map(|(from, to)| to - from));
            let Some(found) = ways.and_then(|(u, v)| u.cross(v).try_normalize()) else { continue };
            let sine = found.cross(surface.normal).length();
            if sine < NORMAL_TOLERANCE {
                return;
            }
            if best.is_none_or(|(least, _)| sine < least) {
                best = Some((sine, found));
            }
        }
    }
    if let Some((sine, found)) = best {
        let what =
            format!("{ray:?}: the normal {} is off by a sine of {sine:.2e}: hits nearby say ±{found}", surface.normal);
        report.add("normal", &case.name, what);
    }
}

/// Follows a ray away from the surface, on the side that it came from.
fn check_departure<P: Primitive>(case: &Case<P>, ray: &Ray, hit: Hit, surface: &Surface, report: &mut Report) {
    let side = if surface.normal.dot(ray.direction) < 0.0 { surface.normal } else { -surface.normal };
    let origin = surface.departure(side, hit.t * ray.direction.length());
    let away = Ray { origin, direction: side };
    let step = origin.distance(surface.point);
    // What is met within a few steps is the surface that was left.
    if let Some(again) = case.hit(&away, 4.0 * step) {
        let what =
            format!("{ray:?}: a ray that leaves the hit along its normal meets the shape again at {:e}", again.t);
        report.add("departure", &case.name, what);
    }
}

/// Compares hits of the shape as it is with those in other placements.
pub(super) fn check_placements<P: Primitive>(cases: &[Case<P>], report: &mut Report) {
    let Some((first, others)) = cases.split_first() else { return };
    for case in others {
        let map = case.placed * first.placed.inverse();
        // A few rays graze the surface and may or may not hit it.
        let (mut rays, mut lost) = (0, 0);
        for ray in first.rays(300, 3) {
            let moved =
                Ray { origin: map.transform_point3(ray.origin), direction: map.transform_vector3(ray.direction) };
            // Rays along a plane meet it at the end of the world, if at all.
            let near = 1e6 * first.size / ray.direction.length();
            let [a, b] = [first.hit(&ray, near), case.hit(&moved, near)];
            rays += 1;
            let (Some(a), Some(b)) = (a, b) else {
                lost += u32::from(a.is_some() != b.is_some());
                continue;
            };
            let normal = first.surface(&ray, a).normal;
            let slope = (normal.dot(ray.direction).abs() / ray.direction.length()).max(1e-6);
            let expected = map.transform_point3(ray.at(a.t));
            let off = case.surface(&moved, b).point.distance(expected);
            let scale = case.size / first.size;
            let allowed =
                16.0 * (case.rounding(&moved, b.t) + scale * first.rounding(&ray, a.t)) / slope + 1e-9 * case.size;
            if (off.is_nan() || off > allowed) && slope > 1e-3 {
                let what = format!("{ray:?} hits at {}; placed, the hit is {off:e} from where it should be", a.t);
                report.add("placement", &case.name, what);
            }
        }
        if lost * 50 > rays {
            report.add(
                "placement",
                &case.name,
                format!("{lost} of {rays} rays hit in one placement and not in another"),
            );
        }
    }
}
