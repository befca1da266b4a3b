//! The committed models and textures of the gallery are what `examples/make_assets.rs` writes.

#[expect(dead_code, reason = "the program's own entry")]
#[path = "../examples/make_assets.rs"]
mod make_assets;

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

const GALLERY: &str = "scenes/gallery";
const FOLDERS: [&str; 2] = ["models", "textures"];

#[test]
fn the_gallery_has_the_assets_that_the_program_makes() {
    let made = tempfile::tempdir().expect("a folder");
    make_assets::write_assets(made.path()).expect("written");
    let files = assets(Path::new(GALLERY));
    assert!(!files.is_empty(), "no assets in {GALLERY}");
    assert_eq!(files, assets(made.path()));
    for file in files {
        let [committed, made] = [Path::new(GALLERY), made.path()].map(|folder| folder.join(&file));
        let equal = if file.extension().is_some_and(|is| is == "png") {
            // Encoders may change, pixels may not.
            let [committed, made] = [committed, made].map(|path| image::open(path).expect("an image"));
            committed == made
        } else {
            let [committed, made] = [committed, made].map(|path| fs::read_to_string(path).expect("text"));
            committed == made
        };
        assert!(equal, "{}: run `cargo run --release --example make_assets`", file.display());
    }
}

/// Files in the folders of assets, by their path below `root`.
fn assets(root: &Path) -> BTreeSet<PathBuf> {
    let files = |folder: &&str| fs::read_dir(root.join(folder)).expect("a folder");
    let path = |file: fs::DirEntry| file.path().strip_prefix(root).expect("below the root").to_path_buf();
    FOLDERS.iter().flat_map(files).map(|file| path(file.expect("an entry"))).collect()
}
