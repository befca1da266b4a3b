//! Meshes to measure with.

use snell::{
    Renderer, Snapshot,
    prelude::{DAffine3, DVec3, Mesh, Name, Primitive, TriangleMesh},
};
use std::{
    fs,
    io::{self, Error, ErrorKind},
    path::Path,
    sync::Arc,
};

/// An indexed triangle mesh.
pub(crate) struct Subject {
    pub(crate) positions: Vec<[f32; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Subject {
    /// Reads a `.tri` file: counts of vertices and triangles, positions, corners; all little-endian and of 32 bits.
    pub(crate) fn read_tri(path: &Path) -> io::Result<Self> {
        let bytes = fs::read(path)?;
        let (words, _) = bytes.as_chunks::<4>();
        let wrong = || Error::new(ErrorKind::InvalidData, format!("{} is not as long as it says", path.display()));
        let [vertices, triangles, rest @ ..] = words else { return Err(wrong()) };
        let count = |word: &[u8; 4]| 3 * u32::from_le_bytes(*word) as usize;
        let (positions, corners) = rest.split_at_checked(count(vertices)).ok_or_else(wrong)?;
        if corners.len() != count(triangles) {
            return Err(wrong());
        }
        Ok(Self {
            positions: positions.as_chunks().0.iter().map(|p| p.map(f32::from_le_bytes)).collect(),
            triangles: corners.as_chunks().0.iter().map(|c| c.map(u32::from_le_bytes)).collect(),
        })
    }

    /// The mesh without its tree.
    pub(crate) fn mesh(&self) -> Mesh {
        Mesh::new(TriangleMesh::new(self.positions.clone(), self.triangles.clone()).expect("a sound mesh"))
    }

    /// A snapshot of the mesh alone.
    pub(crate) fn snapshot(&self) -> Arc<Snapshot> {
        let mut renderer = Renderer::new();
        renderer.world.spawn((Name::new("camera"), snell::prelude::Camera::default()));
        renderer.world.spawn((Name::new("mesh"), self.mesh()));
        renderer.snapshot().expect("a scene that can be drawn")
    }

    /// The corners of the box around all vertices.
    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        let points = self.positions.iter().map(|p| DVec3::from_array(p.map(f64::from)));
        points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| (min.min(p), max.max(p)))
    }
}

/// Builds the tree of a mesh that has none yet.
pub(crate) fn build(mesh: &Mesh) {
    mesh.pack(&DAffine3::IDENTITY).expect("a mesh with a surface");
}
