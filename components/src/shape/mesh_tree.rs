//! The tree over a mesh's triangles, and the search for hits in it.

use super::{
    mesh::point,
    shear::{Block, RayFrame},
};
use crate::{
    bvh::{BLOCK, Blocks, Box32, Bvh, Leaf, Visitor, reaches},
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
    tree: Blocks,
    blocks: Vec<Block>,
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
            let corners = triangles.map(&corners);
            let vertices = [0, 1, 2].map(|vertex| [0, 1, 2].map(|axis| corners.map(|corners| corners[vertex][axis])));
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

    /// The vertices of a triangle, from where the search has just read them.
    #[inline]
    pub(super) fn vertices(&self, triangle: u32) -> [DVec3; 3] {
        let place = self.places[triangle as usize] as usize;
        self.blocks[place / BLOCK].vertices_of(place % BLOCK)
    }

    /// The nearest hit within `t_max`, the lowest triangle among equally near ones; the ray is in the world.
    pub(super) fn nearest(&self, to: &DAffine3, ray: &Ray, t_max: f64, cost: &mut Cost) -> Option<Hit> {
        lanes::run(Nearest { tree: self, object_from_world: to, ray, t_max, cost })
    }

    /// Whether anything is hit before `t_max`; the ray is in the world.
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
        let mut search = Search { tree, frame: RayFrame::new(&ray), limit: self.t_max, best: None, only_reached: None };
        tree.tree.walk(lanes, &ray, self.t_max, self.cost, &mut search);
        // If what was found last counts, what was found on the way does not matter: all that was passed over is farther.
        let counts = |hit: &Hit| reaches(&ray, &tree.vertices(hit.part), hit.t);
        if search.best.as_ref().is_none_or(counts) {
            return search.best;
        }
        search = Search { limit: self.t_max, best: None, only_reached: Some(&ray), ..search };
        tree.tree.walk(lanes, &ray, self.t_max, self.cost, &mut search);
        search.best
    }
}

struct Search<'a> {
    tree: &'a MeshTree,
    frame: RayFrame,
    limit: f64,
    best: Option<Hit>,
    /// The ray, where each hit is to be checked: see [`reaches`].
    only_reached: Option<&'a Ray>,
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
                let hit = Hit { t: distances[lane], part: block.triangles[lane] };
                if self.only_reached.is_some_and(|ray| !reaches(ray, &block.vertices_of(lane), hit.t)) {
                    continue;
                }
                // On equal distance the lowest index, whatever the order of the walk.
                if self.best.is_none_or(|best| hit.t < best.t || hit.t == best.t && hit.part < best.part) {
                    self.best = Some(hit);
                    self.limit = hit.t;
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
        let mut search = AnySearch { tree, ray: &ray, frame: RayFrame::new(&ray), t_max: self.t_max, found: false };
        tree.tree.walk(lanes, &ray, self.t_max, self.cost, &mut search);
        search.found
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
                if t < self.t_max && reaches(self.ray, &block.vertices_of(lane), t) {
                    self.found = true;
                    return None;
                }
            }
        }
        Some(self.t_max)
    }
}
