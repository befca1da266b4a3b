//! The search of many rays at once in a mesh's tree.

use super::{
    mesh_tree::{MeshTree, NONE, counts},
    shear::{Block, RayFrames},
};
use crate::{
    bvh::{BLOCK, BoxRays, FARTHEST, Leaf, Limits, PacketVisitor, above, four_surely_reach, reaches},
    lanes::{self, Job, Lanes, vector},
    packet::{self, Hits, Mask, PACKET, Packet, PerRay, Vectors},
    primitive::Cost,
    space::Ray,
};
use glam::DAffine3;

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
struct RaysInMesh {
    origins: Vectors,
    directions: Vectors,
    frames: RayFrames,
    boxes: BoxRays,
    /// The rays that are to be walked together; the others, which no box could tell from, go alone.
    together: Mask,
}

impl RaysInMesh {
    #[inline(always)]
    fn new<L: Lanes>(l: L, to: &DAffine3, packet: &Packet, rays: Mask) -> Self {
        let none = [[0.0; PACKET]; 3];
        let (frames, boxes) = (RayFrames::new(), BoxRays::new());
        let mut this = Self { origins: none, directions: none, frames, boxes, together: 0 };
        for (group, which) in packet::groups(rays) {
            let origins = vector::moved(l, to, vector::load(l, &packet.origins, group));
            let directions = vector::turned(l, &to.matrix3, vector::load(l, &packet.directions, group));
            let fit =
                packet::valid_of_four(l, origins, directions) & l.d_le(vector::reach(l, origins), l.d_splat(FARTHEST));
            this.together |= Mask::from(fit & which) << (4 * group);
            vector::store(l, origins, 0b1111, &mut this.origins, group);
            vector::store(l, directions, 0b1111, &mut this.directions, group);
            this.frames.set(l, group, origins, directions);
            this.boxes.set(l, group, origins, directions);
        }
        this
    }

    #[inline(always)]
    fn ray(&self, i: usize) -> Ray {
        Ray { origin: packet::vector_of(&self.origins, i), direction: packet::vector_of(&self.directions, i) }
    }

    /// Those of four rays for whose hits at `t`, if any, in blocks at some places a walk surely comes in time.
    #[inline(always)]
    fn surely_reach<L: Lanes>(&self, l: L, group: usize, blocks: &[Block], places: &[u32; 4], t: &[f64; 4]) -> u32 {
        let mut bounds = [[[0.0; 4]; 3]; 2];
        for (lane, &place) in places.iter().enumerate() {
            let [min, max] = blocks[place as usize / BLOCK].bounds_of(place as usize % BLOCK);
            for axis in 0..3 {
                (bounds[0][axis][lane], bounds[1][axis][lane]) = (min[axis], max[axis]);
            }
        }
        let (origins, directions) = (vector::load(l, &self.origins, group), vector::load(l, &self.directions, group));
        four_surely_reach(l, origins, directions, &bounds, l.d_load(t))
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
    fn run<L: Lanes>(self, l: L) -> (Mask, Mask) {
        let Self { tree, to, packet, rays, t_max, hits, cost } = self;
        let placed = RaysInMesh::new(l, to, packet, rays);
        let together = placed.together;
        hits.t = *t_max;
        hits.part = [NONE; PACKET];
        let limits = rounded(t_max, together);
        let mut search = Search { tree, frames: &placed.frames, hits, places: [0; PACKET], limits, rays: together };
        tree.tree.walk_packet(l, &placed.boxes, together, cost, &mut search);
        let (mut met, mut alone) = (0, rays & !together);
        let Search { hits, places, .. } = search;
        let found = packet::those(together, |i| hits.part[i] != NONE);
        for (group, which) in packet::groups(found) {
            // As for a ray alone: nearly always what was found last counts.
            let places = &places.as_chunks().0[group];
            let sure = placed.surely_reach(l, group, &tree.blocks, places, packet::four(&hits.t, group)) & which;
            met |= Mask::from(sure) << (4 * group);
            for lane in packet::each(Mask::from(which & !sure)) {
                let (i, place) = (4 * group + lane, places[lane] as usize);
                let vertices = tree.blocks[place / BLOCK].vertices_of(place % BLOCK);
                let reached = reaches(&placed.ray(i), &vertices, hits.t[i]);
                *if reached { &mut met } else { &mut alone } |= 1 << i;
            }
        }
        (met, alone)
    }
}

struct Search<'a> {
    tree: &'a MeshTree,
    frames: &'a RayFrames,
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
            let Some((mut found, distances)) = self.frames.one(i).hit_block(lanes, block, self.hits.t[i]) else {
                continue;
            };
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
    fn run<L: Lanes>(self, l: L) -> (Mask, Mask) {
        let Self { tree, to, packet, rays, t_max, cost } = self;
        let placed = RaysInMesh::new(l, to, packet, rays);
        let together = placed.together;
        let limits = rounded(t_max, together);
        let mut search = AnySearch { tree, placed: &placed, t_max, limits, alive: together };
        tree.tree.walk_packet(l, &placed.boxes, together, cost, &mut search);
        (together & !search.alive, rays & !together)
    }
}

struct AnySearch<'a> {
    tree: &'a MeshTree,
    placed: &'a RaysInMesh,
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
            let Some((mut found, distances)) = self.placed.frames.one(i).hit_block(lanes, block, t_max) else {
                continue;
            };
            while found != 0 {
                let lane = found.trailing_zeros() as usize % BLOCK;
                found &= found - 1;
                let t = distances[lane];
                if t < t_max && counts(lanes, &self.placed.ray(i), block, lane, t) {
                    self.alive &= !(1 << i);
                    break;
                }
            }
        }
    }
}
