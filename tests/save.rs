//! A scene that is written and read again is the same scene: the same text and, to the last bit, the same picture.

mod support {
    pub(crate) mod cases;
}

use snell::{
    Renderer,
    prelude::*,
    systems::{registry::Registry, save::Unsayable, scene::Scene},
};
use std::path::Path;
use support::cases::{Case, files};

fn loaded(load: impl FnOnce(&mut Renderer) -> Result<Vec<snell::Notice>, snell::Faults>) -> Renderer {
    let mut renderer = Renderer::new();
    if let Err(faults) = load(&mut renderer) {
        panic!("{faults}");
    }
    renderer
}

fn text(renderer: &Renderer) -> Result<String, Unsayable> {
    Scene::of(&renderer.world).to_text(renderer.world.resource::<Registry>())
}

/// The scene in a file, written and read again; checks that it is written the same once more.
fn again(file: &Path) -> Renderer {
    let first = loaded(|renderer| renderer.load(file));
    let written = text(&first).expect("a scene that can be written");
    let second = loaded(|renderer| renderer.load_text(&written, file));
    assert_eq!(text(&second).as_ref(), Ok(&written), "{}", file.display());
    second
}

#[test]
fn every_golden_scene_is_the_same_picture_after_it_was_written_and_read() {
    let cases = Case::all(Path::new("tests/golden")).expect("a folder of cases");
    assert!(!cases.is_empty(), "there are no cases");
    for case in cases {
        let (_, expected) = case.expected().expect("a golden picture");
        let snapshot = again(&case.scene).snapshot().expect("a snapshot");
        assert_eq!(render(&snapshot, &Options::default()).picture.hash(), expected, "{}", case.name);
    }
}

#[test]
fn every_scene_of_the_gallery_can_be_written_and_read() {
    for file in files(Path::new("scenes/gallery"), "ron").expect("a gallery") {
        again(&file);
    }
}

#[test]
fn every_field_of_every_component_is_written() {
    let scene = r##"Scene(version: 1, settings: (width: 33, height: 44, depth: 5, antialias: Four, shadows: false,
        refraction: false, background: "#123456", cutoff: 0.25),
    entities: {
        "eye": [Camera(position: (1, 2, 3), direction: (0, 0, -1), up: (0, 1, 0.5), roll: 7, screen_distance: 1.25)],
        "arm \"of\" steel": [Transform([Translate((1, 2, 3)), Scale(2), Scale((1, 2, 3)), RotateX(1), RotateY(2), RotateZ(3),
            Rotate(axis: (1, 1, 0), degrees: 0.1)])],
        "hand": [Triangle(a: (0, 0, 0), b: (1, 0, 0), c: (0, 1e-7, 0.30000000000000004),
            normals: [(0, 0, 1), (0, 0.1, 1), (0, 0, 1)], uvs: [(0, 0), (1, 0), (0, 1)]),
            Parent("arm \"of\" steel"), MadeOf("stuff")],
        "stuff": [Color((0.1, 0.2, 0.3)), Ambient(0.1), Diffuse((0.1, 0.7, 0.2)), Highlight(strength: 0.2, exponent: 3),
            Mirror(0.1), Transmission(0.2), Refraction(1.3), Opacity(0.5), Absorption(0.3),
            Dispersion(abbe: 20, wavelengths: 3), MediumRank(-2), Checker(even: 0.1, odd: "#ff8000", frequency: 3)],
        "spot": [ConeLight(position: (1, 1, 1), direction: (1, 0, 0), angle: 12, fall_off: Linear, intensity: 2,
            shadows: false)],
        "disk": [DiskLight(position: (1, 1, 1), direction: (1, 0, 0), radius: 0.5, emission: Radiant, error: 0.5,
            samples: 12, intensity: (1, 2, 3), shadows: false)],
    })"##;
    let first = loaded(|renderer| renderer.load_text(scene, "inline.ron"));
    let written = text(&first).expect("a scene that can be written");
    let squeezed = |text: &str| -> String {
        text.replace("steps: ", "").split_whitespace().collect::<String>().replace(",)", ")").replace(",]", "]")
    };
    // Each `name: value` of the scene stands in what is written; none has its default.
    let written = squeezed(&written);
    for field in squeezed(scene).split([',', '(', '[', ')', ']']).filter(|field| field.contains(':')) {
        let name = field.split(':').next().unwrap_or_default();
        assert!(written.contains(&format!("{name}:")), "{field} is lost in {written}");
    }
    for value in ["0.30000000000000004", "1e-7", "\"#123456\"", "\"#ff8000\"", "Rotate(axis:(1,1,0),degrees:0.1)"] {
        assert!(written.contains(value), "{value} is lost in {written}");
    }
    let second = loaded(|renderer| renderer.load_text(&text(&first).expect("again"), "inline.ron"));
    assert_eq!(text(&first), text(&second));
}

#[test]
fn nameless_entities_keep_their_place_in_the_order() {
    let mut renderer = Renderer::new();
    let world = &mut renderer.world;
    world.spawn((Name::new("camera"), Camera { position: DVec3::Z * 5.0, ..Camera::default() }));
    // Two surfaces in one place: the first in the order is seen.
    world.spawn((Sphere { radius: 1.0 }, Color(Rgb::X)));
    world.spawn((Sphere { radius: 1.0 }, Color(Rgb::Y)));
    world.spawn((Name::new("zenith"), AmbientLight::default()));
    let before = render(&renderer.snapshot().expect("a snapshot"), &Options::default()).picture.hash();
    let written = text(&renderer).expect("a scene that can be written");
    let mut second = loaded(|renderer| renderer.load_text(&written, "inline.ron"));
    let after = render(&second.snapshot().expect("a snapshot"), &Options::default()).picture.hash();
    assert_eq!(before, after, "{written}");
}

#[test]
fn what_no_file_can_say_is_told() {
    let mut renderer = Renderer::new();
    let mesh = TriangleMesh::new(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], vec![[0, 1, 2]]).expect("a mesh");
    renderer.world.spawn((
        Name::new("sail"),
        Mesh { model: snell::components::asset::Asset::from_data(mesh), ..Mesh::default() },
    ));
    renderer.world.spawn((Name::new("hole"), Sphere { radius: f64::NAN }));
    let told = text(&renderer).expect_err("two faults").to_string();
    assert!(told.contains("\"sail\": Mesh.model: it was made in memory"), "{told}");
    assert!(told.contains("\"hole\": Sphere.radius: NaN is not a number"), "{told}");
}

#[test]
fn what_can_be_said_is_kept_though_other_things_cannot() {
    let mut renderer = Renderer::new();
    renderer.add("camera", Camera::at([0.0, 0.0, 5.0]));
    let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let model = TriangleMesh::new(corners, vec![[0, 1, 2]]).expect("a mesh");
    renderer.add("made", (Mesh::new(model), Color::srgb(0x4080c0)));
    renderer
        .add("ball", (Sphere { radius: 0.5 }, PointLight { intensity: Rgb::splat(f64::NAN), ..PointLight::default() }));
    renderer.add("ball", Sphere { radius: 9.0 });
    let registry = renderer.world.resource::<Registry>();
    let (kept, lost) = Scene::of(&renderer.world).to_text_in_part(registry);
    let lost = lost.to_string();
    for what in ["\"made\": Mesh.model: it was made in memory", "\"ball\": PointLight.intensity", "\"ball\": names"] {
        assert!(lost.contains(what), "{lost}");
    }
    assert_eq!(lost.lines().count(), 3, "{lost}");
    assert!(text(&renderer).is_err());
    let again = loaded(|renderer| renderer.load_text(&kept, "kept.ron"));
    let expected = [
        r#""camera": [Camera(position: (0, 0, 5))],"#,
        r##""made": [Color("#4080c0")],"##,
        r#""ball": [Sphere(0.5), PointLight(position: (0, 0, 0))],"#,
    ];
    assert!(expected.iter().all(|line| kept.contains(line)) && !kept.contains("Sphere(9)"), "{kept}");
    assert_eq!(text(&again), Ok(kept));
}
