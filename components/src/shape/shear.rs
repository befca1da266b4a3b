//! The ray–triangle test: sheared edge functions (Woop, Benthin, Wald: Watertight Ray/Triangle Intersection, JCGT 2(1),
//! 2013) in `f64`.
//!
//! Vertices are moved so that the ray starts at the origin and sheared so that it runs along +z; the signs of three 2D
//! edge functions then decide. Two triangles that share an edge evaluate the very same products for it, and a rounded
//! difference of products can be falsely zero but never has the wrong sign, so with zero counting as inside no ray
//! slips between them. Contraction to fused multiply-add would break this.

use super::triangle_kernel::{TriangleHit, TriangleKernel};
use crate::{
    lanes::{Lanes, vector},
    packet::{Mask, PACKET, PerRay, Vectors},
    real::{self, Real, Vector},
    space::Ray,
};
use glam::DVec3;

/// A ray prepared for triangle tests.
pub type RayFrame = Sheared<f64>;

/// A ray prepared for triangle tests in either precision.
#[derive(Clone, Copy, Debug)]
pub struct Sheared<R> {
    /// Where it starts, in the order of its axes.
    start: [R; 3],
    kx: usize,
    ky: usize,
    kz: usize,
    shear_x: R,
    shear_y: R,
    scale_z: R,
}

impl<R: Real> Sheared<R> {
    /// Prepares a ray; its direction must not be zero.
    #[must_use]
    #[inline]
    pub fn new(ray: &Ray) -> Self {
        let d: Vector<R> = real::vector(ray.direction);
        let (x, y, z) = (d[0].abs(), d[1].abs(), d[2].abs());
        // Without branches: nothing foretells them.
        let yz = if y >= z { 1 } else { 2 };
        let kz = if x >= y && x >= z { 0 } else { yz };
        // The axes that follow; the winding is kept whichever way the ray runs along its main axis.
        let next = if kz == 2 { 0 } else { kz + 1 };
        let last = if kz == 0 { 2 } else { kz - 1 };
        let backward = d[kz] < R::ZERO;
        let (kx, ky) = (if backward { last } else { next }, if backward { next } else { last });
        let scale_z = R::ONE / d[kz];
        let origin: Vector<R> = real::vector(ray.origin);
        let start = [origin[kx], origin[ky], origin[kz]];
        Self { start, kx, ky, kz, shear_x: d[kx] * scale_z, shear_y: d[ky] * scale_z, scale_z }
    }

    /// A vertex in the ray's frame: x and y sheared, z still unscaled.
    #[inline]
    fn place(&self, vertex: DVec3) -> Vector<R> {
        let v: Vector<R> = real::vector(vertex);
        let z = v[self.kz] - self.start[2];
        let (x, y) = (v[self.kx] - self.start[0], v[self.ky] - self.start[1]);
        [x - self.shear_x * z, y - self.shear_y * z, z * self.scale_z]
    }

    /// Twice the signed areas that the ray cuts off at the edges opposite to each vertex.
    #[inline]
    fn edges([a, b, c]: [Vector<R>; 3]) -> [R; 3] {
        [c[0] * b[1] - c[1] * b[0], a[0] * c[1] - a[1] * c[0], b[0] * a[1] - b[1] * a[0]]
    }

    /// Weights of the three vertices where the ray crosses the triangle's plane, beside the triangle too; those of
    /// [`Sheared::hit`] where that hits. The first vertex alone for a ray along the plane.
    #[must_use]
    #[inline]
    pub fn weights(&self, vertices: [DVec3; 3]) -> [f64; 3] {
        let [a, b, c] = vertices;
        let [u, v, w] = Self::edges([self.place(a), self.place(b), self.place(c)]);
        let det = u + v + w;
        if det == R::ZERO || !det.is_finite() {
            return [1.0, 0.0, 0.0];
        }
        [(u / det).to_f64(), (v / det).to_f64(), (w / det).to_f64()]
    }

    /// Hit of either side of a triangle with `0 < t <= t_max`; edges and vertices count as inside.
    #[must_use]
    #[inline]
    pub fn hit(&self, vertices: [DVec3; 3], t_max: f64) -> Option<TriangleHit> {
        let [a, b, c] = vertices.map(|v| self.place(v));
        let [u, v, w] = Self::edges([a, b, c]);
        let zero = R::ZERO;
        if (u < zero || v < zero || w < zero) && (u > zero || v > zero || w > zero) {
            return None;
        }
        let det = u + v + w;
        // Also drops NaN: only a finite, nonzero determinant is a hit.
        if det == zero || !det.is_finite() {
            return None;
        }
        let t = (u * a[2] + v * b[2] + w * c[2]) / det;
        // A convex combination lies between the vertices; rounding of a needle must not carry it beyond.
        let nearest = min(min(a[2], b[2]), c[2]);
        let farthest = max(max(a[2], b[2]), c[2]);
        let t = max(nearest, min(farthest, t)).to_f64();
        let weights = || [u / det, v / det, w / det].map(Real::to_f64);
        if t > 0.0 && t <= t_max { Some(TriangleHit { t, weights: weights() }) } else { None }
    }
}

impl<R: Real> TriangleKernel for Sheared<R> {
    #[inline]
    fn new(ray: &Ray) -> Self {
        Self::new(ray)
    }

    #[inline]
    fn hit(&self, vertices: [DVec3; 3], t_max: f64) -> Option<TriangleHit> {
        self.hit(vertices, t_max)
    }
}

/// Four triangles.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(crate) struct Block {
    /// By vertex, axis and triangle.
    pub(crate) vertices: [[[f32; 4]; 3]; 3],
    /// Which triangles they are.
    pub(crate) triangles: [u32; 4],
}

impl Block {
    /// The least and the greatest coordinates of one of its triangles, each with a 0 to fill the lanes.
    #[inline(always)]
    pub(crate) fn bounds_of(&self, lane: usize) -> [[f32; 4]; 2] {
        let [a, b, c] = &self.vertices;
        let least = |axis: usize| min(min(a[axis][lane], b[axis][lane]), c[axis][lane]);
        let greatest = |axis: usize| max(max(a[axis][lane], b[axis][lane]), c[axis][lane]);
        [[least(0), least(1), least(2), 0.0], [greatest(0), greatest(1), greatest(2), 0.0]]
    }

    /// The vertices of one of its triangles.
    #[inline]
    pub(crate) fn vertices_of(&self, lane: usize) -> [DVec3; 3] {
        // Written out: the compiler does not inline a closure over arrays.
        let vertex = |i: usize| {
            let [x, y, z] = &self.vertices[i];
            DVec3::new(f64::from(x[lane]), f64::from(y[lane]), f64::from(z[lane]))
        };
        [vertex(0), vertex(1), vertex(2)]
    }
}

impl RayFrame {
    /// [`RayFrame::place`] of four vertices.
    #[inline(always)]
    fn place_block<L: Lanes>(&self, l: L, vertices: &[[f32; 4]; 3]) -> [L::D; 3] {
        let x = l.d_sub(l.d_widen(&vertices[self.kx]), l.d_splat(self.start[0]));
        let y = l.d_sub(l.d_widen(&vertices[self.ky]), l.d_splat(self.start[1]));
        let z = l.d_sub(l.d_widen(&vertices[self.kz]), l.d_splat(self.start[2]));
        let x = l.d_sub(x, l.d_mul(l.d_splat(self.shear_x), z));
        let y = l.d_sub(y, l.d_mul(l.d_splat(self.shear_y), z));
        [x, y, z]
    }

    /// [`RayFrame::hit`] of four triangles: which are hit within `t_max`, and at what distances.
    #[inline(always)]
    pub(crate) fn hit_block<L: Lanes>(&self, lanes: L, block: &Block, t_max: f64) -> Option<(u32, [f64; 4])> {
        let l = lanes;
        let [a, b, c] = &block.vertices;
        let (a, b, c) = (self.place_block(l, a), self.place_block(l, b), self.place_block(l, c));
        let (u, v, w) = (cross(l, &c, &b), cross(l, &a, &c), cross(l, &b, &a));
        let zero = l.d_splat(0.0);
        // Where a sign is NaN, the determinant is too.
        let negative = l.d_lt(l.d_min(l.d_min(u, v), w), zero);
        let positive = l.d_lt(zero, l.d_max(l.d_max(u, v), w));
        if negative & positive == 0b1111 {
            return None;
        }
        let det = l.d_add(l.d_add(u, v), w);
        let size = l.d_abs(det);
        let proper = l.d_lt(zero, size) & l.d_lt(size, l.d_splat(f64::INFINITY));
        let scale_z = l.d_splat(self.scale_z);
        let (az, bz, cz) = (l.d_mul(a[2], scale_z), l.d_mul(b[2], scale_z), l.d_mul(c[2], scale_z));
        let t = l.d_add(l.d_add(l.d_mul(u, az), l.d_mul(v, bz)), l.d_mul(w, cz));
        let t = l.d_div(t, det);
        let nearest = l.d_min(l.d_min(az, bz), cz);
        let farthest = l.d_max(l.d_max(az, bz), cz);
        let t = l.d_max(nearest, l.d_min(farthest, t));
        let within = l.d_lt(zero, t) & l.d_le(t, l.d_splat(t_max));
        let hits = !(negative & positive) & proper & within;
        if hits == 0 {
            return None;
        }
        let mut distances = [0.0; 4];
        l.d_store(t, &mut distances);
        Some((hits, distances))
    }
}

/// The axes of four rays' frames: those whose main axis is x, those of which it is y if not x, and those that run backward
/// along it.
#[derive(Clone, Copy)]
pub(super) struct Axes {
    along_x: u32,
    along_y: u32,
    backward: u32,
}

impl Axes {
    /// Those of [`RayFrame::new`].
    #[inline(always)]
    pub(super) fn of<L: Lanes>(l: L, directions: vector::Four<L>) -> Self {
        let [x, y, z] = [l.d_abs(directions[0]), l.d_abs(directions[1]), l.d_abs(directions[2])];
        let along_x = l.d_le(y, x) & l.d_le(z, x);
        let along_y = l.d_le(z, y);
        let main = l.d_select(along_x, directions[0], l.d_select(along_y, directions[1], directions[2]));
        Self { along_x, along_y, backward: l.d_lt(main, l.d_splat(0.0)) }
    }

    /// Vectors in the order of these axes.
    #[inline(always)]
    pub(super) fn turn<L: Lanes>(self, l: L, [x, y, z]: vector::Four<L>) -> vector::Four<L> {
        let Self { along_x, along_y, backward } = self;
        let next = l.d_select(along_x, y, l.d_select(along_y, z, x));
        let last = l.d_select(along_x, z, l.d_select(along_y, x, y));
        let main = l.d_select(along_x, x, l.d_select(along_y, y, z));
        [l.d_select(backward, last, next), l.d_select(backward, next, last), main]
    }
}

/// Rays prepared for triangle tests.
pub(super) struct RayFrames {
    start: Vectors,
    shear_x: PerRay,
    shear_y: PerRay,
    scale_z: PerRay,
    /// As [`Axes`] has them.
    along_x: Mask,
    along_y: Mask,
    backward: Mask,
}

/// `kx`, `ky` and `kz` by a bit each of [`Axes`], the first lowest.
const ORDER: [[usize; 3]; 8] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [1, 2, 0], [1, 0, 2], [2, 1, 0], [0, 2, 1], [2, 1, 0]];

impl RayFrames {
    #[inline(always)]
    pub(super) fn new() -> Self {
        let none = [0.0; PACKET];
        Self { start: [none; 3], shear_x: none, shear_y: none, scale_z: none, along_x: 0, along_y: 0, backward: 0 }
    }

    /// [`RayFrame::new`] of four rays; once.
    #[inline(always)]
    pub(super) fn set<L: Lanes>(&mut self, l: L, group: usize, origins: vector::Four<L>, directions: vector::Four<L>) {
        let axes = Axes::of(l, directions);
        let [x, y, main] = axes.turn(l, directions);
        let scale = l.d_div(l.d_splat(1.0), main);
        l.d_store(scale, &mut self.scale_z.as_chunks_mut().0[group]);
        l.d_store(l.d_mul(x, scale), &mut self.shear_x.as_chunks_mut().0[group]);
        l.d_store(l.d_mul(y, scale), &mut self.shear_y.as_chunks_mut().0[group]);
        vector::store(l, axes.turn(l, origins), 0b1111, &mut self.start, group);
        self.along_x |= Mask::from(axes.along_x) << (4 * group);
        self.along_y |= Mask::from(axes.along_y) << (4 * group);
        self.backward |= Mask::from(axes.backward) << (4 * group);
    }

    /// One of them.
    #[inline(always)]
    pub(super) fn one(&self, i: usize) -> RayFrame {
        let bit = |mask: Mask| (mask >> i & 1) as usize;
        let [kx, ky, kz] = ORDER[bit(self.along_x) | bit(self.along_y) << 1 | bit(self.backward) << 2];
        let [x, y, z] = &self.start;
        let (shear_x, shear_y, scale_z) = (self.shear_x[i], self.shear_y[i], self.scale_z[i]);
        Sheared { start: [x[i], y[i], z[i]], kx, ky, kz, shear_x, shear_y, scale_z }
    }
}

/// An edge function of four triangles.
#[inline(always)]
fn cross<L: Lanes>(l: L, p: &[L::D; 3], q: &[L::D; 3]) -> L::D {
    l.d_sub(l.d_mul(p[0], q[1]), l.d_mul(p[1], q[0]))
}

#[inline]
fn min<R: Real>(a: R, b: R) -> R {
    if a < b { a } else { b }
}

#[inline]
fn max<R: Real>(a: R, b: R) -> R {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{self, Job};

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

    /// Whether frames made four at a time are those made one by one, bit for bit.
    struct Four([DVec3; 4], [DVec3; 4]);

    impl Job for Four {
        type Output = bool;

        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> bool {
            let Self(origins, directions) = self;
            let four = |of: [DVec3; 4]| {
                let along = |axis: usize| l.d_load(&core::array::from_fn(|i| of[i][axis]));
                [along(0), along(1), along(2)]
            };
            let mut frames = RayFrames::new();
            frames.set(l, 3, four(origins), four(directions));
            let bits = |f: RayFrame| {
                let numbers = [f.start[0], f.start[1], f.start[2], f.shear_x, f.shear_y, f.scale_z];
                ([f.kx, f.ky, f.kz], numbers.map(f64::to_bits))
            };
            (0..4).all(|i| bits(frames.one(12 + i)) == bits(frame(origins[i], directions[i])))
        }
    }

    #[test]
    fn frames_of_four_rays_are_those_of_each_with_ties_of_axes_too() {
        let coordinates = [-2.0, -1.0, -0.0, 0.0, 0.3, 1.0];
        let mut directions = vec![];
        for x in coordinates {
            for y in coordinates {
                directions.extend(coordinates.map(|z| DVec3::new(x, y, z)).into_iter().filter(|d| *d != DVec3::ZERO));
            }
        }
        let origin = |i: usize| DVec3::new(1.0 / (i + 1) as f64, -0.7, i as f64);
        for i in 0..directions.len() {
            let four = [0, 1, 2, 3].map(|lane| directions[(i + 5 * lane) % directions.len()]);
            assert!(lanes::run(Four([0, 1, 2, 3].map(|lane| origin(i + lane)), four)), "{four:?}");
        }
    }
}
