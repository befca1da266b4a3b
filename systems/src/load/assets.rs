//! Files that a scene refers to: found with a helpful message, read once, shared by all who name them.

use super::{
    fault::{Fault, Notice, nearest},
    image,
    obj::{self, Model},
};
use bevy_ecs::prelude::*;
use rayon::prelude::*;
use snell_components::{color::Encoding, texture::Image};
use std::{
    collections::{BTreeMap, BTreeSet},
    fs, io,
    path::{Path, PathBuf},
    sync::Arc,
};

/// Most entries of a folder that are looked through for a name near to one that was not found.
const NEIGHBOURS: usize = 1000;

/// What was read from files so far, by canonical path; `None` for a file with faults.
#[derive(Default)]
pub(super) struct Assets {
    /// What the numbers of colours mean in the scene that names the files.
    pub(super) encoding: Encoding,
    models: Vec<(String, Model)>,
    model_by_file: BTreeMap<PathBuf, Option<usize>>,
    image_by_file: BTreeMap<PathBuf, Option<Arc<Image>>>,
    /// Images that were decoded before they were asked for.
    decoded: BTreeMap<PathBuf, Result<Image, Fault>>,
    /// All that is wrong with the files, in the order of reading.
    pub(super) faults: Vec<Fault>,
    /// What was repaired or passed over.
    pub(super) notices: Vec<Notice>,
}

/// The files that the last sound scene was read from: its own and all that it uses.
#[derive(Resource, Clone, Debug, Default, PartialEq, Eq)]
pub struct UsedFiles(pub BTreeSet<PathBuf>);

impl Assets {
    /// All files that were read.
    pub(super) fn files(&self) -> impl Iterator<Item = PathBuf> {
        let materials = self.models.iter().flat_map(|(_, model)| &model.materials);
        let of_materials = materials.flat_map(|material| {
            let library = material.line.iter().map(|line| line.file.to_path_buf());
            library.chain(material.texture.iter().map(|texture| PathBuf::from(&texture.0)))
        });
        self.model_by_file.keys().chain(self.image_by_file.keys()).cloned().chain(of_materials)
    }

    /// The number of the model in a file; `None` if the file was read but has faults, which are noted here.
    ///
    /// # Errors
    /// Why there is no file to read, for whoever names it.
    pub(super) fn model(&mut self, file: &Path, written: &str) -> Result<Option<usize>, String> {
        let found = find(file)?;
        if let Some(known) = self.model_by_file.get(&found) {
            return Ok(*known);
        }
        let number = match obj::read(file) {
            Ok((model, notices)) => {
                self.notices.extend(notices);
                self.models.push((written.into(), model));
                Some(self.models.len() - 1)
            }
            Err(faults) => {
                self.faults.extend(faults.0);
                None
            }
        };
        self.model_by_file.insert(found, number);
        Ok(number)
    }

    /// A model by its number, and its path as the scene first gave it.
    pub(super) fn model_at(&self, number: usize) -> Option<&(String, Model)> {
        self.models.get(number)
    }

    /// Decodes some files in parallel, each once, for [`Assets::image`] to find. What is no file is left to it.
    pub(super) fn decode_images(&mut self, files: Vec<PathBuf>) {
        let mut found = BTreeMap::new();
        for file in files {
            if let Ok(path) = file.canonicalize()
                && path.is_file()
            {
                found.entry(path).or_insert(file);
            }
        }
        // One alone is as soon decoded when it is asked for.
        if found.len() > 1 {
            let decoded = found.into_par_iter().map(|(path, file)| (path, image::read(&file)));
            self.decoded = decoded.collect();
        }
    }

    /// The image in a file; `None` if the file was read but has a fault, which is noted here.
    ///
    /// # Errors
    /// Why there is no file to read, for whoever names it.
    pub(super) fn image(&mut self, file: &Path) -> Result<Option<Arc<Image>>, String> {
        let found = find(file)?;
        if let Some(known) = self.image_by_file.get(&found) {
            return Ok(known.clone());
        }
        let read = self.decoded.remove(&found).unwrap_or_else(|| image::read(file));
        let image = read.map_err(|fault| self.faults.push(fault)).ok().map(Arc::new);
        self.image_by_file.insert(found, image.clone());
        Ok(image)
    }
}

/// The one path of a file, however it is written.
///
/// # Errors
/// Why there is no file, and the nearest name that there is.
pub(super) fn find(file: &Path) -> Result<PathBuf, String> {
    let found = file.canonicalize().map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => format!("no such file{}", nearest_file(file)),
        _ => reason(&error),
    })?;
    if found.is_dir() { Err("this is a folder, not a file".into()) } else { Ok(found) }
}

/// Why a file cannot be read, in words that are the same on every system where the cause is a common one.
pub(super) fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "no such file".into(),
        io::ErrorKind::PermissionDenied => "not allowed to read this file".into(),
        _ => error.to_string(),
    }
}

/// The file in the same folder whose name is nearest, as a question; empty if none is near.
fn nearest_file(file: &Path) -> String {
    let (Some(name), Some(folder)) = (file.file_name().and_then(|name| name.to_str()), file.parent()) else {
        return String::new();
    };
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let Ok(entries) = fs::read_dir(folder) else { return String::new() };
    let mut names: Vec<String> =
        entries.take(NEIGHBOURS).filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
    names.sort_unstable();
    let near = nearest(name, names.iter().map(String::as_str));
    near.map_or(String::new(), |near| format!("; did you mean `{near}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::image::{ImageBuffer, Rgb};

    #[test]
    fn images_decoded_ahead_are_those_that_are_asked_for() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = |name: &str| folder.path().join(name);
        for (name, level) in [("a.png", 10u8), ("b.png", 20)] {
            ImageBuffer::from_pixel(1, 1, Rgb([level; 3])).save(file(name)).expect("saved");
        }
        fs::write(file("broken.png"), "no image").expect("written");
        let names = ["a.png", "b.png", "a.png", "broken.png", "absent.png"];

        let mut one_by_one = Assets::default();
        let plain = names.map(|name| one_by_one.image(&file(name)));
        let mut ahead = Assets::default();
        ahead.decode_images(names.map(file).to_vec());
        assert_eq!(ahead.decoded.len(), 3, "each file once");
        // Had it not been decoded, it would now be another.
        ImageBuffer::from_pixel(1, 1, Rgb([30u8; 3])).save(file("a.png")).expect("saved");
        assert_eq!(names.map(|name| ahead.image(&file(name))), plain);
        assert!(ahead.decoded.is_empty());
        assert_eq!(ahead.faults.len(), 1);
        assert_eq!(ahead.faults, one_by_one.faults);
    }
}
