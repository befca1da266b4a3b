//! The built-in shapes, one file each.

mod cuboid;
mod mesh;
mod mesh_tree;
mod plane;
mod shear;
mod sphere;
mod triangle;

pub use cuboid::{Cuboid, PackedCuboid};
pub use mesh::{Mesh, MeshError, PackedMesh, Shading, TriangleMesh};
pub use plane::{PackedPlane, Plane};
pub use shear::{RayFrame, TriangleHit};
pub use sphere::{PackedSphere, Sphere};
pub use triangle::{PackedTriangle, Triangle};
