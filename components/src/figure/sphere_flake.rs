//! `SphereFlake(depth: 4)`: a ball that carries nine balls of a third of its radius, each of which carries nine …
//!
//! True spheres, with a tree of their own; after the balls of Haines: A Proposal for Standard Graphics Environments, 1987.

use super::shared::shared;
use crate::{
    bvh::{Box32, Bvh},
    describe::Describe,
    math,
    method::{Accelerator, Methods},
    primitive::{Cost, Degenerate, Extent, Hit, Primitive, Surface},
    shape::{nearest_root, sphere_uv},
    space::{Bounds, Ray},
};
use bevy_ecs::prelude::*;
use core::ops::Range;
use glam::{DAffine3, DVec2, DVec3};
use std::sync::Arc;

/// Balls on each ball: six around its equator, three above.
const CHILDREN: [(f64, f64); 9] = [
    (90.0, 0.0),
    (90.0, 60.0),
    (90.0, 120.0),
    (90.0, 180.0),
    (90.0, 240.0),
    (90.0, 300.0),
    (35.0, 30.0),
    (35.0, 150.0),
    (35.0, 270.0),
];

/// Deepest flake: 597 871 balls.
const MAX_DEPTH: u32 = 6;

/// Largest ball: the boxes of a tree are in single precision.
const MAX_RADIUS: f64 = 1e37;

/// Most balls in one leaf of the tree.
const LEAF: usize = 4;

/// A ball that carries nine smaller ones, each of which carries nine, and so on.
#[derive(Component, Clone, Debug, PartialEq, Describe)]
pub struct SphereFlake {
    /// Radius of the largest ball, about the origin; object units.
    #[describe(positive, at_most(MAX_RADIUS))]
    pub radius: f64,
    /// How many times balls carry smaller ones: there are (9^(depth + 1) − 1) / 8 in all.
    #[describe(within(0.0, MAX_DEPTH as f64), about = "how many times balls carry smaller ones")]
    pub depth: u32,
}

impl Default for SphereFlake {
    fn default() -> Self {
        Self { radius: 1.0, depth: 3 }
    }
}

/// A ball of a flake, object space.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Ball {
    center: DVec3,
    radius: f64,
}

impl SphereFlake {
    /// All balls, larger ones first.
    fn balls(&self) -> Vec<Ball> {
        let mut balls = vec![(Ball { center: DVec3::ZERO, radius: self.radius }, DVec3::Y)];
        let mut parents = 0..1;
        for _ in 0..self.depth {
            for parent in parents.clone() {
                let (ball, up) = balls[parent];
                let (right, forward) = up.any_orthonormal_pair();
                for (polar, azimuth) in CHILDREN {
                    let (out, along) = math::sin_cos_degrees(polar);
                    let (sin, cos) = math::sin_cos_degrees(azimuth);
                    let direction = ((right * cos + forward * sin) * out + up * along).normalize();
                    let radius = ball.radius / 3.0;
                    let center = ball.center + direction * (ball.radius + radius);
                    balls.push((Ball { center, radius }, direction));
                }
            }
            parents = parents.end..balls.len();
        }
        balls.into_iter().map(|(ball, _)| ball).collect()
    }
}

/// A flake, immutable, in object space.
#[derive(Debug)]
struct Flake {
    tree: Bvh,
    /// Larger ones first.
    balls: Vec<Ball>,
    /// The same in the order of the tree's leaves.
    leaves: Vec<Ball>,
    bounds: Bounds,
}

impl Flake {
    fn new(balls: Vec<Ball>) -> Self {
        let around = |ball: &Ball| {
            let (low, high) = (ball.center - ball.radius, ball.center + ball.radius);
            Bounds { min: low, max: high }.widened(8.0 * f64::EPSILON * low.abs().max(high.abs()).max_element())
        };
        let tree = Bvh::build(balls.iter().map(|ball| Box32::around(&around(ball))), LEAF);
        let bounds = balls.iter().map(around).fold(Bounds::EMPTY, Bounds::union);
        let leaves = tree.order().iter().map(|&i| balls[i as usize]).collect();
        Self { tree, balls, leaves, bounds }
    }
}

/// A placed flake as the inner loop sees it.
#[derive(Clone, Debug)]
pub struct PackedSphereFlake {
    flake: Arc<Flake>,
    placed: Arc<Placed>,
}

#[derive(Debug)]
struct Placed {
    object_from_world: DAffine3,
    world_from_object: DAffine3,
    /// Of a point of the surface, world units.
    error: f64,
}

impl Primitive for SphereFlake {
    type Packed = PackedSphereFlake;

    fn pack(&self, world_from_object: &DAffine3) -> Result<(Extent, PackedSphereFlake), Degenerate> {
        if !(self.radius > 0.0 && self.radius.is_finite()) {
            return Err(Degenerate(format!("its radius is not a number above zero: {}", self.radius)));
        }
        if self.radius > MAX_RADIUS {
            return Err(Degenerate(format!("its radius is more than {MAX_RADIUS:e}: {}", self.radius)));
        }
        if self.depth > MAX_DEPTH {
            return Err(Degenerate(format!("its depth is more than {MAX_DEPTH}: {}", self.depth)));
        }
        let flake = shared(self, || Ok::<_, Degenerate>(Flake::new(self.balls())))?;
        let bounds = flake.bounds.transformed(world_from_object);
        let placed = Placed {
            object_from_world: world_from_object.inverse(),
            world_from_object: *world_from_object,
            error: Surface::rounding(bounds.min.abs().max(bounds.max.abs()).max_element()),
        };
        Ok((Extent::Bounded(bounds), PackedSphereFlake { flake, placed: Arc::new(placed) }))
    }

    #[inline]
    fn hit(packed: &PackedSphereFlake, ray: &Ray, t_max: f64, cost: &mut Cost) -> Option<Hit> {
        let mut search = Search { flake: &packed.flake, ray: packed.placed.local(ray), limit: t_max, best: None };
        let ray = search.ray;
        packed.flake.tree.walk(&ray, t_max, cost, |run, _, cost| search.test(run, cost));
        search.best
    }

    /// Its balls are always tested by the default method, in a tree of boxes or one by one.
    fn hit_with(packed: &PackedSphereFlake, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> Option<Hit> {
        if with.accelerator != Accelerator::BruteForce {
            return Self::hit(packed, ray, t_max, cost);
        }
        let mut search = Search { flake: &packed.flake, ray: packed.placed.local(ray), limit: t_max, best: None };
        search.test(0..packed.flake.leaves.len(), cost);
        search.best
    }

    #[inline]
    fn blocks(packed: &PackedSphereFlake, ray: &Ray, t_max: f64, cost: &mut Cost) -> bool {
        let ray = packed.placed.local(ray);
        packed.flake.tree.any(&ray, t_max, cost, |run, cost| {
            cost.primitives += run.len() as u64;
            let mut balls = packed.flake.leaves[run].iter();
            balls.any(|ball| nearest_root::<f64>(ball.center, ball.radius, &ray, t_max).is_some_and(|t| t < t_max))
        })
    }

    fn surface(packed: &PackedSphereFlake, ray: &Ray, hit: Hit) -> Surface {
        let uv = sphere_uv(packed.outward(ray, hit).1);
        Surface { uv, ..Self::surface_without_uv(packed, ray, hit) }
    }

    fn surface_without_uv(packed: &PackedSphereFlake, ray: &Ray, hit: Hit) -> Surface {
        let placed = &packed.placed;
        let (Ball { center, radius }, outward) = packed.outward(ray, hit);
        let normal = (placed.object_from_world.matrix3.transpose() * outward).normalize_or(DVec3::Y);
        Surface {
            point: placed.world_from_object.transform_point3(center + outward * radius),
            normal,
            shading_normal: normal,
            uv: DVec2::ZERO,
            slot: 0,
            error: placed.error,
        }
    }
}

impl PackedSphereFlake {
    /// The ball that was hit, and the unit vector from its centre to where, object space.
    fn outward(&self, ray: &Ray, hit: Hit) -> (Ball, DVec3) {
        let ball = self.flake.balls[hit.part as usize];
        (ball, (self.placed.local(ray).at(hit.t) - ball.center).normalize_or(DVec3::Y))
    }
}

impl Placed {
    fn local(&self, ray: &Ray) -> Ray {
        ray.transformed(&self.object_from_world)
    }
}

/// A search for the nearest ball.
struct Search<'a> {
    flake: &'a Flake,
    ray: Ray,
    limit: f64,
    best: Option<Hit>,
}

impl Search<'_> {
    /// Tests a run of balls; returns the distance beyond which nothing matters.
    #[inline]
    fn test(&mut self, run: Range<usize>, cost: &mut Cost) -> f64 {
        cost.primitives += run.len() as u64;
        for i in run {
            let Ball { center, radius } = self.flake.leaves[i];
            if let Some(t) = nearest_root::<f64>(center, radius, &self.ray, self.limit) {
                let hit = Hit { t, part: self.flake.tree.order()[i] };
                // On equal distance the lowest index, whatever the order of the walk.
                if self.best.is_none_or(|best| hit.t < best.t || hit.part < best.part) {
                    self.best = Some(hit);
                    self.limit = hit.t;
                }
            }
        }
        self.limit
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;
    use glam::DMat3;

    #[test]
    fn a_flake_larger_than_single_precision_has_no_surface() {
        for (radius, is) in [(1e37, true), (1e38, false), (1e150, false), (f64::INFINITY, false)] {
            assert_eq!(SphereFlake { radius, depth: 1 }.pack(&DAffine3::IDENTITY).is_ok(), is, "{radius}");
        }
    }

    #[test]
    fn balls_touch_the_one_that_carries_them() {
        let balls = SphereFlake { radius: 2.0, depth: 3 }.balls();
        assert_eq!(balls.len(), (9usize.pow(4) - 1) / 8);
        for (n, ball) in balls.iter().enumerate().skip(1) {
            // Children stand in blocks of nine, in the order of their parents.
            let parent = balls[(n - 1) / 9];
            assert_eq!(ball.radius, parent.radius / 3.0);
            let gap = ball.center.distance(parent.center) - ball.radius - parent.radius;
            assert!(gap.abs() < 1e-14, "{n}: {gap}");
        }
    }

    #[test]
    fn normals_stand_on_what_touches_the_ball() {
        let placement =
            DAffine3::from_mat3(DMat3::from_rotation_x(0.9) * DMat3::from_diagonal(DVec3::new(1.0, 0.4, 1.7)));
        let (_, packed) = SphereFlake { depth: 3, ..SphereFlake::default() }.pack(&placement).expect("a flake");
        let mut random = SplitMix64::new(6);
        let mut point = |reach: f64| DVec3::from_array([(); 3].map(|()| reach * (2.0 * random.unit() - 1.0)));
        let mut hits = 0;
        for _ in 0..4000 {
            let origin = point(6.0);
            let ray = Ray { origin, direction: point(1.5) - origin };
            let Some(hit) = SphereFlake::hit(&packed, &ray, f64::INFINITY, &mut Cost::default()) else { continue };
            hits += 1;
            let surface = SphereFlake::surface(&packed, &ray, hit);
            let out =
                placement.inverse().transform_point3(surface.point) - packed.flake.balls[hit.part as usize].center;
            let touching = [out.cross(DVec3::X), out.cross(DVec3::Y), out.cross(DVec3::Z)];
            for tangent in touching.map(|tangent| placement.transform_vector3(tangent).normalize_or_zero()) {
                let sine = surface.normal.dot(tangent).abs();
                assert!(sine < 1e-11, "{ray:?}: {sine:e}");
            }
        }
        assert!(hits > 1500, "{hits}");
    }

    #[test]
    fn the_tree_finds_what_trying_all_balls_finds() {
        let placement = DAffine3::from_scale(DVec3::new(1.0, 2.0, 0.7));
        let (_, packed) = SphereFlake { depth: 3, ..SphereFlake::default() }.pack(&placement).expect("a flake");
        let mut random = SplitMix64::new(5);
        let mut point = |reach: f64| DVec3::from_array([(); 3].map(|()| reach * (2.0 * random.unit() - 1.0)));
        let mut hits = 0;
        for _ in 0..2000 {
            let origin = point(5.0);
            let ray = Ray { origin, direction: point(1.5) - origin };
            let [mut cost, mut all] = [Cost::default(); 2];
            let hit = SphereFlake::hit(&packed, &ray, f64::INFINITY, &mut cost);
            assert_eq!(hit, SphereFlake::hit_with(&packed, &ray, f64::INFINITY, &Methods::BRUTE_FORCE, &mut all));
            assert!(cost.primitives < all.primitives / 4);
            assert_eq!(SphereFlake::blocks(&packed, &ray, 1.0, &mut cost), hit.is_some_and(|hit| hit.t < 1.0));
            let Some(hit) = hit else { continue };
            hits += 1;
            let surface = SphereFlake::surface(&packed, &ray, hit);
            let error = (surface.point - ray.at(hit.t)).length();
            assert!(error <= surface.error, "{error}");
        }
        assert!(hits > 1000, "{hits}");
    }
}
