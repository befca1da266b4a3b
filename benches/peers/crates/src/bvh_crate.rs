//! `bvh`: a binary tree that yields the triangles whose boxes a ray meets.

use crate::{Mesh, Ray, Tree};
use bvh::{
    aabb::{Aabb, Bounded},
    bounding_hierarchy::{BHShape, BoundingHierarchy},
    bvh::Bvh,
};
use nalgebra::{Point3, Vector3};

#[derive(Clone)]
struct Triangle {
    corner: Point3<f32>,
    edges: [Vector3<f32>; 2],
    node: usize,
}

impl Bounded<f32, 3> for Triangle {
    fn aabb(&self) -> Aabb<f32, 3> {
        let [a, b] = self.edges.map(|edge| self.corner + edge);
        Aabb::empty().grow(&self.corner).grow(&a).grow(&b)
    }
}

impl BHShape<f32, 3> for Triangle {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

impl Triangle {
    /// Distance by Möller and Trumbore's test, if it is from `t_min` to below `t_max`.
    #[inline(always)]
    fn hit(&self, ray: &bvh::ray::Ray<f32, 3>, t_min: f32, t_max: f32) -> Option<f32> {
        let [e1, e2] = &self.edges;
        let p = ray.direction.cross(e2);
        let det = e1.dot(&p);
        if det == 0.0 {
            return None;
        }
        let s = ray.origin - self.corner;
        let q = s.cross(e1);
        let (u, v, t) = (s.dot(&p) / det, ray.direction.dot(&q) / det, e2.dot(&q) / det);
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= t_min && t < t_max).then_some(t)
    }
}

struct Built {
    tree: Bvh<f32, 3>,
    triangles: Vec<Triangle>,
}

pub fn build(mesh: &Mesh, parallel: bool) -> Box<dyn Tree> {
    let point = |i: u32| Point3::from(mesh.positions[i as usize]);
    let triangle = |&[a, b, c]: &[u32; 3]| {
        let corner = point(a);
        Triangle { corner, edges: [point(b) - corner, point(c) - corner], node: 0 }
    };
    let mut triangles: Vec<_> = mesh.triangles.iter().map(triangle).collect();
    let tree = if parallel { Bvh::build_par(&mut triangles) } else { Bvh::build(&mut triangles) };
    Box::new(Built { tree, triangles })
}

fn converted(ray: &Ray) -> bvh::ray::Ray<f32, 3> {
    bvh::ray::Ray::new(Point3::from(ray.origin), Vector3::from(ray.direction))
}

impl Tree for Built {
    fn closest(&self, ray: &Ray) -> Option<f32> {
        let from = converted(ray);
        let candidates = self.tree.traverse_iterator(&from, &self.triangles);
        candidates.fold(None, |best, triangle| triangle.hit(&from, ray.t_min, best.unwrap_or(ray.t_max)).or(best))
    }

    fn blocked(&self, ray: &Ray) -> bool {
        let from = converted(ray);
        self.tree
            .traverse_iterator(&from, &self.triangles)
            .any(|triangle| triangle.hit(&from, ray.t_min, ray.t_max).is_some())
    }
}
