//! The ray–triangle test of 2004: the vertices are turned into the frame of the ray, which there runs along +z from the
//! origin; signs tell whether (0, 0) lies in the projected triangle, and the plane of the triangle at (0, 0) gives the
//! distance.
//!
//! Neighbours share the turned vertices, so that with zero counting as inside no ray slips between them. The distance,
//! though, comes from the plane, which is badly known for triangles seen edge-on.

use super::triangle_kernel::{TriangleHit, TriangleKernel};
use crate::{
    real::{self, Real, Vector},
    space::Ray,
};
use glam::DVec3;

/// The frame of a ray.
#[derive(Clone, Copy, Debug)]
pub struct Turned<R> {
    origin: Vector<R>,
    /// Unit axes of the frame, world space; the last along the ray.
    axes: [Vector<R>; 3],
    /// Length of the ray's direction.
    length: R,
}

impl<R: Real> TriangleKernel for Turned<R> {
    #[inline]
    fn new(ray: &Ray) -> Self {
        let direction = real::vector::<R>(ray.direction);
        let length = real::dot(direction, direction).sqrt();
        let z = real::times(direction, R::ONE / length);
        // Across the axis that the ray runs along least.
        let [x, y, z_size] = z.map(Real::abs);
        let across = if x <= y && x <= z_size {
            [R::ONE, R::ZERO, R::ZERO]
        } else if y <= z_size {
            [R::ZERO, R::ONE, R::ZERO]
        } else {
            [R::ZERO, R::ZERO, R::ONE]
        };
        let x = real::cross(across, z);
        let x = real::times(x, R::ONE / real::dot(x, x).sqrt());
        Self { origin: real::vector(ray.origin), axes: [x, real::cross(z, x), z], length }
    }

    #[inline]
    fn hit(&self, vertices: [DVec3; 3], t_max: f64) -> Option<TriangleHit> {
        let seen = vertices.map(|v| real::minus(real::vector(v), self.origin));
        let along = |axis: usize| seen.map(|v| real::dot(v, self.axes[axis]));
        let aside = |v: [R; 3]| v.iter().all(|x| *x > R::ZERO) || v.iter().all(|x| *x < R::ZERO);
        let x = along(0);
        if aside(x) {
            return None;
        }
        let y = along(1);
        if aside(y) {
            return None;
        }
        let edge = |i: usize, j: usize| x[i] * y[j] - x[j] * y[i];
        let (u, v, w) = (edge(1, 2), edge(2, 0), edge(0, 1));
        let signs = [u, v, w];
        if signs.iter().any(|e| *e < R::ZERO) && signs.iter().any(|e| *e > R::ZERO) {
            return None;
        }
        let z = along(2);
        let corner = |i: usize| [x[i], y[i], z[i]];
        let normal = real::cross(real::minus(corner(1), corner(0)), real::minus(corner(2), corner(0)));
        if normal[2] == R::ZERO {
            return None;
        }
        let t = (real::dot(normal, corner(0)) / normal[2] / self.length).to_f64();
        let sum = u + v + w;
        let weights = [u / sum, v / sum, w / sum].map(Real::to_f64);
        (t > 0.0 && t <= t_max && t.is_finite()).then_some(TriangleHit { t, weights })
    }
}
