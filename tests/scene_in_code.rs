//! A scene made in code is the scene of the file that says the same.

use snell::{prelude::*, systems::scene::Scene};

const FILE: &str = r##"Scene(
    version: 1,
    settings: (width: 48, height: 32),
    entities: {
        "camera": [Camera(position: (0, 2, 6), target: (0, 1, 0))],
        "sky": [AmbientLight(intensity: 0.3)],
        "sun": [DirectionalLight(direction: (-1, -2, -1))],
        "lamp": [PointLight(position: (3, 5, 4))],
        "ground": [Plane, Checker, Ambient(1), Diffuse(1)],
        "brass": [Color("#e8c27c"), Diffuse(0.7), Mirror(0.25)],
        "table": [Box((2, 0.1, 2)), Transform([Rotate(axis: (0, 1, 0), degrees: 30)])],
        "ball": [Sphere(0.5), Transform([Scale(1.5), Translate((0, 0.8, 0))]), MadeOf("brass"), Parent("table")],
    },
)
"##;

fn in_code() -> Renderer {
    let mut scene = Renderer::new();
    scene.set_size(48, 32);
    scene.add("camera", Camera::at([0.0, 2.0, 6.0]).looking_at([0.0, 1.0, 0.0]));
    scene.add("sky", AmbientLight::grey(0.3));
    scene.add("sun", DirectionalLight::along([-1.0, -2.0, -1.0]));
    scene.add("lamp", PointLight::at([3.0, 5.0, 4.0]));
    scene.add("ground", (Plane {}, Checker::default())).with((Ambient::grey(1.0), Diffuse::grey(1.0)));
    let brass = scene.add("brass", (Color::srgb(0xe8c27c), Diffuse::grey(0.7), Mirror::grey(0.25))).id();
    let table = scene.add("table", Cuboid { size: DVec3::new(2.0, 0.1, 2.0) }).turned(DVec3::Y, 30.0).id();
    scene.add("ball", Sphere { radius: 0.5 }).scaled(1.5).at([0.0, 0.8, 0.0]).made_of(brass).within(table);
    scene
}

#[test]
fn both_give_the_same_bits() {
    let mut file = Renderer::new();
    file.load_text(FILE, "file.ron").expect("sound");
    let draw = |scene: &mut Renderer| render(&scene.snapshot().expect("a scene"), &Options::default()).picture.hash();
    assert_eq!(draw(&mut in_code()), draw(&mut file));
}

#[test]
fn what_is_made_in_code_is_written_as_the_file() {
    let scene = in_code();
    let text = Scene::of(&scene.world).to_text(scene.world.resource()).expect("a scene that a file can say");
    assert_eq!(text, FILE);
}
