//! Settings that concern the scene as a whole: its placement, and what its numbers mean.

use snell::components::color::{Encoding, linear_from_srgb};
use snell::prelude::*;
use snell::systems::image::{self, Format, Metadata, levels8, srgb8};
use std::path::Path;

/// Objects and lights, all in the space of an entity named in `parents`, or of none.
fn scene([things, lights]: [&str; 2], settings: &str) -> Renderer {
    let text = format!(
        r#"Scene(version: 1, settings: (width: 48, height: 36, {settings}), entities: {{
            "camera": [Camera(position: (0, 2, 7), target: (0, 0.5, 0))],
            "placed": [Transform([RotateY(30), Scale((1.2, 0.8, 1)), Translate((0.4, 0.1, -0.5))])],
            "stays": [Transform([])],
            "ground": [Plane, Checker(odd: 0.3), Parent("{things}")],
            "ball": [Sphere(radius: 0.7), Transform([Translate((-1, 0.7, 0))]), Parent("{things}"), Mirror(0.5), Diffuse(0.5)],
            "brick": [Box(size: (1, 1, 1)), Transform([RotateY(20), Translate((1, 0.5, 0))]), Parent("{things}")],
            "lamp": [PointLight(position: (3, 4, 2)), Parent("{lights}")],
            "spot": [ConeLight(position: (-2, 4, 1), direction: (1, -2, 0), fall_off: Linear), Parent("{lights}")],
            "sky": [AmbientLight(0.2)],
        }})"#
    );
    let mut renderer = Renderer::new();
    renderer.load_text(&text, "scene.ron").expect("a scene");
    renderer
}

fn drawn(renderer: &mut Renderer) -> Picture {
    render(&renderer.snapshot().expect("a snapshot"), &Options::default()).picture
}

const PLACED: &str = "transform: [RotateY(30), Scale((1.2, 0.8, 1)), Translate((0.4, 0.1, -0.5))]";

#[test]
fn a_scene_is_placed_as_if_all_in_it_had_one_parent() {
    let plain = drawn(&mut scene(["stays", "stays"], ""));
    let with_lights = drawn(&mut scene(["stays", "stays"], PLACED));
    let without = drawn(&mut scene(["stays", "stays"], &format!("{PLACED}, transform_lights: false")));
    assert_eq!(with_lights.hash(), drawn(&mut scene(["placed", "placed"], "")).hash());
    assert_eq!(without.hash(), drawn(&mut scene(["placed", "stays"], "")).hash());
    assert_ne!(with_lights.hash(), without.hash());
    assert_ne!(with_lights.hash(), plain.hash());
}

#[test]
fn a_scene_turned_one_way_is_seen_as_by_a_camera_turned_the_other_way() {
    let mut turned = scene(["stays", "stays"], "transform: [RotateY(25)]");
    let mut from_there = scene(["stays", "stays"], "");
    let mut cameras = from_there.world.query::<&mut Camera>();
    cameras.single_mut(&mut from_there.world).expect("a camera").place(Step::RotateY(-25.0));
    let [a, b] = [drawn(&mut turned), drawn(&mut from_there)];
    let off = a.pixels.iter().zip(&b.pixels).filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| (a - b).abs() > 1e-5));
    // Only where an edge is met to the last digit may rounding decide otherwise.
    assert!(off.count() <= 2);
}

#[test]
fn a_scene_may_be_placed_anew_and_put_back() {
    let mut renderer = scene(["stays", "stays"], "");
    let before = drawn(&mut renderer).hash();
    renderer.settings().transform = Transform::new([Step::RotateX(10.0)]);
    let placed = drawn(&mut renderer).hash();
    renderer.settings().transform_lights = false;
    let without_lights = drawn(&mut renderer).hash();
    assert!(before != placed && placed != without_lights && before != without_lights);
    renderer.settings().transform = Transform::default();
    assert_eq!(drawn(&mut renderer).hash(), before);
}

#[test]
fn a_thing_that_shines_and_has_a_shape_leaves_its_light_where_it_was() {
    let lit = |settings: &str| {
        let text = format!(
            r#"(version: 1, settings: (width: 9, height: 9, {settings}), entities: {{
                "camera": [Camera(position: (0, 1, 5))],
                "lamp": [PointLight(position: (0, 3, 3)), Sphere(radius: 0.5), Transform([Translate((0, 1, 0))])],
            }})"#
        );
        let mut renderer = Renderer::new();
        renderer.load_text(&text, "scene.ron").expect("a scene");
        drawn(&mut renderer)
    };
    let alone = lit("transform: [Translate((0, 0, -1))], transform_lights: false");
    assert_ne!(alone.hash(), lit("transform: [Translate((0, 0, -1))]").hash());
    assert_ne!(alone.hash(), lit("").hash());
}

#[test]
fn a_placement_that_cannot_be_undone_is_a_fault() {
    let text = "(version: 1, settings: (width: 8,\n  transform: [Scale((1, 0, 1))]), entities: {})";
    let faults = Renderer::new().load_text(text, "scene.ron").expect_err("a fault").to_string();
    let expected = "scene.ron:2:14: settings.transform: expected a placement that can be undone: this one is singular";
    assert!(faults.starts_with(expected), "{faults}");
}

/// The letter on a board that fills the picture, texel by pixel.
fn letter(encoding: &str) -> Renderer {
    let text = format!(
        r##"(version: 1, settings: (width: 8, height: 8, encoding: {encoding}, background: "#804020"), entities: {{
            "camera": [Camera(position: (0, 0, 1.05), screen_distance: 1)],
            "sky": [AmbientLight(1)],
            "board": [Box(size: (1, 1, 0.1)), ImageTexture("letter.png"), Ambient(1)],
        }})"##
    );
    let mut renderer = Renderer::new();
    renderer.load_text(&text, "tests/golden/textures/scene.ron").expect("a scene");
    renderer
}

#[test]
fn raw_numbers_of_a_texture_come_out_as_they_went_in() {
    let file = image::read(Path::new("tests/golden/textures/letter.png")).expect("a picture").0;
    assert_eq!((file.width, file.height), (8, 8));
    let (mut srgb, mut raw) = (letter("Srgb"), letter("Raw"));
    assert_eq!(srgb8(&drawn(&mut srgb)), srgb8(&file));
    assert_eq!(levels8(&drawn(&mut raw), Encoding::Raw), srgb8(&file));
    assert_ne!(drawn(&mut raw).hash(), drawn(&mut srgb).hash());
}

#[test]
fn a_raw_picture_says_so_in_its_file_and_is_read_as_such() {
    let mut raw = letter("Raw");
    let snapshot = raw.snapshot().expect("a snapshot");
    let frame = render(&snapshot, &Options::default());
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("raw.png");
    let metadata = Metadata::of(&frame, &snapshot.settings, Path::new("scene.ron"));
    image::write(&path, Format::Png16, &frame.picture, &metadata).expect("written");
    let (read, told) = image::read(&path).expect("read");
    assert_eq!(told.encoding(), Encoding::Raw);
    for (a, b) in read.pixels.iter().flatten().zip(frame.picture.pixels.iter().flatten()) {
        assert!((a - b).abs() <= 1.0 / 65_535.0, "{a} and {b}");
    }
}

#[test]
fn colours_in_hexadecimal_are_numbers_as_those_of_images() {
    let background = |encoding: &str| letter(encoding).settings().background;
    let numbers = Rgb::new(128.0, 64.0, 32.0) / 255.0;
    assert_eq!(background("Raw"), numbers);
    assert_eq!(background("Srgb"), Rgb::from_array(numbers.to_array().map(linear_from_srgb)));
}

#[test]
fn textures_follow_a_change_of_what_numbers_mean() {
    let mut renderer = letter("Srgb");
    let before = drawn(&mut renderer).hash();
    renderer.settings().encoding = Encoding::Raw;
    assert_eq!(drawn(&mut renderer).hash(), drawn(&mut letter("Raw")).hash());
    renderer.settings().encoding = Encoding::Srgb;
    assert_eq!(drawn(&mut renderer).hash(), before);
}
