//! Cutting faces into triangles.
//!
//! A polygon is looked at along the coordinate axis nearest to its Newell normal, which keeps the coordinates as they
//! are: products of differences of `f32` values are all but always exact in `f64`, and so are the signs on which every
//! decision rests.
//!
//! Whatever order corners are cut off in, the windings of the triangles add up to the winding of the polygon. If all of
//! them turn like the polygon, each point of a simple polygon is therefore covered exactly once: that is the test.

use glam::{DVec2, DVec3};

/// Corners up to which a polygon that is no fan is cut by its ears, at a cost that grows with their square.
const MOST_EARS: usize = 4096;

/// Cuts a polygon into its `n − 2` triangles, given as corner numbers that turn as the polygon does.
///
/// False if the polygon crosses itself, has no area or is too large to be cut: the triangles are then a fan.
pub(super) fn cut(corners: &[DVec3], triangles: &mut Vec<[usize; 3]>) -> bool {
    let flat = flattened(corners);
    triangles.clear();
    triangles.extend((1..corners.len().saturating_sub(1)).map(|i| [0, i, i + 1]));
    let is_fan = flat.as_ref().is_some_and(|p| triangles.iter().all(|&[a, b, c]| cross(p[a], p[b], p[c]) > 0.0));
    if is_fan {
        return true;
    }
    match flat.filter(|p| p.len() <= MOST_EARS).and_then(|p| ears(&p)) {
        Some(ears) => {
            *triangles = ears;
            true
        }
        None => false,
    }
}

/// The corners without one of their coordinates, seen so that they turn counter-clockwise.
fn flattened(corners: &[DVec3]) -> Option<Vec<DVec2>> {
    let origin = *corners.first()?;
    let mut normal = DVec3::ZERO;
    let mut last = *corners.last()? - origin;
    for &corner in corners {
        let here = corner - origin;
        normal += last.cross(here);
        last = here;
    }
    let size = normal.abs().max_element();
    if size == 0.0 {
        return None;
    }
    let (u, v, w) = match normal.abs().to_array() {
        [x, _, _] if x == size => (1, 2, 0),
        [_, y, _] if y == size => (2, 0, 1),
        _ => (0, 1, 2),
    };
    let (u, v) = if normal[w] > 0.0 { (u, v) } else { (v, u) };
    Some(corners.iter().map(|p| DVec2::new(p[u], p[v])).collect())
}

/// Twice the signed area of a triangle; positive if it turns counter-clockwise.
fn cross(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Cuts off one ear after the other: a corner whose triangle holds no other corner. A corner without area is cut off
/// only where there is no ear, so that a point on an edge stays a corner of the triangles on both its sides.
fn ears(points: &[DVec2]) -> Option<Vec<[usize; 3]>> {
    let mut ring: Vec<usize> = (0..points.len()).collect();
    let mut triangles = Vec::with_capacity(ring.len().saturating_sub(2));
    let mut at = 0;
    // Keeps adversarial polygons from cubic time; others need a small multiple of their size.
    let mut looks = 16 * points.len();
    while ring.len() >= 3 {
        let len = ring.len();
        let triangle = |i: usize| [ring[(i + len - 1) % len], ring[i], ring[(i + 1) % len]];
        // Outwards from the last cut: where there are few ears, the next is beside it.
        let mut near = (0..len).map(|k| if k % 2 == 0 { at + k / 2 } else { at + len - k.div_ceil(2) } % len);
        let is_next = |i: &usize| {
            looks = looks.saturating_sub(1);
            looks > 0 && is_ear(triangle(*i), &ring, points)
        };
        let ear = near.find(is_next).or_else(|| (0..len).find(|&i| area(triangle(i), points) == 0.0))?;
        triangles.push(triangle(ear));
        ring.remove(ear);
        // From one corner on, so that neighbours are not cut one after the other into slivers with a common corner.
        at = (ear + 1) % (len - 1);
    }
    Some(triangles)
}

fn area([a, b, c]: [usize; 3], points: &[DVec2]) -> f64 {
    cross(points[a], points[b], points[c])
}

/// Whether a corner's triangle has an area and no corner of the ring inside or on its edge. Corners at the same place
/// as one of its own do not count: polygons with holes touch themselves there.
fn is_ear(triangle: [usize; 3], ring: &[usize], points: &[DVec2]) -> bool {
    let [a, b, c] = triangle.map(|i| points[i]);
    let inside = |p: DVec2| cross(a, b, p) >= 0.0 && cross(b, c, p) >= 0.0 && cross(c, a, p) >= 0.0;
    let blocks = |p: DVec2| inside(p) && p != a && p != b && p != c;
    cross(a, b, c) > 0.0 && !ring.iter().any(|&i| blocks(points[i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat3, DQuat};

    fn sin(radians: f64) -> f64 {
        snell_components::math::sin_cos_degrees(radians.to_degrees()).0
    }

    fn cos(radians: f64) -> f64 {
        snell_components::math::sin_cos_degrees(radians.to_degrees()).1
    }

    fn in_plane(points: &[[f64; 2]]) -> Vec<DVec3> {
        points.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect()
    }

    /// Twice the area as a vector.
    fn newell(corners: &[DVec3]) -> DVec3 {
        (0..corners.len()).map(|i| corners[i].cross(corners[(i + 1) % corners.len()])).sum()
    }

    /// Cuts a flat simple polygon and checks that its triangles turn as it does and cover its area.
    fn check(corners: &[DVec3]) -> Vec<[usize; 3]> {
        let mut triangles = vec![];
        assert!(cut(corners, &mut triangles), "not cut: {} corners from {:?}", corners.len(), corners[0]);
        assert_eq!(triangles.len(), corners.len() - 2);
        let whole = newell(corners);
        let mut sum = 0.0;
        for triangle in &triangles {
            let part = newell(&triangle.map(|i| corners[i])).dot(whole.normalize());
            assert!(
                part >= -1e-12 * whole.length(),
                "flipped: {triangle:?} of {} corners from {:?}",
                corners.len(),
                corners[0]
            );
            sum += part;
        }
        assert!((sum - whole.length()).abs() <= 1e-9 * whole.length());
        triangles
    }

    /// The polygon as it is, reversed, started at every corner, and turned in space.
    fn check_everywhere(points: &[[f64; 2]]) {
        let tilted = DMat3::from_quat(DQuat::from_xyzw(0.1, 0.7, -0.5, 0.5).normalize());
        for start in 0..points.len() {
            let mut corners = in_plane(points);
            corners.rotate_left(start);
            for to in [DMat3::IDENTITY, tilted, DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X)] {
                let mut placed: Vec<DVec3> = corners.iter().map(|&p| to * p + DVec3::splat(3.0)).collect();
                check(&placed);
                placed.reverse();
                check(&placed);
            }
        }
    }

    #[test]
    fn convex_polygons_are_fans() {
        let hexagon = [[2.0, 0.0], [1.0, 2.0], [-1.0, 2.0], [-2.0, 0.0], [-1.0, -2.0], [1.0, -2.0]];
        assert_eq!(check(&in_plane(&hexagon)), [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]]);
        check_everywhere(&hexagon);
    }

    #[test]
    fn concave_polygons_are_cut_by_their_ears() {
        check_everywhere(&[[0.0, 0.0], [4.0, 1.0], [0.0, 2.0], [1.0, 1.0]]);
        check_everywhere(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]]);
        let star: Vec<_> = (0..10)
            .map(|i| {
                let (angle, radius) = (f64::from(i) * std::f64::consts::PI / 5.0, if i % 2 == 0 { 3.0 } else { 1.0 });
                [radius * cos(angle), radius * sin(angle)]
            })
            .collect();
        check_everywhere(&star);
        let mut comb = vec![[40.0, -1.0], [40.0, 0.0]];
        comb.extend((0..40).rev().map(|i| [f64::from(i), if i % 2 == 0 { 0.0 } else { 10.0 }]));
        comb.push([0.0, -1.0]);
        check_everywhere(&comb);
    }

    #[test]
    fn a_point_on_an_edge_stays_a_corner() {
        let square = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let corners = in_plane(&square);
        for [a, b, c] in check(&corners) {
            assert!((corners[b] - corners[a]).cross(corners[c] - corners[a]).z > 0.0);
        }
        check_everywhere(&square);
    }

    #[test]
    fn a_hole_joined_to_the_rim_stays_open() {
        let (rim, hole) =
            ([[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0]], [[3.0, 3.0], [3.0, 6.0], [6.0, 6.0], [6.0, 3.0]]);
        let ring: Vec<_> = rim.into_iter().chain([rim[0]]).chain(hole).chain([hole[0]]).collect();
        check_everywhere(&ring);
    }

    #[test]
    fn random_simple_polygons_are_covered_once() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / (1u64 << 24) as f64
        };
        for round in 0..300 {
            let count = 4 + round % 60;
            // Radii at increasing angles, bent by a twist that keeps circles circles: simple, and seldom star-shaped.
            let points: Vec<_> = (0..count)
                .map(|i| {
                    let radius = 0.05 + random();
                    let angle = f64::from(i) / f64::from(count) * std::f64::consts::TAU + 6.0 * radius;
                    DVec3::new(radius * cos(angle), radius * sin(angle), 0.0)
                })
                .collect();
            if is_simple(&points) {
                check(&points);
            }
            let points: Vec<_> = (0..count)
                .map(|i| {
                    let (angle, radius) = (f64::from(i) / f64::from(count) * std::f64::consts::TAU, 0.05 + random());
                    DVec3::new(radius * cos(angle), 0.0, radius * sin(angle))
                })
                .collect();
            check(&points);
        }
    }

    fn is_simple(points: &[DVec3]) -> bool {
        let flat: Vec<_> = points.iter().map(|p| p.truncate()).collect();
        let edge = |i: usize| (flat[i], flat[(i + 1) % flat.len()]);
        let apart = |(a, b): (DVec2, DVec2), (c, d): (DVec2, DVec2)| {
            cross(a, b, c) * cross(a, b, d) > 0.0 || cross(c, d, a) * cross(c, d, b) > 0.0
        };
        let next = |i: usize, j: usize| (i + 1) % flat.len() == j || (j + 1) % flat.len() == i;
        (0..flat.len()).all(|i| (0..i).all(|j| next(i, j) || apart(edge(i), edge(j))))
    }

    #[test]
    fn crossed_flat_and_endless_polygons_are_fans() {
        let mut triangles = vec![];
        let bow = in_plane(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
        assert!(!cut(&bow, &mut triangles));
        assert_eq!(triangles, [[0, 1, 2], [0, 2, 3]]);
        assert!(!cut(&in_plane(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]]), &mut triangles));
        assert!(!cut(&[DVec3::ONE; 5], &mut triangles));
        assert!(!cut(&[], &mut triangles) && triangles.is_empty());
        let zigzag: Vec<_> = (0..100_000).map(|i| DVec3::new(f64::from(i), f64::from(i % 2), 0.0)).collect();
        cut(&zigzag, &mut triangles);
        assert_eq!(triangles.len(), 99_998);
    }

    #[test]
    fn large_polygons_take_little_time() {
        // A double spiral: few of its corners are ears at any time.
        let arm = |i: i32, width: f64| {
            let angle = f64::from(i) * 0.05;
            [(angle + width) * cos(angle), (angle + width) * sin(angle)]
        };
        let points: Vec<_> = (20..2000).map(|i| arm(i, 1.0)).chain((20..2000).rev().map(|i| arm(i, 0.0))).collect();
        check(&in_plane(&points));
    }
}
