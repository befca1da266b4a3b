//! The ray–triangle test: sheared edge functions (Woop, Benthin, Wald: Watertight Ray/Triangle Intersection, JCGT 2(1),
//! 2013) in `f64`.
//!
//! Vertices are moved so that the ray starts at the origin and sheared so that it runs along +z; the signs of three 2D
//! edge functions then decide. Two triangles that share an edge evaluate the very same products for it, and a rounded
//! difference of products can be falsely zero but never has the wrong sign, so with zero counting as inside no ray
//! slips between them. Contraction to fused multiply-add would break this.

use crate::space::Ray;
use glam::DVec3;

/// A ray prepared for triangle tests.
#[derive(Clone, Copy, Debug)]
pub struct RayFrame {
    origin: DVec3,
    kx: usize,
    ky: usize,
    kz: usize,
    shear_x: f64,
    shear_y: f64,
    scale_z: f64,
}

/// Where a ray met a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Distance in units of the ray's direction.
    pub t: f64,
    /// Weights of the three vertices; not negative, sum 1 up to rounding.
    pub weights: [f64; 3],
}

impl RayFrame {
    /// Prepares a ray; its direction must not be zero.
    #[must_use]
    #[inline]
    pub fn new(ray: &Ray) -> Self {
        let d = ray.direction;
        let size = d.abs();
        let kz = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let next = (kz + 1) % 3;
        // Keep the winding whichever way the ray runs along its main axis.
        let (kx, ky) = if d[kz] < 0.0 { ((next + 1) % 3, next) } else { (next, (next + 1) % 3) };
        let scale_z = 1.0 / d[kz];
        Self { origin: ray.origin, kx, ky, kz, shear_x: d[kx] * scale_z, shear_y: d[ky] * scale_z, scale_z }
    }

    /// A vertex in the ray's frame: x and y sheared, z still unscaled.
    #[inline]
    fn place(&self, vertex: DVec3) -> [f64; 3] {
        let v = vertex - self.origin;
        let z = v[self.kz];
        [v[self.kx] - self.shear_x * z, v[self.ky] - self.shear_y * z, z * self.scale_z]
    }

    /// Twice the signed areas that the ray cuts off at the edges opposite to each vertex.
    #[inline]
    fn edges([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
        [c[0] * b[1] - c[1] * b[0], a[0] * c[1] - a[1] * c[0], b[0] * a[1] - b[1] * a[0]]
    }

    /// Weights of the three vertices where the ray crosses the triangle's plane, beside the triangle too; those of
    /// [`RayFrame::hit`] where that hits. The first vertex alone for a ray along the plane.
    #[must_use]
    pub fn weights(&self, vertices: [DVec3; 3]) -> [f64; 3] {
        let [u, v, w] = Self::edges(vertices.map(|v| self.place(v)));
        let det = u + v + w;
        if det == 0.0 || !det.is_finite() { [1.0, 0.0, 0.0] } else { [u / det, v / det, w / det] }
    }

    /// Hit of either side of a triangle with `0 < t <= t_max`; edges and vertices count as inside.
    #[must_use]
    #[inline]
    pub fn hit(&self, vertices: [DVec3; 3], t_max: f64) -> Option<TriangleHit> {
        let [a, b, c] = vertices.map(|v| self.place(v));
        let [u, v, w] = Self::edges([a, b, c]);
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return None;
        }
        let det = u + v + w;
        // Also drops NaN: only a finite, nonzero determinant is a hit.
        if det == 0.0 || !det.is_finite() {
            return None;
        }
        let t = (u * a[2] + v * b[2] + w * c[2]) / det;
        // A convex combination lies between the vertices; rounding of a needle must not carry it beyond.
        let nearest = min(min(a[2], b[2]), c[2]);
        let farthest = max(max(a[2], b[2]), c[2]);
        let t = max(nearest, min(farthest, t));
        if t > 0.0 && t <= t_max { Some(TriangleHit { t, weights: [u / det, v / det, w / det] }) } else { None }
    }
}

#[inline]
fn min(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline]
fn max(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(origin: DVec3, direction: DVec3) -> RayFrame {
        RayFrame::new(&Ray { origin, direction })
    }

    const UNIT: [DVec3; 3] = [DVec3::ZERO, DVec3::X, DVec3::Y];

    #[test]
    fn hits_inside_edges_and_vertices_from_both_sides() {
        for z in [-2.0, 2.0] {
            for (x, y) in [(0.25, 0.25), (0.0, 0.0), (1.0, 0.0), (0.5, 0.5), (0.0, 0.5)] {
                let hit = frame(DVec3::new(x, y, z), DVec3::Z * -z).hit(UNIT, f64::INFINITY).expect("a hit");
                assert_eq!(hit.t, 1.0);
                assert_eq!((hit.weights[1], hit.weights[2]), (x, y));
            }
        }
        assert!(frame(DVec3::new(0.6, 0.6, 1.0), DVec3::NEG_Z).hit(UNIT, f64::INFINITY).is_none());
    }

    #[test]
    fn respects_the_range_and_ignores_degenerate_triangles() {
        let down = frame(DVec3::new(0.25, 0.25, 1.0), DVec3::NEG_Z);
        assert!(down.hit(UNIT, 1.0).is_some());
        assert!(down.hit(UNIT, 0.999).is_none());
        assert!(frame(DVec3::new(0.25, 0.25, -1.0), DVec3::NEG_Z).hit(UNIT, f64::INFINITY).is_none());
        assert!(down.hit([DVec3::ZERO, DVec3::ONE, DVec3::splat(2.0)], f64::INFINITY).is_none());
        assert!(down.hit([DVec3::NAN, DVec3::X, DVec3::Y], f64::INFINITY).is_none());
    }
}
