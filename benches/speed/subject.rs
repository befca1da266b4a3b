//! Meshes to measure with.

use snell::{
    Renderer, Snapshot,
    components::math,
    prelude::{Arrangement, DAffine3, DVec3, Figure, Mesh, Name, Primitive, TriangleField, TriangleMesh},
};
use std::{
    fs,
    io::{self, Error, ErrorKind},
    path::{Path, PathBuf},
    process::Command,
    sync::Arc,
};

/// An indexed triangle mesh with a name.
pub(crate) struct Subject {
    pub(crate) name: String,
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
            name: path.file_stem().unwrap_or_default().to_string_lossy().into(),
            positions: positions.as_chunks().0.iter().map(|p| p.map(f32::from_le_bytes)).collect(),
            triangles: corners.as_chunks().0.iter().map(|c| c.map(u32::from_le_bytes)).collect(),
        })
    }

    /// The mesh without its tree.
    pub(crate) fn mesh(&self) -> Mesh {
        Mesh::new(TriangleMesh::new(self.positions.clone(), self.triangles.clone()).expect("a sound mesh"))
    }

    /// The corners of the box around all vertices.
    pub(crate) fn bounds(&self) -> (DVec3, DVec3) {
        let points = self.positions.iter().map(|p| DVec3::from_array(p.map(f64::from)));
        points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), p| (min.min(p), max.max(p)))
    }
}

/// A snapshot of a mesh alone.
pub(crate) fn snapshot(mesh: Mesh) -> Arc<Snapshot> {
    let mut renderer = Renderer::new();
    renderer.world.spawn((Name::new("camera"), snell::prelude::Camera::default()));
    renderer.world.spawn((Name::new("mesh"), mesh));
    renderer.snapshot().expect("a scene that can be drawn")
}

/// Builds the tree of a mesh that has none yet.
pub(crate) fn build(mesh: &Mesh) {
    mesh.pack(&DAffine3::IDENTITY).expect("a mesh with a surface");
}

/// The scanned models that are there, packed ones where `xz` is there; says which are not.
pub(crate) fn scanned() -> Vec<Subject> {
    let data = std::env::var_os("SNELL_DATA").map_or("../shared/data".into(), PathBuf::from);
    let bunny = data.join("meshes/stanford_bunny/stanford-bunny.obj");
    let dragon = data.join("meshes/stanford_dragon/dragon_vrip.obj.xz");
    let texts = [("bunny", fs::read(&bunny).ok()), ("dragon", unpacked(&dragon))];
    let mut found = vec![];
    for (name, text) in texts {
        match text {
            Some(text) => found.push(Subject { name: name.into(), ..read_obj(&String::from_utf8_lossy(&text)) }),
            None => println!("skipped: {name} (not in {}, or no `xz`)", data.display()),
        }
    }
    found
}

fn unpacked(file: &Path) -> Option<Vec<u8>> {
    let output = Command::new("xz").arg("-dc").arg(file).output().ok()?;
    output.status.success().then_some(output.stdout)
}

/// Vertices and triangles; all that the scanned models hold.
fn read_obj(text: &str) -> Subject {
    let mut subject = Subject { name: String::new(), positions: vec![], triangles: vec![] };
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => subject.positions.push([(); 3].map(|()| number(&mut words))),
            Some("f") => subject.triangles.push([(); 3].map(|()| number::<u32>(&mut words) - 1)),
            _ => {}
        }
    }
    subject
}

fn number<'a, T: std::str::FromStr>(words: &mut impl Iterator<Item = &'a str>) -> T {
    words.next().and_then(|word| word.parse().ok()).expect("a number")
}

/// Triangles on a grid, their edges half the spacing.
pub(crate) fn sparse(count: u32) -> Subject {
    field("sparse", TriangleField { count, size: 0.5, ..TriangleField::default() })
}

/// Triangles at random, their edges eight times the space each has.
pub(crate) fn chaotic(count: u32) -> Subject {
    field("chaotic", TriangleField { count, size: 8.0, arrangement: Arrangement::Random, ..TriangleField::default() })
}

fn field(name: &str, field: TriangleField) -> Subject {
    let mesh = field.triangles().expect("a sound mesh");
    let corners = (0..mesh.len()).flat_map(|triangle| mesh.corners(triangle));
    Subject {
        name: format!("{name}, {}", field.count),
        positions: corners.map(|corner| corner.as_vec3().to_array()).collect(),
        triangles: (0..field.count).map(|n| [3 * n, 3 * n + 1, 3 * n + 2]).collect(),
    }
}

/// Waves over a square, of `2 · edge²` triangles.
pub(crate) fn waves(edge: u32) -> Subject {
    let wave = |x: f64| math::sin_cos_degrees(x * 1080.0).0;
    let side = edge + 1;
    let at = |i: u32| [i % side, i / side].map(|k| f64::from(k) / f64::from(edge));
    let point = |[x, z]: [f64; 2]| [x, 0.04 * (wave(x) + wave(z + 0.3 * x)), z].map(|x| x as f32);
    let corner = (0..edge * edge).map(|i| (i / edge) * side + i % edge);
    Subject {
        name: format!("waves, {}", 2 * edge * edge),
        positions: (0..side * side).map(|i| point(at(i))).collect(),
        triangles: corner.flat_map(|a| [[a, a + side, a + 1], [a + 1, a + side, a + side + 1]]).collect(),
    }
}
