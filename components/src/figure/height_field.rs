//! `HeightField(size: (10, 2, 10))`: hills over a rectangle, as triangles.
//!
//! Waves of noise, each half as wide as the one before, are added up; the lowest point is at y = 0, the highest at the
//! height asked for. Texture coordinates: u along x, v against z.

use super::{Figure, MAX_TRIANGLES};
use crate::{
    describe::{Describe, Fault},
    math,
    random::SplitMix64,
    shape::{MeshError, Shading, TriangleMesh},
};
use bevy_ecs::prelude::*;
use glam::DVec3;

/// Hills over a rectangle about the origin.
#[derive(Component, Clone, Debug, PartialEq, Describe)]
#[describe(check = Self::agrees)]
pub struct HeightField {
    /// Width, greatest height and depth, object units.
    #[describe(positive, required)]
    pub size: DVec3,
    /// Squares along either side; each is two triangles.
    #[describe(within(1.0, 2048.0))]
    pub cells: u32,
    /// Hills along either side.
    #[describe(within(0.5, 1024.0))]
    pub hills: f64,
    /// Height of each wave over that of the one twice as wide.
    #[describe(within(0.0, 1.0))]
    pub roughness: f64,
    /// Chooses the hills.
    pub seed: u32,
    /// Whether the triangles are smoothed.
    pub smooth: bool,
}

impl Default for HeightField {
    fn default() -> Self {
        Self { size: DVec3::ONE, cells: 128, hills: 4.0, roughness: 0.4, seed: 0, smooth: true }
    }
}

impl HeightField {
    /// Whether the fields go together.
    fn agrees(&self) -> Result<(), Fault> {
        if 2 * u64::from(self.cells) * u64::from(self.cells) > MAX_TRIANGLES {
            return Err(Fault::new("cells", format!("at most 2048, for {MAX_TRIANGLES} triangles")));
        }
        Ok(())
    }
}

impl HeightField {
    /// Heights in rows along x, from −z to +z, 0 to 1.
    fn heights(&self) -> Vec<f64> {
        let along = self.cells + 1;
        let cell = 1.0 / f64::from(self.cells);
        let mut heights: Vec<f64> = (0..along)
            .flat_map(|z| (0..along).map(move |x| [x, z].map(|n| f64::from(n) * cell * self.hills)))
            .map(|[x, z]| self.waves(x, z))
            .collect();
        let low = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let high = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let range = high - low;
        for height in &mut heights {
            *height = if range > 0.0 { (*height - low) / range } else { 0.0 };
        }
        heights
    }

    /// Waves of noise at a point, in widths of the widest hill.
    fn waves(&self, x: f64, z: f64) -> f64 {
        let (mut sum, mut height, mut scale) = (0.0, 1.0, 1.0);
        let mut wave = 0;
        // Waves narrower than two squares would only alias.
        while height > 1e-3 && (wave == 0 || self.hills * scale * 2.0 <= f64::from(self.cells)) {
            sum += height * self.noise(wave, x * scale, z * scale);
            height *= self.roughness;
            scale *= 2.0;
            wave += 1;
        }
        sum
    }

    /// Noise of one wave, 0 to 1: random values at whole coordinates, joined smoothly.
    fn noise(&self, wave: u32, x: f64, z: f64) -> f64 {
        let (column, row) = (math::floor(x), math::floor(z));
        let value = |right: f64, down: f64| {
            // Below 2^27: there are at most 1024 hills, and no more of a narrower wave.
            let place = (row + down) as u64 * 0x1_0000 + (column + right) as u64;
            let mut random = SplitMix64::new(u64::from(self.seed) << 32 | u64::from(wave) << 27 | place);
            random.unit()
        };
        let (right, down) = (fade(x - column), fade(z - row));
        let blend = |a: f64, b: f64, weight: f64| a + (b - a) * weight;
        let above = blend(value(0.0, 0.0), value(1.0, 0.0), right);
        let below = blend(value(0.0, 1.0), value(1.0, 1.0), right);
        blend(above, below, down)
    }
}

/// From 0 to 1 with slope and curvature zero at both ends (Perlin: Improving Noise, 2002).
fn fade(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

impl Figure for HeightField {
    fn triangles(&self) -> Result<TriangleMesh, MeshError> {
        self.check().map_err(|fault| MeshError::new(format!("its {}: expected {}", fault.field, fault.expected)))?;
        if self.cells == 0 {
            return Err(MeshError::new("it has no cells"));
        }
        let along = self.cells + 1;
        let unit = |n: u32| f64::from(n) / f64::from(self.cells);
        let grid = (0..along).flat_map(|z| (0..along).map(move |x| (x, z)));
        let positions = grid.clone().zip(self.heights()).map(|((x, z), height)| {
            (DVec3::new(unit(x) - 0.5, height, unit(z) - 0.5) * self.size).as_vec3().to_array()
        });
        let uvs = grid.map(|(x, z)| [unit(x) as f32, (1.0 - unit(z)) as f32]).collect();
        let squares = (0..self.cells).flat_map(|z| (0..self.cells).map(move |x| z * along + x));
        // Counter-clockwise seen from above.
        let triangles: Vec<_> =
            squares.flat_map(|a| [[a, a + along, a + along + 1], [a, a + along + 1, a + 1]]).collect();
        let corners = triangles.iter().copied().map(Some).collect();
        TriangleMesh::with_attributes(positions.collect(), triangles, (vec![], vec![]), (uvs, corners), vec![])
    }

    fn shading(&self) -> Shading {
        if self.smooth { Shading::Smooth } else { Shading::Flat }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field() -> HeightField {
        HeightField { size: DVec3::new(4.0, 2.0, 6.0), cells: 32, ..HeightField::default() }
    }

    #[test]
    fn it_fills_its_box_and_looks_upward() {
        let mesh = field().triangles().expect("a mesh");
        assert_eq!(mesh.len(), 2 * 32 * 32);
        let mut bounds = crate::space::Bounds::EMPTY;
        let mut area = 0.0;
        for [a, b, c] in (0..mesh.len()).map(|n| mesh.corners(n)) {
            bounds = bounds.union(crate::space::Bounds::of_points([a, b, c]));
            let up = 0.5 * (b - a).cross(c - a).y;
            assert!(up > 0.0);
            area += up;
        }
        assert_eq!((bounds.min, bounds.max), (DVec3::new(-2.0, 0.0, -3.0), DVec3::new(2.0, 2.0, 3.0)));
        assert!((area - 24.0).abs() < 1e-5, "its shadow at noon is the rectangle: {area}");
    }

    #[test]
    fn another_seed_gives_other_hills_and_more_waves_rougher_ones() {
        assert_eq!(field().heights(), field().heights());
        assert_ne!(field().heights(), HeightField { seed: 1, ..field() }.heights());
        let steps = |roughness| -> f64 {
            let heights = HeightField { roughness, ..field() }.heights();
            heights.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum()
        };
        assert!(steps(0.7) > 1.5 * steps(0.1));
    }
}
