//! The tree of rays of a pixel: it adds up to the picture, and says where everything comes from.

mod support {
    pub(crate) mod desk;
    pub(crate) mod random;
}

use snell::{
    RayTree,
    prelude::*,
    systems::render::{Added, Dropped, Way},
    why,
};
use std::{fs, path::PathBuf};
use support::{desk::Desk, random::Random};

/// Pixels looked at, over all scenes of the gallery.
const PIXELS: usize = 1000;

fn gallery() -> Vec<PathBuf> {
    let entries = fs::read_dir("scenes/gallery").expect("a gallery").map(|entry| entry.expect("an entry").path());
    let mut scenes: Vec<_> = entries.filter(|path| path.extension().is_some_and(|is| is == "ron")).collect();
    scenes.sort();
    assert!(!scenes.is_empty());
    scenes
}

fn bits<const N: usize>(numbers: [f64; N]) -> [u64; N] {
    numbers.map(f64::to_bits)
}

/// Whether all sums of a tree hold, to the last bit.
fn check_sums(tree: &RayTree) {
    assert_eq!(bits(tree.sum().to_array()), bits(tree.light), "samples");
    for sample in &tree.samples {
        assert_eq!(bits(sample.sum().to_array()), bits(sample.light), "contributions");
        for part in sample.contributions.iter().filter(|part| part.what == Added::Surface) {
            let terms = &sample.rays[part.ray].terms;
            let sum = terms.iter().fold(Rgb::ZERO, |sum, term| sum + Rgb::from_array(term.amount));
            assert_eq!(bits(sum.to_array()), bits(part.light), "terms");
            for term in terms.iter().filter(|term| !term.lamps.is_empty()) {
                let sum = term.lamps.iter().fold(Rgb::ZERO, |sum, lamp| sum + Rgb::from_array(lamp.light));
                assert_eq!(bits(sum.to_array()), bits(term.light), "lamps");
            }
        }
    }
}

#[test]
fn the_contributions_of_random_pixels_of_the_gallery_add_up_to_the_film() {
    let mut random = Random::new(7);
    let scenes = gallery();
    for (number, path) in scenes.iter().enumerate() {
        let mut renderer = Renderer::new();
        renderer.load(path).expect("a sound scene");
        let (width, height) = (192, 120);
        (renderer.settings().width, renderer.settings().height) = (width, height);
        let snapshot = renderer.snapshot().expect("a snapshot");
        let film = render(&snapshot, &Options::default()).picture;
        let share = PIXELS.div_ceil(scenes.len()).min(PIXELS - number * PIXELS.div_ceil(scenes.len()));
        for _ in 0..share {
            let (x, y) = (random.below(width as usize) as u32, random.below(height as usize) as u32);
            let tree = why(&snapshot, x, y);
            let summed = tree.sum().as_vec3().to_array();
            let drawn = film.pixel(x, y).expect("a pixel");
            let bits = |pixel: [f32; 3]| pixel.map(f32::to_bits);
            assert_eq!(bits(summed), bits(drawn), "{} {x},{y}", path.display());
            assert_eq!(bits(tree.pixel), bits(drawn), "{} {x},{y}", path.display());
            check_sums(&tree);
        }
    }
}

const ROOM: &str = r#"Scene(
    version: 1,
    settings: (width: 9, height: 9, depth: 2, cutoff: 0.1, background: (0.2, 0.4, 0.6)),
    entities: {
        "eye": [Camera(position: (0, 1, 5))],
        "sun": [DirectionalLight(direction: (0, -1, 0))],
        "side": [PointLight(position: (9, 1, 0), intensity: 0.5)],
        "mirror": [
            Ambient(0.1),
            Diffuse(0.5),
            Mirror(0.5),
        ],
        "base": [MadeOf("mirror")],
        "wall": [
            Plane(), Transform([RotateX(90)]),
            Like("base"),
        ],
        "roof": [Box(size: (2, 0.1, 2)), Transform([Translate((0, 3, 0.5))])],
        "film": [Plane(), Transform([RotateX(90), Translate((0, 0, 4.9))]), Transmission(0.05), Diffuse(0)],
    },
)"#;

/// The tree of the middle of [`ROOM`], or of a change of it.
fn middle(scene: &str) -> RayTree {
    let mut renderer = Renderer::new();
    if let Err(faults) = renderer.load_text(scene, "room.ron") {
        panic!("{faults}");
    }
    let mut tree = why(&renderer.snapshot().expect("a snapshot"), 4, 4);
    tree.locate(&mut renderer.world);
    tree
}

#[test]
fn a_tree_names_what_the_rays_meet_and_the_lines_that_say_so() {
    let tree = middle(&ROOM.replace(r#""film": ["#, r#""film": [Opacity(0),"#));
    check_sums(&tree);
    let [sample] = tree.samples.as_slice() else { panic!("one ray through the pixel") };
    let [through, wall, ..] = sample.rays.as_slice() else { panic!("the film and the wall") };
    assert_eq!((through.start.way, through.start.parent), (Way::Camera, None));
    assert_eq!((wall.start.way, wall.start.parent, wall.depth), (Way::Transmitted, Some(0), 1));
    let line = |thing: &snell::systems::why::Thing| thing.line.as_ref().map(ToString::to_string);
    let effect = wall.start.effect.as_ref().expect("what let it through");
    assert_eq!((effect.component, line(effect)), (Some("Opacity"), Some("room.ron:19".into())));
    let met = wall.met.as_ref().expect("the wall");
    assert_eq!((met.object.name.as_deref(), line(&met.object)), (Some("wall"), Some("room.ron:14".into())));
    assert_eq!((met.material.name.as_deref(), line(&met.material)), (Some("mirror"), Some("room.ron:8".into())));
    assert!((met.distance - 4.9).abs() < 1e-6 && met.from_outside, "{met:?}");
    let [ambient, diffuse] = wall.terms.as_slice() else { panic!("two terms") };
    assert_eq!((ambient.effect.component, line(&ambient.effect)), (Some("Ambient"), Some("room.ron:9".into())));
    assert_eq!((diffuse.effect.component, line(&diffuse.effect)), (Some("Diffuse"), Some("room.ron:10".into())));
    // The side light grazes the wall, the sun is parallel to it.
    let [side, sun] = diffuse.lamps.as_slice() else { panic!("two lamps") };
    assert_eq!((side.lamp.name.as_deref(), sun.lamp.name.as_deref()), (Some("side"), Some("sun")));
    assert_eq!(sun.visible, None, "the sun does not reach the wall");
    assert_eq!(sun.facing_away, 1);
    assert_eq!(line(&sun.lamp), Some("room.ron:6".into()));
    let mirrored = sample.rays.iter().find(|ray| ray.start.way == Way::Mirrored).expect("a mirrored ray");
    let effect = mirrored.start.effect.as_ref().expect("what mirrored it");
    assert_eq!((effect.component, line(effect)), (Some("Mirror"), Some("room.ron:11".into())));
}

#[test]
fn a_tree_tells_what_was_cut_and_what_was_too_deep() {
    // The film lets through less than the cut-off.
    let tree = middle(&ROOM.replace("cutoff: 0.1", "cutoff: 0.2"));
    let [ray] = tree.samples[0].rays.as_slice() else { panic!("nothing behind the film is followed") };
    let [dropped] = ray.dropped.as_slice() else { panic!("one ray") };
    assert_eq!((dropped.why, dropped.start.share), (Dropped::Cut, [0.05; 3]));

    let tree = middle(&ROOM.replace("depth: 2", "depth: 0"));
    let sample = &tree.samples[0];
    assert_eq!(sample.rays[0].dropped[0].why, Dropped::TooDeep);
    let last = sample.contributions.last().expect("a contribution");
    // The mean of the background's channels.
    assert_eq!(last.what, Added::BeyondDepth);
    assert_eq!(bits(last.light), bits([(0.2 + 0.4 + 0.6) / 3.0; 3]));
    check_sums(&tree);
}

#[test]
fn what_hides_a_light_is_named() {
    let scene = ROOM.replace("RotateX(90)]),\n            Like", "Translate((0, -1, 0))]),\n            Like");
    let scene = scene.replace("position: (0, 1, 5)", "position: (0, 3.5, 4), target: (0, -1, 0.5)");
    let scene =
        scene.replace(r#""film""#, "\"pane\": [Plane(), Transform([Translate((0, 2, 0))]), Opacity(0.25)],\n\"film\"");
    let tree = middle(&scene);
    let rays = &tree.samples[0].rays;
    let floor = rays.iter().find(|ray| ray.met.as_ref().is_some_and(|met| met.object.name.as_deref() == Some("wall")));
    let lamps = &floor.expect("the floor").terms[1].lamps;
    let sun = lamps.iter().find(|lamp| lamp.lamp.name.as_deref() == Some("sun")).expect("the sun");
    let names: Vec<_> = sun.in_the_way.iter().filter_map(|thing| thing.name.as_deref()).collect();
    assert_eq!(names, ["pane", "roof"]);
    assert_eq!((sun.visible, sun.hidden, sun.light), (Some([0.0; 3]), 1, [0.0; 3]));
}

#[test]
fn colours_are_shown_as_the_scenes_encoding_has_them() {
    let half = r#"(version: 1, settings: (width: 1, height: 1, background: 0.5, encoding: ENCODING), entities: {
        "camera": [Camera(position: (0, 0, 0))]})"#;
    for (encoding, level) in [("Srgb", "bc"), ("Raw", "80")] {
        let mut renderer = Renderer::new();
        renderer.load_text(&half.replace("ENCODING", encoding), "half.ron").expect("sound");
        let tree = why(&renderer.snapshot().expect("a scene"), 0, 0);
        let hex = format!("#{level}{level}{level}");
        assert!(tree.to_string().contains(&format!("shown as {hex}")), "{tree}");
        assert!(tree.svg().contains(&hex), "{}", tree.svg());
        assert_eq!(serde_json::to_value(&tree).expect("JSON")["encoding"], encoding);
    }
}

#[test]
fn the_command_prints_text_json_and_a_drawing() {
    let desk = Desk::new();
    desk.put("room.ron", ROOM);
    let (code, out, err) = desk.run("why room.ron 4 4");
    assert_eq!((code, err.as_str()), (0, ""));
    assert!(out.starts_with("pixel 4,4 of 9x9: linear light ("), "{out}");
    assert!(out.contains("meets `film` (room.ron:19) from outside"), "{out}");

    let (code, out, err) = desk.run("why room.ron 4 4 --json --svg tree.svg --size 64x64");
    assert_eq!((code, err.as_str()), (0, ""));
    let tree: serde_json::Value = serde_json::from_str(&out).expect("JSON");
    assert_eq!(tree["width"], 64);
    assert_eq!(tree["samples"][0]["rays"][0]["way"], "Camera");
    let svg = fs::read_to_string(desk.path("tree.svg")).expect("a drawing");
    assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>") && svg.contains("Pixel 4, 4"), "{svg}");

    let (code, out, err) = desk.run("why room.ron 9 0");
    assert_eq!((code, out.as_str()), (2, ""));
    assert!(err.contains("the pixel 9, 0 lies outside the picture of 9x9 pixels"), "{err}");
}
