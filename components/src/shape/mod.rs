//! The built-in shapes, one file each.

mod cone;
mod cuboid;
mod cylinder;
mod mesh;
mod mesh_methods;
mod mesh_packet;
mod mesh_surface;
mod mesh_tree;
mod moller_trumbore;
mod plane;
mod ray_frame;
mod shear;
mod sphere;
mod terminator;
mod triangle;
mod triangle_kernel;

pub use cone::{Cone, PackedCone};
pub use cuboid::{Cuboid, PackedCuboid};
pub use cylinder::Cylinder;
pub use mesh::{Mesh, MeshError, PackedMesh, Shading, TriangleMesh};
pub use moller_trumbore::MollerTrumbore;
pub use plane::{PackedPlane, Plane};
pub use ray_frame::Turned;
pub use shear::{RayFrame, Sheared};
pub(crate) use sphere::sphere_uv;
pub use sphere::{PackedSphere, Sphere, naive_root, nearest_root};
pub use triangle::{PackedTriangle, Triangle};
pub use triangle_kernel::{TriangleHit, TriangleKernel};
