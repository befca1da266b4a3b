//! `ImageTexture(image: "wood.png", filter: Anisotropic)`: an image file on a surface.

use super::{Filter, Image, Pattern, Sampler, Texture, Wrap};
use crate::{
    asset::Asset,
    color::Encoding,
    describe::{Describe, FieldVisitor, Spec, Value},
};
use bevy_ecs::prelude::*;
use std::sync::Arc;

/// An image file as a texture.
#[derive(Component, Clone, Debug, Default)]
pub struct ImageTexture {
    /// The image.
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

impl Describe for ImageTexture {
    const TAG: &'static str = "ImageTexture";

    fn describe(&mut self, fields: &mut dyn FieldVisitor) {
        let about = "image file, relative to the scene's";
        fields.field("image", Value::Image(&mut self.image), Spec::any(about).required());
        fields.field("wrap", Value::Choice(&mut self.wrap), Spec::any("what the image shows beyond its edges"));
        fields.field("filter", Value::Choice(&mut self.filter), Spec::any("how its texels are put together"));
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
