//! A ray prepared for tests of boxes, which err on the safe side only.

use super::Node;
use crate::{
    lanes::{Lanes, vector},
    packet::{Mask, PACKET},
    space::Ray,
};
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

/// A ray prepared for box tests in `f32` that err on the safe side only: origins and inverse directions for near planes,
/// then for far ones.
///
/// The distance to a plane is `(plane − origin) · inverse`. The origin and the inverse direction are moved before they
/// are rounded to `f32`, the way that makes near distances smaller and far ones larger; the two operations and the
/// rounding then add at most three roundings, which [`SLACK`] outweighs. An inverse that makes near distances smaller
/// stays finite, one that makes far distances larger is never zero.
///
/// Four coordinates on lanes, of one ray or of four; `reach` is the largest of a ray's origin.
#[inline(always)]
fn planes<L: Lanes>(l: L, origin: L::D, direction: L::D, reach: L::D) -> [[f32; 4]; 4] {
    let margin = l.d_add(l.d_mul(l.d_splat(ORIGIN_ULPS * f64::EPSILON), reach), l.d_splat(TINY32));
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
    [near, shrunk, far, grown]
}

/// Rays prepared for box tests; see [`planes`].
pub(crate) struct BoxRays {
    /// By axis: origins and inverse directions for near planes, then for far ones.
    pub(super) planes: [[[f32; PACKET]; 4]; 3],
    /// The rays that run backward along each axis.
    pub(super) negative: [Mask; 3],
}

impl BoxRays {
    #[inline(always)]
    pub(crate) fn new() -> Self {
        Self { planes: [[[0.0; PACKET]; 4]; 3], negative: [0; 3] }
    }

    /// Prepares four rays, which must not start [beyond boxes](is_beyond_boxes); once.
    #[inline(always)]
    pub(crate) fn set<L: Lanes>(
        &mut self,
        lanes: L,
        group: usize,
        origins: vector::Four<L>,
        directions: vector::Four<L>,
    ) {
        let l = lanes;
        let reach = vector::reach(l, origins);
        for axis in 0..3 {
            let planes = planes(l, origins[axis], directions[axis], reach);
            for (to, from) in self.planes[axis].iter_mut().zip(planes) {
                to.as_chunks_mut().0[group] = from;
            }
            self.negative[axis] |= Mask::from(l.d_signs(directions[axis])) << (4 * group);
        }
    }
}

/// A ray prepared for box tests, with each number in all lanes.
pub(super) struct BoxRay<L: Lanes> {
    near: [(L::F, L::F); 3],
    far: [(L::F, L::F); 3],
    /// Which of a node's planes are the near ones; the far ones are the others.
    near_planes: [usize; 3],
    far_planes: [usize; 3],
}

impl<L: Lanes> BoxRay<L> {
    /// From the numbers of [`planes`] by axis, and whether the ray runs backward along each.
    #[inline(always)]
    fn of(l: L, [x, y, z]: [[f32; 4]; 3], negative: [usize; 3]) -> Self {
        let [a, b, c] = negative;
        Self {
            near: [
                (l.f_splat(x[0]), l.f_splat(x[1])),
                (l.f_splat(y[0]), l.f_splat(y[1])),
                (l.f_splat(z[0]), l.f_splat(z[1])),
            ],
            far: [
                (l.f_splat(x[2]), l.f_splat(x[3])),
                (l.f_splat(y[2]), l.f_splat(y[3])),
                (l.f_splat(z[2]), l.f_splat(z[3])),
            ],
            near_planes: [3 * a, 1 + 3 * b, 2 + 3 * c],
            far_planes: [3 - 3 * a, 4 - 3 * b, 5 - 3 * c],
        }
    }

    /// The ray must not start [beyond boxes](is_beyond_boxes).
    #[inline(always)]
    pub(super) fn new(lanes: L, ray: &Ray) -> Self {
        let l = lanes;
        let direction = l.d_load(&padded(ray.direction));
        let reach = ray.origin.abs();
        let reach = larger(larger(reach.x, reach.y), reach.z);
        let [near, shrunk, far, grown] = planes(l, l.d_load(&padded(ray.origin)), direction, l.d_splat(reach));
        let along = |i: usize| [near[i], shrunk[i], far[i], grown[i]];
        // The sign bit, so that −0 and +0 lead to the same planes as the inverse they make.
        let signs = l.d_signs(direction) as usize;
        Self::of(l, [along(0), along(1), along(2)], [signs & 1, signs >> 1 & 1, signs >> 2 & 1])
    }

    /// One of the rays of a packet.
    #[inline(always)]
    pub(super) fn one_of(lanes: L, rays: &BoxRays, i: usize) -> Self {
        let BoxRays { planes: [x, y, z], negative: [a, b, c] } = rays;
        let along = |of: &[[f32; PACKET]; 4]| [of[0][i], of[1][i], of[2][i], of[3][i]];
        let bit = |of: &Mask| (of >> i & 1) as usize;
        Self::of(lanes, [along(x), along(y), along(z)], [bit(a), bit(b), bit(c)])
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
pub(crate) const FARTHEST: f64 = 0.25 * f32::MAX as f64;

/// Whether a ray starts where the differences to boxes leave the range of `f32`: what they say then is worth nothing.
#[inline(always)]
pub(super) fn is_beyond_boxes(origin: DVec3) -> bool {
    let reach = origin.abs();
    larger(larger(reach.x, reach.y), reach.z) > FARTHEST
}
