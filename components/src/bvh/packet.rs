//! Walking the tree along many rays at once.
//!
//! Every node and leaf is visited once, with the rays that come to it: it is read once, and the tests of the rays do not
//! wait for one another. Where the walk comes first is decided by the nearest of the rays.

use super::{
    Blocks, Bvh, Child, Node, WIDTH,
    beam::Beam,
    box_ray::{BoxRay, BoxRays, FARTHEST, above},
    traverse::Leaf,
};
use crate::{
    lanes::{self, Job, Lanes, Room, Stack, vector},
    packet::{self, Mask, PACKET, Packet, PerRay},
    primitive::Cost,
};
use core::ops::Range;

/// Distances beyond which nothing matters to each ray.
pub(crate) type Limits = [f32; PACKET];

/// What is done with the leaves along rays.
pub(crate) trait PacketVisitor {
    /// Whether a ray ends at the first thing found, so that the nearest need not come first.
    const ANY: bool;

    /// The limits of all rays, each from [`above`](super::above).
    fn limits(&self) -> &Limits;

    /// The rays that are not at their end yet.
    fn alive(&self) -> Mask;

    /// Tells the machine that a leaf will probably be visited.
    #[inline(always)]
    fn soon<L: Lanes>(&self, _: L, _: Leaf) {}

    /// Tests what a leaf holds with the rays that come to it.
    ///
    /// To be `#[inline(always)]`: see [`Job::run`].
    fn visit<L: Lanes>(&mut self, lanes: L, leaf: Leaf, rays: Mask, cost: &mut Cost);
}

/// The valid rays of a packet whose distances to boxes are within the range of `f32`: the others must go alone.
#[must_use]
pub fn fits_boxes(packet: &Packet) -> Mask {
    lanes::run(Fitting(packet))
}

struct Fitting<'a>(&'a Packet);

impl Job for Fitting<'_> {
    type Output = Mask;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Mask {
        let mut fitting = 0;
        let most = l.d_splat(FARTHEST);
        for (group, which) in packet::groups(self.0.valid()) {
            let [[x, y, z], _] = self.0.four(group);
            let within = l.d_le(l.d_abs(l.d_load(x)), most)
                & l.d_le(l.d_abs(l.d_load(y)), most)
                & l.d_le(l.d_abs(l.d_load(z)), most);
            fitting |= Mask::from(within & which) << (4 * group);
        }
        fitting
    }
}

/// Two numbers for each child put aside: see [`super::Bvh::MAX_DEPTH`].
const ROOM: usize = 2 * ((WIDTH - 1) * Bvh::MAX_DEPTH + 1);

/// The rays that reach beyond a distance.
#[inline(always)]
fn reaching<L: Lanes>(l: L, limits: &Limits, distance: f32, rays: Mask) -> Mask {
    let distance = l.f_splat(distance);
    let (mut reach, mut rest) = (0, rays);
    while rest != 0 {
        let group = rest.trailing_zeros() as usize / 8;
        rest &= !(0xff << (8 * group));
        reach |= Mask::from(l.f_le(distance, l.f_load(&limits.as_chunks().0[group]))) << (8 * group);
    }
    rays & reach
}

/// From so many rays on a beam around them tells which children are worth a test against the rays, eight at a time; else
/// each ray is tested against all children.
const MANY: u32 = 16;

/// How many groups of eight hold some rays.
#[inline(always)]
fn eights(rays: Mask) -> u32 {
    let rays = rays | rays >> 4;
    let rays = rays | rays >> 2;
    ((rays | rays >> 1) & 0x0101_0101_0101_0101).count_ones()
}

/// Puts a child aside, and the rays that come to it: farthest first above `base`, if the nearest is to come first.
#[inline(always)]
fn put_aside<L: Lanes, V: PacketVisitor>(
    l: L,
    nodes: &[Node],
    child: Child,
    distance: f32,
    come: Mask,
    base: usize,
    stack: &mut Stack<'_, ROOM>,
    visitor: &V,
) {
    // Nearly all that is put aside will be visited by some ray.
    if child.is_leaf() {
        visitor.soon(l, child.leaf_run());
    } else if let Some(node) = nodes.get(child.0 as usize) {
        l.prefetch(node);
    }
    let key = u64::from(distance.to_bits()) << 32 | u64::from(child.0);
    stack.push(come);
    stack.push(key);
    if !V::ANY {
        // The last is next.
        let new = stack.since(base);
        let mut at = new.len() - 2;
        while at > 0 && new[at - 1] < key {
            (new[at], new[at + 1]) = (new[at - 2], new[at - 1]);
            at -= 2;
        }
        (new[at], new[at + 1]) = (come, key);
    }
}

/// Visits the leaves along the rays, until nothing is left within their limits.
#[inline(always)]
fn walk<L: Lanes, V: PacketVisitor>(
    lanes: L,
    nodes: &[Node],
    boxes: &BoxRays,
    rays: Mask,
    cost: &mut Cost,
    visitor: &mut V,
) {
    let l = lanes;
    if nodes.is_empty() || rays == 0 {
        return;
    }
    let beam = if rays.count_ones() >= MANY { Beam::around(l, boxes, rays) } else { None };
    let mut room = Room::<ROOM>::new();
    let mut stack = Stack::new(&mut room);
    let (mut child, mut rays) = (Child::node(0), rays);
    loop {
        if child.is_leaf() {
            visitor.visit(lanes, child.leaf_run(), rays, cost);
        } else {
            let node = &nodes[child.0 as usize];
            cost.nodes += u64::from(rays.count_ones());
            let base = stack.len();
            let mut by_beam = None;
            if let (Some(beam), true) = (&beam, rays.count_ones() >= MANY) {
                let (near, entered) = beam.enter(l, node);
                // A child and eight rays cost half as much again as a ray and eight children.
                if 3 * entered.count_ones() * eights(rays) <= 2 * rays.count_ones() {
                    by_beam = Some((beam, near, entered));
                }
            }
            if let Some((beam, near, mut entered)) = by_beam {
                let mut distances = [0.0; WIDTH];
                l.f_store(near, &mut distances);
                while entered != 0 {
                    let lane = entered.trailing_zeros() as usize % WIDTH;
                    entered &= entered - 1;
                    let come = beam.entering(l, boxes, node, lane, visitor.limits(), rays);
                    if come != 0 {
                        put_aside(l, nodes, node.child[lane], distances[lane], come, base, &mut stack, visitor);
                    }
                }
            } else {
                let mut entering = l.m_none();
                let mut distances = l.f_splat(f32::INFINITY);
                let mut entered = 0;
                let limits = visitor.limits();
                let mut rest = rays;
                while rest != 0 {
                    let (i, bit) = (rest.trailing_zeros() as usize, rest & rest.wrapping_neg());
                    rest ^= bit;
                    let (near, far) = BoxRay::one_of(l, boxes, i).distances(l, node, limits[i]);
                    let (least, mask) = l.f_least_of_le(near, far, distances);
                    distances = least;
                    entered |= mask;
                    entering = l.m_set(entering, mask, bit);
                }
                let mut come = [0; WIDTH];
                l.m_store(entering, &mut come);
                let mut near = [0.0; WIDTH];
                l.f_store(distances, &mut near);
                while entered != 0 {
                    let lane = entered.trailing_zeros() as usize % WIDTH;
                    entered &= entered - 1;
                    put_aside(l, nodes, node.child[lane], near[lane], come[lane], base, &mut stack, visitor);
                }
            }
        }
        loop {
            let (Some(key), Some(come)) = (stack.pop(), stack.pop()) else { return };
            rays = come & visitor.alive();
            if !V::ANY && rays != 0 {
                rays = reaching(l, visitor.limits(), f32::from_bits((key >> 32) as u32), rays);
            }
            if rays != 0 {
                child = Child(key as u32);
                break;
            }
        }
    }
}

impl Blocks {
    /// Visits the blocks along some rays, until nothing is left within their limits.
    #[inline(always)]
    pub(crate) fn walk_packet<L: Lanes>(
        &self,
        lanes: L,
        boxes: &BoxRays,
        rays: Mask,
        cost: &mut Cost,
        visitor: &mut impl PacketVisitor,
    ) {
        walk(lanes, &self.nodes, boxes, rays, cost, visitor);
    }
}

/// The walk of a [`Bvh`] as a job.
struct Walk<'a, F, const ANY: bool> {
    tree: &'a Bvh,
    packet: &'a Packet,
    rays: Mask,
    runs: Runs<F, ANY>,
    cost: &'a mut Cost,
}

/// Leaves as runs of [`Bvh::order`].
struct Runs<F, const ANY: bool> {
    leaf: F,
    limits: Limits,
    alive: Mask,
}

impl<F: FnMut(Range<usize>, Mask, &mut Limits, &mut Cost) -> Mask, const ANY: bool> PacketVisitor for Runs<F, ANY> {
    const ANY: bool = ANY;

    #[inline(always)]
    fn limits(&self) -> &Limits {
        &self.limits
    }

    #[inline(always)]
    fn alive(&self) -> Mask {
        self.alive
    }

    #[inline(always)]
    fn visit<L: Lanes>(&mut self, _: L, leaf: Leaf, rays: Mask, cost: &mut Cost) {
        self.alive &= !(self.leaf)(leaf.first..leaf.first + leaf.len, rays, &mut self.limits, cost);
    }
}

impl<F: FnMut(Range<usize>, Mask, &mut Limits, &mut Cost) -> Mask, const ANY: bool> Job for Walk<'_, F, ANY> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(mut self, lanes: L) {
        let mut boxes = BoxRays::new();
        let l = lanes;
        for (group, _) in packet::groups(self.rays) {
            let Packet { origins, directions, .. } = self.packet;
            boxes.set(l, group, vector::load(l, origins, group), vector::load(l, directions, group));
        }
        walk(lanes, &self.tree.nodes, &boxes, self.rays, self.cost, &mut self.runs);
    }
}

impl Bvh {
    /// [`Bvh::walk`] along some rays of a packet, which must be [fit for boxes](fits_boxes).
    ///
    /// `leaf` gets a run of [`Bvh::order`] and the rays that come to it, and lowers the distances beyond which nothing
    /// matters to each.
    pub fn walk_packet(
        &self,
        packet: &Packet,
        rays: Mask,
        limits: &mut PerRay,
        cost: &mut Cost,
        mut leaf: impl FnMut(Range<usize>, Mask, &mut PerRay, &mut Cost),
    ) {
        let rounded = limits.map(above);
        let leaf = |run: Range<usize>, rays: Mask, rounded: &mut Limits, cost: &mut Cost| {
            leaf(run, rays, limits, cost);
            for i in packet::each(rays) {
                rounded[i] = above(limits[i]);
            }
            0
        };
        let runs = Runs { leaf, limits: rounded, alive: rays };
        lanes::run(Walk::<_, false> { tree: self, packet, rays, runs, cost });
    }

    /// [`Bvh::any`] along some rays of a packet, which must be [fit for boxes](fits_boxes): which of them `leaf` tells
    /// to be blocked.
    pub fn any_packet(
        &self,
        packet: &Packet,
        rays: Mask,
        limits: &PerRay,
        cost: &mut Cost,
        mut leaf: impl FnMut(Range<usize>, Mask, &mut Cost) -> Mask,
    ) -> Mask {
        let mut blocked = 0;
        let leaf = |run: Range<usize>, rays: Mask, _: &mut Limits, cost: &mut Cost| {
            let more = leaf(run, rays, cost);
            blocked |= more;
            more
        };
        let runs = Runs { leaf, limits: limits.map(above), alive: rays };
        lanes::run(Walk::<_, true> { tree: self, packet, rays, runs, cost });
        blocked
    }
}
