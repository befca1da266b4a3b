//! Meshes met by other methods than the default ones.

use super::{
    mesh::{TriangleMesh, point},
    triangle_kernel::{TriangleKernel, WithKernel, choose},
};
use crate::{
    bvh::{Box32, Bvh, reaches},
    method::{Accelerator, Methods},
    primitive::{Cost, Hit},
    space::{BoundingSphere, Bounds, Ray},
    sphere_tree::SphereTree,
};
use core::ops::Range;
use std::sync::OnceLock;

/// Most triangles in a leaf of the tree of boxes, as in the one of the default methods.
const LEAF: usize = 4;

type Corners = [[f32; 3]; 3];

/// What other methods need; made when first asked for.
#[derive(Debug, Default)]
pub(super) struct OtherTrees {
    /// A tree of boxes with plain leaves, and the triangles in its order.
    boxes: OnceLock<(Bvh, Vec<Corners>)>,
    /// The tree of spheres, and the triangles in its order.
    spheres: OnceLock<(SphereTree, Vec<Corners>)>,
}

impl TriangleMesh {
    /// The nearest hit in object space, on equal distance of the lowest triangle.
    pub(super) fn hit_with(&self, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> Option<Hit> {
        choose(with, ray, Nearest { mesh: self, ray, t_max, with, cost })
    }

    /// Whether a triangle is hit with `0 < t < t_max`, object space.
    pub(super) fn blocks_with(&self, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> bool {
        choose(with, ray, Any { mesh: self, ray, t_max, with, cost })
    }

    fn boxes(&self) -> &(Bvh, Vec<Corners>) {
        self.others.boxes.get_or_init(|| {
            let tree = Bvh::build((0..self.len()).map(|i| Box32::around(&Bounds::of_points(self.corners(i)))), LEAF);
            let triangles = self.ordered(tree.order());
            (tree, triangles)
        })
    }

    fn spheres(&self) -> &(SphereTree, Vec<Corners>) {
        self.others.spheres.get_or_init(|| {
            let tree = SphereTree::build((0..self.len()).map(|i| BoundingSphere::of_triangle(self.corners(i))));
            let triangles = self.ordered(tree.order());
            (tree, triangles)
        })
    }

    fn ordered(&self, order: &[u32]) -> Vec<Corners> {
        order.iter().map(|&i| self.corners(i as usize).map(|v| v.as_vec3().to_array())).collect()
    }
}

/// The nearest hit.
struct Nearest<'a> {
    mesh: &'a TriangleMesh,
    ray: &'a Ray,
    t_max: f64,
    with: &'a Methods,
    cost: &'a mut Cost,
}

impl WithKernel for Nearest<'_> {
    type Output = Option<Hit>;

    fn run<K: TriangleKernel>(self, kernel: &K) -> Option<Hit> {
        let Self { mesh, ray, t_max, with, cost } = self;
        let mut search = Search { ray, kernel, limit: t_max, best: None };
        match with.accelerator {
            Accelerator::Tree => {
                let (tree, triangles) = mesh.boxes();
                tree.walk(ray, t_max, cost, |run, _, cost| search.test(run, triangles, tree.order(), cost));
            }
            Accelerator::SphereTree => {
                let (tree, triangles) = mesh.spheres();
                tree.walk(ray, t_max, cost, |run, _, cost| search.test(run, triangles, tree.order(), cost));
            }
            Accelerator::BruteForce => {
                let (tree, triangles) = mesh.boxes();
                search.test(0..mesh.len(), triangles, tree.order(), cost);
            }
        }
        search.best
    }
}

/// Whether anything is hit.
struct Any<'a> {
    mesh: &'a TriangleMesh,
    ray: &'a Ray,
    t_max: f64,
    with: &'a Methods,
    cost: &'a mut Cost,
}

impl WithKernel for Any<'_> {
    type Output = bool;

    fn run<K: TriangleKernel>(self, kernel: &K) -> bool {
        let Self { mesh, ray, t_max, with, cost } = self;
        let test = |run: Range<usize>, triangles: &[Corners], cost: &mut Cost| {
            triangles[run].iter().any(|corners| {
                cost.primitives += 1;
                let vertices = corners.map(point);
                kernel.hit(vertices, t_max).is_some_and(|hit| hit.t < t_max && reaches(ray, &vertices, hit.t))
            })
        };
        match with.accelerator {
            Accelerator::Tree => {
                let (tree, triangles) = mesh.boxes();
                tree.any(ray, t_max, cost, |run, cost| test(run, triangles, cost))
            }
            Accelerator::SphereTree => {
                let (tree, triangles) = mesh.spheres();
                tree.any(ray, t_max, cost, |run, cost| test(run, triangles, cost))
            }
            Accelerator::BruteForce => test(0..mesh.len(), &mesh.boxes().1, cost),
        }
    }
}

/// A search for the nearest triangle.
struct Search<'a, K> {
    ray: &'a Ray,
    kernel: &'a K,
    limit: f64,
    best: Option<Hit>,
}

impl<K: TriangleKernel> Search<'_, K> {
    /// Tests a run of triangles; returns the distance beyond which nothing matters.
    fn test(&mut self, run: Range<usize>, triangles: &[Corners], order: &[u32], cost: &mut Cost) -> f64 {
        cost.primitives += run.len() as u64;
        for i in run {
            let vertices = triangles[i].map(point);
            let hit = self.kernel.hit(vertices, self.limit);
            if let Some(hit) = hit.filter(|hit| reaches(self.ray, &vertices, hit.t)) {
                let hit = Hit { t: hit.t, part: order[i] };
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
