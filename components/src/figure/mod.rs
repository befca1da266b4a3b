//! Figures: shapes that are made of many triangles or spheres by a rule with a few parameters.
//!
//! A figure of triangles is one component with two trait impls, [`Describe`] for its parameters and [`Figure`] for its
//! rule, and one registration call, that of any shape. Figures with equal parameters share what was made, wherever they
//! are placed.

mod height_field;
mod lathe;
mod shared;
mod sphere_flake;
mod triangle_field;

pub use height_field::HeightField;
pub use lathe::Lathe;
pub use sphere_flake::{PackedSphereFlake, SphereFlake};
pub use triangle_field::{Arrangement, TriangleField};

use crate::{
    describe::Describe,
    method::Methods,
    packet::{Hits, Mask, Packet, PerRay},
    primitive::{Cost, Degenerate, Extent, Hit, Primitive, Surface},
    shape::{Mesh, MeshError, PackedMesh, Shading, TriangleMesh},
    space::{BoundingSphere, Bounds, Ray},
    surfaces::{Meeting, Surfaces},
};
use bevy_ecs::{component::Mutable, prelude::*};
use glam::{DAffine3, DVec3};

/// Most triangles that a built-in figure makes.
pub const MAX_TRIANGLES: u64 = 1 << 23;

/// A shape whose triangles follow from its parameters.
pub trait Figure: Describe + Component<Mutability = Mutable> + Clone {
    /// The triangles, object space; the same ones for the same parameters.
    ///
    /// # Errors
    /// A reason why there are none.
    fn triangles(&self) -> Result<TriangleMesh, MeshError>;

    /// Which of the triangles are smoothed.
    fn shading(&self) -> Shading {
        Shading::AsModelled
    }
}

impl<F: Figure> Primitive for F {
    type Packed = PackedMesh;

    fn pack(&self, world_from_object: &DAffine3) -> Result<(Extent, PackedMesh), Degenerate> {
        let mesh = shared::shared(self, || self.triangles().map_err(|why| Degenerate(why.to_string())))?;
        PackedMesh::place(mesh, self.shading(), world_from_object)
    }

    #[inline]
    fn hit(packed: &PackedMesh, ray: &Ray, t_max: f64, cost: &mut Cost) -> Option<Hit> {
        Mesh::hit(packed, ray, t_max, cost)
    }

    fn hit_with(packed: &PackedMesh, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> Option<Hit> {
        Mesh::hit_with(packed, ray, t_max, with, cost)
    }

    fn blocks_with(packed: &PackedMesh, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> bool {
        Mesh::blocks_with(packed, ray, t_max, with, cost)
    }

    #[inline]
    fn blocks(packed: &PackedMesh, ray: &Ray, t_max: f64, cost: &mut Cost) -> bool {
        Mesh::blocks(packed, ray, t_max, cost)
    }

    fn hit_packet(
        packed: &PackedMesh,
        packet: &Packet,
        rays: Mask,
        t_max: &PerRay,
        hits: &mut Hits,
        cost: &mut Cost,
    ) -> Mask {
        Mesh::hit_packet(packed, packet, rays, t_max, hits, cost)
    }

    fn blocks_packet(packed: &PackedMesh, packet: &Packet, rays: Mask, t_max: &PerRay, cost: &mut Cost) -> Mask {
        Mesh::blocks_packet(packed, packet, rays, t_max, cost)
    }

    fn surface_packet(meshes: &[PackedMesh], met: &Meeting<'_>, surfaces: &mut Surfaces) {
        Mesh::surface_packet(meshes, met, surfaces);
    }

    fn surface(packed: &PackedMesh, ray: &Ray, hit: Hit) -> Surface {
        Mesh::surface(packed, ray, hit)
    }

    fn surface_without_uv(packed: &PackedMesh, ray: &Ray, hit: Hit) -> Surface {
        Mesh::surface_without_uv(packed, ray, hit)
    }

    fn lift(packed: &PackedMesh, ray: &Ray, hit: Hit) -> DVec3 {
        Mesh::lift(packed, ray, hit)
    }

    fn bounding_sphere(packed: &PackedMesh, bounds: &Bounds) -> BoundingSphere {
        Mesh::bounding_sphere(packed, bounds)
    }
}
