//! The built-in shapes, one file each.

mod cone;
mod cuboid;
mod cylinder;
mod mesh;
mod mesh_tree;
mod plane;
mod shear;
mod sphere;
mod triangle;

pub use cone::{Cone, PackedCone};
pub use cuboid::{Cuboid, PackedCuboid};
pub use cylinder::Cylinder;
pub use mesh::{Mesh, MeshError, PackedMesh, Shading, TriangleMesh};
pub use plane::{PackedPlane, Plane};
pub use shear::{RayFrame, TriangleHit};
pub use sphere::{PackedSphere, Sphere};
pub(crate) use sphere::{nearest_root, sphere_uv};
pub use triangle::{PackedTriangle, Triangle};
