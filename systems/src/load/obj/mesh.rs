//! From the parser's flat lists to a triangle mesh.

use super::log::Log;
use super::polygon;
use super::scan::{Run, Scan};
use glam::{DVec3, Vec3};
use snell_components::shape::{MeshError, TriangleMesh};

/// Whether the parser read as many faces, corners and values as the check counted.
pub(super) fn agrees(parsed: &tobj::Mesh, scan: &Scan) -> bool {
    let [_, uvs, normals] = scan.counts;
    let faces_agree = match parsed.face_arities.as_slice() {
        // How the parser says that all faces are triangles.
        [] => 3 * scan.faces == scan.corners,
        arities => arities.len() == scan.faces && arities.iter().map(|&n| n as usize).sum::<usize>() == scan.corners,
    };
    let corners_of = |count: usize| if count > 0 { scan.corners } else { 0 };
    faces_agree
        && parsed.indices.len() == scan.corners
        && parsed.texcoord_indices.len() == corners_of(uvs)
        && parsed.normal_indices.len() == corners_of(normals)
        && parsed.positions.len() <= 3 * scan.counts[0]
}

/// The lists of a mesh, one entry per triangle in those of attributes that any triangle has.
#[derive(Default)]
struct Lists {
    triangles: Vec<[u32; 3]>,
    uvs: Vec<Option<[u32; 3]>>,
    normals: Vec<Option<[u32; 3]>>,
    slots: Vec<u16>,
}

/// The mesh; its slots are those of the runs' materials, faces without one have the slot after the last.
pub(super) fn build(
    parsed: tobj::Mesh,
    runs: &[Run],
    default_slot: u16,
    log: &mut Log,
) -> Result<TriangleMesh, MeshError> {
    let positions = parsed.positions.as_chunks().0.to_vec();
    let any_uvs = runs.iter().any(|run| run.has.uvs);
    let any_normals = runs.iter().any(|run| run.has.normals);
    let any_material = runs.iter().any(|run| run.material.is_some());
    let mut lists = Lists::default();
    let mut cuts = vec![];
    let mut corner = 0;
    let mut face = 0;
    for (i, run) in runs.iter().enumerate() {
        let end = runs.get(i + 1).map(|next| next.first);
        while end.map_or(corner < parsed.indices.len(), |end| face < end) {
            let arity = parsed.face_arities.get(face).map_or(3, |&n| n as usize);
            let range = corner..corner + arity;
            let Some(vertices) = parsed.indices.get(range.clone()) else { break };
            if arity == 3 {
                cuts.clear();
                cuts.push([0, 1, 2]);
            } else {
                cut(vertices, &positions, &mut cuts, log);
            }
            let of =
                |indices: &[u32], cut: [usize; 3]| indices.get(range.clone()).map(|indices| cut.map(|i| indices[i]));
            for &cut in &cuts {
                lists.triangles.push(cut.map(|i| vertices[i]));
                if any_uvs {
                    lists.uvs.push(of(&parsed.texcoord_indices, cut).filter(|_| run.has.uvs));
                }
                if any_normals {
                    lists.normals.push(of(&parsed.normal_indices, cut).filter(|_| run.has.normals));
                }
                if any_material {
                    lists.slots.push(run.material.unwrap_or(default_slot));
                }
            }
            corner += arity;
            face += 1;
        }
    }
    let mesh = if any_uvs || any_normals || any_material {
        let normals = parsed.normals.as_chunks().0.iter().map(|&n| unit(n)).collect();
        let uvs = parsed.texcoords.as_chunks().0.to_vec();
        TriangleMesh::with_attributes(
            positions,
            lists.triangles,
            (normals, lists.normals),
            (uvs, lists.uvs),
            lists.slots,
        )?
    } else {
        TriangleMesh::new(positions, lists.triangles)?
    };
    if mesh.degenerate() > 0 {
        log.notice(None, &format!("triangles without an area left out: {}", mesh.degenerate()));
    }
    Ok(mesh)
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
