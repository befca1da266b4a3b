//! What the ray–triangle tests have in common, and the choice between them.

use super::{moller_trumbore::MollerTrumbore, ray_frame::Turned, shear::Sheared};
use crate::{
    method::{Methods, Precision, TriangleTest},
    space::Ray,
};
use glam::DVec3;

/// A ray prepared for one way of testing triangles.
pub trait TriangleKernel {
    /// Prepares a ray; its direction must not be zero.
    fn new(ray: &Ray) -> Self;

    /// Hit of either side of a triangle with `0 < t <= t_max`.
    fn hit(&self, vertices: [DVec3; 3], t_max: f64) -> Option<TriangleHit>;
}

/// Where a ray met a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Distance in units of the ray's direction.
    pub t: f64,
    /// Weights of the three vertices; not negative, sum 1 up to rounding.
    pub weights: [f64; 3],
}

/// What is done with a ray by whichever test was chosen.
pub(super) trait WithKernel {
    type Output;

    fn run<K: TriangleKernel>(self, kernel: &K) -> Self::Output;
}

/// Runs something with the test that was chosen: one choice per ray, not per triangle.
#[inline]
pub(super) fn choose<W: WithKernel>(methods: &Methods, ray: &Ray, with: W) -> W::Output {
    use {Precision::*, TriangleTest::*};
    match (methods.triangle, methods.precision) {
        (Sheared, F64) => with.run(&self::Sheared::<f64>::new(ray)),
        (Sheared, F32) => with.run(&self::Sheared::<f32>::new(ray)),
        (MollerTrumbore, F64) => with.run(&<self::MollerTrumbore<f64>>::new(ray)),
        (MollerTrumbore, F32) => with.run(&<self::MollerTrumbore<f32>>::new(ray)),
        (RayFrame, F64) => with.run(&Turned::<f64>::new(ray)),
        (RayFrame, F32) => with.run(&Turned::<f32>::new(ray)),
    }
}
