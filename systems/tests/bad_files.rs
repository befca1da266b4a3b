//! Real and broken files of many origins, where a collection of them is present: `SNELL_DATA` names its folder. Without
//! one the tests here pass by.

use serde_json::Value;
use snell_components::color::Encoding;
use snell_systems::load::image;
use snell_systems::load::obj::{self, Model};
use snell_systems::load::{Fault, Faults, Notice};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Time that reading any one file may take, in a test build on a busy machine.
const LONGEST: Duration = Duration::from_secs(60);

fn collection() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let folder = std::env::var_os("SNELL_DATA").map_or(beside, PathBuf::from);
    let found = folder.is_dir().then_some(folder);
    if found.is_none() {
        println!("no collection of files: nothing tested");
    }
    found
}

fn index(file: &Path) -> Vec<Value> {
    let text = std::fs::read_to_string(file).expect("an index");
    let index: Value = serde_json::from_str(&text).expect("JSON");
    index["files"].as_array().expect("a list of files").clone()
}

fn timed<T>(path: &Path, read: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = read();
    assert!(start.elapsed() < LONGEST, "{} took {:?}", path.display(), start.elapsed());
    result
}

fn read_model(path: &Path) -> Result<(Model, Vec<Notice>), Faults> {
    timed(path, || obj::read(path))
}

/// Reads a material library by way of a triangle that names it.
fn read_library(path: &Path) -> Result<(Model, Vec<Notice>), Faults> {
    let folder = tempfile::tempdir().expect("a folder");
    let name = path.file_name().expect("a name");
    std::fs::copy(path, folder.path().join(name)).expect("copied");
    let file = folder.path().join("triangle.obj");
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    std::fs::write(&file, format!("mtllib {}\n{text}", name.to_string_lossy())).expect("written");
    read_model(&file)
}

fn describe(outcome: Result<String, String>) -> (bool, String) {
    match outcome {
        Ok(text) => (true, text),
        Err(text) => (false, text),
    }
}

/// Whether a file loads whose label is not what is right here.
const OTHERWISE: [(&str, bool); 1] = [
    // Holds lines only, and a model must have faces.
    ("bad/obj/tobj/lines.obj", false),
];

#[test]
fn broken_files_are_read_or_refused_as_they_should_be() {
    let Some(folder) = collection() else { return };
    let mut outcomes = BTreeMap::<(String, String, bool), usize>::new();
    let mut wrong = vec![];
    for entry in index(&folder.join("bad/INDEX.json")) {
        let text = |key: &str| entry[key].as_str().unwrap_or_default().to_owned();
        let (name, kind, expect) = (text("path"), text("kind"), text("expect"));
        let path = folder.join(&name);
        let (loaded, message) = match (kind.as_str(), expect.as_str()) {
            (_, "companion") | ("ron", _) => continue,
            _ if !path.is_file() => continue,
            ("obj", _) => describe(summary(read_model(&path))),
            ("mtl", _) => describe(summary(read_library(&path))),
            _ => describe(timed(&path, || image::read(&path)).map(|_| String::new()).map_err(|e: Fault| e.to_string())),
        };
        println!("{}: {name}: {message}", if loaded { "read" } else { "refused" });
        let right = match OTHERWISE.iter().find(|(other, _)| *other == name) {
            Some((_, loads)) => loaded == *loads,
            None => match expect.as_str() {
                "load" | "reference" => loaded,
                "reject" => !loaded,
                "reject_or_skip" | "reject_or_garbage" | "no_crash" => true,
                other => panic!("{name}: unknown label `{other}`"),
            },
        };
        if !right {
            wrong.push(format!("{name} ({expect}): {message}"));
        }
        *outcomes.entry((kind, expect, loaded)).or_default() += 1;
    }
    println!("{outcomes:#?}");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn summary(outcome: Result<(Model, Vec<Notice>), Faults>) -> Result<String, String> {
    match outcome {
        Ok((model, notices)) => {
            let notices: Vec<_> = notices.iter().map(ToString::to_string).collect();
            Ok(format!(
                "{} triangles, {} materials\n  {}",
                model.mesh.len(),
                model.materials.len(),
                notices.join("\n  ")
            ))
        }
        Err(faults) => Err(faults.to_string()),
    }
}

#[test]
fn real_models_have_the_triangles_they_should_have() {
    let Some(folder) = collection() else { return };
    let manifest = std::fs::read_to_string(folder.join("MANIFEST.tsv")).expect("a manifest");
    let mut wrong = vec![];
    for line in manifest.lines() {
        let fields: Vec<_> = line.split('\t').collect();
        let &[name, _, triangles, ..] = fields.as_slice() else { continue };
        let path = folder.join(name);
        if !name.starts_with("meshes/") || !name.ends_with(".obj") || !path.is_file() {
            continue;
        }
        match read_model(&path) {
            Ok((model, notices)) => {
                let found = model.mesh.len() + model.mesh.degenerate();
                let notices: Vec<_> = notices.iter().map(ToString::to_string).collect();
                println!(
                    "{name}: {triangles} {found} ({} without area)\n  {}",
                    model.mesh.degenerate(),
                    notices.join("\n  ")
                );
                if found.to_string() != triangles {
                    wrong.push(format!("{name}: {found} triangles, not {triangles}"));
                }
            }
            Err(faults) => wrong.push(faults.to_string()),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Files below a folder, in order.
fn files_below(folder: &Path) -> Vec<PathBuf> {
    let entries = folder.read_dir().expect("a folder").map(|entry| entry.expect("an entry").path());
    let mut found: Vec<_> =
        entries.flat_map(|path| if path.is_dir() { files_below(&path) } else { vec![path] }).collect();
    found.sort();
    found
}

#[test]
fn real_textures_load() {
    let Some(folder) = collection() else { return };
    for path in files_below(&folder.join("textures")) {
        if path.extension().is_some_and(|extension| extension != "json") {
            let image = timed(&path, || image::read(&path)).unwrap_or_else(|fault| panic!("{fault}"));
            println!("{}: {:?}", path.display(), image.size());
        }
    }
}

#[test]
fn every_encoding_of_a_card_shows_the_same() {
    let Some(folder) = collection() else { return };
    let folder = folder.join("textures/format_zoo");
    let mut wrong = vec![];
    for entry in index(&folder.join("INDEX.json")) {
        let name = entry["file"].as_str().expect("a name");
        let list =
            |key: &str| -> Vec<f64> { entry[key].as_array().into_iter().flatten().filter_map(Value::as_f64).collect() };
        let image = image::read(&folder.join(name)).unwrap_or_else(|fault| panic!("{fault}"));
        let (width, height) = image.size();
        if entry["size"].is_array() {
            assert_eq!(list("size"), [f64::from(width), f64::from(height)], "{name}");
        }
        let code = |x: u32, y: u32| image.texel(x, y, Encoding::Raw).map(|number| 255.0 * f64::from(number));
        let mut mean = [0.0; 3];
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            let code = code(x, y);
            mean = std::array::from_fn(|i| mean[i] + code[i] / f64::from(width) / f64::from(height));
        }
        // The index samples the corners two pixels inwards.
        let [left, top] = [width, height].map(|size| 2.min(size - 1));
        let [right, bottom] = [width, height].map(|size| size.saturating_sub(3));
        let found = [
            ("corner_tl", code(left, top)),
            ("corner_tr", code(right, top)),
            ("corner_bl", code(left, bottom)),
            ("corner_br", code(right, bottom)),
            ("mean", mean),
        ];
        for (key, found) in found {
            let expected = list(key);
            let difference = found.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let allowed = match (name.ends_with(".jpg"), key) {
                (false, _) => 0.02,
                // Decoders of lossy images may differ in rounding, and in how they spread colours that are stored coarser.
                (true, "mean") => 0.6,
                (true, _) => 3.0,
            };
            // The decoder that made the index cannot narrow 16 bits to 8: all its values are 255.
            let is_known = !expected.is_empty() && name != "card_gray16.png";
            if is_known && difference > allowed {
                wrong.push(format!("{name} {key}: {found:?}, not {expected:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
