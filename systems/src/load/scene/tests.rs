//! Scenes, bad and good.

use super::*;
use crate::registry::Kind;
use bevy_ecs::system::RunSystemOnce;
use glam::DVec3;
use snell_components::{
    camera::Camera,
    color::linear_from_srgb,
    light::{AmbientLight, DirectionalLight, PointLight},
    material::{
        Ambient, Color, Dielectric, Diffuse, Highlight, MadeOf, MaterialSlots, Mirror, Opacity, Refraction,
        Transmission,
    },
    name::Name,
    shape::{Cuboid, Mesh, Plane, Sphere, Triangle},
    texture::{Checker, ImageTexture},
    transform::{Step, Transform},
};
use std::{collections::BTreeMap, fs, sync::Arc};

/// A world in which all built-in components are known.
fn world() -> World {
    let mut registry = Registry::default();
    registry.register::<Sphere>(Kind::Shape);
    registry.register::<Plane>(Kind::Shape);
    registry.register::<Cuboid>(Kind::Shape);
    registry.register::<Triangle>(Kind::Shape);
    registry.register::<Mesh>(Kind::Shape);
    registry.register::<AmbientLight>(Kind::Light);
    registry.register::<PointLight>(Kind::Light);
    registry.register::<DirectionalLight>(Kind::Light);
    registry.register::<ImageTexture>(Kind::Texture);
    registry.register::<Checker>(Kind::Texture);
    registry.register::<Color>(Kind::Effect);
    registry.register::<Ambient>(Kind::Effect);
    registry.register::<Diffuse>(Kind::Effect);
    registry.register::<Highlight>(Kind::Effect);
    registry.register::<Mirror>(Kind::Effect);
    registry.register::<Transmission>(Kind::Effect);
    registry.register::<Refraction>(Kind::Effect);
    registry.register::<Dielectric>(Kind::Effect);
    registry.register::<Opacity>(Kind::Effect);
    registry.register::<Camera>(Kind::Camera);
    registry.register::<Transform>(Kind::Placement);
    let mut world = World::new();
    world.insert_resource(registry);
    world
}

/// A folder with files that scenes refer to.
fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a parent")).expect("a folder");
        fs::write(path, text).expect("a file");
    }
    folder
}

/// The entities of a world by name.
fn entities(world: &mut World) -> BTreeMap<String, Entity> {
    let mut query = world.query::<(&Name, Entity)>();
    query.iter(world).map(|(name, entity)| (name.to_string(), entity)).collect()
}

/// The world of a scene that is sound.
fn good(text: &str) -> World {
    let mut world = world();
    read_scene_text(&mut world, text, Path::new("scene.ron")).unwrap_or_else(|faults| panic!("{text}\n{faults}"));
    world
}

/// The world of a scene whose entities are sound.
fn with(entities: &str) -> World {
    good(&format!("Scene(version: 1, entities: {{ {entities} }})"))
}

fn get<C: Component + Clone>(world: &mut World, name: &str) -> C {
    let entity = entities(world).get(name).copied().unwrap_or_else(|| panic!("no {name}"));
    world.get::<C>(entity).unwrap_or_else(|| panic!("{name}: no such component")).clone()
}

fn has<C: Component>(world: &mut World, name: &str) -> bool {
    let entity = entities(world)[name];
    world.get::<C>(entity).is_some()
}

/// The faults of a scene, one a line.
fn faults(text: &str) -> String {
    let mut world = world();
    let before = world.run_system_once(|all: Query<Entity>| all.iter().count()).expect("a count");
    let result = read_scene_text(&mut world, text, Path::new("bad.ron"));
    let Err(faults) = result else { panic!("no fault in {text}") };
    let after = world.run_system_once(|all: Query<Entity>| all.iter().count()).expect("a count");
    assert_eq!((before, world.contains_resource::<Settings>()), (after, false), "the world was changed by {text}");
    faults.to_string()
}

/// Faults of whole texts.
const BAD_SCENES: &[(&str, &str)] = &[
    ("", "bad.ron:1:1: x"),
    ("Scene(version: 1", "x"),
    ("Scene(version: 1, entities: {\"a\": [Sphere(radius: 1]})", "x"),
    ("Scene(version: 1 entities: {})", "x"),
    ("Scene(version: 1, entities: {\"a\" [Sphere(radius: 1)]})", "x"),
    ("Scene(version: 1) 5", "x"),
    ("Scene(version: 1, /* entities: {})", "x"),
    ("Scene(version: 1, include: [\"a\\q\"])", "x"),
    ("Scene(version: 1, include: [\"a])", "x"),
    ("Scene(version: 1, include: [,])", "x"),
    ("Scena(version: 1)", "x"),
    ("[1, 2]", "x"),
    ("Scene(entities: {})", "x"),
    ("Scene(version: 2, entitis: {})", "x"),
    ("Scene(version: 0)", "x"),
    ("Scene(version: \"1\")", "x"),
    ("Scene(version: 1, entitis: {}, colour: 1)", "x"),
    ("Scene(version: 1, version: 1)", "x"),
    ("Scene(version: 1, settings: 5, include: 6, entities: [])", "x"),
    ("Scene(version: 1, settings: (width: 0, height: 70000, depth: 1.5, antialias: Fuor, shadows: yes))", "x"),
    ("Scene(version: 1, settings: (widht: 5, background: (1, 2), cutoff: -1, depth: -1))", "x"),
    ("Scene(version: 1, settings: (width: 5000000000, antialias: \"Four\", gamma: 2))", "x"),
    ("Scene(version: 1, include: [5, (path: 5), (prefix: \"a\"), (path: \"a\", transform: []), (pth: \"a\")])", "x"),
    ("Scene(version: 1, include: [\"nowhere.ron\"])", "x"),
    ("Scene(version: 1, entities: {5: [], \"\": [], \"a#b\": [], \"c\": 5, \"d\": [5]})", "x"),
    ("Scene(\n  version: 1,\n  entities: {\n    \"ä\": [], \"ö\": [],\n    \"ö\": [],\n  },\n)", "x"),
];

/// Faults of entities: line 1 holds the list `entities: {`, so they start in line 2.
const BAD_ENTITIES: &[(&str, &str)] = &[
    // Components.
    ("\"a\": [Shpere(radius: 1)],", "x"),
    ("\"a\": [Torus],", "x"),
    ("\"a\": [Sphere],", "x"),
    ("\"a\": [Sphere()],", "x"),
    ("\"a\": [Sphere(raduis: 1)],", "x"),
    ("\"a\": [Sphere(radius: 1, colour: 2)],", "x"),
    ("\"a\": [Sphere(radius: 1, radius: 2)],", "x"),
    ("\"a\": [Sphere(radius: 1), Sphere(radius: 2)],", "x"),
    ("\"a\": [Sphere(radius: 1), Box(size: (1, 1, 1))],", "x"),
    ("\"a\": [Checker(), ImageTexture(\"a.png\")],", "x"),
    ("\"a\": [Mirror(1), Dielectric(1.5)],", "x"),
    ("\"a\": [MadeOf(\"b\"), Diffuse(1)], \"b\": [Diffuse(1)],", "x"),
    ("\"a\": [Highlight(5)],", "x"),
    ("\"a\": [5, \"b\", [Sphere]],", "x"),
    // Numbers.
    ("\"a\": [Sphere(radius: -1)],", "x"),
    ("\"a\": [Sphere(radius: 0)],", "x"),
    ("\"a\": [Sphere(radius: \"1\")],", "x"),
    ("\"a\": [Sphere(radius: NaN)],", "x"),
    ("\"a\": [Sphere(radius: -inf)],", "x"),
    ("\"a\": [Sphere(radius: 1e39)],", "x"),
    ("\"a\": [Sphere(radius: 1e999)],", "x"),
    ("\"a\": [Sphere(radius: 0x10)],", "x"),
    ("\"a\": [Sphere(radius: big)],", "x"),
    ("\"a\": [Mirror(1.5), Transmission((0, 2, -1))],", "x"),
    // Vectors.
    ("\"a\": [Box(size: (1, 0, -1))],", "x"),
    ("\"a\": [Box(size: (1, 2))],", "x"),
    ("\"a\": [Box(size: 5)],", "x"),
    ("\"a\": [DirectionalLight(direction: (0, 0, 0))],", "x"),
    ("\"a\": [DirectionalLight(direction: (1e-200, 0, 0))],", "x"),
    ("\"a\": [PointLight(position: (0, inf, 0))],", "x"),
    ("\"a\": [Triangle(a: (0,0,0), b: (1,0,0), c: (0,1,0), normals: [(0,0,0), 5], uvs: [(0,0,0)])],", "x"),
    ("\"a\": [Triangle(a: (0,0,0), b: (1,0,0), c: (0,1,0), normals: [(0,0,1)])],", "x"),
    // Colours and choices.
    ("\"a\": [Color(\"#ff80\")],", "x"),
    ("\"a\": [Color(\"red\"), Diffuse(-1), Ambient((1, 2))],", "x"),
    ("\"a\": [Camera(position: (0, 0, 0), target: (0, 0, 0))],", "x"),
    ("\"a\": [Camera(position: (0, 0, 0), target: (0, 0, 1), direction: (0, 0, 1))],", "x"),
    ("\"a\": [Camera(position: (0, 0, 0), field_of_view: 180)],", "x"),
    // Placement.
    ("\"a\": [Transform([Translat((1, 0, 0)), Skew(1), 5])],", "x"),
    ("\"a\": [Transform([RotateX((1, 0, 0)), Scale(NaN), Translate(1), RotateY, Scale()])],", "x"),
    ("\"a\": [Transform([Rotate(axis: (0, 0, 0)), Rotate(30), Rotate(axs: (0, 1, 0), degrees: 1)])],", "x"),
    ("\"a\": [Transform(Translate((1, 0, 0)))],", "x"),
    ("\"a\": [Transform([Scale((1, 0, 1))])],", "x"),
    ("\"a\": [Transform([Scale(1e-60)])], \"b\": [Transform([Scale(1e-60)]), Parent(\"a\")],", "x"),
    // Files.
    ("\"a\": [Mesh(model: \"nowhere.obj\"), ImageTexture(5)],", "x"),
    ("\"a\": [Mesh(model: \"\", shading: Smoth)],", "x"),
    // References.
    ("\"ball\": [MadeOf(\"glas\")], \"glass\": [Dielectric(1.5)],", "x"),
    ("\"a\": [MadeOf(glass), Parent(), Like(5)],", "x"),
    ("\"a\": [MadeOf(\"b\")], \"b\": [Sphere(radius: 1)],", "x"),
    ("\"a\": [Like(\"b\")],\n\"b\": [Like(\"c\")],\n\"c\": [Like(\"b\")],", "x"),
    ("\"a\": [Parent(\"a\")],", "x"),
    ("\"c\": [Parent(\"b\")], \"b\": [Parent(\"a\")], \"a\": [Parent(\"c\")],", "x"),
    // Several at once.
    ("\"a\": [Sphere(radius: -1), Colour(1)],\n\"b\": [Diffuse(NaN), Parent(\"d\")],\n\"b\": [],", "x"),
];

#[test]
fn print() {
    for (text, _) in BAD_SCENES {
        println!("{text}\n=> {}", faults(text));
    }
    for (text, _) in BAD_ENTITIES {
        println!("{text}\n=> {}", faults(&format!("Scene(version: 1, entities: {{\n{text}\n}})")));
    }
}
