//! Every shape of a scene, and the tree over them.

use super::pool::{Best, ErasedPool, Nearest};
use core::ops::Range;
use snell_components::{
    bvh::{Box32, Bvh},
    method::{Accelerator, Methods, Precision},
    primitive::{Cost, Extent, Hit, Surface},
    space::{BoundingSphere, Ray},
    sphere_tree::SphereTree,
};
use std::sync::{Arc, OnceLock};

/// Most shapes in a leaf of the tree over all shapes.
const LEAF: usize = 2;

/// Up to so many shapes are tested one by one: preparing a ray for boxes costs more than it saves.
const FLAT: usize = 4;

/// A run of shapes of one type.
#[derive(Clone, Copy, Debug)]
struct Run {
    pool: u32,
    first: u32,
    end: u32,
    /// The object of the first shape.
    owner: u32,
}

impl Run {
    fn range(&self) -> Range<usize> {
        self.first as usize..self.end as usize
    }
}

/// Where a ray met an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Intersection {
    /// The surface.
    pub surface: Surface,
    /// Distance in units of the ray's direction.
    pub t: f64,
    /// Rank of the object in the order of names.
    pub object: u32,
}

impl Intersection {
    /// Of what [`Geometry::nearest`] found and the surface there.
    #[must_use]
    pub fn new(nearest: &Nearest, surface: Surface) -> Self {
        Self { surface, t: nearest.hit.t, object: nearest.object }
    }
}

/// Every shape of a scene; immutable and shared.
#[derive(Default)]
pub struct Geometry {
    /// Over all bounded shapes, unless they are few.
    tree: Option<Bvh>,
    pools: Vec<Arc<dyn ErasedPool>>,
    /// Runs of the tree's leaves, in leaf order.
    runs: Vec<Run>,
    /// For each position in the tree's order at which a leaf begins, its runs.
    leaf_runs: Vec<(u32, u32)>,
    /// Shapes that no box holds; tested by every ray.
    unbounded: Vec<Run>,
    /// Made when first asked for.
    spheres: OnceLock<Spheres>,
}

/// The shapes of the tree sorted into a tree of spheres.
struct Spheres {
    tree: SphereTree,
    /// One shape each, in the tree's order.
    runs: Vec<Run>,
}

/// A surface as it is known with a choice of methods: with shorter numbers as much less surely.
#[inline]
fn less_sure(mut surface: Surface, t: f64, ray: &Ray, with: &Methods) -> Surface {
    if with.precision == Precision::F32 {
        let travelled = t * ray.direction.length();
        surface.error += Surface::rounding(surface.point.abs().max_element() + travelled);
        surface.error *= f64::from(f32::EPSILON) / f64::EPSILON;
    }
    surface
}

impl Geometry {
    /// Builds the tree over the shapes of some pools.
    #[must_use]
    pub fn build<'a>(pools: impl Iterator<Item = &'a Arc<dyn ErasedPool>>) -> Self {
        let pools: Vec<_> = pools.collect();
        let mut boxes = vec![];
        let mut shapes = vec![];
        let mut orders: Vec<Vec<u32>> = vec![vec![]; pools.len()];
        for (pool, shapes_of_pool) in pools.iter().enumerate() {
            for (index, extent) in shapes_of_pool.extents().iter().enumerate() {
                match extent {
                    Extent::Bounded(bounds) => {
                        boxes.push(Box32::around(bounds));
                        shapes.push((pool as u32, index as u32));
                    }
                    // Unbounded shapes come first in their pool.
                    Extent::Unbounded => orders[pool].push(index as u32),
                }
            }
        }
        let owner = |pool: usize, order: &[u32]| order.first().map_or(0, |&i| pools[pool].objects()[i as usize]);
        let whole = |(pool, order): (usize, &Vec<u32>)| {
            let owner = owner(pool, order);
            Run { pool: pool as u32, first: 0, end: order.len() as u32, owner }
        };
        let unbounded: Vec<Run> = orders.iter().enumerate().map(whole).filter(|run| run.end > 0).collect();

        let tree = Bvh::build(boxes.into_iter(), LEAF);
        let mut runs: Vec<Run> = vec![];
        let mut leaf_runs = vec![(0, 0); shapes.len()];
        for leaf in tree.leaves() {
            let start = leaf.start;
            let begin = runs.len();
            let mut members: Vec<_> = tree.order()[leaf].iter().map(|&i| shapes[i as usize]).collect();
            members.sort_unstable();
            for (pool, index) in members {
                let order = &mut orders[pool as usize];
                let at = order.len() as u32;
                match runs[begin..].last_mut() {
                    Some(run) if run.pool == pool => run.end += 1,
                    _ => runs.push(Run { pool, first: at, end: at + 1, owner: owner(pool as usize, &[index]) }),
                }
                order.push(index);
            }
            leaf_runs[start] = (begin as u32, runs.len() as u32);
        }
        let pools = pools.iter().zip(&orders).map(|(pool, order)| pool.permuted(order)).collect();
        let tree = (shapes.len() > FLAT).then_some(tree);
        Self { tree, pools, runs, leaf_runs, unbounded, spheres: OnceLock::new() }
    }

    /// The sphere around an object, by its rank in the order of names, if it is bounded; looks through all objects.
    #[must_use]
    pub fn bounding_sphere(&self, object: u32) -> Option<BoundingSphere> {
        self.pools.iter().find_map(|pool| {
            let index = pool.objects().iter().position(|known| *known == object)?;
            pool.bounding_sphere(index as u32)
        })
    }

    /// [`Geometry::nearest`] with the surface there.
    #[must_use]
    pub fn closest(&self, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> Option<Intersection> {
        let nearest = self.nearest(ray, t_max, with, cost)?;
        Some(Intersection::new(&nearest, self.surface(&nearest, ray, with)))
    }

    /// The surface at what [`Geometry::nearest`] found for this ray with these methods.
    #[must_use]
    #[inline]
    pub fn surface(&self, nearest: &Nearest, ray: &Ray, with: &Methods) -> Surface {
        let Nearest { hit, pool, index, .. } = *nearest;
        less_sure(self.pools[pool as usize].surface(index, ray, hit), hit.t, ray, with)
    }

    /// [`Geometry::surface`] but for the texture coordinates, which mean nothing: where no texture asks for them.
    #[must_use]
    #[inline]
    pub fn surface_without_uv(&self, nearest: &Nearest, ray: &Ray, with: &Methods) -> Surface {
        let Nearest { hit, pool, index, .. } = *nearest;
        less_sure(self.pools[pool as usize].surface_without_uv(index, ray, hit), hit.t, ray, with)
    }

    /// How a surface that was met goes on: where a ray close by, at a distance `t`, crosses its tangent plane.
    #[must_use]
    pub fn beside(&self, met: &Nearest, ray: &Ray, t: f64) -> Surface {
        let Nearest { hit, pool, index, .. } = *met;
        self.pools[pool as usize].surface(index, ray, Hit { t, ..hit })
    }

    /// Nearest hit with `0 < t <= t_max`; among equally near ones the object first in the order of names.
    #[must_use]
    pub fn nearest(&self, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> Option<Nearest> {
        self.nearest_by(ray, t_max, with, cost, |run, best, cost| {
            self.pools[run.pool as usize].closest(run.range(), ray, with, best, cost);
        })
    }

    /// [`Geometry::nearest`] among some objects, told by their ranks.
    #[must_use]
    pub fn nearest_of(
        &self,
        objects: impl Fn(u32) -> bool,
        ray: &Ray,
        t_max: f64,
        with: &Methods,
        cost: &mut Cost,
    ) -> Option<Nearest> {
        self.nearest_by(ray, t_max, with, cost, |run, best, cost| {
            for run in self.parts(run, &objects) {
                self.pools[run.pool as usize].closest(run.range(), ray, with, best, cost);
            }
        })
    }

    /// The shapes of a run that belong to some objects, each a run of its own.
    #[inline]
    fn parts(&self, run: &Run, objects: impl Fn(u32) -> bool) -> impl Iterator<Item = Run> {
        let Run { pool, first, end, owner } = *run;
        // Most runs are of one shape.
        let rest = if end - first > 1 { self.pools[pool as usize].objects() } else { &[] };
        let owner = move |i: u32| if i == first { owner } else { rest[i as usize] };
        (first..end)
            .map(move |i| Run { pool, first: i, end: i + 1, owner: owner(i) })
            .filter(move |run| objects(run.owner))
    }

    /// The nearest hit, where `search` looks through a run.
    #[inline]
    fn nearest_by(
        &self,
        ray: &Ray,
        t_max: f64,
        with: &Methods,
        cost: &mut Cost,
        search: impl Fn(&Run, &mut Best, &mut Cost),
    ) -> Option<Nearest> {
        if !ray.is_valid() {
            return None;
        }
        let mut best = Best { pool: 0, limit: t_max, nearest: None };
        let search = |run: &Run, best: &mut Best, cost: &mut Cost| {
            best.pool = run.pool;
            search(run, best, cost);
        };
        for run in &self.unbounded {
            search(run, &mut best, cost);
        }
        match (&self.tree, with.accelerator) {
            (Some(tree), Accelerator::Tree) => tree.walk(ray, best.limit, cost, |leaf, _, cost| {
                let (begin, end) = self.leaf_runs[leaf.start];
                for run in &self.runs[begin as usize..end as usize] {
                    search(run, &mut best, cost);
                }
                best.limit
            }),
            (_, Accelerator::SphereTree) if !self.runs.is_empty() => {
                let Spheres { tree, runs } = self.spheres();
                tree.walk(ray, best.limit, cost, |own, _, cost| {
                    for run in &runs[own] {
                        search(run, &mut best, cost);
                    }
                    best.limit
                });
            }
            _ => {
                for run in &self.runs {
                    search(run, &mut best, cost);
                }
            }
        }
        best.nearest
    }

    /// Whether anything is hit with `0 < t < t_max`.
    #[must_use]
    pub fn blocked(&self, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> bool {
        self.blocked_if(ray, t_max, with, cost, |run, cost| {
            self.pools[run.pool as usize].blocks(run.range(), ray, t_max, with, cost)
        })
    }

    /// [`Geometry::blocked`] by some objects, told by their ranks.
    #[must_use]
    pub fn blocked_by(
        &self,
        objects: impl Fn(u32) -> bool,
        ray: &Ray,
        t_max: f64,
        with: &Methods,
        cost: &mut Cost,
    ) -> bool {
        self.blocked_if(ray, t_max, with, cost, |run, cost| {
            let blocks = |run: Run| self.pools[run.pool as usize].blocks(run.range(), ray, t_max, with, cost);
            self.parts(run, &objects).any(blocks)
        })
    }

    /// Whether any run `blocks` the ray.
    #[inline]
    fn blocked_if(
        &self,
        ray: &Ray,
        t_max: f64,
        with: &Methods,
        cost: &mut Cost,
        blocks: impl Fn(&Run, &mut Cost) -> bool,
    ) -> bool {
        if !ray.is_valid() {
            return false;
        }
        if self.unbounded.iter().any(|run| blocks(run, cost)) {
            return true;
        }
        match (&self.tree, with.accelerator) {
            (Some(tree), Accelerator::Tree) => tree.any(ray, t_max, cost, |leaf, cost| {
                let (begin, end) = self.leaf_runs[leaf.start];
                self.runs[begin as usize..end as usize].iter().any(|run| blocks(run, cost))
            }),
            (_, Accelerator::SphereTree) if !self.runs.is_empty() => {
                let Spheres { tree, runs } = self.spheres();
                tree.any(ray, t_max, cost, |own, cost| runs[own].iter().any(|run| blocks(run, cost)))
            }
            _ => self.runs.iter().any(|run| blocks(run, cost)),
        }
    }

    fn spheres(&self) -> &Spheres {
        self.spheres.get_or_init(|| {
            let owner = |pool: u32, i: u32| self.pools[pool as usize].objects()[i as usize];
            let one = |pool: u32, i: u32| Run { pool, first: i, end: i + 1, owner: owner(pool, i) };
            let each = |&Run { pool, first, end, .. }: &Run| (first..end).map(move |i| one(pool, i));
            let shapes: Vec<Run> = self.runs.iter().flat_map(each).collect();
            let sphere = |run: &Run| self.pools[run.pool as usize].bounding_sphere(run.first);
            let tree = SphereTree::build(shapes.iter().filter_map(sphere));
            let runs = tree.order().iter().map(|&i| shapes[i as usize]).collect();
            Spheres { tree, runs }
        })
    }
}
