//! Image files as textures: PNG, JPEG, BMP, TGA and EXR.
//!
//! Integer formats are taken as sRGB and brought to linear light; floating-point formats hold linear light already.
//! Grey images have equal channels. Alpha is left out: a texture colours a surface, it does not cut holes into it.
//! Gamma and colour profiles, and the orientation that a camera notes, are left out, too: texture coordinates count
//! from the corners of the image as it is stored.

use super::fault::Fault;
use image::{DynamicImage, ImageReader, Limits};
use snell_components::{color, texture::Image};
use std::fs::File;
use std::io::BufReader;
use std::panic::catch_unwind;
use std::path::Path;

/// Greatest width and height.
const MOST_PIXELS: u32 = 16_384;

/// Greatest size in memory, of the image as decoded and of its texels.
const MOST_BYTES: u64 = 1 << 30;

/// Reads an image, whose format is known from its contents or, for TGA, from its name.
///
/// # Errors
/// A file that cannot be read, is no image of a known format, is damaged, too large, or has texels that are not finite.
pub fn read(path: &Path) -> Result<Image, Fault> {
    let fault = |message: String| Fault::of_file(path, message);
    let is_file = std::fs::metadata(path).map_err(|error| fault(format!("cannot be opened: {error}")))?.is_file();
    // Before opening: to open a pipe would wait for someone to write to it.
    if !is_file {
        return Err(fault("is not a file".into()));
    }
    let reader = ImageReader::open(path)
        .and_then(ImageReader::with_guessed_format)
        .map_err(|error| fault(format!("cannot be read: {error}")))?;
    let decoded = match catch_unwind(|| decode(reader)) {
        Ok(decoded) => decoded.map_err(|error| fault(format!("cannot be decoded: {error}")))?,
        Err(_) => return Err(fault("cannot be decoded: the decoder crashed".into())),
    };
    let (width, height) = (decoded.width(), decoded.height());
    if u64::from(width) * u64::from(height) * size_of::<[f32; 3]>() as u64 > MOST_BYTES {
        return Err(fault(format!("is too large: {width} by {height} pixels")));
    }
    let texels = linear(decoded);
    let wrong = texels.iter().filter(|texel| !texel.iter().all(|x| x.is_finite())).count();
    if wrong > 0 {
        return Err(fault(format!("{wrong} of {} texels are not finite", texels.len())));
    }
    Image::new(width, height, texels).ok_or_else(|| fault("has no pixels".into()))
}

fn decode(mut reader: ImageReader<BufReader<File>>) -> image::ImageResult<DynamicImage> {
    let mut limits = Limits::no_limits();
    limits.max_image_width = Some(MOST_PIXELS);
    limits.max_image_height = Some(MOST_PIXELS);
    limits.max_alloc = Some(MOST_BYTES);
    reader.limits(limits);
    reader.decode()
}

/// The texels in linear light.
fn linear(decoded: DynamicImage) -> Vec<[f32; 3]> {
    match decoded {
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => decoded.into_rgb32f().pixels().map(|p| p.0).collect(),
        DynamicImage::ImageLuma8(_)
        | DynamicImage::ImageLumaA8(_)
        | DynamicImage::ImageRgb8(_)
        | DynamicImage::ImageRgba8(_) => {
            let table = decoding(u8::MAX.into());
            decoded.into_rgb8().pixels().map(|p| p.0.map(|code| table[usize::from(code)])).collect()
        }
        _ => {
            let table = decoding(u16::MAX);
            decoded.into_rgb16().pixels().map(|p| p.0.map(|code| table[usize::from(code)])).collect()
        }
    }
}

/// Linear light of every sRGB code from 0 to `most`.
fn decoding(most: u16) -> Vec<f32> {
    let linear = |code: u16| color::linear_from_srgb(f64::from(code) / f64::from(most)) as f32;
    (0..=most).map(linear).collect()
}
