//! Lights: the contract, and the built-in ones, one file each.
//!
//! A new kind of light is one component with two trait impls, [`Describe`] and [`Light`], and one registration call.
//! Light does not fall off with distance, as in the Whitted model.

mod ambient;
mod cone;
mod directional;
mod disk;
mod point;

pub use ambient::AmbientLight;
pub use cone::{ConeLight, FallOff};
pub use directional::DirectionalLight;
pub use disk::{DiskLight, Emission, PackedDisk};
pub use point::PointLight;

use crate::{color::Rgb, describe::Describe};
use bevy_ecs::{component::Mutable, prelude::*};
use glam::{DAffine3, DVec2, DVec3};

/// A light that shines from somewhere.
pub trait Light: Describe + Component<Mutability = Mutable> {
    /// The form the render reads, world space.
    type Packed: Lamp;

    /// Makes the packed form of the light placed by `world_from_object`.
    fn pack(&self, world_from_object: &DAffine3) -> Self::Packed;
}

/// A light as the render sees it.
pub trait Lamp: Send + Sync + 'static {
    /// The light that arrives at `point` from the part of the lamp that `sample`, in 0..1 × 0..1, picks; none where
    /// that part does not shine. Lamps without area ignore `sample`.
    fn illuminate(&self, point: DVec3, sample: DVec2) -> Option<Illumination>;

    /// The light itself if it is a point light in the world: the render then asks that, without a call for every look. None
    /// for lamps that are sampled.
    fn as_point(&self) -> Option<&PointLight> {
        None
    }

    /// The most that [`Lamp::illuminate`] can give as intensity, at any point and for any sample; none if there is no
    /// limit, or none is known. Rays are cut by an error only where all lamps know theirs.
    fn brightest(&self) -> Option<Rgb> {
        None
    }

    /// How finely the lamp is sampled; none for lamps without area, of which one sample tells all.
    fn sampling(&self) -> Option<Sampling> {
        None
    }
}

/// How finely a lamp with an area is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// The standard error at which sampling ends, in the unit of the intensity.
    pub error: f64,
    /// Samples at most.
    pub most: u32,
}

/// Light arriving at a point, unless something stands in the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Illumination {
    /// From the point to the lamp; any length but zero.
    pub to_light: DVec3,
    /// Where the lamp stands on the ray from the point along `to_light`: what is beyond casts no shadow.
    pub distance: f64,
    /// Linear RGB.
    pub intensity: Rgb,
    /// Whether what stands in the way casts a shadow.
    pub shadows: bool,
}
