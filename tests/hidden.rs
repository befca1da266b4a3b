//! What is hidden is not there for any ray, and is there again afterwards, to the last bit.

use snell::{Options, Renderer, prelude::*, render};

const SCENE: &str = r#"Scene(
    version: 1,
    settings: (width: 40, height: 30),
    entities: {
        "camera": [Camera(position: (0, 1, 6), target: (0, 1, 0))],
        "sky": [AmbientLight(0.2)],
        "lamp": [PointLight(position: (3, 5, 4))],
        "ground": [Plane, Ambient(0.4), Diffuse(0.8), Mirror(0.3)],
        "ball": [Sphere(1), Transform([Translate((0, 1, 0))]), Diffuse(0.8)],
        "moon": [Sphere(0.2), Parent("ball"), Transform([Translate((1.5, 0, 0))]), Diffuse(0.8)],
        "cube": [Box(size: (1, 1, 1)), Transform([Translate((2, 0.5, 0))]), Diffuse(0.5)],
    },
)"#;

fn picture(renderer: &mut Renderer) -> String {
    render(&renderer.snapshot().expect("a snapshot"), &Options::default()).picture.hash()
}

fn loaded(text: &str) -> Renderer {
    let mut renderer = Renderer::new();
    renderer.load_text(text, "scene.ron").expect("a scene");
    renderer
}

/// The scene with another list of components for one entity.
fn with(name: &str, change: impl Fn(&str) -> String) -> String {
    let line = SCENE.lines().find(|line| line.trim_start().starts_with(&format!("{name:?}"))).expect("a line");
    SCENE.replace(line, &change(line))
}

#[test]
fn hidden_shapes_and_lights_are_as_if_they_were_not() {
    for (name, shining) in [
        ("ball", "Sphere(1), "),
        ("cube", "Box(size: (1, 1, 1)), "),
        ("lamp", "PointLight(position: (3, 5, 4))"),
        ("sky", "AmbientLight(0.2)"),
    ] {
        let hidden = with(name, |line| line.replace("],", ", Hidden],"));
        let without = with(name, |line| line.replace(shining, "").replace("[]", "[Transform([])]"));
        assert_eq!(picture(&mut loaded(&hidden)), picture(&mut loaded(&without)), "{name}");
        assert_ne!(picture(&mut loaded(&hidden)), picture(&mut loaded(SCENE)), "{name}");
    }
}

#[test]
fn hiding_and_showing_changes_the_next_picture_and_nothing_else() {
    let mut renderer = loaded(SCENE);
    let whole = picture(&mut renderer);
    let mut names = renderer.world.query::<(Entity, &Name)>();
    let all: Vec<Entity> =
        names.iter(&renderer.world).filter(|(_, name)| name.as_str() != "camera").map(|(entity, _)| entity).collect();
    for entity in all {
        renderer.world.entity_mut(entity).insert(Hidden {});
        assert_ne!(picture(&mut renderer), whole);
        renderer.world.entity_mut(entity).remove::<Hidden>();
        assert_eq!(picture(&mut renderer), whole);
    }
}
