//! Reads image files.

use super::fault::Fault;
use snell_components::texture::Image;
use std::path::Path;

/// Reads an image file.
///
/// # Errors
/// What is wrong with the file.
pub fn read(path: &Path) -> Result<Image, Fault> {
    let bytes = std::fs::read(path).map_err(|e| Fault::of_file(path, e.to_string()))?;
    let texel = bytes.first().map_or(0.0, |byte| f32::from(*byte) / 255.0);
    Image::new(1, 1, vec![[texel; 3]]).ok_or_else(|| Fault::of_file(path, "no pixels"))
}
