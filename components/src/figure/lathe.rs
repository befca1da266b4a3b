//! `Lathe(profile: [(0, 0), (1, 0), (0, 2)])`: a profile turned about Oy, as triangles.
//!
//! Seen with the axis on the left, the profile runs counter-clockwise around the body: from the lowest point up the
//! outside. One that begins and ends on the axis, or ends where it began, makes a closed body. Texture coordinates: u
//! runs once around Oy, 0 at −x going through +z, as on a sphere; v along the profile, by its length.

use super::{Figure, MAX_TRIANGLES};
use crate::{
    describe::{Describe, Fault},
    math,
    shape::{MeshError, Shading, TriangleMesh},
};
use bevy_ecs::prelude::*;
use glam::{DVec2, DVec3};

/// A profile turned about Oy.
#[derive(Component, Clone, Debug, PartialEq, Describe)]
#[describe(check = Self::agrees)]
pub struct Lathe {
    /// Points (distance from Oy, height), up the outside; object units.
    #[describe(required)]
    pub profile: Vec<DVec2>,
    /// Steps around Oy.
    #[describe(within(3.0, 65_536.0))]
    pub segments: u32,
    /// Which edges are smoothed: as modelled, those around the axis; smooth, those along the profile too.
    pub shading: Shading,
}

impl Default for Lathe {
    fn default() -> Self {
        Self { profile: vec![], segments: 48, shading: Shading::AsModelled }
    }
}

impl Lathe {
    /// Whether the fields go together.
    fn agrees(&self) -> Result<(), Fault> {
        let fault = |expected: String| Err(Fault::new("profile", expected));
        if self.profile.len() < 2 {
            return fault(format!("two points or more, found {}", self.profile.len()));
        }
        if let Some(n) = self.profile.iter().position(|point| point.x < 0.0) {
            return fault(format!("distances of at least 0, found {} at point {}", self.profile[n].x, n + 1));
        }
        if let Some(n) = self.profile.windows(2).position(|pair| pair[0] == pair[1]) {
            return fault(format!("points that differ from the one before, but point {} does not", n + 2));
        }
        if self.profile.windows(2).all(|pair| pair[0].x == 0.0 && pair[1].x == 0.0) {
            return fault("a point off the axis".into());
        }
        let triangles = 2 * u64::from(self.segments) * (self.profile.len() as u64 - 1);
        if triangles > MAX_TRIANGLES {
            let most = MAX_TRIANGLES / 2 / (self.profile.len() as u64 - 1);
            return Err(Fault::new(
                "segments",
                format!("at most {most} with this profile, for {MAX_TRIANGLES} triangles"),
            ));
        }
        Ok(())
    }
}

impl Lathe {
    /// Whether the profile ends where it began, off the axis.
    fn is_ring(&self) -> bool {
        self.profile.len() > 2 && self.profile.first() == self.profile.last() && self.profile[0].x > 0.0
    }
}

impl Figure for Lathe {
    fn triangles(&self) -> Result<TriangleMesh, MeshError> {
        self.check().map_err(|fault| MeshError::new(format!("its {}: expected {}", fault.field, fault.expected)))?;
        let (mut triangles, mut normals, mut uvs) = (vec![], vec![], vec![]);
        let rows = Rows::new(self);
        for n in 0..self.profile.len() - 1 {
            for step in 0..self.segments {
                // Counter-clockwise seen from outside: along the profile is up, a further step goes left.
                let [a, b, c, d] = [(n, step), (n, step + 1), (n + 1, step + 1), (n + 1, step)];
                for corners in [[a, b, c], [a, c, d]] {
                    // At a pole one of the two has no area.
                    let vertices = corners.map(|(row, step)| rows.vertex(row, step));
                    if vertices[0] == vertices[1] || vertices[1] == vertices[2] || vertices[2] == vertices[0] {
                        continue;
                    }
                    triangles.push(vertices);
                    let half_steps = corners.map(|(row, column)| rows.half_step(row, column, step));
                    normals.push((self.shading != Shading::Flat).then(|| {
                        let row = |k: usize| if self.shading == Shading::Smooth { corners[k].0 } else { n };
                        [0, 1, 2].map(|k| (row(k) * rows.around() + half_steps[k] % rows.around()) as u32)
                    }));
                    uvs.push(Some([0, 1, 2].map(|k| (corners[k].0 * (rows.around() + 1) + half_steps[k]) as u32)));
                }
            }
        }
        let normals = (rows.normals(), normals);
        TriangleMesh::with_attributes(rows.positions(), triangles, normals, (rows.uvs(), uvs), vec![])
    }
}

/// The points of a lathe: a row for every point of the profile, a column for every half step around.
struct Rows<'a> {
    lathe: &'a Lathe,
    /// Sine and cosine of every half step.
    turns: Vec<(f64, f64)>,
    /// Where the vertices of each row begin.
    first: Vec<u32>,
}

impl<'a> Rows<'a> {
    fn new(lathe: &'a Lathe) -> Self {
        let half_steps = 2 * lathe.segments;
        let turn = |half_step: u32| math::sin_cos_degrees(360.0 * f64::from(half_step) / f64::from(half_steps));
        let len = |point: &DVec2| if point.x == 0.0 { 1 } else { lathe.segments };
        let mut first: Vec<u32> = vec![];
        let mut next = 0;
        for point in &lathe.profile {
            first.push(next);
            next += len(point);
        }
        if lathe.is_ring()
            && let Some(last) = first.last_mut()
        {
            *last = 0;
        }
        Self { lathe, turns: (0..half_steps).map(turn).collect(), first }
    }

    /// Half steps in a turn.
    fn around(&self) -> usize {
        self.turns.len()
    }

    fn vertex(&self, row: usize, step: u32) -> u32 {
        let on_axis = self.lathe.profile[row].x == 0.0;
        self.first[row] + if on_axis { 0 } else { step % self.lathe.segments }
    }

    /// The column of a corner of the quad between `step` and the next: on the axis the one in the middle.
    fn half_step(&self, row: usize, column: u32, step: u32) -> usize {
        if self.lathe.profile[row].x == 0.0 { 2 * step as usize + 1 } else { 2 * column as usize }
    }

    fn positions(&self) -> Vec<[f32; 3]> {
        let mut positions = vec![];
        let rows = self.lathe.profile.len() - usize::from(self.lathe.is_ring());
        for point in &self.lathe.profile[..rows] {
            let columns = if point.x == 0.0 { 1 } else { self.around() };
            let around = self.turns[..columns].iter().step_by(2);
            positions.extend(around.map(|turn| around_axis(*point, *turn).as_vec3().to_array()));
        }
        positions
    }

    /// Unit normals of every segment of the profile, or of every point of it where all is smoothed.
    fn normals(&self) -> Vec<[f32; 3]> {
        let profile = &self.lathe.profile;
        let of_segment = |n: usize| {
            let along = profile[n + 1] - profile[n];
            DVec2::new(along.y, -along.x).normalize_or_zero()
        };
        let last = profile.len() - 1;
        let of_point = |n: usize| match profile[n].x {
            // By symmetry along the axis.
            0.0 => DVec2::Y * of_segment(n.min(last - 1)).y.signum(),
            _ if self.lathe.is_ring() => of_segment((n + last - 1) % last) + of_segment(n % last),
            _ if n == 0 => of_segment(0),
            _ if n == last => of_segment(last - 1),
            _ => of_segment(n - 1) + of_segment(n),
        };
        let rows: Vec<DVec2> = match self.lathe.shading {
            Shading::Flat => vec![],
            Shading::AsModelled => (0..last).map(of_segment).collect(),
            Shading::Smooth => (0..=last).map(of_point).collect(),
        };
        let all = |normal| self.turns.iter().map(move |turn| around_axis(normal, *turn));
        rows.into_iter().flat_map(all).map(|normal| normal.normalize_or_zero().as_vec3().to_array()).collect()
    }

    fn uvs(&self) -> Vec<[f32; 2]> {
        let lengths = self.lathe.profile.windows(2).map(|pair| pair[0].distance(pair[1]));
        let mut along = vec![0.0];
        for length in lengths {
            along.push(along[along.len() - 1] + length);
        }
        let whole = along[along.len() - 1];
        let row = |at: f64| {
            (0..=self.around()).map(move |column| {
                let u = column as f64 / self.around() as f64;
                [u as f32, (at / whole) as f32]
            })
        };
        along.into_iter().flat_map(row).collect()
    }
}

/// A point of the profile's plane, turned about Oy from −x through +z.
fn around_axis(point: DVec2, (sin, cos): (f64, f64)) -> DVec3 {
    DVec3::new(-point.x * cos, point.y, point.x * sin)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lathe(profile: &[(f64, f64)], segments: u32) -> Lathe {
        Lathe { profile: profile.iter().map(|&point| point.into()).collect(), segments, ..Lathe::default() }
    }

    /// Volume by the divergence theorem: positive only if closed faces look outward.
    fn volume(mesh: &TriangleMesh) -> f64 {
        (0..mesh.len()).map(|i| mesh.corners(i)).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
    }

    #[test]
    fn a_cone_has_its_triangles_and_looks_outward() {
        let n = 80;
        let mesh = lathe(&[(0.0, 0.0), (1.0, 0.0), (0.0, 2.0)], n).triangles().expect("a mesh");
        assert_eq!((mesh.len(), mesh.degenerate()), (2 * n as usize, 0));
        // The pyramid over a regular polygon.
        let (sin, _) = math::sin_cos_degrees(360.0 / f64::from(n));
        let expected = 0.5 * f64::from(n) * sin * 2.0 / 3.0;
        assert!((volume(&mesh) - expected).abs() < 1e-6, "{}", volume(&mesh));
    }

    #[test]
    fn every_edge_of_a_closed_body_has_two_triangles() {
        let ring = [(2.0, 0.0), (3.0, 1.0), (2.0, 2.0), (1.0, 1.0), (2.0, 0.0)];
        for (profile, faces) in [(&ring[..], 8), (&[(0.0, -1.0), (1.0, 0.0), (0.5, 1.0), (0.0, 1.0)][..], 4)] {
            let mesh = lathe(profile, 9).triangles().expect("a mesh");
            assert_eq!(mesh.len(), 9 * faces);
            let bits = |p: DVec3| p.to_array().map(f64::to_bits);
            let mut edges = std::collections::BTreeMap::new();
            for corners in (0..mesh.len()).map(|i| mesh.corners(i).map(bits)) {
                for k in 0..3 {
                    let (from, to) = (corners[k], corners[(k + 1) % 3]);
                    *edges.entry((from.min(to), from.max(to))).or_insert(0) += if from < to { 1 } else { -1 };
                }
            }
            assert!(edges.values().all(|sum| *sum == 0), "an edge without its counterpart");
            assert!(volume(&mesh) > 0.0);
        }
    }

    #[test]
    fn faults_name_the_point() {
        let expected = |lathe: Lathe| lathe.check().expect_err("a fault").expected;
        assert_eq!(expected(lathe(&[(1.0, 0.0)], 8)), "two points or more, found 1");
        assert_eq!(expected(lathe(&[(1.0, 0.0), (-1.0, 1.0)], 8)), "distances of at least 0, found -1 at point 2");
        assert_eq!(
            expected(lathe(&[(1.0, 0.0), (1.0, 0.0)], 8)),
            "points that differ from the one before, but point 2 does not"
        );
        assert_eq!(expected(lathe(&[(0.0, 0.0), (0.0, 1.0)], 8)), "a point off the axis");
        let many = Lathe { segments: 65_536, ..lathe(&[(1.0, 0.0); 0], 8) };
        let profile = (0..1000).map(|n| DVec2::new(1.0, f64::from(n))).collect();
        assert_eq!(Lathe { profile, ..many }.check().expect_err("a fault").field, "segments");
    }
}
