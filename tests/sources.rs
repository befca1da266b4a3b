//! The sources of the renderer hold nothing that differs between machines or runs.
//!
//! Beyond `+ − × ÷ √` every function goes through `components/src/math.rs`; nothing fuses or reorders; nothing walks a
//! hash table, whose order changes from run to run. A scan of lines, so it also sees what lints of types do not.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

/// What must not occur.
const FORBIDDEN: &[&str] = &[
    // Fused or reordered.
    ".mul_add(",
    "algebraic_",
    "fadd_fast",
    "fmul_fast",
    // Of no specified precision: differs between system libraries.
    ".powi(",
    ".powf(",
    ".sin(",
    ".cos(",
    ".sin_cos(",
    ".tan(",
    ".asin(",
    ".acos(",
    ".atan(",
    ".atan2(",
    ".sinh(",
    ".cosh(",
    ".tanh(",
    ".exp(",
    ".exp2(",
    ".exp_m1(",
    ".ln(",
    ".ln_1p(",
    ".log(",
    ".log2(",
    ".log10(",
    ".cbrt(",
    ".hypot(",
    // The same, inside the vector library.
    "from_rotation",
    "from_axis_angle",
    "from_euler",
    "from_angle",
    "perspective_",
    "angle_between",
    "slerp(",
    // Walked in another order in every run.
    "HashMap",
    "HashSet",
    // Another number in every run.
    "Instant::",
    "SystemTime",
];

/// Lines that may hold something forbidden: file, text of the line, reason.
const ALLOWED: &[(&str, &str, &str)] = &[
    ("components/src/material.rs", "use bevy_ecs::{entity::EntityHashSet, prelude::*};", "counted only, never walked"),
    ("components/src/material.rs", "pub struct MaterialOf(EntityHashSet);", "counted only, never walked"),
    ("systems/src/extract/materials.rs", "collections::{BTreeMap, HashMap},", "looked up only, never walked"),
    (
        "systems/src/extract/materials.rs",
        "let mut index_of: HashMap<Entity, u32> = HashMap::with_capacity(ranked.len());",
        "looked up only, never walked",
    ),
];

/// Crates that no pixel depends on; every other one of the workspace is scanned, so that a new one is unless it is named here.
const OFF_THE_PATH: &[(&str, &str)] = &[
    ("charts", "looks at a clock and draws charts"),
    ("stability", "tries methods that fail"),
    ("editor", "shows what others drew"),
    ("components/derive", "runs in the compiler"),
];

/// Members of the workspace, from its manifest.
fn members(manifest: &str) -> Vec<&str> {
    let list =
        manifest.split_once("members = [").and_then(|(_, rest)| rest.split_once(']')).expect("a list of members").0;
    list.split(',').map(|name| name.trim().trim_matches('"')).filter(|name| !name.is_empty()).collect()
}

/// The one file that may call what is forbidden elsewhere.
const DOOR: &str = "components/src/math.rs";

/// Lines of a source with something forbidden, trimmed. Comments, and the tests at the end of a file, do not count.
fn offences(source: &str) -> Vec<&str> {
    let lines = source.lines().map(str::trim).take_while(|line| *line != "#[cfg(test)]");
    let code = |line: &&str| !line.starts_with("//");
    lines.filter(code).filter(|line| FORBIDDEN.iter().any(|text| line.contains(text))).collect()
}

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    for entry in entries {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            rust_files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn the_sources_call_nothing_that_differs_between_machines() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut files = vec![];
    let manifest = fs::read_to_string(root.join("Cargo.toml")).expect("a manifest");
    let members = members(&manifest);
    for (off, _) in OFF_THE_PATH {
        assert!(members.contains(off), "{off} is no member any more");
    }
    for on in members.iter().filter(|name| !OFF_THE_PATH.iter().any(|(off, _)| off == *name)) {
        rust_files(&root.join(on).join("src"), &mut files);
    }
    for needed in ["components/src/bvh/traverse.rs", "systems/src/render/trace.rs"] {
        assert!(files.contains(&root.join(needed)), "{needed} is not scanned");
    }
    assert!(files.len() > 30, "only {} files found", files.len());

    let mut unused: BTreeSet<_> = ALLOWED.iter().map(|(file, line, _)| (file.to_string(), line.to_string())).collect();
    let mut faults = vec![];
    for file in files {
        let name = file.strip_prefix(root).expect("within").to_string_lossy().replace('\\', "/");
        if name == DOOR {
            continue;
        }
        let source = fs::read_to_string(&file).expect("a text");
        for line in offences(&source) {
            let allowed = ALLOWED.iter().any(|(allowed, text, _)| *allowed == name && *text == line);
            unused.remove(&(name.clone(), line.to_owned()));
            if !allowed {
                faults.push(format!("{name}: {line}"));
            }
        }
    }
    assert!(faults.is_empty(), "see components/src/math.rs:\n{}", faults.join("\n"));
    assert!(unused.is_empty(), "allowed, but not there: {unused:?}");
}

#[test]
fn planted_offences_are_found() {
    assert_eq!(members("[workspace]\nmembers = [\"a\", \"b/c\",\n \"new\"]\nother = []"), ["a", "b/c", "new"]);
    for text in FORBIDDEN {
        let planted = format!("fn f(x: f64) -> f64 {{\n    x{text} // not at the start\n}}\n");
        assert_eq!(offences(&planted).len(), 1, "{text}");
    }
    assert_eq!(offences("let y = x.sin();\n#[cfg(test)]\nmod tests { let y = x.cos(); }"), ["let y = x.sin();"]);
    assert!(offences("// like x.sin(), but exact\nlet y = math::pow(x, 2.0);").is_empty());
}
