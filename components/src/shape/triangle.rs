//! `Triangle(a: (0,0,0), b: (1,0,0), c: (0,1,0))`: three points, optionally with a normal and texture coordinates each.
//!
//! The front faces the side from which a, b, c run counter-clockwise. Without `uvs`, u and v are the weights of b and c.

use super::{
    shear::RayFrame,
    terminator,
    triangle_kernel::{TriangleKernel, WithKernel, choose},
};
use crate::{
    bvh::reaches,
    describe::{Describe, Fault},
    method::Methods,
    primitive::{Cost, Degenerate, Extent, Hit, Primitive, Surface},
    space::{BoundingSphere, Bounds, Ray},
};
use bevy_ecs::prelude::*;
use glam::{DAffine3, DVec2, DVec3};

/// A triangle by three points.
#[derive(Component, Clone, Debug, Default, PartialEq, Describe)]
#[describe(check = Self::agrees)]
pub struct Triangle {
    /// First point, object space.
    #[describe(required)]
    pub a: DVec3,
    /// Second point, object space.
    #[describe(required)]
    pub b: DVec3,
    /// Third point, object space.
    #[describe(required)]
    pub c: DVec3,
    /// Normals at the points, for smooth (Phong) shading; none for flat shading.
    #[describe(nonzero)]
    pub normals: Vec<DVec3>,
    /// Texture coordinates at the points; none for the weights of b and c.
    pub uvs: Vec<DVec2>,
}

impl Triangle {
    /// Whether the fields go together.
    fn agrees(&self) -> Result<(), Fault> {
        for (field, count) in [("normals", self.normals.len()), ("uvs", self.uvs.len())] {
            if count != 0 && count != 3 {
                return Err(Fault::new(field, format!("three entries or none, found {count}")));
            }
        }
        if (self.b - self.a).cross(self.c - self.a) == DVec3::ZERO {
            return Err(Fault::new("c", "three points that are not on one line"));
        }
        Ok(())
    }
}

/// A triangle as the inner loop sees it.
#[derive(Clone, Debug)]
pub struct PackedTriangle {
    vertices: [DVec3; 3],
    normal: DVec3,
    normals: Option<[DVec3; 3]>,
    uvs: [DVec2; 3],
}

impl Primitive for Triangle {
    type Packed = PackedTriangle;

    fn pack(&self, world_from_object: &DAffine3) -> Result<(Extent, PackedTriangle), Degenerate> {
        let vertices = [self.a, self.b, self.c].map(|v| world_from_object.transform_point3(v));
        // The object-space normal, mapped by the inverse transpose: a mirroring placement must not turn it round.
        let cotangent = world_from_object.inverse().matrix3.transpose();
        let flat = (self.b - self.a).cross(self.c - self.a);
        let normal = (cotangent * flat).try_normalize();
        let Some(normal) = normal else {
            return Err(Degenerate("its three points lie on one line".into()));
        };
        let normals = <[DVec3; 3]>::try_from(self.normals.as_slice()).ok();
        let normals = normals.map(|n| n.map(|n| (cotangent * n).normalize_or(normal)));
        let uvs = <[DVec2; 3]>::try_from(self.uvs.as_slice()).unwrap_or([DVec2::ZERO, DVec2::X, DVec2::Y]);
        let bounds = Bounds::of_points(vertices);
        Ok((Extent::Bounded(bounds), PackedTriangle { vertices, normal, normals, uvs }))
    }

    #[inline]
    fn hit(packed: &PackedTriangle, ray: &Ray, t_max: f64, cost: &mut Cost) -> Option<Hit> {
        cost.primitives += 1;
        Alone { vertices: packed.vertices, ray, t_max }.run(&RayFrame::new(ray))
    }

    fn hit_with(packed: &PackedTriangle, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> Option<Hit> {
        cost.primitives += 1;
        choose(with, ray, Alone { vertices: packed.vertices, ray, t_max })
    }

    fn surface(packed: &PackedTriangle, ray: &Ray, _: Hit) -> Surface {
        let [u, v, w] = RayFrame::new(ray).weights(packed.vertices);
        let [a, b, c] = packed.vertices;
        let shading_normal =
            packed.normals.map_or(packed.normal, |[na, nb, nc]| (na * u + nb * v + nc * w).normalize_or(packed.normal));
        let [ta, tb, tc] = packed.uvs;
        Surface {
            point: a * u + b * v + c * w,
            normal: packed.normal,
            shading_normal,
            uv: ta * u + tb * v + tc * w,
            slot: 0,
            error: Surface::rounding(a.abs().max(b.abs()).max(c.abs()).max_element()),
        }
    }

    fn lift(packed: &PackedTriangle, ray: &Ray, _: Hit) -> DVec3 {
        let Some(normals) = packed.normals else { return DVec3::ZERO };
        let side = if packed.normal.dot(ray.direction) < 0.0 { 1.0 } else { -1.0 };
        let weights = RayFrame::new(ray).weights(packed.vertices);
        terminator::lift(packed.vertices, normals.map(|n| n * side), weights)
    }

    fn bounding_sphere(packed: &PackedTriangle, _: &Bounds) -> BoundingSphere {
        BoundingSphere::of_triangle(packed.vertices)
    }
}

/// A triangle to be tested by any method.
struct Alone<'a> {
    vertices: [DVec3; 3],
    ray: &'a Ray,
    t_max: f64,
}

impl WithKernel for Alone<'_> {
    type Output = Option<Hit>;

    #[inline]
    fn run<K: TriangleKernel>(self, kernel: &K) -> Option<Hit> {
        let hit = kernel.hit(self.vertices, self.t_max).filter(|hit| reaches(self.ray, &self.vertices, hit.t));
        hit.map(|hit| Hit { t: hit.t, part: 0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mirrored_triangle_keeps_its_front() {
        let triangle = Triangle { b: DVec3::X, c: DVec3::Y, ..Triangle::default() };
        let (_, packed) = triangle.pack(&DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0))).expect("a triangle");
        assert_eq!(packed.normal, DVec3::Z);
    }

    #[test]
    fn opposite_normals_fall_back_to_the_face() {
        let normals = vec![DVec3::X, DVec3::NEG_X, DVec3::Z];
        let triangle = Triangle { b: DVec3::X, c: DVec3::Y, normals, ..Triangle::default() };
        let (_, packed) = triangle.pack(&DAffine3::IDENTITY).expect("a triangle");
        let ray = Ray { origin: DVec3::new(0.5, 0.0, 1.0), direction: DVec3::NEG_Z };
        let hit = Triangle::hit(&packed, &ray, f64::INFINITY, &mut Cost::default()).expect("a hit");
        assert_eq!(Triangle::surface(&packed, &ray, hit).shading_normal, DVec3::Z);
    }
}
