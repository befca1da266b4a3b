//! PNG files.

use super::{Metadata, checked_size, levels8, levels16};
use crate::render::Picture;
use ::png::{BitDepth, ColorType, Decoder, Encoder, SrgbRenderingIntent, Transformations};
use snell_components::color::Encoding;
use std::io::Cursor;

/// Bits of a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Depth {
    Eight,
    Sixteen,
}

/// The bytes of a PNG file; metadata becomes `iTXt` chunks.
pub(super) fn encode(picture: &Picture, depth: Depth, metadata: &Metadata) -> Result<Vec<u8>, String> {
    let write = || {
        let mut file = vec![];
        let mut encoder = Encoder::new(&mut file, picture.width, picture.height);
        encoder.set_color(ColorType::Rgb);
        let encoding = metadata.encoding();
        if encoding == Encoding::Srgb {
            encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
        }
        for (key, value) in metadata.iter() {
            encoder.add_itxt_chunk(key.into(), value.into())?;
        }
        let levels = match depth {
            Depth::Eight => {
                encoder.set_depth(BitDepth::Eight);
                levels8(picture, encoding).into_flattened()
            }
            Depth::Sixteen => {
                encoder.set_depth(BitDepth::Sixteen);
                levels16(picture, encoding).into_iter().flatten().flat_map(u16::to_be_bytes).collect()
            }
        };
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&levels)?;
        writer.finish()?;
        Ok(file)
    };
    write().map_err(|why: ::png::EncodingError| why.to_string())
}

/// The picture and metadata of a PNG file.
pub(super) fn decode(file: &[u8]) -> Result<(Picture, Metadata), String> {
    let shown = |why: ::png::DecodingError| format!("is not a sound PNG file: {why}");
    let mut decoder = Decoder::new(Cursor::new(file));
    // Palettes become colours, depths below 8 become 8.
    decoder.set_transformations(Transformations::EXPAND);
    let header = decoder.read_header_info().map_err(shown)?;
    let (width, height) = checked_size(header.width.into(), header.height.into())?;
    let mut reader = decoder.read_info().map_err(shown)?;
    let mut levels = vec![0; reader.output_buffer_size().ok_or("is too large to be read")?];
    let frame = reader.next_frame(&mut levels).map_err(shown)?;
    levels.truncate(frame.buffer_size());
    // Text may also follow the pixels.
    reader.finish().map_err(shown)?;

    let channels: Vec<f64> = match frame.bit_depth {
        BitDepth::Sixteen => {
            let value = |bytes: &[u8; 2]| f64::from(u16::from_be_bytes(*bytes)) / f64::from(u16::MAX);
            levels.as_chunks().0.iter().map(value).collect()
        }
        _ => levels.iter().map(|byte| f64::from(*byte) / f64::from(u8::MAX)).collect(),
    };
    let info = reader.info();
    let mut metadata = Metadata::default();
    for chunk in &info.uncompressed_latin1_text {
        metadata.insert(&chunk.keyword, &chunk.text);
    }
    for chunk in &info.utf8_text {
        // Compressed text that cannot be unpacked is no part of the picture.
        if let Ok(text) = chunk.get_text() {
            metadata.insert(&chunk.keyword, text);
        }
    }
    let encoding = metadata.encoding();
    let linear = |channel: f64| encoding.decode(channel) as f32;
    let pixels = match frame.color_type {
        ColorType::Grayscale | ColorType::Indexed => channels.iter().map(|grey| [linear(*grey); 3]).collect(),
        ColorType::GrayscaleAlpha => channels.as_chunks().0.iter().map(|[grey, _]| [linear(*grey); 3]).collect(),
        ColorType::Rgb => channels.as_chunks().0.iter().map(|rgb: &[f64; 3]| rgb.map(linear)).collect(),
        ColorType::Rgba => channels.as_chunks().0.iter().map(|[r, g, b, _]| [*r, *g, *b].map(linear)).collect(),
    };

    Ok((Picture { width, height, pixels }, metadata))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grey_and_palette_files_are_read() {
        let mut file = vec![];
        let mut encoder = Encoder::new(&mut file, 8, 1);
        encoder.set_color(ColorType::Indexed);
        encoder.set_depth(BitDepth::One);
        encoder.set_palette(vec![0, 0, 0, 255, 0, 255]);
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(&[0b0100_0000]).expect("data");
        writer.finish().expect("an end");
        let (picture, _) = decode(&file).expect("a picture");
        assert_eq!(picture.pixels[..3], [[0.0; 3], [1.0, 0.0, 1.0], [0.0; 3]]);

        let mut file = vec![];
        let mut encoder = Encoder::new(&mut file, 2, 1);
        encoder.set_color(ColorType::GrayscaleAlpha);
        let mut writer = encoder.write_header().expect("a header");
        writer.write_image_data(&[255, 0, 0, 255]).expect("data");
        writer.finish().expect("an end");
        assert_eq!(decode(&file).expect("a picture").0.pixels, [[1.0; 3], [0.0; 3]]);
    }

    #[test]
    fn a_claim_of_more_pixels_than_memory_is_refused() {
        let mut file = vec![];
        let writer = Encoder::new(&mut file, 1 << 20, 1 << 20).write_header().expect("a header");
        drop(writer);
        let error = decode(&file).expect_err("too large");
        assert!(error.contains("1048576x1048576 pixels are too many"), "{error}");
    }
}
