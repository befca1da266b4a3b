//! Textures: the contract for patterns, images and the checkerboard.
//!
//! A texture on a material multiplies its colour. A new pattern is one component with two trait impls, [`Describe`] and
//! [`Texture`], and one registration call.

mod checker;
mod footprint;
mod image;
mod image_texture;
mod pyramid;
mod sampler;
mod wrap;

pub use checker::Checker;
pub use footprint::{Axes, Footprint};
pub use image::Image;
pub use image_texture::ImageTexture;
pub use sampler::{Filter, Sampler};
pub use wrap::Wrap;

use crate::{
    color::{Encoding, Rgb},
    describe::Describe,
    packet::{Mask, Vectors, each, set_vector, vector_of},
    surfaces::Surfaces,
};
use bevy_ecs::{component::Mutable, prelude::*};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// A texture component.
pub trait Texture: Describe + Component<Mutability = Mutable> {
    /// The form the render reads; nothing if there is nothing to show.
    fn pack(&self) -> Option<Arc<dyn Pattern>>;

    /// The same, where the numbers of files mean what `encoding` says; of interest to textures that come from files.
    fn pack_as(&self, _encoding: Encoding) -> Option<Arc<dyn Pattern>> {
        self.pack()
    }
}

/// A colour for every point of a surface.
pub trait Pattern: Send + Sync + core::fmt::Debug + 'static {
    /// The colour there, linear RGB.
    fn color(&self, at: &TexturePoint) -> Rgb;

    /// [`Pattern::color`] for some rays of a packet, where no footprints are worked out; what stands for other rays stays as
    /// it is. By default one after the other; worth writing for patterns that tell several at once faster, with the very same bits.
    fn color_packet(&self, surfaces: &Surfaces, rays: Mask, colors: &mut Vectors) {
        for i in each(rays) {
            let uv = DVec2::new(surfaces.uv[0][i], surfaces.uv[1][i]);
            let point = vector_of(&surfaces.point, i);
            set_vector(colors, i, self.color(&TexturePoint { uv, point, footprint: Footprint::default() }));
        }
    }

    /// Whether the colour depends on [`TexturePoint::footprint`]; where no texture of a scene does, none is worked out.
    fn filters(&self) -> bool {
        false
    }

    /// The most of each channel that [`Pattern::color`] can give; none if that is not known. Rays are cut by an error
    /// only where all patterns know theirs.
    fn brightest(&self) -> Option<Rgb> {
        None
    }
}

/// By how much a weighted mean may exceed the largest of what it is taken of, by rounding.
const ROUNDED: f64 = 1.0 + 16.0 * f64::EPSILON;

/// Where on a surface a texture is looked up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TexturePoint {
    /// The shape's texture coordinates.
    pub uv: DVec2,
    /// The point, world space.
    pub point: DVec3,
    /// How much of the surface is seen as one; zero for a texture that does not filter.
    pub footprint: Footprint,
}
