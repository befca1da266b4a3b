//! The search of many rays at once in a mesh's tree.

use super::{
    mesh_tree::{MeshTree, NONE, counts},
    shear::RayFrame,
};
use crate::{
    bvh::{BLOCK, BoxRays, Leaf, Limits, PacketVisitor, above, is_beyond_boxes},
    lanes::{self, Job, Lanes},
    packet::{self, Hits, Mask, PACKET, Packet, PerRay},
    primitive::Cost,
    space::Ray,
};
use glam::{DAffine3, DVec3};

/// Fewer rays than this go one by one: preparing them for the walk together costs more than it saves.
const FEW: u32 = 3;

impl MeshTree {
    /// [`MeshTree::nearest`] for some rays of a packet: tells which hit, and where.
    pub(super) fn nearest_packet(
        &self,
        to: &DAffine3,
        packet: &Packet,
        rays: Mask,
        t_max: &PerRay,
        hits: &mut Hits,
        cost: &mut Cost,
    ) -> Mask {
        let mut met = 0;
        let mut alone = rays;
        if rays.count_ones() >= FEW {
            (met, alone) = lanes::run(Nearest { tree: self, to, packet, rays, t_max, hits, cost });
        }
        met | packet::hit_each(alone, hits, |i| self.nearest(to, &packet.ray(i), t_max[i], cost))
    }

    /// [`MeshTree::blocks`] for some rays of a packet: tells which are blocked.
    pub(super) fn blocks_packet(
        &self,
        to: &DAffine3,
        packet: &Packet,
        rays: Mask,
        t_max: &PerRay,
        cost: &mut Cost,
    ) -> Mask {
        let mut blocked = 0;
        let mut alone = rays;
        if rays.count_ones() >= FEW {
            (blocked, alone) = lanes::run(Blocked { tree: self, to, packet, rays, t_max, cost });
        }
        for i in packet::each(alone) {
            blocked |= Mask::from(self.blocks(to, &packet.ray(i), t_max[i], cost)) << i;
        }
        blocked
    }
}

/// Some rays in the space of a mesh, prepared for its boxes and triangles.
struct Placed {
    rays: [Ray; PACKET],
    frames: [RayFrame; PACKET],
    boxes: BoxRays,
    /// The rays that are to be walked together; the others, which no box could tell from, go alone.
    together: Mask,
}

impl Placed {
    #[inline(always)]
    fn new<L: Lanes>(lanes: L, to: &DAffine3, packet: &Packet, rays: Mask) -> Self {
        let none = Ray { origin: DVec3::ZERO, direction: DVec3::Z };
        let mut this =
            Self { rays: [none; PACKET], frames: [RayFrame::NONE; PACKET], boxes: BoxRays::new(), together: rays };
        for i in packet::each(rays) {
            let ray = packet.ray(i).transformed(to);
            if !ray.is_valid() || is_beyond_boxes(ray.origin) {
                this.together &= !(1 << i);
                continue;
            }
            this.rays[i] = ray;
            this.frames[i] = RayFrame::new(&ray);
            this.boxes.set(lanes, i, &ray);
        }
        this
    }
}

/// The limits of some rays as the walk wants them.
#[inline(always)]
fn rounded(limits: &PerRay, rays: Mask) -> Limits {
    let mut rounded = [0.0; PACKET];
    for i in packet::each(rays) {
        rounded[i] = above(limits[i]);
    }
    rounded
}

/// The search for the nearest triangles.
struct Nearest<'a> {
    tree: &'a MeshTree,
    to: &'a DAffine3,
    packet: &'a Packet,
    rays: Mask,
    t_max: &'a PerRay,
    hits: &'a mut Hits,
    cost: &'a mut Cost,
}

impl Job for Nearest<'_> {
    /// The rays that hit, and those that are to be asked alone.
    type Output = (Mask, Mask);

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> (Mask, Mask) {
        let Self { tree, to, packet, rays, t_max, hits, cost } = self;
        let placed = Placed::new(lanes, to, packet, rays);
        let together = placed.together;
        hits.t = *t_max;
        hits.part = [NONE; PACKET];
        let limits = rounded(t_max, together);
        let mut search = Search { tree, frames: &placed.frames, hits, places: [0; PACKET], limits, rays: together };
        tree.tree.walk_packet(lanes, &placed.boxes, together, cost, &mut search);
        let (mut met, mut alone) = (0, rays & !together);
        for i in packet::each(together) {
            let Search { hits, places, .. } = &search;
            if hits.part[i] == NONE {
                continue;
            }
            // As for a ray alone: nearly always what was found last counts.
            let block = &tree.blocks[places[i] as usize / BLOCK];
            if counts(lanes, &placed.rays[i], block, places[i] as usize % BLOCK, hits.t[i]) {
                met |= 1 << i;
            } else {
                alone |= 1 << i;
            }
        }
        (met, alone)
    }
}

struct Search<'a> {
    tree: &'a MeshTree,
    frames: &'a [RayFrame; PACKET],
    /// The distances of what was found, or the ends of the rays, and the triangles, or [`NONE`].
    hits: &'a mut Hits,
    /// Where the triangles stand: four times the block and the lane.
    places: [u32; PACKET],
    limits: Limits,
    rays: Mask,
}

impl PacketVisitor for Search<'_> {
    const ANY: bool = false;

    #[inline(always)]
    fn limits(&self) -> &Limits {
        &self.limits
    }

    #[inline(always)]
    fn alive(&self) -> Mask {
        self.rays
    }

    #[inline(always)]
    fn soon<L: Lanes>(&self, lanes: L, leaf: Leaf) {
        if let Some(block) = self.tree.blocks.get(leaf.first) {
            lanes.prefetch(block);
        }
    }

    #[inline(always)]
    fn visit<L: Lanes>(&mut self, lanes: L, leaf: Leaf, rays: Mask, cost: &mut Cost) {
        cost.primitives += leaf.len as u64 * u64::from(rays.count_ones());
        let block = &self.tree.blocks[leaf.first];
        let mut rays = rays;
        while rays != 0 {
            let i = rays.trailing_zeros() as usize;
            rays &= rays - 1;
            let Some((mut found, distances)) = self.frames[i].hit_block(lanes, block, self.hits.t[i]) else { continue };
            while found != 0 {
                let lane = found.trailing_zeros() as usize % BLOCK;
                found &= found - 1;
                let (t, triangle) = (distances[lane], block.triangles[lane]);
                let Hits { t: limit, part } = &mut *self.hits;
                // On equal distance the lowest index, whatever the order of the walk.
                if t < limit[i] || t == limit[i] && triangle < part[i] {
                    (limit[i], part[i]) = (t, triangle);
                    self.places[i] = (leaf.first * BLOCK + lane) as u32;
                    self.limits[i] = above(t);
                }
            }
        }
    }
}

/// The search for any triangles before the ends of rays.
struct Blocked<'a> {
    tree: &'a MeshTree,
    to: &'a DAffine3,
    packet: &'a Packet,
    rays: Mask,
    t_max: &'a PerRay,
    cost: &'a mut Cost,
}

impl Job for Blocked<'_> {
    /// The rays that are blocked, and those that are to be asked alone.
    type Output = (Mask, Mask);

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> (Mask, Mask) {
        let Self { tree, to, packet, rays, t_max, cost } = self;
        let placed = Placed::new(lanes, to, packet, rays);
        let together = placed.together;
        let limits = rounded(t_max, together);
        let mut search = AnySearch { tree, placed: &placed, t_max, limits, alive: together };
        tree.tree.walk_packet(lanes, &placed.boxes, together, cost, &mut search);
        (together & !search.alive, rays & !together)
    }
}

struct AnySearch<'a> {
    tree: &'a MeshTree,
    placed: &'a Placed,
    t_max: &'a PerRay,
    limits: Limits,
    /// The rays that are not blocked yet.
    alive: Mask,
}

impl PacketVisitor for AnySearch<'_> {
    const ANY: bool = true;

    #[inline(always)]
    fn limits(&self) -> &Limits {
        &self.limits
    }

    #[inline(always)]
    fn alive(&self) -> Mask {
        self.alive
    }

    #[inline(always)]
    fn soon<L: Lanes>(&self, lanes: L, leaf: Leaf) {
        if let Some(block) = self.tree.blocks.get(leaf.first) {
            lanes.prefetch(block);
        }
    }

    #[inline(always)]
    fn visit<L: Lanes>(&mut self, lanes: L, leaf: Leaf, rays: Mask, cost: &mut Cost) {
        cost.primitives += leaf.len as u64 * u64::from(rays.count_ones());
        let block = &self.tree.blocks[leaf.first];
        let mut rays = rays;
        while rays != 0 {
            let i = rays.trailing_zeros() as usize;
            rays &= rays - 1;
            let t_max = self.t_max[i];
            let Some((mut found, distances)) = self.placed.frames[i].hit_block(lanes, block, t_max) else { continue };
            while found != 0 {
                let lane = found.trailing_zeros() as usize % BLOCK;
                found &= found - 1;
                let t = distances[lane];
                if t < t_max && counts(lanes, &self.placed.rays[i], block, lane, t) {
                    self.alive &= !(1 << i);
                    break;
                }
            }
        }
    }
}
