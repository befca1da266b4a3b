//! A tree whose leaves are blocks of four things, tested together on lanes.

use super::{Bvh, Node};

/// Things in a block.
pub(crate) const BLOCK: usize = 4;

/// A tree over blocks: a leaf is one block of one to four things.
#[derive(Clone, Debug)]
pub(crate) struct Blocks {
    pub(super) nodes: Vec<Node>,
}

impl Blocks {
    /// Makes each leaf of a tree a block; the leaves must hold at most four things.
    ///
    /// Tells the things of each block, by their index among the boxes the tree was built from; the last of a block that
    /// is not full is repeated.
    pub(crate) fn new(tree: Bvh) -> (Self, Vec<[u32; BLOCK]>) {
        let Bvh { mut nodes, order: things } = tree;
        let mut order = vec![];
        for node in &mut nodes {
            for lane in 0..super::WIDTH {
                if node.holds(lane) && node.child[lane].is_leaf() {
                    let run = node.child[lane].run();
                    let members = &things[run.clone()];
                    node.child[lane] = super::Child::leaf(order.len(), run.len());
                    order.push(core::array::from_fn(|i| members[i.min(members.len() - 1)]));
                }
            }
        }
        (Self { nodes }, order)
    }

    /// The boxes of the root's children: up to eight that together hold everything.
    pub(crate) fn top_boxes(&self) -> impl Iterator<Item = crate::space::Bounds> {
        super::top_boxes(&self.nodes)
    }

    pub(crate) fn bytes(&self) -> usize {
        self.nodes.len() * size_of::<Node>()
    }
}
