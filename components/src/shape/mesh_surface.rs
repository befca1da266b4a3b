//! The surfaces of a mesh that rays of a packet met: four triangles at once.

use super::{
    mesh::{Placed, point2},
    shear::Axes,
    terminator::lift_of_four,
};
use crate::{
    bvh::BLOCK,
    lanes::{Job, Lanes, vector},
    packet::{Mask, each, groups},
    surfaces::{Meeting, Surfaces},
};
use glam::{DVec2, DVec3};

/// The surfaces of a placed mesh that some rays met, as [`Placed::surface`] and [`Placed::lift`] tell of each.
pub(super) struct MetMesh<'a> {
    pub(super) placed: &'a Placed,
    pub(super) met: &'a Meeting<'a>,
    pub(super) rays: Mask,
    pub(super) surfaces: &'a mut Surfaces,
}

/// Corners, or normals there, of four triangles: by vertex, axis and triangle.
type Corners = [[[f32; 4]; 3]; 3];

impl Job for MetMesh<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) {
        let Self { placed, met, rays, surfaces } = self;
        for (group, which) in groups(rays) {
            let (mut corners, mut normals): (Corners, Corners) = ([[[0.0; 4]; 3]; 3], [[[0.0; 4]; 3]; 3]);
            let mut smooth = 0;
            for lane in 0..4 {
                if which >> lane & 1 == 0 {
                    continue;
                }
                let triangle = met.part[4 * group + lane];
                let (block, at) = placed.tree.block_of(triangle);
                for (to, from) in corners.iter_mut().zip(&block.vertices) {
                    for (to, from) in to.iter_mut().zip(from) {
                        to[lane] = from[at % BLOCK];
                    }
                }
                if let Some(of) = placed.normals(triangle) {
                    smooth |= 1 << lane;
                    for (to, from) in normals.iter_mut().zip(of) {
                        for (to, from) in to.iter_mut().zip(from) {
                            to[lane] = from;
                        }
                    }
                }
                surfaces.slot[4 * group + lane] = placed.slot_of(triangle);
            }
            let [a, b, c] = widened(l, &corners);
            let origin = vector::load(l, &met.packet.origins, group);
            let direction = vector::load(l, &met.packet.directions, group);
            let origin_there = vector::moved(l, &placed.object_from_world, origin);
            let direction_there = vector::turned(l, &placed.object_from_world.matrix3, direction);
            let from_origin =
                [vector::sub(l, a, origin_there), vector::sub(l, b, origin_there), vector::sub(l, c, origin_there)];
            let weights = weights(l, direction_there, from_origin);

            let face = vector::cross(l, vector::sub(l, b, a), vector::sub(l, c, a));
            let face = vector::turned(l, &placed.cotangent, face);
            let normal = vector::unit_or(l, face, vector::splat(l, DVec3::Y));
            let there = blend(l, [a, b, c], weights);
            let point = vector::moved(l, &placed.world_from_object, there);
            let (mut shading, mut lift) = (normal, vector::splat(l, DVec3::ZERO));
            if smooth != 0 {
                let [na, nb, nc] = widened(l, &normals);
                let blended = vector::turned(l, &placed.cotangent, blend(l, [na, nb, nc], weights));
                shading = vector::select(l, smooth, vector::unit_or(l, blended, normal), normal);
                let curved = vector::differ(l, shading, normal) & which;
                if curved != 0 {
                    let (one, other) = (l.d_splat(1.0), l.d_splat(-1.0));
                    let side = l.d_if_lt(vector::dot(l, face, direction), l.d_splat(0.0), one, other);
                    let none = lift;
                    let seen = [
                        vector::times(l, vector::unit_or(l, vector::turned(l, &placed.cotangent, na), none), side),
                        vector::times(l, vector::unit_or(l, vector::turned(l, &placed.cotangent, nb), none), side),
                        vector::times(l, vector::unit_or(l, vector::turned(l, &placed.cotangent, nc), none), side),
                    ];
                    let vertices = [
                        vector::moved(l, &placed.world_from_object, a),
                        vector::moved(l, &placed.world_from_object, b),
                        vector::moved(l, &placed.world_from_object, c),
                    ];
                    let lifted = lift_of_four(l, vertices, seen, weights);
                    lift = vector::select(l, curved, lifted, none);
                }
            }
            vector::store(l, point, which, &mut surfaces.point, group);
            vector::store(l, normal, which, &mut surfaces.normal, group);
            vector::store(l, shading, which, &mut surfaces.shading_normal, group);
            vector::store(l, lift, which, &mut surfaces.lift, group);
            l.d_store_some(l.d_splat(placed.error), which, &mut surfaces.error.as_chunks_mut().0[group]);

            let textured = (met.textured >> (4 * group)) as u32 & which;
            if textured != 0 {
                let mut each_weight = [[0.0; 4]; 3];
                for (weight, to) in weights.iter().zip(&mut each_weight) {
                    l.d_store(*weight, to);
                }
                for lane in each(Mask::from(textured)) {
                    let [u, v, w] = [each_weight[0][lane], each_weight[1][lane], each_weight[2][lane]];
                    let uv = match placed.mesh.uvs_of(met.part[4 * group + lane]) {
                        Some([a, b, c]) => point2(a) * u + point2(b) * v + point2(c) * w,
                        None => DVec2::new(v, w),
                    };
                    surfaces.set_uv(4 * group + lane, uv);
                }
            }
        }
    }
}

#[inline(always)]
fn widened<L: Lanes>(l: L, [a, b, c]: &Corners) -> [vector::Four<L>; 3] {
    [
        [l.d_widen(&a[0]), l.d_widen(&a[1]), l.d_widen(&a[2])],
        [l.d_widen(&b[0]), l.d_widen(&b[1]), l.d_widen(&b[2])],
        [l.d_widen(&c[0]), l.d_widen(&c[1]), l.d_widen(&c[2])],
    ]
}

/// Means of vectors at the corners, by weights.
#[inline(always)]
pub(super) fn blend<L: Lanes>(l: L, [a, b, c]: [vector::Four<L>; 3], [u, v, w]: [L::D; 3]) -> vector::Four<L> {
    vector::add(l, vector::add(l, vector::times(l, a, u), vector::times(l, b, v)), vector::times(l, c, w))
}

/// [`super::shear::RayFrame::weights`] of four rays in a triangle each, whose vertices are told from the rays' origins.
#[inline(always)]
fn weights<L: Lanes>(l: L, direction: vector::Four<L>, vertices: [vector::Four<L>; 3]) -> [L::D; 3] {
    let axes = Axes::of(l, direction);
    let [dx, dy, dz] = axes.turn(l, direction);
    let scale = l.d_div(l.d_splat(1.0), dz);
    let shear = (l.d_mul(dx, scale), l.d_mul(dy, scale));
    let [a, b, c] = vertices;
    let a = sheared(l, axes, shear, a);
    let b = sheared(l, axes, shear, b);
    let c = sheared(l, axes, shear, c);
    let u = l.d_sub(l.d_mul(c.0, b.1), l.d_mul(c.1, b.0));
    let v = l.d_sub(l.d_mul(a.0, c.1), l.d_mul(a.1, c.0));
    let w = l.d_sub(l.d_mul(b.0, a.1), l.d_mul(b.1, a.0));
    let det = l.d_add(l.d_add(u, v), w);
    let (zero, one, size) = (l.d_splat(0.0), l.d_splat(1.0), l.d_abs(det));
    let proper = l.d_lt(zero, size) & l.d_lt(size, l.d_splat(f64::INFINITY));
    [
        l.d_select(proper, l.d_div(u, det), one),
        l.d_select(proper, l.d_div(v, det), zero),
        l.d_select(proper, l.d_div(w, det), zero),
    ]
}

/// Where vertices stand in the sheared frames of rays.
#[inline(always)]
fn sheared<L: Lanes>(l: L, axes: Axes, (shear_x, shear_y): (L::D, L::D), vertex: vector::Four<L>) -> (L::D, L::D) {
    let [x, y, z] = axes.turn(l, vertex);
    (l.d_sub(x, l.d_mul(shear_x, z)), l.d_sub(y, l.d_mul(shear_y, z)))
}
