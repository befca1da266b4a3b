//! Golden pictures that nothing is compared with.

use super::cases::files;
use std::{
    io,
    path::{Path, PathBuf},
};

/// Pictures below `root` that have no scene.
pub(crate) fn dead(root: &Path) -> io::Result<Vec<PathBuf>> {
    let mut pictures = files(root, "png")?;
    pictures.retain(|picture| !picture.with_extension("ron").exists());
    Ok(pictures)
}
