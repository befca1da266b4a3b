//! From the faces of a file to a triangle mesh.

use super::log::Log;
use super::polygon;
use super::scan::{Has, Scan};
use glam::{DVec3, Vec3};
use snell_components::shape::{MeshError, TriangleMesh};

/// The lists of a mesh, one entry per triangle in those of attributes that any triangle has.
#[derive(Default)]
struct Lists {
    triangles: Vec<[u32; 3]>,
    uvs: Vec<Option<[u32; 3]>>,
    normals: Vec<Option<[u32; 3]>>,
    slots: Vec<u16>,
}

/// The mesh of a file without faults; takes its lists away. Its slots are those of the runs' materials, faces without one
/// have the slot after the last.
pub(super) fn build(scan: &mut Scan) -> Result<TriangleMesh, MeshError> {
    let positions = std::mem::take(&mut scan.positions);
    let vertices = std::mem::take(&mut scan.vertices);
    let any_material = scan.runs.iter().any(|run| run.material.is_some());
    let mesh = if scan.polygons.is_empty() && !any_material && !scan.runs.iter().any(|run| run.has != Has::NONE) {
        let triangles = vertices.as_chunks().0.to_vec();
        drop(vertices);
        TriangleMesh::new(positions, triangles)?
    } else {
        let lists = Lists::cut(scan, &positions, &vertices, any_material);
        drop(vertices);
        let normals = std::mem::take(&mut scan.normals).into_iter().map(unit).collect();
        let uvs = std::mem::take(&mut scan.uvs);
        let Lists { triangles, uvs: corner_uvs, normals: corner_normals, slots } = lists;
        TriangleMesh::with_attributes(positions, triangles, (normals, corner_normals), (uvs, corner_uvs), slots)?
    };
    if mesh.degenerate() > 0 {
        scan.log.notice(None, &format!("triangles without an area left out: {}", mesh.degenerate()));
    }
    Ok(mesh)
}

impl Lists {
    /// All faces cut into triangles.
    fn cut(scan: &mut Scan, positions: &[[f32; 3]], vertices: &[u32], any_material: bool) -> Self {
        let any_uvs = !scan.uvs.is_empty() && scan.runs.iter().any(|run| run.has.uvs);
        let any_normals = !scan.normals.is_empty() && scan.runs.iter().any(|run| run.has.normals);
        let default_slot = scan.names.len() as u16;
        let mut lists = Self::default();
        let mut cuts = vec![];
        let mut polygons = scan.polygons.iter().copied().peekable();
        let mut corner = 0;
        for (i, run) in scan.runs.iter().enumerate() {
            let end = scan.runs.get(i + 1).map_or(scan.faces, |next| next.first);
            for face in run.first..end {
                let arity = polygons.next_if(|(number, _)| *number == face).map_or(3, |(_, arity)| arity);
                let range = corner..corner + arity;
                corner += arity;
                let vertices = &vertices[range.clone()];
                if arity == 3 {
                    cuts.clear();
                    cuts.push([0, 1, 2]);
                } else {
                    cut(vertices, positions, &mut cuts, &mut scan.log);
                }
                let of = |indices: &[u32], cut: [usize; 3]| {
                    indices.get(range.clone()).map(|indices| cut.map(|i| indices[i]))
                };
                for &cut in &cuts {
                    lists.triangles.push(cut.map(|i| vertices[i]));
                    if any_uvs {
                        lists.uvs.push(of(&scan.corner_uvs, cut).filter(|_| run.has.uvs));
                    }
                    if any_normals {
                        lists.normals.push(of(&scan.corner_normals, cut).filter(|_| run.has.normals));
                    }
                    if any_material {
                        lists.slots.push(run.material.unwrap_or(default_slot));
                    }
                }
            }
        }
        lists
    }
}

fn cut(vertices: &[u32], positions: &[[f32; 3]], cuts: &mut Vec<[usize; 3]>, log: &mut Log) {
    let point = |&i: &u32| positions.get(i as usize).map_or(DVec3::ZERO, |&p| Vec3::from_array(p).as_dvec3());
    let corners: Vec<DVec3> = vertices.iter().map(point).collect();
    if !polygon::cut(&corners, cuts) {
        log.notice(None, "a face that crosses itself, has no area or has too many corners is cut as a fan");
    }
}

/// A normal of length 1, so that blending weighs corners alike; zero stays zero.
fn unit(normal: [f32; 3]) -> [f32; 3] {
    Vec3::from_array(normal).as_dvec3().normalize_or_zero().as_vec3().to_array()
}
