//! Every golden scene gives its golden picture, to the last bit, whatever draws it and in whatever order its entities are
//! written.
//!
//! The oracle is the hash in the golden file, so builds of all kinds must arrive at the same bits.

mod support {
    pub(crate) mod cases;
    pub(crate) mod random;
    pub(crate) mod shuffle;
}

use snell::prelude::*;
use std::{fs, path::Path, sync::Arc};
use support::{cases::Case, shuffle::shuffled};

const THREADS: [usize; 4] = [1, 2, 3, 8];
const TILES: [u32; 2] = [7, 64];
const SEEDS: [u64; 4] = [1, 2, 3, 4];

/// Every case with the hash of its picture.
fn cases() -> Vec<(Case, String)> {
    let cases = Case::all(Path::new("tests/golden")).expect("a folder of cases");
    assert!(!cases.is_empty(), "there are no cases");
    let with_hash = |case: Case| {
        let (_, hash) = case.expected().expect("a golden picture");
        (case, hash)
    };
    cases.into_iter().map(with_hash).collect()
}

fn text(case: &Case) -> String {
    fs::read_to_string(&case.scene).expect("a scene")
}

/// What a scene's text stands for, as if it were in the case's file.
fn snapshot(case: &Case, text: &str) -> Arc<Snapshot> {
    let mut renderer = Renderer::new();
    if let Err(faults) = renderer.load_text(text, &case.scene) {
        panic!("{faults}");
    }
    renderer.snapshot().expect("a snapshot")
}

#[test]
fn neither_threads_nor_tiles_matter() {
    for (case, expected) in cases() {
        let snapshot = snapshot(&case, &text(&case));
        for threads in THREADS {
            for tile in TILES {
                let options = Options { threads: Some(threads), tile: Some(tile), ..Options::default() };
                let found = render(&snapshot, &options).picture.hash();
                assert_eq!(found, expected, "{}: {threads} threads, tile {tile}", case.name);
            }
        }
    }
}

#[test]
fn the_trees_change_nothing() {
    for (case, expected) in cases() {
        for accelerator in [Accelerator::SphereTree, Accelerator::BruteForce] {
            let options = Options { methods: Methods { accelerator, ..Methods::default() }, ..Options::default() };
            let found = render(&snapshot(&case, &text(&case)), &options).picture.hash();
            assert_eq!(found, expected, "{}: {accelerator:?}", case.name);
        }
    }
}

#[test]
fn a_region_is_the_part_of_the_whole() {
    for (case, expected) in cases() {
        let snapshot = snapshot(&case, &text(&case));
        let whole = render(&snapshot, &Options::default()).picture;
        assert_eq!(whole.hash(), expected, "{}", case.name);
        let (width, height) = (whole.width, whole.height);
        for region in [
            Region { x: 0, y: 0, width: width / 2, height: height / 3 },
            Region { x: width / 3, y: height / 4, width: width / 3, height: height / 2 },
            Region { x: width - 5, y: height / 2, width: 5, height: height - height / 2 },
        ] {
            let part = render(&snapshot, &Options { region: Some(region), ..Options::default() }).picture;
            let crop = whole.crop(region).expect("within the picture");
            assert!(part == crop, "{}: {region:?}", case.name);
        }
    }
}

#[test]
fn the_order_in_which_entities_are_written_means_nothing() {
    for (case, expected) in cases() {
        let written = text(&case);
        for seed in SEEDS {
            let shuffled = shuffled(&written, seed).expect("a map of entities");
            assert_ne!(shuffled, written, "{}: seed {seed} leaves the order", case.name);
            let found = render(&snapshot(&case, &shuffled), &Options::default()).picture.hash();
            assert_eq!(found, expected, "{}: entities in the order\n{shuffled}", case.name);
        }
    }
}

#[test]
fn shuffling_moves_whole_entities() {
    let scene = |entries: [&str; 3]| format!("Scene(entities: {{{}}}, version: 1)", entries.join(","));
    let entries = [
        "\"a\": [Like(\"b, }\\\"\")]",
        " // of c, }\n\"b\": [Transform([Scale(2), RotateX(3)])]",
        "\"c\": [Plane] /* , */ ",
    ];
    let [a, b, c] = entries;
    let all = [[a, b, c], [a, c, b], [b, a, c], [b, c, a], [c, a, b], [c, b, a]].map(|order| squeezed(&scene(order)));
    let mut met: Vec<_> =
        (0..50).map(|seed| squeezed(&shuffled(&scene(entries), seed).expect("a map of entities"))).collect();
    met.sort();
    met.dedup();
    assert_eq!(met.len(), all.len());
    assert!(met.iter().all(|text| all.contains(text)), "{met:#?}");
    assert_eq!(shuffled("Scene(version: 1)", 1), None);
}

/// Without white space, which shuffling may change.
fn squeezed(text: &str) -> String {
    text.split_whitespace().collect()
}
