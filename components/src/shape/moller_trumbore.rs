//! The usual ray–triangle test (Möller, Trumbore: Fast, Minimum Storage Ray/Triangle Intersection, 1997), without any
//! tolerance. Two triangles that share an edge compute different things for it, so rays slip between them.

use super::triangle_kernel::{TriangleHit, TriangleKernel};
use crate::{
    real::{self, Real, Vector},
    space::Ray,
};
use glam::DVec3;

/// A ray for this test.
#[derive(Clone, Copy, Debug)]
pub struct MollerTrumbore<R> {
    origin: Vector<R>,
    direction: Vector<R>,
}

impl<R: Real> TriangleKernel for MollerTrumbore<R> {
    #[inline]
    fn new(ray: &Ray) -> Self {
        Self { origin: real::vector(ray.origin), direction: real::vector(ray.direction) }
    }

    #[inline]
    fn hit(&self, vertices: [DVec3; 3], t_max: f64) -> Option<TriangleHit> {
        let [a, b, c] = vertices.map(real::vector);
        let (ab, ac) = (real::minus(b, a), real::minus(c, a));
        let p = real::cross(self.direction, ac);
        let det = real::dot(ab, p);
        if det == R::ZERO {
            return None;
        }
        let s = real::minus(self.origin, a);
        let u = real::dot(s, p) / det;
        if !(u >= R::ZERO && u <= R::ONE) {
            return None;
        }
        let q = real::cross(s, ab);
        let v = real::dot(self.direction, q) / det;
        if !(v >= R::ZERO && u + v <= R::ONE) {
            return None;
        }
        let t = (real::dot(ac, q) / det).to_f64();
        let (u, v) = (u.to_f64(), v.to_f64());
        (t > 0.0 && t <= t_max && t.is_finite()).then_some(TriangleHit { t, weights: [1.0 - u - v, u, v] })
    }
}
