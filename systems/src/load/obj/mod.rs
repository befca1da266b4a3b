//! Wavefront OBJ models with their MTL materials.
//!
//! A file is read once, statement by statement, each checked so that a fault has its line and column and all faults of a
//! file are found at once. Libraries of materials pass a like check and are then read by `tobj`, which the check of
//! models has no need of: it has read every number already. What has no meaning here is passed over with a notice. Missing or unreadable material libraries and textures are noticed, too:
//! the shape is there without them.
//!
//! What is read beyond the plain statements: relative indices, indices that point ahead, continued lines, LF, CR LF and
//! CR, a byte order mark, comments anywhere, bytes that are not UTF-8 (in names and comments, with a notice), vertices
//! with a weight or a colour (without it). Polygons are cut into triangles that cover them exactly, concave ones too.
//! Groups, object names and smoothing groups have no effect: a model is one mesh, smooth where it has normals. Normals
//! are brought to length 1. Every vertex must be finite, whether a face uses it or not.
//!
//! # Materials
//!
//! The libraries of a model are searched in the order they are named; the first material of a name counts.
//!
//! | MTL | here |
//! |---|---|
//! | `Kd` | `color`, linear RGB; white where absent |
//! | (none) | `diffuse` is 1: `Kd` is the colour already |
//! | `Ka` | `ambient`, as a share of the colour: `Ka / Kd`, at most 1; 1 where absent, 0 for `illum 0` |
//! | `Ks`, `Ns` | `highlight` of that strength and exponent; none if either is 0, or for `illum` 0 and 1 |
//! | `Ks`, `illum` 3 to 7 | `mirror`, at most 1; none if `Ks` is 0 |
//! | `d`, or `Tr` as `1 − d` | `opacity`; `d` counts where both are present |
//! | `Ni` | `index`, where `d` is below 1 and `Ni` is not 1, if `illum` is absent or one with refraction: 4, 6, 7, 9 |
//! | `map_Kd` | `texture`, relative to the MTL file, without its options; it multiplies the colour |
//!
//! Whatever else a material says is passed over with a notice.

mod feed;
mod lines;
mod log;
mod material;
mod mesh;
mod mtl;
mod polygon;
mod scan;
#[cfg(test)]
mod tests;
mod word;

pub use material::ModelMaterial;

use super::fault::{Fault, Faults, Notice, Position, nearest};
use super::{file, image};
use log::Log;
use mtl::Library;
use rayon::prelude::*;
use scan::Scan;
use snell_components::shape::TriangleMesh;
use snell_components::texture::Image;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use word::quoted;

/// Largest model read. No file below it holds more vertices or corners than 32-bit indices can tell apart.
const MOST_BYTES: u64 = 4 << 30;

/// Material libraries read for one model.
const MOST_LIBRARIES: usize = 256;

/// Names compared to find one that was meant.
const MOST_COMPARED: usize = 1000;

/// A model as read from a file.
#[derive(Clone, Debug)]
pub struct Model {
    /// The triangles.
    pub mesh: Arc<TriangleMesh>,
    /// The materials, in the order of the mesh's slots; empty if no face names one. Only those that faces use, in the
    /// order of their first use, and at the end a plain one if some faces have none.
    pub materials: Vec<ModelMaterial>,
}

/// Reads a model, with its materials and their textures.
///
/// # Errors
/// All faults of the file and of its material libraries, up to a limit for each, with their lines and columns.
pub fn read(path: &Path) -> Result<(Model, Vec<Notice>), Faults> {
    let whole = |fault: Fault| Faults(vec![fault]);
    let reader = file::open_text(path, MOST_BYTES).map_err(whole)?;
    let mut scan = Scan::new(path);
    scan.read(reader).map_err(|error| whole(Fault::of_file(path, format!("cannot be read: {error}"))))?;
    let mut materials = Materials::read(path, &mut scan);
    let mut faults = vec![];
    let mut model = None;
    if scan.faces == 0 && !scan.log.has_faults() {
        faults.push(Fault::of_file(path, "has no faces"));
    } else if !scan.log.has_faults() {
        match mesh::build(&mut scan) {
            Ok(mesh) => model = Some(Model { mesh: Arc::new(mesh), materials: materials.of_slots(&mut scan) }),
            Err(error) => faults.push(Fault::of_file(path, error.to_string())),
        }
    }
    let (mut all_faults, mut notices) = scan.log.into_parts();
    all_faults.append(&mut faults);
    for library in materials.libraries {
        let (mut faults, mut found) = library.log.into_parts();
        all_faults.append(&mut faults);
        notices.append(&mut found);
    }
    match model.filter(|_| all_faults.is_empty()) {
        Some(model) => Ok((model, notices)),
        None => Err(Faults(all_faults)),
    }
}

/// The material libraries of a model, and the textures their materials share.
struct Materials {
    libraries: Vec<Library>,
    /// Library and entry of each name.
    by_name: BTreeMap<String, (usize, usize)>,
    textures: BTreeMap<PathBuf, Result<Arc<Image>, Fault>>,
}

impl Materials {
    /// Reads the libraries that a model names, each once. Those that cannot be read are noticed.
    fn read(model: &Path, scan: &mut Scan) -> Self {
        let mut this = Self { libraries: vec![], by_name: BTreeMap::new(), textures: BTreeMap::new() };
        let folder = model.parent().unwrap_or(Path::new(""));
        let mut seen = BTreeSet::new();
        for (names, at) in std::mem::take(&mut scan.libraries) {
            for path in library_paths(folder, &names) {
                if seen.contains(&path) {
                    continue;
                }
                if seen.len() == MOST_LIBRARIES {
                    scan.log.notice(Some(at), "a material library beyond the number that is read");
                    return this;
                }
                match mtl::read(&path) {
                    Ok(library) => this.add(library),
                    Err(fault) => scan.log.notice(Some(at), &format!("material library {fault}")),
                }
                seen.insert(path);
            }
        }
        this
    }

    fn add(&mut self, mut library: Library) {
        for (i, entry) in library.entries.iter().enumerate() {
            if self.by_name.contains_key(&entry.name) {
                let text =
                    format!("material {} is defined before; this one is passed over", quoted(entry.name.as_bytes()));
                library.log.notice(Some(entry.at), &text);
            } else {
                self.by_name.insert(entry.name.clone(), (self.libraries.len(), i));
            }
        }
        self.libraries.push(library);
    }

    /// Decodes the textures of these materials, in parallel.
    fn decode(&mut self, names: &[(String, Position)]) {
        let paths = names.iter().filter_map(|(name, _)| {
            let &(library, entry) = self.by_name.get(name)?;
            let library = &self.libraries[library];
            library.texture(&library.entries[entry])
        });
        let paths: BTreeSet<PathBuf> = paths.collect();
        let read = |path: PathBuf| (path.clone(), image::read(&path).map(Arc::new));
        self.textures = paths.into_par_iter().map(read).collect::<Vec<_>>().into_iter().collect();
    }

    /// The materials that faces use, and a plain one for the faces without if others have one.
    fn of_slots(&mut self, scan: &mut Scan) -> Vec<ModelMaterial> {
        let names = std::mem::take(&mut scan.names);
        self.decode(&names);
        let some_have_none = scan.runs.iter().any(|run| run.material.is_none());
        let mut materials: Vec<_> = names.iter().map(|(name, at)| self.named(name, *at, &mut scan.log)).collect();
        if some_have_none && !materials.is_empty() {
            materials.push(ModelMaterial::default());
        }
        materials
    }

    fn named(&mut self, name: &str, at: Position, log: &mut Log) -> ModelMaterial {
        let Some(&(library, entry)) = self.by_name.get(name) else {
            if self.libraries.is_empty() {
                log.notice(Some(at), "a material without a library that could be read is plain white");
            } else {
                let known = self.by_name.keys().map(String::as_str).filter(|known| !known.is_empty());
                let near =
                    Some(name).filter(|_| log.has_room()).and_then(|name| nearest(name, known.take(MOST_COMPARED)));
                let hint = near.map(|near| format!(" (did you mean `{near}`?)")).unwrap_or_default();
                let name = quoted(name.as_bytes());
                log.notice(Some(at), &format!("there is no material {name}{hint}: it is plain white"));
            }
            return ModelMaterial::named(name);
        };
        let texture = self.libraries[library].texture(&self.libraries[library].entries[entry]);
        let Library { entries, log } = &mut self.libraries[library];
        let entry = &entries[entry];
        let mut material = ModelMaterial::of(entry, log);
        if let Some(path) = texture {
            // A fault is noticed once, where the texture is first used.
            let image = self.textures.get_mut(&path).and_then(|read| match read {
                Ok(image) => Some(image.clone()),
                Err(fault) if !fault.message.is_empty() => {
                    log.notice(Some(entry.at), &format!("texture {fault}"));
                    fault.message.clear();
                    None
                }
                Err(_) => None,
            });
            material.texture = image.map(|image| (path.display().to_string(), image));
        }
        material
    }
}

/// The libraries of one `mtllib` statement: one name that may hold spaces, or several.
fn library_paths(folder: &Path, names: &str) -> Vec<PathBuf> {
    let whole = file::resolve(folder, names);
    let several: Vec<_> = names.split_whitespace().map(|name| file::resolve(folder, name)).collect();
    if whole.is_file() || !several.iter().any(|path| path.is_file()) { vec![whole] } else { several }
}
