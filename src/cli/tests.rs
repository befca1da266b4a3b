//! The commands on worlds built in code; what the program does with scene files is tested in `tests/cli.rs`.

use super::*;
use crate::prelude::*;
use snell_systems::image::{self, key};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A folder with a scene that says nothing, for entities that come from code.
struct Desk(TempDir);

impl Desk {
    fn new() -> Self {
        let desk = Self(tempfile::tempdir().expect("a folder"));
        std::fs::write(desk.path("empty.ron"), "Scene(version: 1, entities: {})").expect("written");
        desk
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Runs words, of which `@name` is a file in the folder; returns the exit code, output and error output.
    fn run(&self, renderer: Renderer, words: &str) -> (u8, String, String) {
        let word = |word: &str| match word.strip_prefix('@') {
            Some(name) => self.path(name).into_os_string(),
            None => word.into(),
        };
        let (mut out, mut err) = (vec![], vec![]);
        let args = ["snell"].into_iter().chain(words.split_whitespace()).map(word);
        let code = run_with(renderer, args, &mut Console { out: &mut out, err: &mut err });
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("text");
        (code, text(out), text(err))
    }
}

fn ball() -> Renderer {
    let mut renderer = Renderer::new();
    renderer.world.spawn(Camera { position: DVec3::new(0.0, 0.0, 5.0), ..Camera::default() });
    renderer.world.spawn(DirectionalLight { direction: DVec3::new(-1.0, -2.0, -1.0), ..DirectionalLight::default() });
    renderer.world.spawn((Sphere { radius: 1.0 }, Color(Rgb::new(0.8, 0.2, 0.1)), Diffuse(Rgb::ONE)));
    renderer
}

fn read(path: &Path) -> (Picture, image::Metadata) {
    image::read(path).expect("a picture")
}

#[test]
fn a_render_writes_the_picture_with_its_metadata_and_sums_up() {
    let desk = Desk::new();
    let (code, out, err) = desk.run(ball(), "render @empty.ron -o @a.exr --size 32x24 --threads 1 --stats @a.json");
    assert_eq!((code, err.as_str()), (0, ""));
    assert!(out.contains("a.exr, 32x24") && out.contains("768 primary") && out.contains("on 1 thread\n"), "{out}");

    let (picture, metadata) = read(&desk.path("a.exr"));
    assert_eq!(metadata.get(key::HASH), Some(picture.hash().as_str()));
    assert!(metadata.get(key::SETTINGS).is_some_and(|text| text.starts_with("(width: 32, height: 24,")));

    let json = std::fs::read_to_string(desk.path("a.json")).expect("read");
    let stats: Stats = serde_json::from_str(&json).expect("stats");
    assert_eq!((stats.version, stats.drawn, stats.hash), (Stats::VERSION, 768, picture.hash()));
}

#[test]
fn the_picture_is_the_same_for_any_number_of_threads() {
    let desk = Desk::new();
    let bytes = ["1", "3"].map(|threads| {
        let words = format!("render @empty.ron -o @{threads}.png --size 32x24 --threads {threads} --quiet");
        let (code, out, err) = desk.run(ball(), &words);
        assert_eq!((code, out.as_str(), err.as_str()), (0, "", ""));
        std::fs::read(desk.path(&format!("{threads}.png"))).expect("read")
    });
    assert_eq!(bytes[0], bytes[1]);
}

#[test]
fn a_region_is_the_crop_of_the_whole() {
    let desk = Desk::new();
    assert_eq!(desk.run(ball(), "render @empty.ron -o @whole.exr --size 32x24").0, 0);
    let (code, out, _) = desk.run(ball(), "render @empty.ron -o @part.exr --size 32x24 --region 10,8,7,5");
    assert_eq!(code, 0);
    assert!(out.contains("7x5 at 10,8 of 32x24"), "{out}");
    let (part, metadata) = read(&desk.path("part.exr"));
    let crop = read(&desk.path("whole.exr")).0.crop(Region { x: 10, y: 8, width: 7, height: 5 });
    assert_eq!(Some(part), crop);
    assert_eq!(metadata.get(key::REGION), Some("10,8,7,5"));

    let (code, _, err) = desk.run(ball(), "render @empty.ron -o @no.exr --size 32x24 --region 30,0,3,1");
    assert_eq!(code, 2);
    assert!(err.contains("--region 30,0,3,1 reaches beyond the picture, which has 32x24 pixels"), "{err}");
    assert!(!desk.path("no.exr").exists());
}

#[test]
fn the_hash_is_that_of_the_picture() {
    let desk = Desk::new();
    assert_eq!(desk.run(ball(), "render @empty.ron -o @a.exr --size 32x24 --antialias four").0, 0);
    let (code, out, _) = desk.run(ball(), "hash @empty.ron --size 32x24 --antialias four");
    assert_eq!(code, 0);
    let expected = format!("{}  {}\n", read(&desk.path("a.exr")).0.hash(), desk.path("empty.ron").display());
    assert_eq!(out, expected);
    assert_ne!(desk.run(ball(), "hash @empty.ron --size 32x24").1, expected);
}

#[test]
fn methods_can_be_chosen_and_are_told() {
    let desk = Desk::new();
    let hash = |words: &str| {
        let (code, out, _) = desk.run(ball(), &format!("hash @empty.ron --size 32x24 {words}"));
        assert_eq!(code, 0, "{words}");
        out
    };
    assert_eq!(hash("--accelerator spheretree"), hash(""));
    assert_eq!(hash("--accelerator BruteForce"), hash("--triangle-test MollerTrumbore"), "there is no triangle");
    assert_ne!(hash("--precision F32"), hash(""));
    assert_ne!(hash("--precision F32 --sphere-test naive"), hash("--precision F32 --sphere-test robust"));

    let words = "render @empty.ron -o @a.exr --size 32x24";
    assert_eq!(desk.run(ball(), words).0, 0);
    assert_eq!(read(&desk.path("a.exr")).1.get(key::METHODS), None);
    assert_eq!(desk.run(ball(), &format!("{words} --precision F32")).0, 0);
    let told = "accelerator Tree, triangle Sheared, sphere Robust, precision F32";
    assert_eq!(read(&desk.path("a.exr")).1.get(key::METHODS), Some(told));
    assert_eq!(desk.run(ball(), &format!("{words} --precision F16")).0, 2);
}

#[test]
fn a_png_has_the_bits_that_were_asked_for() {
    let desk = Desk::new();
    for (bits, at_24) in [("8", 8), ("16", 16)] {
        let words = format!("render @empty.ron -o @{bits}.png --size 8x6 --bits {bits}");
        assert_eq!(desk.run(ball(), &words).0, 0);
        // The depth follows signature, length, name, width and height.
        assert_eq!(std::fs::read(desk.path(&format!("{bits}.png"))).expect("read")[24], at_24);
    }
    let (code, _, err) = desk.run(ball(), "render @empty.ron -o @a.exr --bits 8");
    assert_eq!(code, 2);
    assert!(err.contains("an EXR file always holds 32-bit floats"), "{err}");
}

#[test]
fn what_cannot_be_written_is_told_before_the_scene_is_read() {
    let desk = Desk::new();
    for (words, code, told) in [
        ("render @missing.ron -o @a.jpg", 2, "pictures are .png or .exr files, not .jpg"),
        ("render @missing.ron -o @no/a.png", 1, "there is no folder"),
        ("render @missing.ron -o @a.png --stats @no/a.json", 1, "there is no folder"),
    ] {
        let (was, _, err) = desk.run(ball(), words);
        assert_eq!(was, code, "{words}");
        assert!(err.starts_with("error: ") && err.contains(told) && err.lines().count() == 1, "{err}");
    }
}

#[test]
fn a_world_that_cannot_be_rendered_is_a_fault_of_the_scene() {
    let desk = Desk::new();
    for command in ["render", "hash", "check"] {
        let (code, _, err) = desk.run(Renderer::new(), &format!("{command} @empty.ron"));
        assert_eq!(code, 1, "{command}");
        assert!(err.contains("empty.ron: the scene has no camera") && err.ends_with("\n1 fault\n"), "{err}");
    }
}

#[test]
fn scenes_are_checked_one_by_one() {
    let desk = Desk::new();
    let (code, out, err) = desk.run(ball(), "check @empty.ron @empty.ron");
    assert_eq!((code, err.as_str()), (0, ""));
    assert_eq!(out, format!("{0}: ok\n{0}: ok\n", desk.path("empty.ron").display()));
}

#[test]
fn wrong_usage_ends_with_2() {
    let desk = Desk::new();
    for words in ["", "draw", "render", "render a.ron --threads 0", "render a.ron --size 0x5", "check"] {
        assert_eq!(desk.run(Renderer::new(), words).0, 2, "{words}");
    }
    assert_eq!(desk.run(Renderer::new(), "--version").0, 0);
}
