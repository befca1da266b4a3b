//! Textures: the contract for patterns, images and the checkerboard.
//!
//! A texture on a material multiplies its colour. A new pattern is one component with two trait impls, [`Describe`] and
//! [`Texture`], and one registration call.

use crate::{
    asset::Asset,
    color::Rgb,
    describe::{Describe, FieldVisitor, Spec, Value},
    math,
};
use bevy_ecs::{component::Mutable, prelude::*};
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// A texture component.
pub trait Texture: Describe + Component<Mutability = Mutable> {
    /// The form the render reads; nothing if there is nothing to show.
    fn pack(&self) -> Option<Arc<dyn Pattern>>;
}

/// A colour for every point of a surface.
pub trait Pattern: Send + Sync + core::fmt::Debug + 'static {
    /// The colour there, linear RGB.
    fn color(&self, at: &TexturePoint) -> Rgb;

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

/// How far a lookup moves from one ray to the next in the picture, to the right and down: the sides of the parallelogram
/// whose mean colour the ray stands for. Infinite where nothing is known of the neighbours.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// In texture coordinates.
    pub uv: [DVec2; 2],
    /// In world space.
    pub point: [DVec3; 2],
}

/// Pixels of an image, linear light, the first row on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    width: u32,
    height: u32,
    texels: Vec<[f32; 3]>,
}

impl Image {
    /// An image from its rows, the first on top; nothing unless there are `width` times `height` texels, at least one.
    #[must_use]
    pub fn new(width: u32, height: u32, texels: Vec<[f32; 3]>) -> Option<Self> {
        let fits = !texels.is_empty() && texels.len() as u64 == u64::from(width) * u64::from(height);
        fits.then_some(Self { width, height, texels })
    }

    /// Width and height in texels.
    #[must_use]
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// The texel nearest to texture coordinates; the image repeats, v points up.
    #[must_use]
    pub fn nearest(&self, uv: DVec2) -> Rgb {
        let x = wrapped(uv.x, self.width);
        let y = self.height - 1 - wrapped(uv.y, self.height);
        let texel = self.texels[y as usize * self.width as usize + x as usize];
        Rgb::from_array(texel.map(f64::from))
    }
}

/// The texel among `count` that holds a coordinate, which repeats with period 1; 0 for what is not finite.
fn wrapped(coordinate: f64, count: u32) -> u32 {
    // For a coordinate just below zero `x − floor(x)` rounds to 1: the index is limited, not the fraction.
    let fraction = coordinate - math::floor(coordinate);
    ((fraction * f64::from(count)) as u32).min(count - 1)
}

/// An image file as a texture.
#[derive(Component, Clone, Debug, Default)]
pub struct ImageTexture {
    /// The image.
    pub image: Asset<Image>,
}

impl Describe for ImageTexture {
    const TAG: &'static str = "ImageTexture";

    fn describe(&mut self, fields: &mut dyn FieldVisitor) {
        let about = "image file, relative to the scene's";
        fields.field("image", Value::Image(&mut self.image), Spec::any(about).required());
    }
}

impl Texture for ImageTexture {
    fn pack(&self) -> Option<Arc<dyn Pattern>> {
        self.image.data.clone().map(|image| image as Arc<dyn Pattern>)
    }
}

impl Pattern for Image {
    fn color(&self, at: &TexturePoint) -> Rgb {
        self.nearest(at.uv)
    }

    fn brightest(&self) -> Option<Rgb> {
        let most = self.texels.iter().fold([0.0f32; 3], |most, texel| {
            core::array::from_fn(|i| if texel[i] > most[i] { texel[i] } else { most[i] })
        });
        Some(Rgb::from_array(most.map(f64::from)))
    }
}

/// Squares of two colours in turn, in texture coordinates.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct Checker {
    /// Colour of the square at the origin, linear RGB.
    pub even: Rgb,
    /// Colour of its neighbours, linear RGB.
    pub odd: Rgb,
    /// Squares per unit of u and v.
    pub frequency: f64,
}

impl Default for Checker {
    fn default() -> Self {
        Self { even: Rgb::ONE, odd: Rgb::ZERO, frequency: 1.0 }
    }
}

impl Describe for Checker {
    const TAG: &'static str = "Checker";

    fn describe(&mut self, fields: &mut dyn FieldVisitor) {
        fields.field("even", Value::Color(&mut self.even), Spec::not_negative("square at the origin, linear RGB"));
        fields.field("odd", Value::Color(&mut self.odd), Spec::not_negative("its neighbours, linear RGB"));
        fields.field("frequency", Value::Number(&mut self.frequency), Spec::positive("squares per unit of u and v"));
    }
}

impl Texture for Checker {
    fn pack(&self) -> Option<Arc<dyn Pattern>> {
        Some(Arc::new(self.clone()))
    }
}

impl Pattern for Checker {
    fn color(&self, at: &TexturePoint) -> Rgb {
        let square = at.uv * self.frequency;
        // Halves keep the parity without converting a far coordinate to an integer.
        let half = (math::floor(square.x) + math::floor(square.y)) * 0.5;
        if half == math::floor(half) { self.even } else { self.odd }
    }

    fn brightest(&self) -> Option<Rgb> {
        Some(self.even.max(self.odd))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_texel_is_the_one_that_holds_the_point() {
        let image = Image::new(2, 1, vec![[0.0; 3], [1.0; 3]]).expect("an image");
        for (u, value) in [(0.0, 0.0), (0.49, 0.0), (0.5, 1.0), (1.0, 0.0), (-1e-9, 1.0), (-0.25, 1.0), (7.75, 1.0)] {
            assert_eq!(image.nearest(DVec2::new(u, 0.5)).x, value, "{u}");
        }
        for u in [f64::NAN, f64::INFINITY, 1e300, -1e300, -1e-300] {
            assert!(image.nearest(DVec2::splat(u)).is_finite());
        }
        assert!(Image::new(0, 0, vec![]).is_none() && Image::new(2, 2, vec![[0.0; 3]]).is_none());
    }

    #[test]
    fn rows_run_from_top_to_bottom() {
        let image = Image::new(1, 2, vec![[1.0; 3], [0.0; 3]]).expect("an image");
        assert_eq!((image.nearest(DVec2::new(0.5, 0.75)).x, image.nearest(DVec2::new(0.5, 0.25)).x), (1.0, 0.0));
    }

    #[test]
    fn the_checkerboard_alternates_across_the_origin() {
        let at = |u, v| Checker::default().color(&TexturePoint { uv: DVec2::new(u, v), ..TexturePoint::default() }).x;
        assert_eq!(
            [at(0.5, 0.5), at(-0.5, 0.5), at(-0.5, -0.5), at(1.5, 0.5), at(1e9 + 0.5, 0.5)],
            [1.0, 0.0, 1.0, 0.0, 1.0]
        );
    }
}
