//! Image files as textures: PNG, JPEG, BMP, TGA and EXR.
//!
//! The numbers of integer formats are kept; what they mean is a setting of the scene. Floating-point formats hold
//! linear light.
//! Grey images have equal channels. Alpha is left out: a texture colours a surface, it does not cut holes into it.
//! Gamma and colour profiles, and the orientation that a camera notes, are left out, too: texture coordinates count
//! from the corners of the image as it is stored.

use super::fault::Fault;
use super::file;
use image::{DynamicImage, ImageReader, Limits};
use snell_components::texture::Image;
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
    file::check(path)?;
    let reader = ImageReader::open(path)
        .and_then(ImageReader::with_guessed_format)
        .map_err(|error| fault(format!("cannot be read: {error}")))?;
    if reader.format().is_none() {
        return Err(fault("is no PNG, JPEG, BMP, TGA or EXR image".into()));
    }
    let decoded = match catch_unwind(|| decode(reader)) {
        Ok(decoded) => decoded.map_err(|error| fault(format!("cannot be decoded: {error}")))?,
        Err(_) => return Err(fault("cannot be decoded: the decoder crashed".into())),
    };
    let (width, height) = (decoded.width(), decoded.height());
    if u64::from(width) * u64::from(height) * size_of::<[f32; 3]>() as u64 > MOST_BYTES {
        return Err(fault(format!("is too large: {width} by {height} pixels")));
    }
    texels(decoded).map_err(fault)
}

fn decode(mut reader: ImageReader<BufReader<File>>) -> image::ImageResult<DynamicImage> {
    let mut limits = Limits::no_limits();
    limits.max_image_width = Some(MOST_PIXELS);
    limits.max_image_height = Some(MOST_PIXELS);
    limits.max_alloc = Some(MOST_BYTES);
    reader.limits(limits);
    reader.decode()
}

/// The image with its numbers as they are.
fn texels(decoded: DynamicImage) -> Result<Image, String> {
    let (width, height) = (decoded.width(), decoded.height());
    let image = match decoded {
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            let texels: Vec<_> = decoded.into_rgb32f().pixels().map(|p| p.0).collect();
            let wrong = texels.iter().filter(|texel| !texel.iter().all(|x| x.is_finite())).count();
            if wrong > 0 {
                return Err(format!("{wrong} of {} texels are not finite", texels.len()));
            }
            Image::new(width, height, texels)
        }
        DynamicImage::ImageLuma8(_)
        | DynamicImage::ImageLumaA8(_)
        | DynamicImage::ImageRgb8(_)
        | DynamicImage::ImageRgba8(_) => {
            Image::from_bytes(width, height, decoded.into_rgb8().pixels().map(|p| p.0).collect())
        }
        _ => Image::from_words(width, height, decoded.into_rgb16().pixels().map(|p| p.0).collect()),
    };
    image.ok_or_else(|| "has no pixels".into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{ImageBuffer, Luma, Rgb, Rgba, Rgba32FImage};
    use snell_components::color::{Encoding, linear_from_srgb};
    use std::path::PathBuf;
    use tempfile::TempDir;

    fn saved(name: &str, image: impl Into<DynamicImage>) -> (TempDir, PathBuf) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join(name);
        image.into().save(&path).expect("saved");
        (folder, path)
    }

    fn texel(image: &Image) -> [f32; 3] {
        image.texel(0, 0, Encoding::Srgb)
    }

    #[test]
    fn integers_are_taken_as_srgb_and_alpha_is_left_out() {
        for name in ["a.png", "a.bmp", "a.tga"] {
            let (_folder, path) = saved(name, ImageBuffer::from_pixel(2, 1, Rgba([0u8, 188, 255, 7])));
            let image = read(&path).expect("an image");
            assert_eq!(image.size(), (2, 1));
            let middle = linear_from_srgb(188.0 / 255.0) as f32;
            assert_eq!(texel(&image), [0.0, middle, 1.0], "{name}");
        }
        let (_folder, path) = saved("a.png", ImageBuffer::from_pixel(1, 1, Luma([32_768u16])));
        let grey = linear_from_srgb(32_768.0 / 65_535.0) as f32;
        assert_eq!(texel(&read(&path).expect("an image")), [grey; 3]);
    }

    #[test]
    fn floats_are_linear_and_must_be_finite() {
        let image = |r| Rgba32FImage::from_pixel(1, 1, Rgba([r, -0.5, 7.25, 0.0]));
        let (_folder, path) = saved("a.exr", image(0.5));
        assert_eq!(texel(&read(&path).expect("an image")), [0.5, -0.5, 7.25]);
        let (_folder, path) = saved("a.exr", image(f32::NAN));
        assert_eq!(read(&path).expect_err("a fault").message, "1 of 1 texels are not finite");
    }

    #[test]
    fn the_contents_tell_the_format() {
        let (_folder, path) = saved("a.png", ImageBuffer::from_pixel(1, 1, Rgb([255u8; 3])));
        for other in ["a.jpg", "a.tga", "a.txt", "a"] {
            let other = path.with_file_name(other);
            std::fs::copy(&path, &other).expect("copied");
            assert!(read(&other).is_ok(), "{}", other.display());
        }
    }

    #[test]
    fn faults_name_the_file_and_the_reason() {
        let (folder, path) = saved("a.png", ImageBuffer::from_pixel(64, 64, Rgb([1u8; 3])));
        let message = |path: &Path| {
            let fault = read(path).expect_err("a fault");
            assert_eq!(fault.file, path);
            fault.message
        };
        let whole = std::fs::read(&path).expect("read");
        std::fs::write(&path, &whole[..whole.len() / 2]).expect("written");
        assert!(message(&path).starts_with("cannot be decoded: "));
        std::fs::write(&path, "no image").expect("written");
        assert!(message(&path).starts_with("cannot be decoded: "));
        let text = path.with_extension("txt");
        std::fs::write(&text, "no image").expect("written");
        assert_eq!(message(&text), "is no PNG, JPEG, BMP, TGA or EXR image");
        assert_eq!(message(folder.path()), "is not a file");
        assert_eq!(message(&path.with_extension("jpg")), "does not exist");
    }

    #[test]
    fn what_is_too_large_is_refused_before_it_is_decoded() {
        let (_folder, path) = saved("a.png", ImageBuffer::from_pixel(MOST_PIXELS + 1, 1, Luma([0u8])));
        assert!(read(&path).expect_err("a fault").message.contains("exceeds limit"));
    }
}
