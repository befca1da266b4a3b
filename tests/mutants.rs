//! One bit, one normal, one light: the comparer and the golden report notice each.
//!
//! The conformance suite notices the same of a shape and a light: `tests/conformance_faults.rs` has
//! `one_bit_between_the_hits`, `a_bent_normal_in_one_place` and `a_light_brighter_than_told_by_one_bit` among its faults.

use snell::{
    Picture,
    golden::{Bless, Golden},
    prelude::*,
    systems::compare::{Comparison, Level},
};
use std::fs;

const SCENE: &str = r#"(version: 1, settings: (width: 24, height: 18), entities: {
    "camera": [Camera(position: (0.3, 0.3, 2))],
    "left": [DirectionalLight(direction: (1, -1, -1), intensity: 0.5)],
    "right": [DirectionalLight(direction: (-1, -1, -1), intensity: 0.25)],
    "leaf": [Triangle(a: (0, 0, 0), b: (1, 0, 0), c: (0, 1, 0), normals: [(0, 0, 1), (0.2, 0, 1), (0, 0.2, 1)])],
})"#;

fn draw(scene: &str) -> Picture {
    let mut renderer = Renderer::new();
    renderer.load_text(scene, "leaf.ron").expect("sound");
    render(&renderer.snapshot().expect("a scene"), &Options::default()).picture
}

/// The picture of the scene with one thing changed.
fn mutants() -> [(&'static str, Picture); 3] {
    let replaced = |from: &str, to: &str| {
        assert_eq!(SCENE.matches(from).count(), 1, "{from}");
        draw(&SCENE.replace(from, to))
    };
    let mut bit = draw(SCENE);
    let lit = bit.pixels.iter_mut().find(|pixel| pixel[1] > 0.1).expect("the leaf");
    lit[1] = f32::from_bits(lit[1].to_bits() ^ 1);
    [
        ("one bit", bit),
        ("one normal", replaced("(0.2, 0, 1)", "(0.201, 0, 1)")),
        ("one light", replaced("intensity: 0.25", "intensity: 0.251")),
    ]
}

#[test]
fn the_comparer_notices_each() {
    let picture = draw(SCENE);
    assert!(Comparison::between(&picture, &draw(SCENE)).is_within(Level::Exact));
    for (what, mutant) in mutants() {
        let found = Comparison::between(&picture, &mutant);
        assert!(!found.is_within(Level::Exact) && found.bits > 0, "{what}: {found}");
    }
}

#[test]
fn the_golden_report_notices_each() {
    let folder = tempfile::tempdir().expect("a folder");
    let reports = folder.path().join("reports");
    for (what, mut mutant) in mutants() {
        let golden = Golden::at(what, &folder.path().join(format!("{what}.png")), &reports);
        golden.check(&mut draw(SCENE), &Bless::All).expect("blessed");
        golden.check(&mut draw(SCENE), &Bless::Nothing).expect("equal");
        golden.check(&mut mutant, &Bless::Nothing).expect_err(what);
        let page = fs::read_to_string(reports.join("report.html")).expect("a report");
        assert!(page.contains(&format!("<h2>{what}</h2>")), "{what}");
    }
}
