//! A ray prepared for tests of boxes, which err on the safe side only.

use super::Node;
use crate::{lanes::Lanes, space::Ray};
use glam::DVec3;

/// Relative slack on distances: four roundings of `f32` on either side, of which three occur.
const SLACK: f64 = 4.0 / (1u64 << 24) as f64;

/// How far a ray is widened, in ulps of its origin's largest coordinate: an exact test takes the ray to its own space
/// first, and may find a hit that much beside the ray, and so outside the bounds. Matters for rays along an axis alone;
/// on all others the slack on distances is far larger.
const ORIGIN_ULPS: f64 = 64.0;

/// More than the rounding of any number to `f32`, relative; and the least `f32`, for those near zero.
const ULP32: f64 = f32::EPSILON as f64;
const TINY32: f64 = f32::from_bits(1) as f64;

/// A ray prepared for box tests in `f32` that err on the safe side only.
///
/// The distance to a plane is `(plane − origin) · inverse`. The origin and the inverse direction are moved before they
/// are rounded to `f32`, the way that makes near distances smaller and far ones larger; the two operations and the
/// rounding then add at most three roundings, which [`SLACK`] outweighs. An inverse that makes near distances smaller
/// stays finite, one that makes far distances larger is never zero.
#[derive(Clone, Copy)]
pub(super) struct Planes {
    /// Origins and inverse directions for near planes.
    near: [[f32; 3]; 2],
    /// Origins and inverse directions for far planes.
    far: [[f32; 3]; 2],
    /// Which of a node's planes are the near ones; the far ones are the others.
    near_planes: [u32; 3],
}

impl Planes {
    /// Of no ray.
    pub(super) const NONE: Self = Self { near: [[0.0; 3]; 2], far: [[0.0; 3]; 2], near_planes: [0, 1, 2] };

    /// The ray must not start [beyond boxes](is_beyond_boxes).
    #[inline(always)]
    pub(super) fn new<L: Lanes>(lanes: L, ray: &Ray) -> Self {
        let l = lanes;
        let origin = l.d_load(&padded(ray.origin));
        let direction = l.d_load(&padded(ray.direction));
        let reach = ray.origin.abs();
        let reach = larger(larger(reach.x, reach.y), reach.z);
        let margin = l.d_splat(ORIGIN_ULPS * f64::EPSILON * reach + TINY32);
        let spread = l.d_add(l.d_mul(l.d_abs(origin), l.d_splat(ULP32)), margin);
        let ahead = l.d_with_sign(spread, direction);
        let near = l.d_narrow(l.d_add(origin, ahead));
        let far = l.d_narrow(l.d_sub(origin, ahead));
        let inverse = l.d_div(l.d_splat(1.0), direction);
        let (most, least) = (l.d_splat(f64::from(f32::MAX)), l.d_splat(f64::from(f32::MIN)));
        let shrunk = l.d_mul(inverse, l.d_splat(1.0 - SLACK));
        let shrunk = l.d_narrow(l.d_max(l.d_min(shrunk, most), least));
        let tiny = l.d_with_sign(l.d_splat(TINY32), inverse);
        let grown = l.d_narrow(l.d_add(l.d_mul(inverse, l.d_splat(1.0 + SLACK)), tiny));
        // The sign bit, so that −0 and +0 lead to the same planes as the inverse they make.
        let negative = l.d_signs(direction);
        Self {
            near: [[near[0], near[1], near[2]], [shrunk[0], shrunk[1], shrunk[2]]],
            far: [[far[0], far[1], far[2]], [grown[0], grown[1], grown[2]]],
            near_planes: [3 * (negative & 1), 1 + 3 * (negative >> 1 & 1), 2 + 3 * (negative >> 2 & 1)],
        }
    }
}

/// [`Planes`] with each number in all lanes.
pub(super) struct BoxRay<L: Lanes> {
    near: [(L::F, L::F); 3],
    far: [(L::F, L::F); 3],
    near_planes: [usize; 3],
    far_planes: [usize; 3],
}

impl<L: Lanes> BoxRay<L> {
    #[inline(always)]
    pub(super) fn of(lanes: L, planes: &Planes) -> Self {
        let l = lanes;
        let Planes { near, far, near_planes: [x, y, z] } = planes;
        let (x, y, z) = (*x as usize, *y as usize, *z as usize);
        Self {
            near: [
                (l.f_splat(near[0][0]), l.f_splat(near[1][0])),
                (l.f_splat(near[0][1]), l.f_splat(near[1][1])),
                (l.f_splat(near[0][2]), l.f_splat(near[1][2])),
            ],
            far: [
                (l.f_splat(far[0][0]), l.f_splat(far[1][0])),
                (l.f_splat(far[0][1]), l.f_splat(far[1][1])),
                (l.f_splat(far[0][2]), l.f_splat(far[1][2])),
            ],
            near_planes: [x, y, z],
            far_planes: [3 - x, 5 - y, 7 - z],
        }
    }

    /// The ray must not start [beyond boxes](is_beyond_boxes).
    #[inline(always)]
    pub(super) fn new(lanes: L, ray: &Ray) -> Self {
        Self::of(lanes, &Planes::new(lanes, ray))
    }

    /// Distances at which the ray enters the children of a node, and which children it enters within `limit`.
    #[inline(always)]
    pub(super) fn enter(&self, lanes: L, node: &Node, limit: f32) -> (L::F, u32) {
        let (near, far) = self.distances(lanes, node, limit);
        (near, lanes.f_le(near, far))
    }

    /// Distances at which the ray enters the children of a node, if it does, and leaves them, or those up to `limit`.
    #[inline(always)]
    pub(super) fn distances(&self, lanes: L, node: &Node, limit: f32) -> (L::F, L::F) {
        let l = lanes;
        let mut near = l.f_splat(0.0);
        let mut far = l.f_splat(limit);
        for axis in 0..3 {
            // Comparisons with NaN (a ray in a face) keep what was known.
            let (origin, inverse) = self.near[axis];
            let plane = l.f_load(&node.planes[self.near_planes[axis]]);
            near = l.f_max(l.f_mul(l.f_sub(plane, origin), inverse), near);
            let (origin, inverse) = self.far[axis];
            let plane = l.f_load(&node.planes[self.far_planes[axis]]);
            far = l.f_min(l.f_mul(l.f_sub(plane, origin), inverse), far);
        }
        (near, far)
    }
}

/// A vector in four lanes; the last holds something that divides.
#[inline(always)]
pub(super) fn padded(v: DVec3) -> [f64; 4] {
    [v.x, v.y, v.z, 1.0]
}

#[inline(always)]
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// An `f32` not below a distance that is not negative.
#[inline(always)]
pub(crate) fn above(t: f64) -> f32 {
    (t * (1.0 + ULP32) + TINY32) as f32
}

/// The largest coordinate from which differences to boxes stay within the range of `f32`.
pub(super) const FARTHEST: f64 = 0.25 * f32::MAX as f64;

/// Whether a ray starts where the differences to boxes leave the range of `f32`: what they say then is worth nothing.
#[inline(always)]
pub(crate) fn is_beyond_boxes(origin: DVec3) -> bool {
    let reach = origin.abs();
    larger(larger(reach.x, reach.y), reach.z) > FARTHEST
}
