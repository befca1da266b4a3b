//! Which hits of triangles a walk comes to, so that trees and lists agree on them whatever the numbers.
//!
//! Where coordinates of one triangle differ by fifteen digits and more, an edge function rounds away what is small, and a
//! ray that passes far beside the triangle seems to hit it. A list would take such a hit and a tree would not, whose boxes
//! the ray misses. So a hit counts only if a walk comes to the triangle's own box in time for it: boxes only grow toward
//! the root, and a walk that comes to the smallest comes to all.

use super::{
    Box32, Node,
    box_ray::{BoxRay, is_beyond_boxes, larger},
};
use crate::{
    lanes::{self, Job, Lanes, vector},
    space::{Bounds, Ray},
};
use glam::DVec3;

/// Roundings of the point of a hit, in ulps, within which it is surely come to: a quarter of what a walk allows.
const ULPS: f64 = 16.0;

/// Whether a walk along `ray` comes to a triangle's box in time for a hit of the triangle at `t`.
#[inline]
pub(crate) fn reaches(ray: &Ray, vertices: &[DVec3; 3], t: f64) -> bool {
    let [a, b, c] = *vertices;
    let bounds = Bounds { min: a.min(b).min(c), max: a.max(b).max(c) };
    // Nearly always the point lies in the box, but for a rounding far below what a walk allows on every axis.
    let way = ray.direction * t;
    let slack = (way.abs() + ray.origin.abs().max_element()) * (ULPS * f64::EPSILON);
    let point = ray.origin + way;
    let within = (bounds.min - slack).cmple(point) & point.cmple(bounds.max + slack);
    within.all() || enters(ray, &Box32::around(&bounds), t)
}

/// Whether [`reaches`] says yes at its first look, by the same arithmetic on lanes; where not, it is to be asked.
///
/// The box around the triangle is told as its least and greatest coordinates; the last of each four is 0.
#[inline(always)]
pub(crate) fn surely_reaches<L: Lanes>(lanes: L, ray: &Ray, [min, max]: [[f32; 4]; 2], t: f64) -> bool {
    let l = lanes;
    let four = |v: DVec3| [v.x, v.y, v.z, 0.0];
    let reach = ray.origin.abs();
    let reach = larger(larger(reach.x, reach.y), reach.z);
    let way = l.d_mul(l.d_load(&four(ray.direction)), l.d_splat(t));
    let slack = l.d_mul(l.d_add(l.d_abs(way), l.d_splat(reach)), l.d_splat(ULPS * f64::EPSILON));
    let point = l.d_add(l.d_load(&four(ray.origin)), way);
    let from = l.d_le(l.d_sub(l.d_widen(&min), slack), point);
    let to = l.d_le(point, l.d_add(l.d_widen(&max), slack));
    from & to == 0b1111
}

/// [`surely_reaches`] of four rays, each with a box of its own: least and greatest, by axis.
#[inline(always)]
pub(crate) fn four_surely_reach<L: Lanes>(
    l: L,
    origins: vector::Four<L>,
    directions: vector::Four<L>,
    [min, max]: &[[[f32; 4]; 3]; 2],
    t: L::D,
) -> u32 {
    let reach = vector::reach(l, origins);
    let mut within = 0b1111;
    for axis in 0..3 {
        let way = l.d_mul(directions[axis], t);
        let slack = l.d_mul(l.d_add(l.d_abs(way), reach), l.d_splat(ULPS * f64::EPSILON));
        let point = l.d_add(origins[axis], way);
        within &= l.d_le(l.d_sub(l.d_widen(&min[axis]), slack), point);
        within &= l.d_le(point, l.d_add(l.d_widen(&max[axis]), slack));
    }
    within
}

/// Whether a walk would enter a node's child of that box before `t`, by the very arithmetic of the walk.
#[cold]
fn enters(ray: &Ray, bounds: &Box32, t: f64) -> bool {
    struct Enter<'a>(&'a Ray, &'a Node, f64);

    impl Job for Enter<'_> {
        type Output = bool;

        #[inline(always)]
        fn run<L: Lanes>(self, lanes: L) -> bool {
            let Self(ray, node, t) = self;
            BoxRay::new(lanes, ray).enter(lanes, node, super::box_ray::above(t)).1 & 1 != 0
        }
    }

    if is_beyond_boxes(ray.origin) {
        return true;
    }
    let mut node = Node::EMPTY;
    for axis in 0..3 {
        (node.planes[axis][0], node.planes[axis + 3][0]) = (bounds.min[axis], bounds.max[axis]);
    }
    lanes::run(Enter(ray, &node, t))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_beside_or_behind_the_box_is_not_reached() {
        let flat = [DVec3::new(0.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.0, 1.0, 1.0)];
        let down = Ray { origin: DVec3::new(0.3, 3.0, 0.3), direction: DVec3::NEG_Y };
        assert!(reaches(&down, &flat, 2.0));
        assert!(reaches(&down, &flat, 2.0f64.next_down()), "a rounding before it");
        assert!(!reaches(&down, &flat, 1.0), "before it is met");
        assert!(!reaches(&Ray { origin: DVec3::new(1.1, 3.0, 0.3), ..down }, &flat, 2.0), "beside it");
        assert!(!reaches(&Ray { direction: DVec3::Y, ..down }, &flat, 2.0), "behind");
        // Where the point is not within the box, the walk decides: this ray enters it long before.
        assert!(reaches(&down, &flat, 5.0));
    }
}
