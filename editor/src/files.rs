//! The editor's own files: scenes opened last, and what is kept of a scene that has no file yet.

use std::{
    env, fs,
    path::{Path, PathBuf},
};

/// What is kept of a scene without a file.
pub const UNTITLED: &str = "untitled.autosave.ron";

/// Scenes remembered.
const MOST_RECENT: usize = 10;

/// The user's folder for the editor; `SNELL_EDITOR_DATA` takes its place.
#[must_use]
pub fn data_folder() -> PathBuf {
    let variable = |name: &str| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    variable("SNELL_EDITOR_DATA")
        .or_else(|| variable("XDG_DATA_HOME").map(|folder| folder.join("snell-editor")))
        .or_else(|| variable("APPDATA").map(|folder| folder.join("Snell Editor")))
        .or_else(|| variable("HOME").map(|folder| folder.join(".local/share/snell-editor")))
        .unwrap_or_else(|| env::temp_dir().join("snell-editor"))
}

/// The scenes opened last, the latest first; those that are gone are left out.
#[must_use]
pub fn recent(data: &Path) -> Vec<PathBuf> {
    let text = fs::read_to_string(data.join("recent.txt")).unwrap_or_default();
    text.lines().map(PathBuf::from).filter(|path| path.is_file()).take(MOST_RECENT).collect()
}

/// Remembers a scene. What cannot be remembered is no reason to trouble anybody.
pub fn remember(data: &Path, scene: &Path) {
    let scene = scene.canonicalize().unwrap_or(scene.into());
    let others = recent(data).into_iter().filter(|known| *known != scene);
    let paths: Vec<_> = [scene.clone()].into_iter().chain(others).take(MOST_RECENT).collect();
    let text: String = paths.iter().filter_map(|path| Some(format!("{}\n", path.to_str()?))).collect();
    if fs::create_dir_all(data).is_ok() {
        let _ = snell::systems::image::write_atomically(&data.join("recent.txt"), text.as_bytes());
    }
}

/// A path as seen from a folder: with `..` where that leads there, or else absolute; with `/` on every system.
#[must_use]
pub fn relative(path: &Path, folder: &Path) -> PathBuf {
    let absolute =
        |path: &Path| path.canonicalize().unwrap_or_else(|_| env::current_dir().unwrap_or_default().join(path));
    let (path, folder) = (absolute(path), absolute(folder));
    let common = path.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    if common < 2 {
        return path;
    }
    let up = folder.components().skip(common).map(|_| "..".to_owned());
    let down = path.components().skip(common).map(|part| part.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/").into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_scene_comes_first_and_each_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let [a, b] = ["a.ron", "b.ron"].map(|name| folder.path().canonicalize().expect("a folder").join(name));
        for scene in [&a, &b] {
            fs::write(scene, "").expect("written");
        }
        for scene in [&a, &b, &a] {
            remember(folder.path(), scene);
        }
        assert_eq!(recent(folder.path()), [a.clone(), b]);
        fs::remove_file(&a).expect("removed");
        assert_eq!(recent(folder.path()).len(), 1);
    }

    #[test]
    fn paths_are_seen_from_a_folder() {
        let folder = tempfile::tempdir().expect("a folder");
        let (inner, model) = (folder.path().join("scenes"), folder.path().join("models/a.obj"));
        fs::create_dir_all(&inner).expect("made");
        fs::create_dir_all(folder.path().join("models")).expect("made");
        fs::write(&model, "").expect("written");
        assert_eq!(relative(&model, &inner), Path::new("../models/a.obj"));
        assert_eq!(relative(&model, folder.path()), Path::new("models/a.obj"));
    }
}
