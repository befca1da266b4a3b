//! All packed shapes of one type, behind an interface that knows no type.

use core::ops::Range;
use glam::DVec3;
use snell_components::{
    method::Methods,
    primitive::{Cost, Extent, Hit, Primitive, Surface},
    space::{BoundingSphere, Ray},
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

/// Shapes of one type as the tree sees them; called once per run.
pub trait ErasedPool: Send + Sync {
    /// How far each shape reaches.
    fn extents(&self) -> &[Extent];

    /// The same shapes in another order.
    fn permuted(&self, order: &[u32]) -> Arc<dyn ErasedPool>;

    /// The object each shape belongs to.
    fn objects(&self) -> &[u32];

    /// The nearest hit within the run that beats `best`: nearer, or as near and of an earlier object.
    fn closest(&self, run: Range<usize>, ray: &Ray, with: &Methods, best: &mut Best, cost: &mut Cost);

    /// Whether a shape of the run blocks the ray before `t_max`.
    fn blocks(&self, run: Range<usize>, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> bool;

    /// The sphere around a shape, if it is bounded.
    fn bounding_sphere(&self, index: u32) -> Option<BoundingSphere>;

    /// The surface of a hit.
    fn surface(&self, index: u32, ray: &Ray, hit: Hit) -> Surface;

    /// The same but for the texture coordinates, which mean nothing.
    fn surface_without_uv(&self, index: u32, ray: &Ray, hit: Hit) -> Surface;

    /// See [`Primitive::lift`].
    fn lift(&self, index: u32, ray: &Ray, hit: Hit) -> DVec3;
}

/// A search for the nearest hit.
#[derive(Clone, Copy, Debug)]
pub struct Best {
    /// Number of the pool being searched.
    pub pool: u32,
    /// Nothing beyond this matters.
    pub limit: f64,
    /// What was found.
    pub nearest: Option<Nearest>,
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

    #[inline]
    fn search(&self, run: Range<usize>, best: &mut Best, mut hit: impl FnMut(&P::Packed, f64) -> Option<Hit>) {
        let first = run.start;
        for (n, shape) in self.shapes[run].iter().enumerate() {
            if let Some(hit) = hit(shape, best.limit) {
                let index = first + n;
                let object = self.objects[index];
                if best.nearest.is_none_or(|nearest| hit.t < nearest.hit.t || object < nearest.object) {
                    best.limit = hit.t;
                    best.nearest = Some(Nearest { hit, pool: best.pool, index: index as u32, object });
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

    fn closest(&self, run: Range<usize>, ray: &Ray, with: &Methods, best: &mut Best, cost: &mut Cost) {
        // Chosen once per run, so that the usual loop knows of no other method.
        if with.is_default() {
            self.search(run, best, |shape, limit| P::hit(shape, ray, limit, cost));
        } else {
            self.search(run, best, |shape, limit| P::hit_with(shape, ray, limit, with, cost));
        }
    }

    fn blocks(&self, run: Range<usize>, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> bool {
        let mut shapes = self.shapes[run].iter();
        if with.is_default() {
            shapes.any(|shape| P::blocks(shape, ray, t_max, cost))
        } else {
            shapes.any(|shape| P::blocks_with(shape, ray, t_max, with, cost))
        }
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

    fn lift(&self, index: u32, ray: &Ray, hit: Hit) -> DVec3 {
        P::lift(&self.shapes[index as usize], ray, hit)
    }
}
