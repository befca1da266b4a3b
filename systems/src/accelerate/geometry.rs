//! Every shape of a scene, and the tree over them.

use super::pool::{Best, Bests, ErasedPool, Nearest, Run};
use snell_components::{
    bvh::{Box32, Bvh, fits_boxes},
    method::{Accelerator, Methods, Precision},
    packet::{Mask, Packet, PerRay, each, those},
    primitive::{Cost, Extent, Hit, Surface},
    space::{BoundingSphere, Ray},
    sphere_tree::SphereTree,
    surfaces::{Meeting, Surfaces},
};
use std::sync::{Arc, OnceLock};

/// Most shapes in a leaf of the tree over all shapes.
const LEAF: usize = 2;

/// Up to so many shapes are tested one by one: preparing a ray for boxes costs more than it saves.
const FLAT: usize = 4;

/// Fewer rays than this go one by one.
const FEW_RAYS: u32 = 3;

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
    /// Runs of shapes that no box holds, which every ray tests; then those of the tree's leaves, in leaf order.
    runs: Vec<Run>,
    /// How many runs are of the first kind.
    unbounded: usize,
    /// For each position in the tree's order at which a leaf begins, its runs.
    leaf_runs: Vec<(u32, u32)>,
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
        Self::build_of(pools, |_| true)
    }

    /// The shapes of some objects alone, told by their ranks; numbers of shapes differ from those here.
    #[must_use]
    pub fn of_objects(&self, objects: impl Fn(u32) -> bool) -> Self {
        Self::build_of(self.pools.iter(), objects)
    }

    fn build_of<'a>(pools: impl Iterator<Item = &'a Arc<dyn ErasedPool>>, objects: impl Fn(u32) -> bool) -> Self {
        let pools: Vec<_> = pools.collect();
        let mut boxes = vec![];
        let mut shapes = vec![];
        let mut orders: Vec<Vec<u32>> = vec![vec![]; pools.len()];
        for (pool, shapes_of_pool) in pools.iter().enumerate() {
            let owned = shapes_of_pool.extents().iter().zip(shapes_of_pool.objects()).enumerate();
            for (index, (extent, _)) in owned.filter(|(_, (_, object))| objects(**object)) {
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
        let whole = |(pool, order): (usize, &Vec<u32>)| Run { pool: pool as u32, first: 0, end: order.len() as u32 };
        let mut runs: Vec<Run> = orders.iter().enumerate().map(whole).filter(|run| run.end > 0).collect();
        let unbounded = runs.len();

        let tree = Bvh::build(boxes.into_iter(), LEAF);
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
                    _ => runs.push(Run { pool, first: at, end: at + 1 }),
                }
                order.push(index);
            }
            leaf_runs[start] = (begin as u32, runs.len() as u32);
        }
        let pools = pools.iter().zip(&orders).map(|(pool, order)| pool.permuted(order)).collect();
        let tree = (shapes.len() > FLAT).then_some(tree);
        Self { tree, pools, runs, unbounded, leaf_runs, spheres: OnceLock::new() }
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

    /// The surfaces at what some rays of a packet met, as [`Geometry::surface`] tells of each; texture coordinates for
    /// those alone that are `textured`. All of the rays must have found something.
    pub fn surfaces(
        &self,
        packet: &Packet,
        (rays, textured): (Mask, Mask),
        best: &Bests,
        with: &Methods,
        surfaces: &mut Surfaces,
    ) {
        let Bests { limit, part, pool, index, .. } = best;
        let mut rest = rays;
        while rest != 0 {
            let of = pool[rest.trailing_zeros() as usize];
            let mine = those(rest, |i| pool[i] == of);
            rest &= !mine;
            let met = Meeting { packet, rays: mine, textured: mine & textured, shape: index, t: limit, part };
            self.pools[of as usize].surfaces(&met, surfaces);
        }
        if with.precision == Precision::F32 {
            for i in each(rays) {
                surfaces.error[i] = less_sure(surfaces.get(i), limit[i], &packet.ray(i), with).error;
            }
        }
    }

    /// How a surface that was met goes on: where a ray close by, at a distance `t`, crosses its tangent plane.
    #[must_use]
    pub fn beside(&self, met: &Nearest, ray: &Ray, t: f64) -> Surface {
        let Nearest { hit, pool, index, .. } = *met;
        self.pools[pool as usize].surface(index, ray, Hit { t, ..hit })
    }

    /// Nearest hit with `0 < t <= t_max`; among equally near ones the object first in the order of names.
    #[must_use]
    #[inline]
    pub fn nearest(&self, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> Option<Nearest> {
        if !ray.is_valid() {
            return None;
        }
        let mut best = Best::within(t_max);
        if self.tree.is_none() && with.is_default() {
            for run in &self.runs {
                self.search(*run, ray, None, &mut best, cost);
            }
        } else {
            self.nearest_of_many(ray, with, &mut best, cost);
        }
        best.nearest()
    }

    /// Searches many shapes, or by other methods; apart, so that a search of few has nothing of it to prepare.
    #[inline(never)]
    fn nearest_of_many(&self, ray: &Ray, with: &Methods, best: &mut Best, cost: &mut Cost) {
        let (unbounded, bounded) = self.runs.split_at(self.unbounded);
        let accelerator = with.accelerator;
        let with = with.other();
        for run in unbounded {
            self.search(*run, ray, with, best, cost);
        }
        match (&self.tree, accelerator) {
            (Some(tree), Accelerator::Tree) => tree.walk(ray, best.limit, cost, |leaf, _, cost| {
                let (begin, end) = self.leaf_runs[leaf.start];
                for run in &self.runs[begin as usize..end as usize] {
                    self.search(*run, ray, with, best, cost);
                }
                best.limit
            }),
            (_, Accelerator::SphereTree) if !bounded.is_empty() => {
                let Spheres { tree, runs } = self.spheres();
                tree.walk(ray, best.limit, cost, |own, _, cost| {
                    for run in &runs[own] {
                        self.search(*run, ray, with, best, cost);
                    }
                    best.limit
                });
            }
            _ => {
                for run in bounded {
                    self.search(*run, ray, with, best, cost);
                }
            }
        }
    }

    #[inline(always)]
    fn search(&self, run: Run, ray: &Ray, with: Option<&Methods>, best: &mut Best, cost: &mut Cost) {
        self.pools[run.pool as usize].closest(run, ray, with, best, cost);
    }

    /// Whether anything is hit with `0 < t < t_max`.
    #[must_use]
    #[inline]
    pub fn blocked(&self, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> bool {
        if !ray.is_valid() {
            return false;
        }
        if self.tree.is_none() && with.is_default() {
            return self.runs.iter().any(|run| self.blocks(*run, ray, t_max, None, cost));
        }
        self.blocked_by_many(ray, t_max, with, cost)
    }

    #[inline(never)]
    fn blocked_by_many(&self, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> bool {
        let (unbounded, bounded) = self.runs.split_at(self.unbounded);
        let accelerator = with.accelerator;
        let with = with.other();
        let blocks = |run: &Run, cost: &mut Cost| self.blocks(*run, ray, t_max, with, cost);
        if unbounded.iter().any(|run| blocks(run, cost)) {
            return true;
        }
        match (&self.tree, accelerator) {
            (Some(tree), Accelerator::Tree) => tree.any(ray, t_max, cost, |leaf, cost| {
                let (begin, end) = self.leaf_runs[leaf.start];
                self.runs[begin as usize..end as usize].iter().any(|run| blocks(run, cost))
            }),
            (_, Accelerator::SphereTree) if !bounded.is_empty() => {
                let Spheres { tree, runs } = self.spheres();
                tree.any(ray, t_max, cost, |own, cost| runs[own].iter().any(|run| blocks(run, cost)))
            }
            _ => bounded.iter().any(|run| blocks(run, cost)),
        }
    }

    /// [`Geometry::nearest`] for some rays of a packet, the same to the last bit; `best` has begun.
    pub fn nearest_packet(&self, packet: &Packet, rays: Mask, with: &Methods, best: &mut Bests, cost: &mut Cost) {
        let valid = rays & packet.valid();
        let rays = self.together(packet, valid, with);
        for i in each(valid & !rays) {
            best.set(i, self.nearest(&packet.ray(i), best.limit[i], with, cost));
        }
        if rays == 0 {
            return;
        }
        let (unbounded, bounded) = self.runs.split_at(self.unbounded);
        let search = |runs: &[Run], rays: Mask, best: &mut Bests, cost: &mut Cost| {
            for run in runs {
                self.pools[run.pool as usize].closest_packet(*run, packet, rays, best, cost);
            }
        };
        search(unbounded, rays, best, cost);
        let Some(tree) = &self.tree else { return search(bounded, rays, best, cost) };
        let mut limits = best.limit;
        tree.walk_packet(packet, rays, &mut limits, cost, |leaf, rays, limits, cost| {
            let (begin, end) = self.leaf_runs[leaf.start];
            search(&self.runs[begin as usize..end as usize], rays, best, cost);
            for i in each(rays) {
                limits[i] = best.limit[i];
            }
        });
    }

    /// [`Geometry::blocked`] for some rays of a packet: which are blocked before their `t_max`.
    #[must_use]
    pub fn blocked_packet(&self, packet: &Packet, rays: Mask, t_max: &PerRay, with: &Methods, cost: &mut Cost) -> Mask {
        let rays = rays & packet.valid();
        let together = self.together(packet, rays, with);
        let alone = those(rays & !together, |i| self.blocked(&packet.ray(i), t_max[i], with, cost));
        if together == 0 {
            return alone;
        }
        let blocks = |runs: &[Run], rays: Mask, cost: &mut Cost| {
            let mut blocked = 0;
            for run in runs {
                let rest = rays & !blocked;
                if rest == 0 {
                    break;
                }
                blocked |= self.pools[run.pool as usize].blocks_packet(*run, packet, rest, t_max, cost);
            }
            blocked
        };
        let flat = if self.tree.is_some() { self.unbounded } else { self.runs.len() };
        let blocked = blocks(&self.runs[..flat], together, cost);
        let (Some(tree), rest) = (&self.tree, together & !blocked) else { return alone | blocked };
        let within = tree.any_packet(packet, rest, t_max, cost, |leaf, rays, cost| {
            let (begin, end) = self.leaf_runs[leaf.start];
            blocks(&self.runs[begin as usize..end as usize], rays, cost)
        });
        alone | blocked | within
    }

    /// Those of some rays that are searched for together; the others go one by one.
    fn together(&self, packet: &Packet, rays: Mask, with: &Methods) -> Mask {
        if !with.is_default() {
            return 0;
        }
        let fit = if self.tree.is_some() { rays & fits_boxes(packet) } else { rays };
        if fit.count_ones() < FEW_RAYS { 0 } else { fit }
    }

    #[inline(always)]
    fn blocks(&self, run: Run, ray: &Ray, t_max: f64, with: Option<&Methods>, cost: &mut Cost) -> bool {
        self.pools[run.pool as usize].blocks(run, ray, t_max, with, cost)
    }

    fn spheres(&self) -> &Spheres {
        self.spheres.get_or_init(|| {
            let each = |&Run { pool, first, end }: &Run| (first..end).map(move |i| Run { pool, first: i, end: i + 1 });
            let shapes: Vec<Run> = self.runs[self.unbounded..].iter().flat_map(each).collect();
            let sphere = |run: &Run| self.pools[run.pool as usize].bounding_sphere(run.first);
            let tree = SphereTree::build(shapes.iter().filter_map(sphere));
            let runs = tree.order().iter().map(|&i| shapes[i as usize]).collect();
            Spheres { tree, runs }
        })
    }
}
