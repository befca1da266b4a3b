//! The bounding-volume tree: eight children a node, over bounds alone.
//!
//! The tree knows no shape. Whoever builds it keeps the things it bounds in [`Bvh::order`] and tests them in the leaf
//! callback; a mesh does so for its triangles, the acceleration system for all objects of a scene.
//!
//! Boxes are `f32`, rounded outward, and the traversal's own rounding is bounded on the safe side, so a walk visits
//! every leaf whose contents an exact test would hit: the tree can cost time, never change a picture.

mod beam;
mod bins;
mod blocks;
mod box_ray;
mod build;
mod packet;
mod reach;
mod traverse;

use crate::{math, space::Bounds};
use glam::DVec3;

pub(crate) use blocks::{BLOCK, Blocks};
pub(crate) use box_ray::{BoxRays, FARTHEST, above};
pub use packet::fits_boxes;
pub(crate) use packet::{Limits, PacketVisitor};
pub(crate) use reach::{four_surely_reach, reaches, surely_reaches};
pub(crate) use traverse::{Leaf, Visitor};

/// Children of a node.
pub const WIDTH: usize = 8;

/// Most things in one leaf.
pub const MAX_LEAF: usize = 16;

/// Most things in one tree.
pub const MAX_LEN: usize = 1 << 27;

/// A box of `f32` around a box of `f64`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Box32 {
    /// Least coordinates, rounded down.
    pub min: [f32; 3],
    /// Greatest coordinates, rounded up.
    pub max: [f32; 3],
}

impl Box32 {
    /// The box that holds nothing.
    pub const EMPTY: Self = Self { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] };

    /// The smallest `f32` box around `bounds`.
    #[must_use]
    pub fn around(bounds: &Bounds) -> Self {
        Self { min: bounds.min.to_array().map(math::f32_below), max: bounds.max.to_array().map(math::f32_above) }
    }

    /// The smallest box around three `f32` points.
    #[must_use]
    #[inline]
    pub fn of_triangle([a, b, c]: &[[f32; 3]; 3]) -> Self {
        let of = |v: &[f32; 3]| Self { min: *v, max: *v };
        of(a).union(&of(b)).union(&of(c))
    }

    #[inline]
    pub(crate) fn union(&self, other: &Self) -> Self {
        let lower = |a: f32, b: f32| if b < a { b } else { a };
        let upper = |a: f32, b: f32| if b > a { b } else { a };
        Self {
            min: core::array::from_fn(|i| lower(self.min[i], other.min[i])),
            max: core::array::from_fn(|i| upper(self.max[i], other.max[i])),
        }
    }
}

/// One node: the boxes of its children as a structure of arrays.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
struct Node {
    /// Least x, y, z, then greatest x, y, z.
    planes: [[f32; WIDTH]; 6],
    child: [Child; WIDTH],
}

impl Node {
    const EMPTY: Self = {
        let (none, no) = ([f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]);
        Self { planes: [none, none, none, no, no, no], child: [Child(0); WIDTH] }
    };

    /// Whether a lane holds a child.
    fn holds(&self, lane: usize) -> bool {
        self.planes[0][lane] != f32::INFINITY
    }
}

/// A child: a node by index, or a leaf as a run of [`Bvh::order`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;

    fn node(index: usize) -> Self {
        Self(index as u32)
    }

    fn leaf(first: usize, len: usize) -> Self {
        debug_assert!((1..=MAX_LEAF).contains(&len) && first < MAX_LEN);
        Self(Self::LEAF | ((len - 1) as u32) << 27 | first as u32)
    }

    #[inline]
    fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    #[inline]
    fn run(self) -> core::ops::Range<usize> {
        let first = (self.0 & (MAX_LEN as u32 - 1)) as usize;
        first..first + ((self.0 >> 27) & 15) as usize + 1
    }

    #[inline(always)]
    fn leaf_run(self) -> Leaf {
        let core::ops::Range { start, end } = self.run();
        Leaf { first: start, len: end - start }
    }

    /// The same child in a tree whose nodes are stored `nodes` further on.
    fn shifted(self, nodes: usize) -> Self {
        if self.is_leaf() { self } else { Self(self.0 + nodes as u32) }
    }
}

/// A tree over boxes.
#[derive(Clone, Debug)]
pub struct Bvh {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

impl Bvh {
    /// More levels of nodes than any tree has: forty that split by area, below which every level halves the count, and
    /// 2²⁷ things.
    pub(crate) const MAX_DEPTH: usize = 72;

    /// The things in leaf order, by their index among the boxes the tree was built from.
    #[must_use]
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// The leaves as runs of [`Bvh::order`], in order.
    pub fn leaves(&self) -> impl Iterator<Item = core::ops::Range<usize>> {
        let mut leaves: Vec<_> = self
            .nodes
            .iter()
            .flat_map(|node| node.child.iter().enumerate().filter(|(lane, _)| node.holds(*lane)))
            .filter(|(_, child)| child.is_leaf())
            .map(|(_, child)| child.run())
            .collect();
        leaves.sort_by_key(|run| run.start);
        leaves.into_iter()
    }

    /// The boxes of the root's children: up to eight that together hold everything.
    pub fn top_boxes(&self) -> impl Iterator<Item = Bounds> {
        top_boxes(&self.nodes)
    }

    /// Bytes the tree occupies.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.nodes.len() * size_of::<Node>() + self.order.len() * size_of::<u32>()
    }
}

/// The boxes of the root's children.
fn top_boxes(nodes: &[Node]) -> impl Iterator<Item = Bounds> {
    let of = |root: &Node, lane: usize| Bounds {
        min: DVec3::from_array([0, 1, 2].map(|axis| f64::from(root.planes[axis][lane]))),
        max: DVec3::from_array([3, 4, 5].map(|plane| f64::from(root.planes[plane][lane]))),
    };
    let root = nodes.first().into_iter();
    root.flat_map(move |root| (0..WIDTH).filter(|lane| root.holds(*lane)).map(move |lane| of(root, lane)))
}
