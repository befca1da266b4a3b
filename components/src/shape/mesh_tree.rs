//! The tree over a mesh's triangles, and the search for hits in it.

use super::{
    mesh::point,
    shear::{Block, RayFrame},
};
use crate::{
    bvh::{BLOCK, Blocks, Box32, Bvh, Leaf, Visitor, reaches, surely_reaches},
    lanes::{self, Job, Lanes},
    pages,
    primitive::{Cost, Hit},
    space::{BoundingSphere, Bounds, Ray},
};
use glam::{DAffine3, DVec3};
use rayon::prelude::*;

/// A tree, and the triangles in the order of its leaves: four in a block.
#[derive(Debug)]
pub(super) struct MeshTree {
    pub(super) tree: Blocks,
    pub(super) blocks: Vec<Block>,
    /// Where each triangle stands: four times its block and its lane.
    places: Vec<u32>,
    /// Around all triangles, object space.
    pub(super) sphere: BoundingSphere,
    /// Largest coordinate of a vertex.
    pub(super) magnitude: f64,
}

impl MeshTree {
    /// Builds the tree over `len` triangles.
    pub(super) fn build(len: usize, corners: impl Fn(u32) -> [[f32; 3]; 3] + Sync) -> Self {
        let tree = Bvh::build_with(len, |i| Box32::of_triangle(&corners(i as u32)), BLOCK);
        let (tree, order) = Blocks::new(tree);
        let block = |triangles: &[u32; BLOCK]| {
            // Plain loops: maps over arrays are calls.
            let mut vertices = [[[0.0; BLOCK]; 3]; 3];
            for (lane, &triangle) in triangles.iter().enumerate() {
                let corners = corners(triangle);
                for (vertex, corner) in vertices.iter_mut().zip(corners) {
                    for axis in 0..3 {
                        vertex[axis][lane] = corner[axis];
                    }
                }
            }
            Block { vertices, triangles: *triangles }
        };
        let mut blocks = pages::with_room(order.len());
        order.par_iter().with_min_len(1024).map(block).collect_into_vec(&mut blocks);
        let mut places = vec![0; len];
        for (i, &triangle) in order.as_flattened().iter().enumerate() {
            places[triangle as usize] = i as u32;
        }
        let all = || (0..len).flat_map(|i| corners(i as u32)).map(point);
        // Vertices are `f32` as the boxes are, so these are the exact bounds.
        let bounds = tree.top_boxes().fold(Bounds::EMPTY, Bounds::union);
        let sphere = BoundingSphere::about(bounds.center(), all());
        let magnitude = bounds.min.abs().max(bounds.max.abs()).max_element();
        Self { tree, blocks, places, sphere, magnitude }
    }

    /// Up to eight boxes that together hold all triangles, object space.
    pub(super) fn top_boxes(&self) -> impl Iterator<Item = Bounds> {
        self.tree.top_boxes()
    }

    /// Bytes it occupies.
    pub(super) fn bytes(&self) -> usize {
        self.tree.bytes() + self.blocks.len() * size_of::<Block>() + self.places.len() * size_of::<u32>()
    }

    /// The block that a triangle stands in, and its lane there.
    #[inline]
    pub(super) fn block_of(&self, triangle: u32) -> (&Block, usize) {
        let place = self.places[triangle as usize] as usize;
        (&self.blocks[place / BLOCK], place % BLOCK)
    }

    /// The vertices of a triangle, from where the search has just read them.
    #[inline]
    pub(super) fn vertices(&self, triangle: u32) -> [DVec3; 3] {
        let (block, lane) = self.block_of(triangle);
        block.vertices_of(lane)
    }

    /// The nearest hit within `t_max`, the lowest triangle among equally near ones; the ray is in the world.
    #[inline]
    pub(super) fn nearest(&self, to: &DAffine3, ray: &Ray, t_max: f64, cost: &mut Cost) -> Option<Hit> {
        lanes::run(Nearest { tree: self, object_from_world: to, ray, t_max, cost })
    }

    /// Whether anything is hit before `t_max`; the ray is in the world.
    #[inline]
    pub(super) fn blocks(&self, to: &DAffine3, ray: &Ray, t_max: f64, cost: &mut Cost) -> bool {
        lanes::run(Blocked { tree: self, object_from_world: to, ray, t_max, cost })
    }
}

/// The search for the nearest triangle.
struct Nearest<'a> {
    tree: &'a MeshTree,
    object_from_world: &'a DAffine3,
    ray: &'a Ray,
    t_max: f64,
    cost: &'a mut Cost,
}

impl Job for Nearest<'_> {
    type Output = Option<Hit>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Option<Hit> {
        let ray = self.ray.transformed(self.object_from_world);
        let tree = self.tree;
        let search = tree.tree.walk(lanes, &ray, self.t_max, self.cost, || Search::new(tree, &ray, self.t_max))?;
        // If what was found last counts, what was found on the way does not matter: all that was passed over is farther.
        if search.is_reached(lanes, &ray) {
            return search.found();
        }
        let again = || Search { only_reached: Some(&ray), ..Search::new(tree, &ray, self.t_max) };
        tree.tree.walk(lanes, &ray, self.t_max, self.cost, again)?.found()
    }
}

struct Search<'a> {
    tree: &'a MeshTree,
    frame: RayFrame,
    /// The distance of what was found, or the end of the ray.
    limit: f64,
    /// The triangle that was found, or [`NONE`].
    triangle: u32,
    /// Where it stands: see [`MeshTree::places`].
    place: usize,
    /// The ray, where each hit is to be checked: see [`reaches`].
    only_reached: Option<&'a Ray>,
}

/// More than the number of any triangle.
pub(super) const NONE: u32 = u32::MAX;

impl<'a> Search<'a> {
    #[inline(always)]
    fn new(tree: &'a MeshTree, ray: &Ray, t_max: f64) -> Self {
        Self { tree, frame: RayFrame::new(ray), limit: t_max, triangle: NONE, place: 0, only_reached: None }
    }

    /// Whether what was found counts; see [`reaches`].
    #[inline(always)]
    fn is_reached<L: Lanes>(&self, lanes: L, ray: &Ray) -> bool {
        self.triangle == NONE
            || counts(lanes, ray, &self.tree.blocks[self.place / BLOCK], self.place % BLOCK, self.limit)
    }

    #[inline(always)]
    fn found(&self) -> Option<Hit> {
        (self.triangle != NONE).then_some(Hit { t: self.limit, part: self.triangle })
    }
}

/// Whether a walk comes to a triangle of a block in time for a hit of it: see [`reaches`].
#[inline(always)]
pub(super) fn counts<L: Lanes>(lanes: L, ray: &Ray, block: &Block, lane: usize, t: f64) -> bool {
    surely_reaches(lanes, ray, block.bounds_of(lane), t) || reaches(ray, &block.vertices_of(lane), t)
}

impl Visitor for Search<'_> {
    const ANY: bool = false;

    #[inline(always)]
    fn visit<L: Lanes>(&mut self, lanes: L, leaf: Leaf, cost: &mut Cost) -> Option<f64> {
        cost.primitives += leaf.len as u64;
        let block = &self.tree.blocks[leaf.first];
        if let Some((mut hits, distances)) = self.frame.hit_block(lanes, block, self.limit) {
            while hits != 0 {
                let lane = hits.trailing_zeros() as usize % BLOCK;
                hits &= hits - 1;
                let (t, triangle) = (distances[lane], block.triangles[lane]);
                if self.only_reached.is_some_and(|ray| !counts(lanes, ray, block, lane, t)) {
                    continue;
                }
                // On equal distance the lowest index, whatever the order of the walk.
                if t < self.limit || t == self.limit && triangle < self.triangle {
                    (self.limit, self.triangle, self.place) = (t, triangle, leaf.first * BLOCK + lane);
                }
            }
        }
        Some(self.limit)
    }
}

/// The search for any triangle before the end of a ray.
struct Blocked<'a> {
    tree: &'a MeshTree,
    object_from_world: &'a DAffine3,
    ray: &'a Ray,
    t_max: f64,
    cost: &'a mut Cost,
}

impl Job for Blocked<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> bool {
        let ray = self.ray.transformed(self.object_from_world);
        let tree = self.tree;
        let search = || AnySearch { tree, ray: &ray, frame: RayFrame::new(&ray), t_max: self.t_max, found: false };
        tree.tree.walk(lanes, &ray, self.t_max, self.cost, search).is_some_and(|search| search.found)
    }
}

struct AnySearch<'a> {
    tree: &'a MeshTree,
    ray: &'a Ray,
    frame: RayFrame,
    t_max: f64,
    found: bool,
}

impl Visitor for AnySearch<'_> {
    const ANY: bool = true;

    #[inline(always)]
    fn visit<L: Lanes>(&mut self, lanes: L, leaf: Leaf, cost: &mut Cost) -> Option<f64> {
        cost.primitives += leaf.len as u64;
        let block = &self.tree.blocks[leaf.first];
        if let Some((mut hits, distances)) = self.frame.hit_block(lanes, block, self.t_max) {
            while hits != 0 {
                let lane = hits.trailing_zeros() as usize % BLOCK;
                hits &= hits - 1;
                let t = distances[lane];
                if t < self.t_max && counts(lanes, self.ray, block, lane, t) {
                    self.found = true;
                    return None;
                }
            }
        }
        Some(self.t_max)
    }
}
