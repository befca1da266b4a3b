//! Stage 6: picture → file, and back.
//!
//! PNG holds the picture sRGB-encoded in 8 or 16 bits, or as it is where [`key::ENCODING`] says so; OpenEXR the light
//! itself in 32-bit floats. Both carry [`Metadata`]: how the picture was made. The same picture with the same metadata gives the same bytes, always.

mod encode;
mod exr;
mod file;
mod metadata;
mod png;

pub use encode::{as_read, levels8, levels16, srgb8, srgb16};
pub use file::{FileError, check_writable, write_atomically};
pub use metadata::{Metadata, key};

use crate::render::Picture;
use std::{fs, path::Path};

/// Kinds of picture files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// PNG, 8 bits a channel, sRGB.
    Png8,
    /// PNG, 16 bits a channel, sRGB.
    Png16,
    /// OpenEXR, 32-bit floats of linear light, compressed without loss.
    Exr,
}

impl Format {
    /// The kind of file that a path's extension asks for; `.png` is [`Format::Png8`].
    ///
    /// # Errors
    /// Any extension but `.png` and `.exr`.
    pub fn of(path: &Path) -> Result<Self, FileError> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
        match extension.as_deref() {
            Some("png") => Ok(Self::Png8),
            Some("exr") => Ok(Self::Exr),
            Some(other) => Err(FileError::new(path, format!("pictures are .png or .exr files, not .{other}"))),
            None => Err(FileError::new(path, "pictures are .png or .exr files; this name has no extension")),
        }
    }
}

/// Most pixels a file may have to be read: a few bytes can claim a picture larger than memory.
const MAX_PIXELS: u64 = 1 << 28;

/// Writes a picture to a file, which is either complete or, after an error, as it was.
///
/// # Errors
/// What keeps the file from being written.
pub fn write(path: &Path, format: Format, picture: &Picture, metadata: &Metadata) -> Result<(), FileError> {
    let encoded = match format {
        Format::Png8 => png::encode(picture, png::Depth::Eight, metadata),
        Format::Png16 => png::encode(picture, png::Depth::Sixteen, metadata),
        Format::Exr => exr::encode(picture, metadata),
    };
    let bytes = encoded.map_err(|why| FileError::new(path, format!("the picture cannot be encoded: {why}")))?;
    write_atomically(path, &bytes)
}

/// Reads a picture, in linear light, and what is known of how it was made. Alpha is dropped; a PNG is taken as sRGB
/// unless [`key::ENCODING`] says otherwise.
///
/// # Errors
/// A file that cannot be read, or is not what its extension says, or has more than 2²⁸ pixels.
pub fn read(path: &Path) -> Result<(Picture, Metadata), FileError> {
    let format = Format::of(path)?;
    let bytes = fs::read(path).map_err(|why| FileError::new(path, format!("cannot be read: {why}")))?;
    let decoded = match format {
        Format::Png8 | Format::Png16 => png::decode(&bytes),
        Format::Exr => exr::decode(&bytes),
    };
    decoded.map_err(|why| FileError::new(path, why))
}

/// The pixels of a picture `width` by `height`, if it is small enough to be read.
fn checked_size(width: u64, height: u64) -> Result<(u32, u32), String> {
    match (u32::try_from(width), u32::try_from(height)) {
        (Ok(w), Ok(h)) if width * height <= MAX_PIXELS => Ok((w, h)),
        _ => Err(format!("{width}x{height} pixels are too many to be read; at most {MAX_PIXELS} are")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture with every 8-bit level, values beyond white, tiny ones and a negative zero.
    fn picture() -> Picture {
        let mut picture = Picture::black(16, 17);
        for (i, pixel) in picture.pixels.iter_mut().enumerate() {
            let level = i as f32 / 255.0;
            *pixel = [level * level, level * 0.5, 1.0 - level];
        }
        picture.pixels[256] = [7.0, 1e-30, -0.0];
        picture
    }

    fn metadata() -> Metadata {
        let mut metadata = Metadata::default();
        metadata.insert(key::SCENE, "scènes/a\nb: c.ron");
        metadata.insert(key::HASH, picture().hash());
        metadata.insert(key::SOFTWARE, "Snell");
        metadata
    }

    #[test]
    fn exr_gives_back_every_bit() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("picture.exr");
        write(&path, Format::Exr, &picture(), &metadata()).expect("written");
        let (read, told) = read(&path).expect("read");
        assert_eq!(read.hash(), picture().hash());
        assert_eq!(told, metadata());
    }

    #[test]
    fn png_gives_back_every_level_and_the_metadata() {
        let folder = tempfile::tempdir().expect("a folder");
        for (format, name) in [(Format::Png8, "8.png"), (Format::Png16, "16.PNG")] {
            let path = folder.path().join(name);
            write(&path, format, &picture(), &metadata()).expect("written");
            let (read, told) = read(&path).expect("read");
            match format {
                Format::Png8 => assert_eq!(srgb8(&read), srgb8(&picture())),
                _ => assert_eq!(srgb16(&read), srgb16(&picture())),
            }
            assert_eq!(told, metadata());
        }
    }

    #[test]
    fn the_same_picture_gives_the_same_bytes() {
        let folder = tempfile::tempdir().expect("a folder");
        for (format, extension) in [(Format::Png8, "png"), (Format::Png16, "png"), (Format::Exr, "exr")] {
            let files = ["a", "b"].map(|name| folder.path().join(name).with_extension(extension));
            let bytes = files.map(|file| {
                write(&file, format, &picture(), &metadata()).expect("written");
                fs::read(&file).expect("read")
            });
            assert_eq!(bytes[0], bytes[1]);
        }
    }

    #[test]
    fn damaged_files_are_errors_and_never_panic() {
        let mut small = Picture::black(9, 7);
        small.pixels[20] = [0.25, 0.5, 8.0];
        let exr = exr::encode(&small, &metadata()).expect("encoded");
        let png = png::encode(&small, png::Depth::Eight, &metadata()).expect("encoded");
        let decoders: [(_, fn(&[u8]) -> Result<(Picture, Metadata), String>); 2] =
            [(exr, exr::decode), (png, png::decode)];
        for (bytes, decode) in decoders {
            // The last chunk of a PNG is 12 bytes that say nothing.
            for end in 0..bytes.len() - 12 {
                assert!(decode(&bytes[..end]).is_err(), "cut to {end} bytes");
            }
            for at in 0..bytes.len() {
                for value in [0, 1, 0x7f, 0x80, 0xff, bytes[at] ^ 1] {
                    let mut changed = bytes.clone();
                    changed[at] = value;
                    // A picture or an error: either will do.
                    let _ = decode(&changed);
                }
            }
        }
    }

    #[test]
    fn formats_go_by_extension() {
        assert_eq!(Format::of(Path::new("a/b.Png")), Ok(Format::Png8));
        assert_eq!(Format::of(Path::new("b.exr")), Ok(Format::Exr));
        let error = Format::of(Path::new("b.jpg")).expect_err("not supported");
        assert_eq!(error.to_string(), "b.jpg: pictures are .png or .exr files, not .jpg");
        assert!(Format::of(Path::new("png")).is_err());
    }
}
