//! Walking the tree along a ray, nearest child first.

use super::{
    Blocks, Bvh, Child, Node, WIDTH,
    box_ray::{BoxRay, above, is_beyond_boxes, padded},
};
use crate::{
    lanes::{self, Job, Lanes, Room, Stack},
    primitive::Cost,
    space::Ray,
};
use core::ops::Range;

/// [`Ray::is_valid`] on lanes.
#[inline(always)]
fn is_valid<L: Lanes>(lanes: L, ray: &Ray) -> bool {
    let l = lanes;
    let zero = l.d_splat(0.0);
    let (origin, direction) = (l.d_load(&padded(ray.origin)), l.d_load(&padded(ray.direction)));
    // Zero times a number is zero unless that is infinite or not a number.
    let sum = l.d_add(l.d_mul(origin, zero), l.d_mul(direction, zero));
    l.d_le(sum, zero) == 0b1111 && l.d_lt(zero, l.d_abs(direction)) & 0b111 != 0
}

/// A leaf, as the tree stores it: a run of the order for a [`Bvh`], one block for [`Blocks`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leaf {
    pub(crate) first: usize,
    pub(crate) len: usize,
}

/// What is done with the leaves along a ray.
pub(crate) trait Visitor {
    /// Whether it stops at the first thing found, so that the nearest need not come first.
    const ANY: bool;

    /// Tests what a leaf holds. Returns the distance beyond which nothing matters from now on, or nothing to stop.
    ///
    /// To be `#[inline(always)]`: see [`Job::run`].
    fn visit<L: Lanes>(&mut self, lanes: L, leaf: Leaf, cost: &mut Cost) -> Option<f64>;
}

/// Room on the stack of a walk; see [`Bvh::MAX_DEPTH`].
const ROOM: usize = (WIDTH - 1) * Bvh::MAX_DEPTH + 1;

/// The first child of a mask, and the distance at which the ray enters it, in one number that sorts by distance: the
/// bits of numbers that are not negative are ordered as they are.
#[inline(always)]
fn first(distances: &[f32; WIDTH], node: &Node, mask: u32) -> u64 {
    let lane = mask.trailing_zeros() as usize % WIDTH;
    u64::from(distances[lane].to_bits()) << 32 | u64::from(node.child[lane].0)
}

/// Visits all leaves, until nothing matters any more.
#[cold]
#[inline(never)]
fn visit_all<L: Lanes, V: Visitor>(lanes: L, nodes: &[Node], cost: &mut Cost, visitor: &mut V) {
    for node in nodes {
        cost.nodes += 1;
        for lane in (0..WIDTH).filter(|&lane| node.holds(lane) && node.child[lane].is_leaf()) {
            if visitor.visit(lanes, node.child[lane].leaf_run(), cost).is_none() {
                return;
            }
        }
    }
}

/// Visits the leaves along the ray, nearest first, until nothing is left within the limit.
///
/// The visitor is made after the ray was prepared for boxes, as those come first, and given back; none where there is
/// nothing to visit.
#[inline(always)]
fn walk<L: Lanes, V: Visitor>(
    lanes: L,
    nodes: &[Node],
    ray: &Ray,
    limit: f64,
    cost: &mut Cost,
    visitor: impl FnOnce() -> V,
) -> Option<V> {
    // A ray that goes nowhere, or comes from nowhere, meets nothing.
    if nodes.is_empty() || !is_valid(lanes, ray) {
        return None;
    }
    if is_beyond_boxes(ray.origin) {
        let mut visitor = visitor();
        visit_all(lanes, nodes, cost, &mut visitor);
        return Some(visitor);
    }
    let ray = BoxRay::new(lanes, ray);
    let mut visitor = visitor();
    along(lanes, nodes, &ray, limit, cost, &mut visitor);
    Some(visitor)
}

/// [`walk`] of a prepared ray.
#[inline(always)]
fn along<L: Lanes, V: Visitor>(
    lanes: L,
    nodes: &[Node],
    ray: &BoxRay<L>,
    limit: f64,
    cost: &mut Cost,
    visitor: &mut V,
) {
    let mut limit = above(limit);
    let mut room = Room::<ROOM>::new();
    let mut stack = Stack::new(&mut room);
    let mut child = Child::node(0);
    loop {
        if child.is_leaf() {
            match visitor.visit(lanes, child.leaf_run(), cost) {
                Some(nearer) => limit = above(nearer),
                None => return,
            }
        } else {
            let node = &nodes[child.0 as usize];
            cost.nodes += 1;
            let (near, mut mask) = ray.enter(lanes, node, limit);
            if V::ANY && mask != 0 {
                // Any order finds whether there is something; the last child is as good as the nearest.
                while mask & (mask - 1) != 0 {
                    stack.push(first(&[0.0; WIDTH], node, mask));
                    mask &= mask - 1;
                }
                child = Child(first(&[0.0; WIDTH], node, mask) as u32);
                continue;
            }
            if mask != 0 {
                let mut distances = [0.0; WIDTH];
                lanes.f_store(near, &mut distances);
                let a = first(&distances, node, mask);
                mask &= mask - 1;
                if mask == 0 {
                    child = Child(a as u32);
                    continue;
                }
                let b = first(&distances, node, mask);
                mask &= mask - 1;
                let (a, b) = if a < b { (a, b) } else { (b, a) };
                if mask == 0 {
                    stack.push(b);
                    child = Child(a as u32);
                    continue;
                }
                let c = first(&distances, node, mask);
                mask &= mask - 1;
                let (a, c) = if a < c { (a, c) } else { (c, a) };
                let (b, c) = if b < c { (b, c) } else { (c, b) };
                if mask == 0 {
                    stack.push(c);
                    stack.push(b);
                    child = Child(a as u32);
                    continue;
                }
                // Sorted, farthest first.
                let base = stack.len();
                stack.push(c);
                stack.push(b);
                stack.push(a);
                while mask != 0 {
                    let d = first(&distances, node, mask);
                    mask &= mask - 1;
                    stack.push(d);
                    let new = stack.since(base);
                    let mut i = new.len() - 1;
                    while i > 0 && new[i - 1] < d {
                        new[i] = new[i - 1];
                        i -= 1;
                    }
                    new[i] = d;
                }
            }
        }
        loop {
            let Some(entry) = stack.pop() else { return };
            if f32::from_bits((entry >> 32) as u32) <= limit {
                child = Child(entry as u32);
                break;
            }
        }
    }
}

impl Blocks {
    /// Visits the blocks along the ray, nearest first, until nothing is left within the limit.
    #[inline(always)]
    pub(crate) fn walk<L: Lanes, V: Visitor>(
        &self,
        lanes: L,
        ray: &Ray,
        limit: f64,
        cost: &mut Cost,
        visitor: impl FnOnce() -> V,
    ) -> Option<V> {
        walk(lanes, &self.nodes, ray, limit, cost, visitor)
    }
}

/// The walk of a [`Bvh`] as a job.
struct Walk<'a, F, const ANY: bool> {
    tree: &'a Bvh,
    ray: &'a Ray,
    limit: f64,
    cost: &'a mut Cost,
    leaf: F,
}

impl<F: FnMut(Range<usize>, &mut Cost) -> Option<f64>, const ANY: bool> Job for Walk<'_, F, ANY> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        walk(lanes, &self.tree.nodes, self.ray, self.limit, self.cost, || Runs::<_, ANY>(&mut self.leaf));
    }
}

/// Leaves as runs of [`Bvh::order`].
struct Runs<F, const ANY: bool>(F);

impl<F: FnMut(Range<usize>, &mut Cost) -> Option<f64>, const ANY: bool> Visitor for Runs<F, ANY> {
    const ANY: bool = ANY;

    #[inline(always)]
    fn visit<L: Lanes>(&mut self, _: L, leaf: Leaf, cost: &mut Cost) -> Option<f64> {
        (self.0)(leaf.first..leaf.first + leaf.len, cost)
    }
}

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
        let mut nearest = limit;
        let leaf = |run: Range<usize>, cost: &mut Cost| {
            nearest = leaf(run, nearest, cost);
            Some(nearest)
        };
        lanes::run(Walk::<_, false> { tree: self, ray, limit, cost, leaf });
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
        let leaf = |run: Range<usize>, cost: &mut Cost| {
            found = leaf(run, cost);
            (!found).then_some(limit)
        };
        lanes::run(Walk::<_, true> { tree: self, ray, limit, cost, leaf });
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{bvh::Box32, math, space::Bounds};
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
    fn a_ray_from_beyond_the_range_of_boxes_visits_all_and_ends() {
        let wide = |reach: f64| Bounds { min: DVec3::splat(-reach), max: DVec3::splat(reach) };
        for reach in [1.0, 1e38, 1e39, 1e300] {
            let boxes: Vec<_> = (1..=20).map(|i| Box32::around(&wide(reach / f64::from(i)))).collect();
            let tree = Bvh::build(boxes.into_iter(), 2);
            for sign in [-1.0, 1.0] {
                for origin in [1.0, 1e38, 3e38, 4e38, 1e39, 1e300].map(|far| DVec3::splat(sign * far)) {
                    for direction in [DVec3::splat(-sign), DVec3::splat(-sign * 1e300), DVec3::new(0.0, 0.0, -sign)] {
                        let mut seen = visited(&tree, &Ray { origin, direction });
                        seen.sort_unstable();
                        seen.dedup();
                        if direction.x != 0.0 {
                            assert_eq!(seen.len(), 20, "boxes of {reach} from {origin} along {direction}");
                        }
                    }
                }
            }
        }
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

    #[test]
    fn no_tree_is_deeper_than_a_walk_has_room_for() {
        fn depth(tree: &Bvh, node: usize) -> usize {
            let node = &tree.nodes[node];
            let below = (0..WIDTH).filter(|&lane| node.holds(lane) && !node.child[lane].is_leaf());
            1 + below.map(|lane| depth(tree, node.child[lane].0 as usize)).max().unwrap_or(0)
        }
        // Points that run into a corner: every split by area cuts off the few farthest.
        let run = |ratio: f64| (0..20_000).map(move |i| math::pow(ratio, f64::from(i) * 0.05) as f32);
        let mut deepest = 0;
        for ratio in [0.9, 0.5, 0.1] {
            let boxes: Vec<_> = run(ratio).map(|x| Box32 { min: [x; 3], max: [x; 3] }).collect();
            deepest = deepest.max(depth(&Bvh::build(boxes.into_iter(), 1), 0));
        }
        assert!((20..=Bvh::MAX_DEPTH).contains(&deepest), "{deepest}");
    }
}
