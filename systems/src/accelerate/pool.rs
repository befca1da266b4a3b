//! All packed shapes of one type, behind an interface that knows no type.

use snell_components::{
    method::Methods,
    packet::{Hits, Mask, PACKET, Packet, PerRay, each, those},
    primitive::{Cost, Extent, Hit, Primitive, Surface},
    space::{BoundingSphere, Ray},
    surfaces::{Meeting, Surfaces},
};
use std::sync::Arc;

/// Which hit is the nearest: all that a search tells, and all that the surface there is worked out from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Distance and part.
    pub hit: Hit,
    /// Which pool.
    pub pool: u32,
    /// Which shape in the pool.
    pub index: u32,
    /// Which object: its rank in the order of names.
    pub object: u32,
}

/// A run of shapes of one type.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// Of which pool.
    pub pool: u32,
    /// The first shape.
    pub first: u32,
    /// The shape after the last.
    pub end: u32,
}

/// Shapes of one type as the tree sees them; called once per run.
pub trait ErasedPool: Send + Sync {
    /// How far each shape reaches.
    fn extents(&self) -> &[Extent];

    /// The same shapes in another order.
    fn permuted(&self, order: &[u32]) -> Arc<dyn ErasedPool>;

    /// The object each shape belongs to.
    fn objects(&self) -> &[u32];

    /// The nearest hit within the run that beats `best`: nearer, or as near and of an earlier object.
    ///
    /// The methods are none where they are the default ones: chosen once per run, so that the usual loop knows of no
    /// other.
    fn closest(&self, run: Run, ray: &Ray, with: Option<&Methods>, best: &mut Best, cost: &mut Cost);

    /// Whether a shape of the run blocks the ray before `t_max`.
    fn blocks(&self, run: Run, ray: &Ray, t_max: f64, with: Option<&Methods>, cost: &mut Cost) -> bool;

    /// [`ErasedPool::closest`] by the default methods for some rays of a packet.
    fn closest_packet(&self, run: Run, packet: &Packet, rays: Mask, best: &mut Bests, cost: &mut Cost);

    /// [`ErasedPool::blocks`] by the default methods for some rays of a packet: which are blocked before their `t_max`.
    fn blocks_packet(&self, run: Run, packet: &Packet, rays: Mask, t_max: &PerRay, cost: &mut Cost) -> Mask;

    /// The sphere around a shape, if it is bounded.
    fn bounding_sphere(&self, index: u32) -> Option<BoundingSphere>;

    /// The surface of a hit.
    fn surface(&self, index: u32, ray: &Ray, hit: Hit) -> Surface;

    /// The same but for the texture coordinates, which mean nothing.
    fn surface_without_uv(&self, index: u32, ray: &Ray, hit: Hit) -> Surface;

    /// The surfaces that rays of a packet met here.
    fn surfaces(&self, met: &Meeting<'_>, surfaces: &mut Surfaces);
}

/// A search for the nearest hit.
#[derive(Clone, Copy, Debug)]
pub struct Best {
    /// Nothing beyond this matters: the distance of what was found, if anything was.
    pub limit: f64,
    part: u32,
    pool: u32,
    index: u32,
    /// `NOTHING` before anything was found.
    object: u32,
}

/// More than the rank of any object.
const NOTHING: u32 = u32::MAX;

impl Best {
    /// Nothing found yet, up to a distance.
    #[inline]
    #[must_use]
    pub fn within(limit: f64) -> Self {
        Self { limit, part: 0, pool: 0, index: 0, object: NOTHING }
    }

    /// What was found.
    #[inline]
    #[must_use]
    pub fn nearest(&self) -> Option<Nearest> {
        let Self { limit, part, pool, index, object } = *self;
        (object != NOTHING).then_some(Nearest { hit: Hit { t: limit, part }, pool, index, object })
    }
}

/// A search for the nearest hit of each ray of a packet.
#[derive(Clone, Debug)]
pub struct Bests {
    /// Nothing beyond this matters: the distance of what was found, if anything was.
    pub limit: PerRay,
    /// Which part of the shape; as what follows, anything where nothing was found.
    pub part: [u32; PACKET],
    /// Which pool.
    pub pool: [u32; PACKET],
    /// Which shape in the pool.
    pub index: [u32; PACKET],
    /// Which object; `NOTHING` before anything was found.
    object: [u32; PACKET],
    /// Of the shape at hand.
    hits: Hits,
}

impl Default for Bests {
    fn default() -> Self {
        let [part, pool, index] = [[0; PACKET]; 3];
        let limit = [f64::INFINITY; PACKET];
        Self { limit, part, pool, index, object: [NOTHING; PACKET], hits: Hits::default() }
    }
}

impl Bests {
    /// Nothing found yet by some rays, up to a distance.
    pub fn begin(&mut self, rays: Mask, limit: f64) {
        for i in each(rays) {
            (self.limit[i], self.object[i]) = (limit, NOTHING);
        }
    }

    /// Nothing found yet by some rays, each up to a distance of its own.
    pub fn begin_within(&mut self, rays: Mask, limits: &PerRay) {
        for i in each(rays) {
            (self.limit[i], self.object[i]) = (limits[i], NOTHING);
        }
    }

    /// Those of some rays that found something.
    #[must_use]
    pub fn found(&self, rays: Mask) -> Mask {
        those(rays, |i| self.object[i] != NOTHING)
    }

    /// The object that a ray found; means nothing for a ray that is not [found](Self::found).
    #[must_use]
    #[inline]
    pub fn object(&self, i: usize) -> u32 {
        self.object[i]
    }

    /// What a ray found.
    #[must_use]
    #[inline]
    pub fn nearest(&self, i: usize) -> Option<Nearest> {
        let (part, pool, index, object) = (self.part[i], self.pool[i], self.index[i], self.object[i]);
        (object != NOTHING).then_some(Nearest { hit: Hit { t: self.limit[i], part }, pool, index, object })
    }

    /// Takes what a ray found alone.
    pub fn set(&mut self, i: usize, nearest: Option<Nearest>) {
        self.object[i] = NOTHING;
        if let Some(Nearest { hit: Hit { t, part }, pool, index, object }) = nearest {
            self.limit[i] = t;
            (self.part[i], self.pool[i], self.index[i], self.object[i]) = (part, pool, index, object);
        }
    }
}

/// All packed shapes of type `P`.
pub struct Pool<P: Primitive> {
    shapes: Vec<P::Packed>,
    extents: Vec<Extent>,
    objects: Vec<u32>,
}

impl<P: Primitive> Pool<P> {
    /// A pool from shapes with their extents and objects.
    pub fn new(shapes: impl IntoIterator<Item = (P::Packed, Extent, u32)>) -> Self {
        let mut this = Self { shapes: vec![], extents: vec![], objects: vec![] };
        for (shape, extent, object) in shapes {
            this.shapes.push(shape);
            this.extents.push(extent);
            this.objects.push(object);
        }
        this
    }

    #[inline(always)]
    fn search(&self, run: Run, best: &mut Best, mut hit: impl FnMut(&P::Packed, f64) -> Option<Hit>) {
        let range = run.first as usize..run.end as usize;
        for ((shape, &object), index) in self.shapes[range.clone()].iter().zip(&self.objects[range]).zip(run.first..) {
            if let Some(Hit { t, part }) = hit(shape, best.limit) {
                // No hit is beyond the limit.
                if t < best.limit || object < best.object {
                    *best = Best { limit: t, part, pool: run.pool, index, object };
                }
            }
        }
    }
}

impl<P: Primitive> ErasedPool for Pool<P> {
    fn extents(&self) -> &[Extent] {
        &self.extents
    }

    fn permuted(&self, order: &[u32]) -> Arc<dyn ErasedPool> {
        let order = || order.iter().map(|&i| i as usize);
        Arc::new(Self {
            shapes: order().map(|i| self.shapes[i].clone()).collect(),
            extents: order().map(|i| self.extents[i]).collect(),
            objects: order().map(|i| self.objects[i]).collect(),
        })
    }

    fn objects(&self) -> &[u32] {
        &self.objects
    }

    fn closest(&self, run: Run, ray: &Ray, with: Option<&Methods>, best: &mut Best, cost: &mut Cost) {
        match with {
            None => self.search(run, best, |shape, limit| P::hit(shape, ray, limit, cost)),
            Some(with) => self.search(run, best, |shape, limit| P::hit_with(shape, ray, limit, with, cost)),
        }
    }

    fn blocks(&self, run: Run, ray: &Ray, t_max: f64, with: Option<&Methods>, cost: &mut Cost) -> bool {
        let mut shapes = self.shapes[run.first as usize..run.end as usize].iter();
        match with {
            None => shapes.any(|shape| P::blocks(shape, ray, t_max, cost)),
            Some(with) => shapes.any(|shape| P::blocks_with(shape, ray, t_max, with, cost)),
        }
    }

    fn closest_packet(&self, run: Run, packet: &Packet, rays: Mask, best: &mut Bests, cost: &mut Cost) {
        for index in run.first..run.end {
            let object = self.objects[index as usize];
            let Bests { limit, hits, .. } = best;
            let met = P::hit_packet(&self.shapes[index as usize], packet, rays, limit, hits, cost);
            for i in each(met) {
                let Hits { t, part } = &best.hits;
                let (t, part) = (t[i], part[i]);
                if t < best.limit[i] || object < best.object[i] {
                    best.limit[i] = t;
                    (best.part[i], best.pool[i], best.index[i], best.object[i]) = (part, run.pool, index, object);
                }
            }
        }
    }

    fn blocks_packet(&self, run: Run, packet: &Packet, rays: Mask, t_max: &PerRay, cost: &mut Cost) -> Mask {
        let mut blocked = 0;
        for shape in &self.shapes[run.first as usize..run.end as usize] {
            blocked |= P::blocks_packet(shape, packet, rays & !blocked, t_max, cost);
            if blocked == rays {
                break;
            }
        }
        blocked
    }

    fn bounding_sphere(&self, index: u32) -> Option<BoundingSphere> {
        match &self.extents[index as usize] {
            Extent::Bounded(bounds) => Some(P::bounding_sphere(&self.shapes[index as usize], bounds)),
            Extent::Unbounded => None,
        }
    }

    fn surface(&self, index: u32, ray: &Ray, hit: Hit) -> Surface {
        P::surface(&self.shapes[index as usize], ray, hit)
    }

    fn surface_without_uv(&self, index: u32, ray: &Ray, hit: Hit) -> Surface {
        P::surface_without_uv(&self.shapes[index as usize], ray, hit)
    }

    fn surfaces(&self, met: &Meeting<'_>, surfaces: &mut Surfaces) {
        P::surface_packet(&self.shapes, met, surfaces);
    }
}
