//! `DiskLight(position: (0, 5, 0), radius: 1)`: a disk that shines to one side; its shadows are soft.

use super::{Illumination, Lamp, Light, Sampling};
use crate::{choice, color::Rgb, describe::Describe, math};
use bevy_ecs::prelude::*;
use glam::{DAffine3, DVec2, DVec3};

choice! {
    /// How a disk shines.
    pub enum Emission {
        /// Every point of the disk is a point light of the same intensity; their mean arrives.
        #[default]
        Even,
        /// The intensity is a radiance: what arrives falls with the cosine at the disk and the square of the distance.
        Radiant,
    }
}

/// A disk that shines to one side.
///
/// `Even` emission: every point of the disk is a point light of the same intensity, and their mean arrives; a disk
/// without radius is a point light. `Radiant`: the intensity is a radiance, and what arrives falls with the cosine at
/// the disk and the square of the distance; on the axis at distance h a surface that faces the disk receives
/// `π·r² / (r² + h²)` of it.
#[derive(Component, Clone, Debug, PartialEq, Describe)]
pub struct DiskLight {
    /// Centre, object space.
    pub position: DVec3,
    /// The side that shines, object space; by default downward, so that the disk is parallel to Oxz.
    #[describe(nonzero)]
    pub direction: DVec3,
    /// Object units; a placement that scales unevenly makes the disk an ellipse.
    #[describe(not_negative, required)]
    pub radius: f64,
    /// Linear RGB.
    #[describe(not_negative)]
    pub intensity: Rgb,
    /// How the disk shines.
    pub emission: Emission,
    /// Standard error at which sampling ends, as a share of the intensity.
    #[describe(not_negative)]
    pub error: f64,
    /// Samples at most.
    #[describe(within(1.0, 1_048_576.0))]
    pub samples: u32,
    /// Whether things cast shadows in this light.
    pub shadows: bool,
}

impl Default for DiskLight {
    fn default() -> Self {
        Self {
            position: DVec3::ZERO,
            direction: DVec3::NEG_Y,
            radius: 1.0,
            intensity: Rgb::ONE,
            emission: Emission::Even,
            error: 0.01,
            samples: 1024,
            shadows: true,
        }
    }
}

/// A disk light as the render sees it, world space.
#[derive(Clone, Debug)]
pub struct PackedDisk {
    center: DVec3,
    /// From the centre to the edge, in two directions.
    edges: [DVec3; 2],
    /// Unit, the side that shines.
    normal: DVec3,
    /// Of the disk.
    area: f64,
    light: DiskLight,
}

impl Light for DiskLight {
    type Packed = PackedDisk;

    fn pack(&self, world_from_object: &DAffine3) -> PackedDisk {
        let [across, along] = perpendicular(self.direction.normalize());
        let edges = [across, along].map(|edge| world_from_object.transform_vector3(edge * self.radius));
        let normal = world_from_object.matrix3.inverse().transpose() * self.direction;
        PackedDisk {
            center: world_from_object.transform_point3(self.position),
            edges,
            normal: normal.normalize(),
            area: core::f64::consts::PI * edges[0].cross(edges[1]).length(),
            light: self.clone(),
        }
    }
}

/// Two unit vectors perpendicular to a unit vector and each other.
fn perpendicular(normal: DVec3) -> [DVec3; 2] {
    let size = normal.abs();
    let axis = if size.x <= size.y && size.x <= size.z {
        DVec3::X
    } else if size.y <= size.z {
        DVec3::Y
    } else {
        DVec3::Z
    };
    let across = normal.cross(axis).normalize();
    [across, normal.cross(across)]
}

/// Maps the square evenly to the disk, neighbours to neighbours (Shirley, Chiu: A Low Distortion Map Between Disk and
/// Square, 1997).
fn on_disk(sample: DVec2) -> DVec2 {
    let (x, y) = (2.0 * sample.x - 1.0, 2.0 * sample.y - 1.0);
    if x == 0.0 && y == 0.0 {
        return DVec2::ZERO;
    }
    let (radius, degrees) = if x.abs() > y.abs() { (x, 45.0 * (y / x)) } else { (y, 90.0 - 45.0 * (x / y)) };
    let (sin, cos) = math::sin_cos_degrees(degrees);
    DVec2::new(radius * cos, radius * sin)
}

impl Lamp for PackedDisk {
    fn illuminate(&self, point: DVec3, sample: DVec2) -> Option<Illumination> {
        let at = on_disk(sample);
        let to_light = self.center + self.edges[0] * at.x + self.edges[1] * at.y - point;
        let facing = -self.normal.dot(to_light);
        // Beside or behind the disk there is no light from it.
        if facing <= 0.0 || facing.is_nan() {
            return None;
        }
        let share = match self.light.emission {
            Emission::Even => 1.0,
            Emission::Radiant => {
                let square = to_light.length_squared();
                self.area * facing / (square * square.sqrt())
            }
        };
        let intensity = self.light.intensity * share;
        Some(Illumination { to_light, distance: 1.0, intensity, shadows: self.light.shadows })
    }

    fn brightest(&self) -> Option<Rgb> {
        match self.light.emission {
            Emission::Even => Some(self.light.intensity),
            // A sample close to the point grows without limit.
            Emission::Radiant => None,
        }
    }

    fn sampling(&self) -> Option<Sampling> {
        let error = self.light.error * self.light.intensity.max_element();
        (self.area > 0.0).then_some(Sampling { error, most: self.light.samples })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_square_maps_evenly_to_the_disk() {
        let n = 200;
        let (mut inside, mut right) = (0, 0);
        for i in 0..n * n {
            let sample = DVec2::new(f64::from(i % n) + 0.5, f64::from(i / n) + 0.5) / f64::from(n);
            let p = on_disk(sample);
            assert!(p.length() <= 1.0);
            inside += i32::from(p.length_squared() < 0.5);
            right += i32::from(p.x > 0.0);
        }
        let half = n * n / 2;
        assert!((inside - half).abs() < n && (right - half).abs() < n, "{inside} {right}");
    }

    #[test]
    fn shines_to_one_side_and_without_radius_like_a_point() {
        let disk = DiskLight { position: DVec3::Y * 2.0, radius: 0.0, ..DiskLight::default() };
        let packed = disk.pack(&DAffine3::IDENTITY);
        let light = packed.illuminate(DVec3::X, DVec2::new(0.3, 0.9)).expect("below");
        let point = super::super::PointLight { position: DVec3::Y * 2.0, ..super::super::PointLight::default() };
        assert_eq!(Some(light), point.illuminate(DVec3::X, DVec2::ZERO));
        assert!(packed.sampling().is_none());
        assert!(packed.illuminate(DVec3::Y * 3.0, DVec2::ZERO).is_none());
    }
}
