//! `ImageTexture(image: "wood.png", filter: Anisotropic)`: an image file on a surface.

use super::{Filter, Image, Pattern, Sampler, Texture, Wrap};
use crate::{asset::Asset, color::Encoding, describe::Describe};
use bevy_ecs::prelude::*;
use std::sync::Arc;

/// An image file as a texture.
#[derive(Component, Clone, Debug, Default, Describe)]
pub struct ImageTexture {
    /// Image file, relative to the scene's.
    #[describe(required)]
    pub image: Asset<Image>,
    /// What it shows beyond its edges.
    pub wrap: Wrap,
    /// How its texels are put together.
    pub filter: Filter,
}

impl From<Image> for ImageTexture {
    fn from(image: Image) -> Self {
        Self { image: Asset::from_data(image), ..Self::default() }
    }
}

impl Texture for ImageTexture {
    fn pack(&self) -> Option<Arc<dyn Pattern>> {
        self.pack_as(Encoding::Srgb)
    }

    fn pack_as(&self, encoding: Encoding) -> Option<Arc<dyn Pattern>> {
        let image = self.image.data.clone()?;
        Some(Arc::new(Sampler::new(image, encoding, self.wrap, self.filter)))
    }
}
