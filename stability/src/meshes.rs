//! Closed meshes to be traced from within.

use crate::random::Random;
use glam::DVec3;
use snell_components::{math, shape::TriangleMesh};
use std::sync::Arc;

/// A closed bumpy sphere about the origin, columns × rows, with shared vertices; every point of it is at least `least`
/// away, so that every ray from nearer than that must meet it.
pub(crate) fn bumpy(columns: usize, rows: usize, bumps: f64, seed: u64) -> TriangleMesh {
    let mut random = Random::new(seed);
    let mut point = |theta: f64, phi: f64| {
        let (st, ct) = math::sin_cos_degrees(theta);
        let (sp, cp) = math::sin_cos_degrees(phi);
        let radius = 1.0 + bumps * random.unit();
        (DVec3::new(st * cp, ct, st * sp) * radius).as_vec3().to_array()
    };
    let mut positions = vec![point(0.0, 0.0), point(180.0, 0.0)];
    for row in 1..rows {
        for column in 0..columns {
            positions.push(point(180.0 * row as f64 / rows as f64, 360.0 * column as f64 / columns as f64));
        }
    }
    let at = |row: usize, column: usize| (2 + (row - 1) * columns + column % columns) as u32;
    let mut triangles = vec![];
    for column in 0..columns {
        triangles.push([0, at(1, column + 1), at(1, column)]);
        triangles.push([1, at(rows - 1, column), at(rows - 1, column + 1)]);
        for row in 1..rows - 1 {
            triangles.push([at(row, column), at(row, column + 1), at(row + 1, column + 1)]);
            triangles.push([at(row, column), at(row + 1, column + 1), at(row + 1, column)]);
        }
    }
    TriangleMesh::new(positions, triangles).unwrap_or_default()
}

/// The mesh of the leak cases: radii from 1 to 6.
pub(crate) fn spiky() -> Arc<TriangleMesh> {
    Arc::new(bumpy(8, 8, 5.0, 1))
}

/// All triangles of a mesh.
pub(crate) fn triangles(mesh: &TriangleMesh) -> Vec<[DVec3; 3]> {
    (0..mesh.len()).map(|i| mesh.corners(i)).collect()
}
