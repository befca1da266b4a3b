//! Images that the textures of a scene name, decoded in parallel before the first of them is asked for.

use super::{
    component::Given,
    include::{Content, Layout},
    node::{Form, Node},
    source::Source,
};
use crate::{
    load::assets::Assets,
    registry::{Kind, Registry},
};
use std::path::{Path, PathBuf};

/// Decodes every file that a texture names. What is wrong with one is told when its texture is read.
pub(super) fn decode_images(registry: &Registry, layout: &Layout<'_>, sources: &[Source], assets: &mut Assets) {
    let mut files = vec![];
    for entity in &layout.entities {
        let (Content::Components(components), Some(source)) = (entity.content, sources.get(entity.place.file)) else {
            continue;
        };
        let is_texture = |node: &&Node| {
            let entry = node.tag(&source.text).and_then(|tag| registry.get(tag));
            entry.is_some_and(|entry| entry.kind == Kind::Texture)
        };
        for texture in components.iter().filter(is_texture) {
            match Given::of(texture) {
                Given::Nothing => {}
                Given::Named(fields) => files.extend(fields.iter().filter_map(|field| file(&field.value, source))),
                Given::Value(node) => files.extend(file(node, source)),
            }
        }
    }
    assets.decode_images(files);
}

/// The file that a text names, as seen from the scene.
fn file(node: &Node, source: &Source) -> Option<PathBuf> {
    let written = matches!(node.form, Form::Text).then(|| node.string(&source.text))??;
    Some(source.path.parent().unwrap_or(Path::new("")).join(written))
}
