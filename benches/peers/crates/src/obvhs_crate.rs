//! `obvhs`: its compressed eight-wide tree and its binary one.

use crate::{Mesh, Ray, Tree};
use glam::Vec3A;
use obvhs::{
    BvhBuildParams,
    bvh2::{Bvh2, builder::build_bvh2_from_tris},
    cwbvh::{CwBvh, builder::build_cwbvh_from_tris},
    ray::RayHit,
    rt_triangle::RtTriangle,
    triangle::Triangle,
};
use std::time::Duration;

struct Built<T> {
    tree: T,
    triangles: Vec<RtTriangle>,
}

pub fn build_wide(mesh: &Mesh, _: bool) -> Box<dyn Tree> {
    let triangles = triangles(mesh);
    let tree = build_cwbvh_from_tris(&triangles, BvhBuildParams::medium_build(), &mut Duration::default());
    let triangles = gathered(&triangles, &tree.primitive_indices);
    Box::new(Built { tree, triangles })
}

pub fn build_binary(mesh: &Mesh, _: bool) -> Box<dyn Tree> {
    let triangles = triangles(mesh);
    let tree = build_bvh2_from_tris(&triangles, BvhBuildParams::medium_build(), &mut Duration::default());
    let triangles = gathered(&triangles, &tree.primitive_indices);
    Box::new(Built { tree, triangles })
}

fn triangles(mesh: &Mesh) -> Vec<Triangle> {
    let point = |i: u32| Vec3A::from_array(mesh.positions[i as usize]);
    mesh.triangles.iter().map(|&[a, b, c]| Triangle { v0: point(a), v1: point(b), v2: point(c) }).collect()
}

fn gathered(triangles: &[Triangle], order: &[u32]) -> Vec<RtTriangle> {
    order.iter().map(|&i| RtTriangle::from(&triangles[i as usize])).collect()
}

fn converted(ray: &Ray) -> obvhs::ray::Ray {
    obvhs::ray::Ray::new(ray.origin.into(), ray.direction.into(), ray.t_min, ray.t_max)
}

impl Tree for Built<CwBvh> {
    fn closest(&self, ray: &Ray) -> Option<f32> {
        let mut hit = RayHit::none();
        let found = self.tree.ray_traverse(converted(ray), &mut hit, |ray, i| self.triangles[i].intersect(ray));
        found.then_some(hit.t)
    }

    fn blocked(&self, ray: &Ray) -> bool {
        !self.tree.ray_traverse_miss(converted(ray), |ray, i| self.triangles[i].intersect(ray))
    }
}

impl Tree for Built<Bvh2> {
    fn closest(&self, ray: &Ray) -> Option<f32> {
        let mut hit = RayHit::none();
        // What it returns compares with a ray that the walk does not shorten; the hit tells.
        self.tree.ray_traverse(converted(ray), &mut hit, |ray, i| self.triangles[i].intersect(ray));
        (hit.primitive_id != u32::MAX).then_some(hit.t)
    }

    fn blocked(&self, ray: &Ray) -> bool {
        !self.tree.ray_traverse_miss(converted(ray), |ray, i| self.triangles[i].intersect(ray))
    }
}
