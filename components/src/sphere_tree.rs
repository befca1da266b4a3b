//! The tree of spheres of 2004: every node is split into the octants about the centre of the sphere around it.
//!
//! Kept to be compared with the tree of boxes; the nearest hit is the same, only the cost differs. Things whose sphere
//! is larger than a quarter of the node's stay at the node, as in the original: a scene of many large things makes it a
//! list. Two guards are new: equal centres, which no octant separates, end in one leaf, and so does what lies deeper
//! than [`MAX_DEPTH`].

use crate::{
    primitive::Cost,
    space::{BoundingSphere, Bounds, Ray},
};
use core::ops::Range;
use glam::DVec3;

/// Deepest node; spheres that lie within each other by a factor of four each would go on for ever.
pub const MAX_DEPTH: usize = 64;

/// How far a ray is widened, in ulps of the coordinates at hand: as for the tree of boxes, an exact test may find a hit
/// that much beside the ray.
const MARGIN_ULPS: f64 = 64.0;

#[derive(Clone, Debug)]
struct Node {
    sphere: BoundingSphere,
    /// The node's own things, as a run of [`SphereTree::order`].
    own: Range<u32>,
    /// The node after all below this one.
    next: u32,
}

/// A tree over spheres.
#[derive(Clone, Debug)]
pub struct SphereTree {
    /// Every node before those below it.
    nodes: Vec<Node>,
    order: Vec<u32>,
    depth: usize,
}

impl SphereTree {
    /// Builds a tree.
    #[must_use]
    pub fn build(spheres: impl Iterator<Item = BoundingSphere>) -> Self {
        let spheres: Vec<_> = spheres.collect();
        let mut this = Self { nodes: vec![], order: Vec::with_capacity(spheres.len()), depth: 0 };
        if !spheres.is_empty() {
            this.add(&spheres, (0..spheres.len() as u32).collect(), 1);
        }
        this
    }

    /// Adds a node over some spheres, and all below it.
    fn add(&mut self, spheres: &[BoundingSphere], members: Vec<u32>, depth: usize) {
        self.depth = self.depth.max(depth);
        let sphere = around(members.iter().map(|&i| spheres[i as usize]));
        let count = members.len();
        let mut octants: [Vec<u32>; 8] = Default::default();
        let mut own = vec![];
        for i in members {
            let BoundingSphere { center, radius } = spheres[i as usize];
            if count == 1 || depth == MAX_DEPTH || radius > 0.25 * sphere.radius {
                own.push(i);
            } else {
                let above = center.cmpgt(sphere.center).bitmask();
                octants[above as usize].push(i);
            }
        }
        // A split that changes nothing would go on for ever.
        if let Some(all) = octants.iter_mut().find(|octant| octant.len() == count) {
            own.append(all);
        }
        let first = self.order.len() as u32;
        self.order.append(&mut own);
        let node = self.nodes.len();
        self.nodes.push(Node { sphere, own: first..self.order.len() as u32, next: 0 });
        for octant in octants.into_iter().filter(|octant| !octant.is_empty()) {
            self.add(spheres, octant, depth + 1);
        }
        self.nodes[node].next = self.nodes.len() as u32;
    }

    /// The things in the order of the runs, by their index among the spheres the tree was built from.
    #[must_use]
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Levels of the tree.
    #[must_use]
    pub fn depth(&self) -> usize {
        self.depth
    }

    /// Visits the things of every node that the ray meets within the limit, in a fixed order.
    ///
    /// `visit` gets a run of [`SphereTree::order`] and the distance beyond which nothing matters, and returns the new
    /// one; things exactly at the limit are still visited.
    #[inline]
    pub fn walk(
        &self,
        ray: &Ray,
        limit: f64,
        cost: &mut Cost,
        mut visit: impl FnMut(Range<usize>, f64, &mut Cost) -> f64,
    ) {
        let mut limit = limit;
        self.visit(ray, limit, cost, |run, cost| {
            limit = visit(run, limit, cost);
            Some(limit)
        });
    }

    /// Whether `visit` says yes for any node along the ray within the limit; stops at the first that does.
    #[inline]
    pub fn any(
        &self,
        ray: &Ray,
        limit: f64,
        cost: &mut Cost,
        mut visit: impl FnMut(Range<usize>, &mut Cost) -> bool,
    ) -> bool {
        let mut found = false;
        self.visit(ray, limit, cost, |run, cost| {
            found = visit(run, cost);
            (!found).then_some(limit)
        });
        found
    }

    fn visit(
        &self,
        ray: &Ray,
        mut limit: f64,
        cost: &mut Cost,
        mut visit: impl FnMut(Range<usize>, &mut Cost) -> Option<f64>,
    ) {
        if !ray.is_valid() {
            return;
        }
        let ray = SphereRay::new(ray);
        let mut at = 0;
        while let Some(node) = self.nodes.get(at) {
            cost.nodes += 1;
            if !ray.meets(&node.sphere, limit) {
                at = node.next as usize;
                continue;
            }
            if !node.own.is_empty() {
                match visit(node.own.start as usize..node.own.end as usize, cost) {
                    Some(nearer) => limit = nearer,
                    None => return,
                }
            }
            at += 1;
        }
    }
}

/// A sphere around some spheres: about the middle of the box that holds them.
fn around(spheres: impl Iterator<Item = BoundingSphere> + Clone) -> BoundingSphere {
    let mut all = spheres.clone();
    if let (Some(one), None) = (all.next(), all.next()) {
        return one;
    }
    let corners = |s: BoundingSphere| [s.center - s.radius, s.center + s.radius];
    let center = Bounds::of_points(spheres.clone().flat_map(corners)).center();
    let reach = spheres.map(|s| s.center.distance(center) + s.radius).fold(0.0, f64::max);
    BoundingSphere { center, radius: reach + 8.0 * f64::EPSILON * (reach + center.abs().max_element()) }
}

/// A ray prepared for tests of spheres that err on the safe side only.
struct SphereRay {
    origin: DVec3,
    /// Its largest coordinate is one, so that no square of it vanishes or overflows.
    direction: DVec3,
    per_square: f64,
    /// What distances along the ray are multiplied by for this direction.
    scale: f64,
    reach: f64,
}

impl SphereRay {
    fn new(ray: &Ray) -> Self {
        let scale = ray.direction.abs().max_element();
        let (origin, direction) = (ray.origin, ray.direction / scale);
        let per_square = 1.0 / direction.length_squared();
        Self { origin, direction, per_square, scale, reach: origin.abs().max_element() }
    }

    /// Whether the ray may meet something in a sphere at a distance up to `limit`.
    ///
    /// The margin on the radius outweighs the rounding of the foot and of the half-chord alike. Every comparison lets
    /// not-a-number pass, which comes of numbers too large to be squared.
    #[inline]
    fn meets(&self, sphere: &BoundingSphere, limit: f64) -> bool {
        let to_center = sphere.center - self.origin;
        let foot = to_center.dot(self.direction) * self.per_square;
        let aside = to_center - self.direction * foot;
        let margin = MARGIN_ULPS * f64::EPSILON * (self.reach + sphere.center.abs().max_element());
        let radius = sphere.radius + margin;
        let square = radius * radius - aside.length_squared();
        if square < 0.0 {
            return false;
        }
        let half = (square * self.per_square).sqrt();
        !(foot + half < 0.0 || foot - half > limit * self.scale)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn visited(tree: &SphereTree, ray: &Ray) -> Vec<u32> {
        let mut seen = vec![];
        tree.walk(ray, f64::INFINITY, &mut Cost::default(), |run, limit, _| {
            seen.extend_from_slice(&tree.order()[run]);
            limit
        });
        seen.sort_unstable();
        seen
    }

    fn all(tree: &SphereTree, count: usize) -> bool {
        let mut order = tree.order().to_vec();
        order.sort_unstable();
        order.iter().copied().eq(0..count as u32)
    }

    #[test]
    fn equal_centres_and_spheres_within_each_other_end() {
        let same = BoundingSphere { center: DVec3::ONE, radius: 1e-3 };
        for count in [0, 1, 2, 3, 10_000] {
            let tree = SphereTree::build(core::iter::repeat_n(same, count));
            assert!(all(&tree, count) && tree.depth() <= 2, "{count}: depth {}", tree.depth());
        }
        // Each an eighth of the one before and about the same centre.
        let mut radius = 1e100;
        let nested: Vec<_> = core::iter::repeat_with(|| {
            radius *= 0.125;
            BoundingSphere { center: DVec3::ONE, radius }
        })
        .take(300)
        .collect();
        let tree = SphereTree::build(nested.into_iter());
        assert!(all(&tree, 300) && tree.depth() <= MAX_DEPTH, "depth {}", tree.depth());
        assert_eq!(visited(&tree, &Ray { origin: DVec3::ZERO, direction: DVec3::ONE }).len(), 300);
    }

    #[test]
    fn large_things_stay_above() {
        let small = (0..8).map(|i| BoundingSphere { center: DVec3::splat(f64::from(i)), radius: 0.01 });
        let large = BoundingSphere { center: DVec3::ZERO, radius: 5.0 };
        let tree = SphereTree::build(small.chain([large]));
        assert_eq!(tree.order()[..1], [8], "the root's own come first");
        let aside = Ray { origin: DVec3::new(20.0, 0.0, 0.0), direction: DVec3::new(-1.0, -0.2, 0.0) };
        assert_eq!(visited(&tree, &aside), [8]);
    }

    #[test]
    fn a_limit_and_an_early_end_are_kept() {
        let row = (0..16).map(|i| BoundingSphere { center: DVec3::X * f64::from(4 * i), radius: 0.5 });
        let tree = SphereTree::build(row);
        let ray = Ray { origin: DVec3::X * -10.0, direction: DVec3::X * 2.0 };
        let mut seen = vec![];
        tree.walk(&ray, 6.9, &mut Cost::default(), |run, limit, _| {
            seen.extend_from_slice(&tree.order()[run]);
            limit
        });
        seen.sort_unstable();
        assert_eq!(seen, [0, 1], "the second starts at 6.75, the third at 8.75");
        let mut runs = 0;
        assert!(tree.any(&ray, f64::INFINITY, &mut Cost::default(), |_, _| {
            runs += 1;
            true
        }));
        assert_eq!(runs, 1);
    }
}
