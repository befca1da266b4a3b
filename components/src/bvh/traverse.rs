//! Walking the tree along a ray, nearest child first.

use super::{Bvh, Child, Node, WIDTH};
use crate::{math, primitive::Cost, space::Ray};
use core::ops::Range;
use smallvec::SmallVec;

/// A ray prepared for box tests in `f32` that err on the safe side only.
///
/// The distance to a plane is `(plane − origin) · inverse`. The origin and the inverse direction are rounded to `f32`
/// the way that makes near distances smaller and far ones larger; the two operations then add at most two roundings,
/// which [`SLACK`] outweighs.
struct BoxRay {
    near: [Axis; 3],
    far: [Axis; 3],
    negative: [bool; 3],
}

#[derive(Clone, Copy)]
struct Axis {
    origin: f32,
    inverse: f32,
}

/// Relative slack on distances: four roundings of `f32` on either side.
const SLACK: f64 = 4.0 / (1u64 << 24) as f64;

/// How far a ray is widened, in ulps of its origin's largest coordinate: an exact test takes the ray to its own space
/// first, and may find a hit that much beside the ray, and so outside the bounds. Matters for rays along an axis alone;
/// on all others the slack on distances is far larger.
const ORIGIN_ULPS: f64 = 64.0;

impl BoxRay {
    fn new(ray: &Ray) -> Self {
        let mut this = Self {
            near: [Axis { origin: 0.0, inverse: 0.0 }; 3],
            far: [Axis { origin: 0.0, inverse: 0.0 }; 3],
            negative: [false; 3],
        };
        let margin = ORIGIN_ULPS * f64::EPSILON * ray.origin.abs().max_element();
        for axis in 0..3 {
            let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
            let (low, high) = (math::f32_below(origin - margin), math::f32_above(origin + margin));
            // The sign bit, so that −0 and +0 lead to the same planes as the inverse they make.
            let negative = direction.is_sign_negative();
            let inverse = 1.0 / direction;
            this.negative[axis] = negative;
            this.near[axis] = Axis { origin: if negative { low } else { high }, inverse: shrunk(inverse) };
            this.far[axis] = Axis { origin: if negative { high } else { low }, inverse: grown(inverse) };
        }
        this
    }

    /// Distances at which the ray enters the children of a node; `None` lanes are beyond `limit` or missed.
    #[inline]
    fn enter(&self, node: &Node, limit: f32) -> ([f32; WIDTH], u32) {
        let mut near = [0.0f32; WIDTH];
        let mut far = [limit; WIDTH];
        for axis in 0..3 {
            let (low, high) = (&node.min[axis], &node.max[axis]);
            let (near_planes, far_planes) = if self.negative[axis] { (high, low) } else { (low, high) };
            let (n, f) = (self.near[axis], self.far[axis]);
            for lane in 0..WIDTH {
                // Comparisons with NaN (a ray in a face) keep what was known.
                let enter = (near_planes[lane] - n.origin) * n.inverse;
                near[lane] = if enter > near[lane] { enter } else { near[lane] };
                let leave = (far_planes[lane] - f.origin) * f.inverse;
                far[lane] = if leave < far[lane] { leave } else { far[lane] };
            }
        }
        let mut mask = 0;
        for lane in 0..WIDTH {
            mask |= u32::from(near[lane] <= far[lane]) << lane;
        }
        (near, mask)
    }
}

/// An inverse direction no larger in magnitude, by more than the rounding of the distance.
fn shrunk(inverse: f64) -> f32 {
    let x = inverse * (1.0 - SLACK);
    if inverse.is_infinite() {
        x as f32
    } else if x > 0.0 {
        // Casting may overflow: stay finite, for the distance must not be overestimated.
        math::f32_below(x)
    } else {
        math::f32_above(x)
    }
}

/// An inverse direction no smaller in magnitude, by more than the rounding of the distance.
fn grown(inverse: f64) -> f32 {
    let x = inverse * (1.0 + SLACK);
    if x > 0.0 { math::f32_above(x) } else { math::f32_below(x) }
}

/// Children yet to visit and the distances at which the ray enters them, nearest last.
type Stack = SmallVec<[(f32, Child); 96]>;

impl Bvh {
    /// Visits leaves along the ray, nearest first, until nothing is left within the limit.
    ///
    /// `leaf` gets a run of [`Bvh::order`] and the distance beyond which nothing matters, and returns the new one;
    /// things exactly at the limit are still visited.
    #[inline]
    pub fn walk(
        &self,
        ray: &Ray,
        limit: f64,
        cost: &mut Cost,
        mut leaf: impl FnMut(Range<usize>, f64, &mut Cost) -> f64,
    ) {
        let mut limit = limit;
        self.visit(ray, limit, cost, |run, cost| {
            limit = leaf(run, limit, cost);
            Some(limit)
        });
    }

    /// Whether `leaf` says yes for any leaf along the ray within the limit; stops at the first that does.
    #[inline]
    pub fn any(
        &self,
        ray: &Ray,
        limit: f64,
        cost: &mut Cost,
        mut leaf: impl FnMut(Range<usize>, &mut Cost) -> bool,
    ) -> bool {
        let mut found = false;
        self.visit(ray, limit, cost, |run, cost| {
            found = leaf(run, cost);
            (!found).then_some(limit)
        });
        found
    }

    /// The walk itself; `leaf` returns the new limit, or nothing to stop.
    #[inline]
    fn visit(
        &self,
        ray: &Ray,
        limit: f64,
        cost: &mut Cost,
        mut leaf: impl FnMut(Range<usize>, &mut Cost) -> Option<f64>,
    ) {
        // A ray that goes nowhere, or comes from nowhere, meets nothing.
        if self.nodes.is_empty() || !ray.is_valid() {
            return;
        }
        let ray = BoxRay::new(ray);
        let mut limit = math::f32_above(limit);
        let mut stack = Stack::new();
        stack.push((0.0, Child::node(0)));
        while let Some((enter, child)) = stack.pop() {
            if enter > limit {
                continue;
            }
            if child.is_leaf() {
                match leaf(child.run(), cost) {
                    Some(nearer) => limit = math::f32_above(nearer),
                    None => return,
                }
                continue;
            }
            let node = &self.nodes[child.0 as usize];
            cost.nodes += 1;
            let (near, mut mask) = ray.enter(node, limit);
            let base = stack.len();
            while mask != 0 {
                let lane = mask.trailing_zeros() as usize;
                mask &= mask - 1;
                let entry = (near[lane], node.child[lane]);
                stack.push(entry);
                // Keep this node's children sorted, farthest first.
                let mut i = stack.len() - 1;
                while i > base && stack[i - 1].0 < entry.0 {
                    stack[i] = stack[i - 1];
                    i -= 1;
                }
                stack[i] = entry;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{bvh::Box32, space::Bounds};
    use glam::DVec3;

    /// A reproducible stream of numbers (splitmix64).
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = *state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn visited(tree: &Bvh, ray: &Ray) -> Vec<u32> {
        let mut seen = vec![];
        tree.walk(ray, f64::INFINITY, &mut Cost::default(), |run, limit, _| {
            seen.extend_from_slice(&tree.order()[run]);
            limit
        });
        seen
    }

    #[test]
    fn a_ray_aimed_at_a_corner_always_reaches_the_box() {
        let mut seed = 1;
        for _ in 0..200 {
            let scale = math::pow(10.0, random(&mut seed) * 12.0 - 6.0);
            let shift = DVec3::splat(1e3 * scale * random(&mut seed));
            let mut point = || DVec3::from_array([0; 3].map(|_| random(&mut seed))) * scale + shift;
            let boxes: Vec<Bounds> = (0..40).map(|_| Bounds::of_points([point(), point()])).collect();
            let origin = point() * 3.0;
            let tree = Bvh::build(boxes.iter().map(Box32::around), 1);
            for (i, b) in boxes.iter().enumerate() {
                for corner in b.corners() {
                    let ray = Ray { origin, direction: corner - origin };
                    assert!(visited(&tree, &ray).contains(&(i as u32)), "{b:?} missed by {ray:?}");
                }
            }
        }
    }

    #[test]
    fn flat_boxes_and_rays_along_the_axes_are_never_missed() {
        // Closed boxes of half-size 1 or 0 about the origin, rays from and along every combination of −2..=2.
        let axis = [-2.0, -1.0, -0.0, 0.0, 1.0, 2.0];
        let grid = || {
            axis.into_iter()
                .flat_map(move |x| axis.into_iter().flat_map(move |y| axis.map(move |z| DVec3::new(x, y, z))))
        };
        for half in [DVec3::ONE, DVec3::new(1.0, 0.0, 1.0), DVec3::new(0.0, 0.0, 1.0), DVec3::ZERO] {
            let b = Bounds { min: -half, max: half };
            let tree = Bvh::build([Box32::around(&b)].into_iter(), 1);
            for origin in grid() {
                for direction in grid().filter(|d| *d != DVec3::ZERO) {
                    // Exact, as all candidates are small integers or halves: does the closed box meet the half-line?
                    let meets = [0.0, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 0.25, 0.75]
                        .iter()
                        .any(|t| b.contains(origin + direction * *t));
                    if meets {
                        let ray = Ray { origin, direction };
                        assert_eq!(visited(&tree, &ray), [0], "{b:?} missed by {ray:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_ray_from_afar_along_an_axis_reaches_what_its_rounding_may_hit() {
        // One ulp of the origin beside a box far smaller than that distance.
        let origin = DVec3::new(-1e9, 1.0, 0.5);
        let beside = 1.0 - f64::EPSILON * 1e9;
        let b = Bounds { min: DVec3::ZERO, max: DVec3::new(1.0, beside, 1.0) };
        let tree = Bvh::build([Box32::around(&b)].into_iter(), 1);
        assert_eq!(visited(&tree, &Ray { origin, direction: DVec3::X }), [0]);
    }

    #[test]
    fn invalid_rays_visit_nothing_and_empty_trees_are_fine() {
        let b = Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE };
        let tree = Bvh::build([Box32::around(&b)].into_iter(), 1);
        for (origin, direction) in [(DVec3::NAN, DVec3::X), (DVec3::ZERO, DVec3::ZERO), (DVec3::ZERO, DVec3::INFINITY)]
        {
            assert!(visited(&tree, &Ray { origin, direction }).is_empty());
        }
        let empty = Bvh::build([].into_iter(), 1);
        assert!(visited(&empty, &Ray { origin: DVec3::ZERO, direction: DVec3::X }).is_empty());
    }

    #[test]
    fn coincident_things_are_separated_and_all_are_kept() {
        for count in [1usize, 2, 9, 1000, 20_000] {
            let b = Box32 { min: [0.0; 3], max: [1.0; 3] };
            let tree = Bvh::build(vec![b; count].into_iter(), 4);
            let mut order = tree.order().to_vec();
            order.sort_unstable();
            assert!(order.iter().copied().eq(0..count as u32));
            assert!(tree.leaves().all(|run| run.len() <= 4));
            assert_eq!(tree.leaves().map(|run| run.len()).sum::<usize>(), count);
        }
    }
}
