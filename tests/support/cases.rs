//! The cases below `tests/golden`: scenes with their golden pictures beside them.

use snell::{
    Picture,
    systems::image::{self, key},
};
use std::{
    fs, io,
    path::{Path, PathBuf},
};

/// Folders, at any depth, that hold what scenes are made of: neither cases nor their pictures.
const PARTS: [&str; 3] = ["models", "parts", "textures"];

/// A scene and its golden picture.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    /// Path of the scene below the folder of cases, without extension.
    pub(crate) name: String,
    /// The scene.
    pub(crate) scene: PathBuf,
    /// The golden picture.
    pub(crate) expected: PathBuf,
}

impl Case {
    /// Every scene below `root`, in the order of names.
    pub(crate) fn all(root: &Path) -> io::Result<Vec<Self>> {
        let case = |scene: PathBuf| {
            let path = scene.strip_prefix(root).unwrap_or(&scene).with_extension("");
            Self { name: path.to_string_lossy().replace('\\', "/"), expected: scene.with_extension("png"), scene }
        };
        Ok(files(root, "ron")?.into_iter().map(case).collect())
    }

    /// The golden picture, of 8 bits, and the hash of the linear light that it was made of.
    ///
    /// # Errors
    /// The picture cannot be read or has no hash.
    pub(crate) fn expected(&self) -> Result<(Picture, String), String> {
        let (picture, metadata) = image::read(&self.expected).map_err(|why| why.to_string())?;
        match metadata.get(key::HASH) {
            Some(hash) => Ok((picture, hash.into())),
            None => Err(format!("{} has no `{}`", self.expected.display(), key::HASH)),
        }
    }
}

/// Files with an extension in a folder and all below it, in order, without those of [`PARTS`].
pub(crate) fn files(folder: &Path, extension: &str) -> io::Result<Vec<PathBuf>> {
    let mut found = vec![];
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if !path.is_dir() {
            found.extend(path.extension().is_some_and(|is| is == extension).then_some(path));
        } else if !PARTS.iter().any(|part| path.ends_with(part)) {
            found.extend(files(&path, extension)?);
        }
    }
    found.sort();
    Ok(found)
}
