//! OpenEXR files.

use super::{Metadata, checked_size, key};
use crate::render::Picture;
use ::exr::{
    math::Vec2,
    meta::{
        MetaData,
        attribute::Text,
        header::{Header, LayerAttributes},
    },
    prelude::{Encoding, Image, Layer, ReadChannels, ReadLayers, SpecificChannels, WritableImage, read},
};
use std::io::Cursor;

/// The bytes of an OpenEXR file of one layer of 32-bit floats.
///
/// The software is told in the attribute `software`, all other metadata in the attribute `comments`, a line
/// `key: value` each: attributes of our own would be written in another order every time.
pub(super) fn encode(picture: &Picture, metadata: &Metadata) -> Result<Vec<u8>, String> {
    let text = |text: &str| Text::from_slice_unchecked(text.as_bytes());
    let comments: String = metadata
        .iter()
        .filter(|(key, _)| *key != key::SOFTWARE)
        .map(|(key, value)| format!("{key}: {value}\n"))
        .collect();
    let attributes = LayerAttributes {
        software_name: metadata.get(key::SOFTWARE).map(text),
        comments: Some(text(&comments)),
        ..LayerAttributes::default()
    };
    let (width, height) = (picture.width as usize, picture.height as usize);
    let channels =
        SpecificChannels::rgb(|Vec2(x, y): Vec2<usize>| <(f32, f32, f32)>::from(picture.pixels[y * width + x]));
    let image = Image::from_layer(Layer::new((width, height), attributes, Encoding::SMALL_LOSSLESS, channels));
    let mut file = vec![];
    image.write().non_parallel().to_buffered(Cursor::new(&mut file)).map_err(|why| why.to_string())?;
    Ok(file)
}

/// The picture and metadata of an OpenEXR file: its first layer with red, green and blue.
pub(super) fn decode(file: &[u8]) -> Result<(Picture, Metadata), String> {
    let shown = |why: ::exr::error::Error| format!("is not a sound OpenEXR file with red, green and blue: {why}");
    let headers = MetaData::read_from_buffered(Cursor::new(file), false).map_err(shown)?.headers;
    for Header { layer_size: Vec2(width, height), .. } in &headers {
        checked_size(*width as u64, *height as u64)?;
    }
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |Vec2(width, height), _| (width, vec![[0.0; 3]; width * height]),
            |(width, pixels), Vec2(x, y), (r, g, b)| pixels[y * *width + x] = [r, g, b],
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(file))
        .map_err(shown)?;

    let Layer { size: Vec2(width, height), attributes, channel_data, .. } = image.layer_data;
    let (width, height) = checked_size(width as u64, height as u64)?;
    let text = |text: Text| String::from_utf8_lossy(text.as_slice()).into_owned();
    let mut metadata = Metadata::default();
    if let Some(software) = attributes.software_name {
        metadata.insert(key::SOFTWARE, text(software));
    }
    for line in attributes.comments.map(text).unwrap_or_default().lines() {
        if let Some((key, value)) = line.split_once(": ") {
            metadata.insert(key, value);
        }
    }
    Ok((Picture { width, height, pixels: channel_data.pixels.1 }, metadata))
}
