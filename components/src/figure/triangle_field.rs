//! `TriangleField(count: 30000)`: many separate triangles, ordered on a grid or strewn at random.
//!
//! They fill a cube about the origin, one for each cell of `spacing`; all are equilateral, `size` along an edge, and
//! turned at random. On the grid, with a size below the spacing, they are sparse and even: time grows with the logarithm
//! of their number. Strewn, and far larger than the spacing, no tree can part them.

use super::{Figure, MAX_TRIANGLES};
use crate::{
    choice,
    describe::Describe,
    math,
    random::SplitMix64,
    shape::{MeshError, TriangleMesh},
};
use bevy_ecs::prelude::*;
use glam::{DMat3, DVec3};

choice! {
    /// Where the triangles of a field are.
    pub enum Arrangement {
        /// In the middle of the cells of a cubic grid.
        #[default]
        Grid,
        /// Anywhere in the same cube.
        Random,
    }
}

/// Many separate triangles.
#[derive(Component, Clone, Debug, PartialEq, Describe)]
pub struct TriangleField {
    /// How many triangles.
    #[describe(within(1.0, MAX_TRIANGLES as f64), required)]
    pub count: u32,
    /// Edge of the cell that each has to itself, object units; the cube has the least whole number of cells along an edge.
    #[describe(positive)]
    pub spacing: f64,
    /// Edge of a triangle, object units.
    #[describe(positive)]
    pub size: f64,
    /// On the grid of cells, or anywhere at random.
    pub arrangement: Arrangement,
    /// Chooses their turns and, if strewn, their places.
    pub seed: u32,
}

impl Default for TriangleField {
    fn default() -> Self {
        Self { count: 1000, spacing: 1.0, size: 0.5, arrangement: Arrangement::Grid, seed: 0 }
    }
}

impl Figure for TriangleField {
    fn triangles(&self) -> Result<TriangleMesh, MeshError> {
        if u64::from(self.count) > MAX_TRIANGLES {
            return Err(MeshError::new(format!("its count is more than {MAX_TRIANGLES}: {}", self.count)));
        }
        let along = (1..).find(|n| n * n * n >= u64::from(self.count)).unwrap_or(1);
        let mut random = SplitMix64::new(u64::from(self.seed));
        let mut positions = Vec::with_capacity(3 * self.count as usize);
        for n in 0..u64::from(self.count) {
            let cell = match self.arrangement {
                Arrangement::Grid => [n % along, n / along % along, n / along / along].map(|n| n as f64 + 0.5),
                Arrangement::Random => [(); 3].map(|()| random.unit() * along as f64),
            };
            let center = (DVec3::from_array(cell) - 0.5 * along as f64) * self.spacing;
            let [right, up] = any_plane(&mut random);
            for degrees in [0.0, 120.0, 240.0] {
                let (sin, cos) = math::sin_cos_degrees(degrees);
                // The corners of an equilateral triangle lie an edge over √3 from its centre.
                let corner = center + (right * cos + up * sin) * (self.size / 3f64.sqrt());
                positions.push(corner.as_vec3().to_array());
            }
        }
        TriangleMesh::new(positions, (0..self.count).map(|n| [3 * n, 3 * n + 1, 3 * n + 2]).collect())
    }
}

/// Two perpendicular unit vectors, every plane and turn in it alike.
fn any_plane(random: &mut SplitMix64) -> [DVec3; 2] {
    // Heights of evenly spread points on a sphere are evenly spread (Archimedes).
    let height = 2.0 * random.unit() - 1.0;
    let (sin, cos) = math::sin_cos_degrees(360.0 * random.unit());
    let radius = (1.0 - height * height).sqrt();
    let normal = DVec3::new(radius * cos, radius * sin, height);
    let (right, up) = normal.any_orthonormal_pair();
    let (sin, cos) = math::sin_cos_degrees(360.0 * random.unit());
    let turned = DMat3::from_cols(right, up, normal)
        * DMat3::from_cols(DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z);
    [turned.x_axis, turned.y_axis]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_triangle_is_equilateral_and_in_its_cell() {
        let field = TriangleField { count: 60, spacing: 2.0, size: 0.7, ..TriangleField::default() };
        let mesh = field.triangles().expect("a mesh");
        assert_eq!(mesh.len(), 60);
        for n in 0..60 {
            let [a, b, c] = mesh.corners(n);
            for edge in [a - b, b - c, c - a] {
                assert!((edge.length() - 0.7).abs() < 1e-6);
            }
            // Four cells along an edge.
            let cell = DVec3::new((n % 4) as f64, (n / 4 % 4) as f64, (n / 16) as f64);
            assert!(((a + b + c) / 3.0 - (cell - 1.5) * 2.0).length() < 1e-6, "{n}");
        }
    }

    #[test]
    fn strewn_triangles_stay_in_the_cube_and_follow_their_seed() {
        let field =
            TriangleField { count: 1000, size: 1e-3, arrangement: Arrangement::Random, ..TriangleField::default() };
        let centers = |field: &TriangleField| -> Vec<DVec3> {
            let mesh = field.triangles().expect("a mesh");
            (0..mesh.len()).map(|n| mesh.corners(n).iter().sum::<DVec3>() / 3.0).collect()
        };
        let first = centers(&field);
        assert!(first.iter().all(|center| center.abs().max_element() < 5.0));
        let mean = first.iter().sum::<DVec3>() / 1000.0;
        // Four standard errors of the mean of 1000 numbers spread evenly over 10.
        assert!(mean.abs().max_element() < 4.0 * 10.0 / (12.0f64 * 1000.0).sqrt(), "{mean}");
        assert_eq!(first, centers(&field));
        assert_ne!(first, centers(&TriangleField { seed: 1, ..field }));
    }
}
