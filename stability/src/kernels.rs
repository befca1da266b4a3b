//! Triangle tests that are in use elsewhere and fail, beyond those that the renderer lets choose.

use glam::DVec3;
use snell_components::{
    real::{self, Real, Vector},
    space::Ray,
};

/// Möller and Trumbore with an absolute tolerance on the determinant and one on the coordinates.
pub(crate) fn tolerant<R: Real>(ray: &Ray, vertices: &[DVec3; 3], det_least: f64, slack: f64) -> Option<f64> {
    let [a, b, c] = vertices.map(real::vector::<R>);
    let (o, d): (Vector<R>, Vector<R>) = (real::vector(ray.origin), real::vector(ray.direction));
    let (det_least, slack) = (R::of(det_least), R::of(slack));
    let (ab, ac) = (real::minus(b, a), real::minus(c, a));
    let p = real::cross(d, ac);
    let det = real::dot(ab, p);
    if det.abs() < det_least || det == R::ZERO {
        return None;
    }
    let s = real::minus(o, a);
    let u = real::dot(s, p) / det;
    let q = real::cross(s, ab);
    let v = real::dot(d, q) / det;
    if !(u >= -slack && v >= -slack && u + v <= R::ONE + slack) {
        return None;
    }
    let t = real::dot(ac, q) / det;
    (t > R::ZERO).then_some(t.to_f64())
}

/// Plücker's test: signs of the volumes that the ray spans with each edge; `ulps` of their sum count as inside.
pub(crate) fn plucker<R: Real>(ray: &Ray, vertices: &[DVec3; 3], ulps: f64) -> bool {
    let o: Vector<R> = real::vector(ray.origin);
    let d: Vector<R> = real::vector(ray.direction);
    let [a, b, c] = vertices.map(|v| real::minus(real::vector(v), o));
    let side = |p: Vector<R>, q: Vector<R>| real::dot(real::cross(real::minus(q, p), real::plus(q, p)), d);
    let (u, v, w) = (side(c, b), side(a, c), side(b, a));
    let slack = R::of(ulps) * (u + v + w).abs();
    let (low, high) = (-slack, slack);
    let inside = u >= low && v >= low && w >= low || u <= high && v <= high && w <= high;
    let normal = real::cross(real::minus(b, a), real::minus(c, a));
    let toward = real::dot(normal, d);
    inside && toward != R::ZERO && real::dot(normal, a) / toward > R::ZERO
}

/// The sheared test with what makes it fail: fused edge functions, or hits refused within a bound of their error.
#[derive(Clone, Copy)]
pub(crate) enum Spoiled {
    /// Edge functions by fused multiply-add, as a compiler that contracts makes them.
    Fused,
    /// Hits not surely in front of the origin are refused, against hitting the surface that a ray starts on.
    Conservative,
}

/// The sheared test in `f64` (fused) or `f32` (conservative), spoiled.
pub(crate) fn sheared(ray: &Ray, vertices: &[DVec3; 3], how: Spoiled) -> bool {
    match how {
        Spoiled::Fused => fused(ray, vertices),
        Spoiled::Conservative => conservative(ray, vertices),
    }
}

fn axes(d: DVec3) -> [usize; 3] {
    let size = d.abs();
    let kz = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let next = (kz + 1) % 3;
    if d[kz] < 0.0 { [(next + 1) % 3, next, kz] } else { [next, (next + 1) % 3, kz] }
}

#[expect(clippy::disallowed_methods, reason = "the failure under test")]
fn fused(ray: &Ray, vertices: &[DVec3; 3]) -> bool {
    let [kx, ky, kz] = axes(ray.direction);
    let d = ray.direction;
    let (sx, sy, sz) = (d[kx] / d[kz], d[ky] / d[kz], 1.0 / d[kz]);
    let [a, b, c] = vertices.map(|v| {
        let v = v - ray.origin;
        [(-sx).mul_add(v[kz], v[kx]), (-sy).mul_add(v[kz], v[ky]), v[kz] * sz]
    });
    let edge = |p: [f64; 3], q: [f64; 3]| p[0].mul_add(q[1], -(p[1] * q[0]));
    let (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
    if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
        return false;
    }
    let det = u + v + w;
    det != 0.0 && (u * a[2] + v * b[2] + w * c[2]) / det > 0.0
}

/// After pbrt, third edition, section 3.9.6: bounds of the error of t, in units of the rounding of `f32`.
fn conservative(ray: &Ray, vertices: &[DVec3; 3]) -> bool {
    let [kx, ky, kz] = axes(ray.direction);
    let d = ray.direction.as_vec3();
    let (sx, sy, sz) = (-d[kx] / d[kz], -d[ky] / d[kz], 1.0 / d[kz]);
    let o = ray.origin.as_vec3();
    let p = vertices.map(|v| {
        let v = v.as_vec3() - o;
        [v[kx] + sx * v[kz], v[ky] + sy * v[kz], v[kz] * sz]
    });
    let edge = |p: [f32; 3], q: [f32; 3]| p[0] * q[1] - p[1] * q[0];
    let e = [edge(p[1], p[2]), edge(p[2], p[0]), edge(p[0], p[1])];
    if e.iter().any(|e| *e < 0.0) && e.iter().any(|e| *e > 0.0) {
        return false;
    }
    let det = e[0] + e[1] + e[2];
    if det == 0.0 {
        return false;
    }
    let t = (e[0] * p[0][2] + e[1] * p[1][2] + e[2] * p[2][2]) / det;
    let gamma = |n: f32| {
        let nu = n * (f32::EPSILON * 0.5);
        nu / (1.0 - nu)
    };
    let most = |axis: usize| p.iter().map(|p| p[axis].abs()).fold(0.0, f32::max);
    let (x, y, z) = (most(0), most(1), most(2));
    let (dx, dy, dz) = (gamma(5.0) * (x + z), gamma(5.0) * (y + z), gamma(3.0) * z);
    let de = 2.0 * (gamma(2.0) * x * y + dy * x + dx * y);
    let e_most = e.iter().map(|e| e.abs()).fold(0.0, f32::max);
    let dt = 3.0 * (gamma(3.0) * e_most * z + de * z + dz * e_most) / det.abs();
    t > dt
}
