//! Scenes, bad and good.

use super::*;
use crate::pipeline::Renderer;
use bevy_ecs::system::RunSystemOnce;
use glam::DVec3;
use snell_components::{
    camera::Camera,
    color::linear_from_srgb,
    material::{Ambient, Color, Dielectric, Diffuse, MadeOf, MaterialSlots, Mirror},
    name::Name,
    shape::{Cuboid, Mesh, Sphere, Triangle},
    texture::{Checker, ImageTexture},
    transform::{Step, Transform},
};
use std::{collections::BTreeMap, fs, sync::Arc};

/// A world in which all built-in components are known.
fn world() -> World {
    let registry = Renderer::new().world.remove_resource::<Registry>().expect("a registry");
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

/// A model with two materials.
const MODEL: &str =
    "mtllib model.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\nf 1 2 3\nusemtl glass\nf 1 2 4\n";

/// Its `model.mtl`.
const MATERIALS: &str = "newmtl red\nKd 0.8 0 0\nnewmtl glass\nKd 0.1 0.1 0.1\nKs 0.5 0.5 0.5\nNs 100\nd 0.5\n";

/// An image of one grey texel.
fn save_image(path: &Path) {
    image::RgbImage::from_pixel(1, 1, image::Rgb([128; 3])).save(path).expect("an image");
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

/// A scene and its faults, each as it is shown behind the file's name.
type Bad = (&'static str, &'static [&'static str]);

/// Faults of whole texts.
const BAD_SCENES: &[Bad] = &[
    // Syntax.
    ("", &["1:1: expected `Scene(version: 1, …)`, found an empty file"]),
    ("Scene(version: 1", &["1:17: the file ends before the scene does: a bracket is not closed"]),
    (
        r#"Scene(version: 1, entities: {"a": [Sphere(radius: 1]})"#,
        &["1:52: expected a comma or a closing bracket, found `]`"],
    ),
    ("Scene(version: 1 entities: {})", &["1:18: expected a comma or a closing bracket, found `e`"]),
    (r#"Scene(version: 1, entities: {"a" [Sphere(radius: 1)]})"#, &["1:34: expected a colon, found `[`"]),
    ("Scene(version: 1) 5", &["1:18: expected the end of the file: the scene is complete before this"]),
    ("Scene(version: 1, /* entities: {})", &["1:21: this comment is not closed: `*/` is missing"]),
    (r#"Scene(version: 1, include: ["a\q"])"#, &["1:30: unknown escape character"]),
    (r#"Scene(version: 1, include: ["a])"#, &[r#"1:29: this text is not closed: `"` is missing"#]),
    ("Scene(version: 1, include: [,])", &["1:29: expected a value, found `,`"]),
    // Structure.
    ("Scena(version: 1)", &["1:1: expected `Scene(version: 1, …)`, found `Scena`; did you mean `Scene`?"]),
    ("[1, 2]", &["1:1: expected `Scene(version: 1, …)`, found `[1, 2]`"]),
    ("Scene(entities: {})", &["1:1: Scene: missing field `version`: write `version: 1`"]),
    (
        "Scene(version: 2, entitis: {})",
        &["1:16: version: this scene is of version 2; this program reads version 1: update it"],
    ),
    ("Scene(version: 0)", &["1:16: version: expected `1`, found `0`"]),
    (r#"Scene(version: "1")"#, &[r#"1:16: version: expected `1`, found `"1"`"#]),
    (
        "Scene(version: 1, entitis: {}, colour: 1)",
        &[
            "1:19: Scene: unknown field `entitis`; did you mean `entities`? Fields are `version`, `settings`, `include` and `entities`",
            "1:32: Scene: unknown field `colour`; fields are `version`, `settings`, `include` and `entities`",
        ],
    ),
    ("Scene(version: 1, version: 1)", &["1:19: Scene: field `version` is given twice"]),
    (
        "Scene(version: 1, settings: 5, include: 6, entities: [])",
        &[
            "1:29: settings: expected `(width: …, height: …)`, found `5`",
            r#"1:41: include: expected a list of files `["…"]`, found `6`"#,
            r#"1:54: entities: expected entities by name `{"name": [ … ]}`, found `[]`"#,
        ],
    ),
    (
        "Scene(version: 1, settings: (width: 0, height: 70000, depth: 1.5, antialias: Fuor, shadows: yes))",
        &[
            "1:37: settings.width: expected a whole number from 1 to 65536, found `0`",
            "1:48: settings.height: expected a whole number from 1 to 65536, found `70000`",
            "1:62: settings.depth: expected a whole number from 0 to 100000, found `1.5`",
            "1:78: settings.antialias: expected `Off`, `Four`, `Grid` or `Adaptive`, found `Fuor`; did you mean `Four`?",
            "1:93: settings.shadows: expected `true` or `false`, found `yes`",
        ],
    ),
    (
        "Scene(version: 1, settings: (widht: 5, background: (1, 2), cutoff: -1, depth: -1))",
        &[
            "1:30: settings: unknown field `widht`; did you mean `width`? Fields are `width`, `height`, `depth`, `antialias`, `grid`, `subdivisions`, `contrast`, `shadows`, `refraction`, `background`, `cutoff`, `error`, `encoding`, `transform` and `transform_lights`",
            r##"1:52: settings.background: expected a colour: one number, three numbers or "#rrggbb", each of at least 0, found `(1, 2)`"##,
            "1:68: settings.cutoff: expected a number from 0 to 1, found `-1`",
            "1:79: settings.depth: expected a whole number from 0 to 100000, found `-1`",
        ],
    ),
    (
        r#"Scene(version: 1, settings: (width: 5000000000, antialias: "Four", gamma: 2))"#,
        &[
            "1:37: settings.width: expected a whole number from 1 to 65536, found `5000000000`",
            r#"1:60: settings.antialias: expected `Off`, `Four`, `Grid` or `Adaptive`, found `"Four"`"#,
            "1:68: settings: unknown field `gamma`; fields are `width`, `height`, `depth`, `antialias`, `grid`, `subdivisions`, `contrast`, `shadows`, `refraction`, `background`, `cutoff`, `error`, `encoding`, `transform` and `transform_lights`",
        ],
    ),
    (
        r#"Scene(version: 1, include: [5, (path: 5), (prefix: "a"), (path: "a", transform: []), (pth: "a")])"#,
        &[
            r#"1:29: include: expected a path in quotes or `(path: "…", prefix: "…", transform: […])`, found `5`"#,
            "1:39: include.path: expected a text in quotes, found `5`",
            "1:43: include: missing field `path` (the file)",
            "1:81: include.transform: a file that is placed needs a `prefix` too, which names its placement",
            "1:87: include: unknown field `pth`; did you mean `path`? Fields are `path`, `prefix` and `transform`",
        ],
    ),
    (r#"Scene(version: 1, include: ["nowhere.ron"])"#, &["1:29: include: cannot read `nowhere.ron`: no such file"]),
    (
        r#"Scene(version: 1, entities: {5: [], "": [], "a#b": [], "c": 5, "d": [5]})"#,
        &[
            "1:30: entities: expected a name in quotes, found `5`",
            "1:37: entities: a name needs at least one character",
            r#"1:45: "a#b": `#` is kept for the names of models' materials"#,
            r#"1:61: "c": expected a list of components `[ … ]`, found `5`"#,
            r#"1:70: "d": expected a component, as `Sphere(radius: 1)`, found `5`"#,
        ],
    ),
    (
        r#"Scene(
  version: 1,
  entities: {
    "ä": [], "ö": [],
    "ö": [],
  },
)"#,
        &[r#"5:5: "ö": the name is taken: it is first given in line 4"#],
    ),
];

/// Faults of entities; they start in line 2 of a scene that has nothing else.
const BAD_ENTITIES: &[Bad] = &[
    // Components.
    (r#""a": [Shpere(radius: 1)],"#, &[r#"2:7: "a": unknown component `Shpere`; did you mean `Sphere`?"#]),
    (r#""a": [Torus],"#, &[r#"2:7: "a": unknown component `Torus`; known are {known}"#]),
    (r#""a": [Sphere],"#, &[r#"2:7: "a": Sphere: missing field `radius` (radius, object units)"#]),
    (r#""a": [Sphere()],"#, &[r#"2:7: "a": Sphere: missing field `radius` (radius, object units)"#]),
    (
        r#""a": [Sphere(raduis: 1)],"#,
        &[r#"2:14: "a": Sphere: unknown field `raduis`; did you mean `radius`? The only field is `radius`"#],
    ),
    (
        r#""a": [Sphere(radius: 1, colour: 2)],"#,
        &[r#"2:25: "a": Sphere: unknown field `colour`; the only field is `radius`"#],
    ),
    (r#""a": [Sphere(radius: 1, radius: 2)],"#, &[r#"2:25: "a": Sphere: field `radius` is given twice"#]),
    (r#""a": [Sphere(radius: 1), Sphere(radius: 2)],"#, &[r#"2:26: "a": `Sphere` is given twice, first in line 2"#]),
    (
        r#""a": [Sphere(radius: 1), Box(size: (1, 1, 1))],"#,
        &[r#"2:26: "a": `Box` beside `Sphere`: an entity has one shape at most"#],
    ),
    (
        r#""a": [Checker(), ImageTexture("a.png")],"#,
        &[
            r#"2:18: "a": `ImageTexture` beside `Checker`: an entity has one texture at most"#,
            r#"2:31: "a": ImageTexture.image: cannot read `a.png`: no such file"#,
        ],
    ),
    (
        r#""a": [Mirror(1), Dielectric(1.5)],"#,
        &[
            r#"2:18: "a": `Dielectric` beside `Mirror`: `Dielectric` takes the place of `Mirror`, `Transmission` and `Refraction`"#,
        ],
    ),
    (
        r#""a": [MadeOf("b"), Diffuse(1)], "b": [Diffuse(1)],"#,
        &[r#"2:20: "a": `Diffuse` beside `MadeOf`: an entity has a material of its own or that of another, not both"#],
    ),
    (
        r#""a": [MadeOf("b"), Absorption(1)], "b": [Diffuse(1)],"#,
        &[
            r#"2:20: "a": `Absorption` beside `MadeOf`: an entity has a material of its own or that of another, not both"#,
        ],
    ),
    (
        r#""a": [Diffuse(1), Dispersion],"#,
        &[r#"2:19: "a": Dispersion: expected `Refraction` or `Dielectric` beside it"#],
    ),
    (r#""a": [Checker(5)],"#, &[r#"2:7: "a": Checker: expected its fields by name, as `even: …`"#]),
    (
        r#""a": [5, "b", [Sphere]],"#,
        &[
            r#"2:7: "a": expected a component, as `Sphere(radius: 1)`, found `5`"#,
            r#"2:10: "a": expected a component, as `Sphere(radius: 1)`, found `"b"`"#,
            r#"2:15: "a": expected a component, as `Sphere(radius: 1)`, found `[Sphere]`"#,
        ],
    ),
    (
        r#""a": [Plane(1), Diffuse],"#,
        &[
            r#"2:7: "a": Plane: expected no fields"#,
            r#"2:17: "a": Diffuse: missing field `strength` (share of the light scattered evenly)"#,
        ],
    ),
    (r#""a": [Plane(size: 1)],"#, &[r#"2:13: "a": Plane: unknown field `size`; there are none"#]),
    // Numbers.
    (r#""a": [Sphere(radius: -1)],"#, &[r#"2:22: "a": Sphere.radius: expected a number above 0, found `-1`"#]),
    (r#""a": [Sphere(radius: 0)],"#, &[r#"2:22: "a": Sphere.radius: expected a number above 0, found `0`"#]),
    (r#""a": [Sphere(radius: "1")],"#, &[r#"2:22: "a": Sphere.radius: expected a number above 0, found `"1"`"#]),
    (
        r#""a": [Sphere(radius: NaN)],"#,
        &[r#"2:22: "a": Sphere.radius: expected a finite number, at most 3.4e38 in size, found `NaN`"#],
    ),
    (
        r#""a": [Sphere(radius: -inf)],"#,
        &[r#"2:22: "a": Sphere.radius: expected a finite number, at most 3.4e38 in size, found `-inf`"#],
    ),
    (
        r#""a": [Sphere(radius: 1e39)],"#,
        &[r#"2:22: "a": Sphere.radius: expected a finite number, at most 3.4e38 in size, found `1e39`"#],
    ),
    (
        r#""a": [Sphere(radius: 1e999)],"#,
        &[r#"2:22: "a": Sphere.radius: expected a finite number, at most 3.4e38 in size, found `1e999`"#],
    ),
    (r#""a": [Sphere(radius: 0x10)],"#, &[r#"2:22: "a": Sphere.radius: expected a number above 0, found `0x10`"#]),
    (r#""a": [Sphere(radius: big)],"#, &[r#"2:22: "a": Sphere.radius: expected a number above 0, found `big`"#]),
    (
        r#""a": [Mirror(1.5), Transmission((0, 2, -1))],"#,
        &[
            r#"2:14: "a": Mirror.strength: expected a number from 0 to 1, found `1.5`"#,
            r#"2:37: "a": Transmission.strength: expected a number from 0 to 1, found `2`"#,
            r#"2:40: "a": Transmission.strength: expected a number from 0 to 1, found `-1`"#,
        ],
    ),
    // Vectors.
    (
        r#""a": [Box(size: (1, 0, -1))],"#,
        &[
            r#"2:21: "a": Box.size: expected a number above 0, found `0`"#,
            r#"2:24: "a": Box.size: expected a number above 0, found `-1`"#,
        ],
    ),
    (
        r#""a": [Box(size: (1, 2))],"#,
        &[r#"2:17: "a": Box.size: expected three numbers `(x, y, z)`, each above 0, found `(1, 2)`"#],
    ),
    (
        r#""a": [Box(size: 5)],"#,
        &[r#"2:17: "a": Box.size: expected three numbers `(x, y, z)`, each above 0, found `5`"#],
    ),
    (
        r#""a": [DirectionalLight(direction: (0, 0, 0))],"#,
        &[r#"2:35: "a": DirectionalLight.direction: expected a vector with a direction, found `(0, 0, 0)`"#],
    ),
    (
        r#""a": [DirectionalLight(direction: (1e-200, 0, 0))],"#,
        &[r#"2:35: "a": DirectionalLight.direction: expected a vector with a direction, found `(1e-200, 0, 0)`"#],
    ),
    (
        r#""a": [PointLight(position: (0, inf, 0))],"#,
        &[r#"2:32: "a": PointLight.position: expected a finite number, at most 3.4e38 in size, found `inf`"#],
    ),
    (
        r#""a": [Triangle(a: (0,0,0), b: (1,0,0), c: (0,1,0), normals: [(0,0,0), 5], uvs: [(0,0,0)])],"#,
        &[
            r#"2:62: "a": Triangle.normals: expected a vector with a direction, found `(0,0,0)`"#,
            r#"2:71: "a": Triangle.normals: expected three numbers `(x, y, z)`, found `5`"#,
            r#"2:81: "a": Triangle.uvs: expected two numbers `(u, v)`, found `(0,0,0)`"#,
        ],
    ),
    (
        r#""a": [Triangle(a: (0,0,0), b: (1,0,0), c: (0,1,0), normals: [(0,0,1)])],"#,
        &[r#"2:61: "a": Triangle.normals: expected three entries or none, found 1"#],
    ),
    // Colours.
    (
        r##""a": [Color("#ff80")],"##,
        &[r##"2:13: "a": Color.color: expected an sRGB colour "#rrggbb" or "#rgb", found `"#ff80"`"##],
    ),
    (
        r#""a": [Color("red"), Diffuse(-1), Ambient((1, 2))],"#,
        &[
            r##"2:13: "a": Color.color: expected an sRGB colour "#rrggbb" or "#rgb", found `"red"`"##,
            r#"2:29: "a": Diffuse.strength: expected a number of at least 0, found `-1`"#,
            r##"2:42: "a": Ambient.strength: expected a colour: one number, three numbers or "#rrggbb", each of at least 0, found `(1, 2)`"##,
        ],
    ),
    // What no single field shows.
    (
        r#""a": [Camera(position: (0, 0, 0), target: (0, 0, 0))],"#,
        &[r#"2:43: "a": Camera.target: expected a point other than `position`"#],
    ),
    (
        r#""a": [Camera(position: (0, 0, 0), target: (0, 0, 1), direction: (0, 0, 1))],"#,
        &[r#"2:65: "a": Camera.direction: expected either `target` or `direction`, not both"#],
    ),
    (
        r#""a": [Camera(position: (0, 0, 0), field_of_view: 180)],"#,
        &[r#"2:50: "a": Camera.field_of_view: expected a number above 0 and up to 179.9, found `180`"#],
    ),
    // Placement.
    (
        r#""a": [Transform([Translat((1, 0, 0)), Skew(1), 5])],"#,
        &[
            r#"2:18: "a": Transform.steps: unknown step `Translat`; did you mean `Translate`?"#,
            r#"2:39: "a": Transform.steps: unknown step `Skew`; steps: `Translate`, `Scale`, `RotateX`, `RotateY`, `RotateZ` and `Rotate`"#,
            r#"2:48: "a": Transform.steps: expected a step, as `Translate((x, y, z))`, found `5`"#,
        ],
    ),
    (
        r#""a": [Transform([RotateX((1, 0, 0)), Scale(NaN), Translate(1), RotateY, Scale()])],"#,
        &[
            r#"2:26: "a": Transform.steps: expected a number, found `(1, 0, 0)`"#,
            r#"2:44: "a": Transform.steps: expected a finite number, at most 3.4e38 in size, found `NaN`"#,
            r#"2:60: "a": Transform.steps: expected three numbers `(x, y, z)`, found `1`"#,
            r#"2:64: "a": Transform.steps: expected `RotateY(degrees)`, found `RotateY`"#,
            r#"2:73: "a": Transform.steps: expected `Scale((x, y, z))`, found `Scale()`"#,
        ],
    ),
    (
        r#""a": [Transform([Rotate(axis: (0, 0, 0)), Rotate(30), Rotate(axs: (0, 1, 0), degrees: 1)])],"#,
        &[
            r#"2:18: "a": Transform.steps: missing field `degrees` (angle)"#,
            r#"2:31: "a": Transform.steps: expected a vector with a direction, found `(0, 0, 0)`"#,
            r#"2:43: "a": Transform.steps: expected `Rotate(axis: (x, y, z), degrees: …)`, found `Rotate(30)`"#,
            r#"2:62: "a": Transform.steps: unknown field `axs`; did you mean `axis`? Fields are `axis` and `degrees`"#,
        ],
    ),
    (
        r#""a": [Transform(Translate((1, 0, 0)))],"#,
        &[
            r#"2:17: "a": Transform.steps: expected a list of steps `[Translate((x, y, z)), …]`, found `Translate((1, 0, 0))`"#,
        ],
    ),
    (
        r#""a": [Transform([Scale((1, 0, 1))])],"#,
        &[r#"2:17: "a": Transform.steps: expected a placement that can be undone: this one is singular or not finite"#],
    ),
    (
        r#""a": [Transform([Scale(1e-60)])], "b": [Transform([Scale(1e-60)]), Parent("a")],"#,
        &[r#"2:41: "b": its placement and those of its parents make one that is singular or not finite"#],
    ),
    // Figures.
    (
        r#""a": [Lathe(profile: [(1, 0), (-1, 2)])], "b": [Lathe(profile: [(1, 0), (1, 1), (1, 1)])],"#,
        &[
            r#"2:22: "a": Lathe.profile: expected distances of at least 0, found -1 at point 2"#,
            r#"2:64: "b": Lathe.profile: expected points that differ from the one before, but point 3 does not"#,
        ],
    ),
    (
        r#""a": [TriangleField(count: 9e9, arrangement: Grit)], "b": [Cone(radius: 0, height: 1)],"#,
        &[
            r#"2:28: "a": TriangleField.count: expected a whole number from 1 to 8388608, found `9e9`"#,
            r#"2:46: "a": TriangleField.arrangement: expected `Grid` or `Random`, found `Grit`; did you mean `Grid`?"#,
            r#"2:73: "b": Cone.radius: expected more than 0 here or at the `top`"#,
        ],
    ),
    // Files and choices.
    (
        r#""a": [Mesh(model: "nowhere.obj"), ImageTexture(5)],"#,
        &[
            r#"2:19: "a": Mesh.model: cannot read `nowhere.obj`: no such file"#,
            r#"2:48: "a": ImageTexture.image: expected a path in quotes, found `5`"#,
        ],
    ),
    (
        r#""a": [Mesh(model: "", shading: Smoth)],"#,
        &[
            r#"2:19: "a": Mesh.model: cannot read ``: no such file"#,
            r#"2:32: "a": Mesh.shading: expected `AsModelled`, `Flat` or `Smooth`, found `Smoth`; did you mean `Smooth`?"#,
        ],
    ),
    // References.
    (
        r#""ball": [MadeOf("glas")], "glass": [Dielectric(1.5)],"#,
        &[r#"2:17: "ball": MadeOf: there is no entity "glas"; did you mean `glass`?"#],
    ),
    (
        r#""a": [MadeOf(glass), Parent(), Like(5)],"#,
        &[
            r#"2:7: "a": MadeOf: expected a name in quotes, as `MadeOf("name")`"#,
            r#"2:22: "a": Parent: expected a name in quotes, as `Parent("name")`"#,
            r#"2:32: "a": Like: expected a name in quotes, as `Like("name")`"#,
        ],
    ),
    (
        r#""a": [MadeOf("b")], "b": [Sphere(radius: 1)],"#,
        &[r#"2:14: "a": MadeOf: expected an entity with effects of a material: "b" has none"#],
    ),
    (
        r#""a": [Like("b")],
"b": [Like("c")],
"c": [Like("b")],"#,
        &[r#"3:12: "b": Like: entities refer to each other in a circle: "b" → "c" → "b""#],
    ),
    (r#""a": [Parent("a")],"#, &[r#"2:14: "a": Parent: entities refer to each other in a circle: "a" → "a""#]),
    (
        r#""c": [Parent("b")], "b": [Parent("a")], "a": [Parent("c")],"#,
        &[r#"2:14: "c": Parent: entities refer to each other in a circle: "c" → "b" → "a" → "c""#],
    ),
    // Long values are shown in part.
    (
        r#""a": [Sphere(radius: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14])],"#,
        &[r#"2:22: "a": Sphere.radius: expected a number above 0, found `[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12,…`"#],
    ),
    // Several at once.
    (
        r#""a": [Sphere(radius: -1), Colour(1)],
"b": [Diffuse(NaN), Parent("d")],
"b": [],"#,
        &[
            r#"2:22: "a": Sphere.radius: expected a number above 0, found `-1`"#,
            r#"2:27: "a": unknown component `Colour`; did you mean `Color`?"#,
            r#"3:15: "b": Diffuse.strength: expected a finite number, at most 3.4e38 in size, found `NaN`"#,
            r#"3:28: "b": Parent: there is no entity "d""#,
            r#"4:1: "b": the name is taken: it is first given in line 3"#,
        ],
    ),
];

#[test]
fn bad_scenes_are_told_place_and_cause_of_every_fault() {
    let wrapped = |entities: &str| format!("Scene(version: 1, entities: {{\n{entities}\n}})");
    let world = world();
    let tags = world.resource::<Registry>().tags().chain(["Like", "MadeOf"]);
    let known = tags.map(|tag| format!("`{tag}`")).collect::<Vec<_>>().join(", ") + " and `Parent`";
    let scenes = BAD_SCENES.iter().map(|(text, expected)| (String::from(*text), expected));
    let entities = BAD_ENTITIES.iter().map(|(text, expected)| (wrapped(text), expected));
    for (text, expected) in scenes.chain(entities) {
        let expected: Vec<_> =
            expected.iter().map(|line| format!("bad.ron:{}", line.replace("{known}", &known))).collect();
        assert_eq!(faults(&text).lines().collect::<Vec<_>>(), expected, "{text}");
    }
}

#[test]
fn a_bad_include_is_told_where_it_is_bad() {
    // Files, and the faults of `main.ron` without the folder's path.
    type Files = &'static [(&'static str, &'static str)];
    let cases: &[(Files, &[&str])] = &[
        (
            &[
                (
                    "main.ron",
                    r#"(version: 1, include: ["parts/a.ron", "parts/a.rn"], entities: {"x": [Sphere(radius: 0)]})"#,
                ),
                ("parts/a.ron", r#"(version: 1, settings: (width: 5), entities: {"y": [Mesh(model: "b.obj")]})"#),
            ],
            &[
                "main.ron:1:39: include: cannot read `DIR/parts/a.rn`: no such file; did you mean `a.ron`?",
                r#"main.ron:1:86: "x": Sphere.radius: expected a number above 0, found `0`"#,
                "parts/a.ron:1:24: settings: an included file has none: they belong to the scene",
                r#"parts/a.ron:1:65: "y": Mesh.model: cannot read `DIR/parts/b.obj`: no such file"#,
            ],
        ),
        (
            &[
                ("main.ron", r#"(version: 1, include: ["a.ron"])"#),
                ("a.ron", r#"(version: 1, include: ["./b.ron"])"#),
                ("b.ron", r#"(version: 1, include: ["a.ron"])"#),
            ],
            &["./b.ron:1:24: include: files include each other in a circle: `DIR/a.ron` → `DIR/./b.ron` → `DIR/a.ron`"],
        ),
        (
            &[
                ("main.ron", r#"(version: 1, include: ["a.ron", "a.ron"], entities: {"x": []})"#),
                ("a.ron", r#"(version: 1, entities: {"x": []})"#),
            ],
            &[r#"a.ron:1:25: "x": the name is taken: it is first given in DIR/main.ron:1"#],
        ),
        (
            &[
                (
                    "main.ron",
                    r#"(version: 1, include: [(path: "a.ron", prefix: "a/"), (path: "a.ron", prefix: "a/")])"#,
                ),
                ("a.ron", r#"(version: 1, entities: {"x": [Parent("y")]})"#),
            ],
            &[
                r#"a.ron:1:25: "a/x": this file is included twice under one prefix, so the name is taken twice"#,
                r#"a.ron:1:38: "x": Parent: there is no entity "y""#,
            ],
        ),
        (
            &[
                ("main.ron", r#"(version: 1, include: [(path: "a.ron", prefix: "a", transform: [Scale(0)])])"#),
                ("a.ron", "(version: 3, entities: 5)"),
            ],
            &[
                "main.ron:1:64: include.transform.steps: expected a placement that can be undone: this one is singular or not finite",
                "a.ron:1:11: version: this scene is of version 3; this program reads version 1: update it",
            ],
        ),
        (
            &[("main.ron", r#"(version: 1, include: ["parts"])"#), ("parts/a.ron", "")],
            &["main.ron:1:24: include: cannot read `DIR/parts`: this is a folder, not a file"],
        ),
    ];
    for (files, expected) in cases {
        let folder = folder(files);
        let path = folder.path().join("main.ron");
        let faults = read_scene(&mut world(), &path).expect_err("faults");
        let dir = folder.path().display().to_string();
        let found = faults.to_string().replace(&format!("\n{dir}/"), "\n").replace(&dir, "DIR");
        assert_eq!(found.trim_start_matches("DIR/").lines().collect::<Vec<_>>(), *expected);
    }
}

#[test]
fn files_that_are_no_text_are_faults() {
    let folder = folder(&[]);
    let path = folder.path().join("main.ron");
    let shown = |path: &Path| {
        let faults = read_scene(&mut world(), path).expect_err("faults").to_string();
        faults.replace(&path.display().to_string(), "PATH")
    };
    assert_eq!(shown(&path), "PATH: no such file");
    assert!(shown(folder.path()).starts_with("PATH: "));
    fs::write(&path, b"(version: 1,\n \"\xC3\xA4\xFF\"").expect("a file");
    assert_eq!(shown(&path), "PATH:2:4: expected UTF-8 text, found the byte 0xff");
}

#[test]
fn a_byte_order_mark_and_other_line_ends_are_fine() {
    good("\u{FEFF}(\r\n\tversion: 1,\r\n\tentities: {},\r\n)\r\n");
    assert_eq!(
        faults("\u{FEFF}(version: 1,\r\n\tentitis: {})").lines().collect::<Vec<_>>(),
        ["bad.ron:2:2: Scene: unknown field `entitis`; did you mean `entities`? \
          Fields are `version`, `settings`, `include` and `entities`"]
    );
}

#[test]
fn damaged_and_deep_texts_are_faults_and_never_more() {
    for open in ["[", "(", "a(", "{1:", "Scene(version: 1, settings: (a: ", "Scene(version: 1, entities: {\"a\": [A("] {
        faults(&open.repeat(100_000));
        faults(&format!("Scene(version: 1, entities: {}", open.repeat(100)));
    }
    let whole = include_str!("../../../../scenes/README.md");
    let scene = whole.split("```ron\n").find(|block| block.starts_with("Scene(")).expect("a scene");
    let scene = scene.split("```").next().expect("a scene");
    for (end, c) in scene.char_indices() {
        // Cut short, and with one character lost or doubled: a fault or not, but always an answer.
        let (before, after) = scene.split_at(end);
        let after = after.get(c.len_utf8()..).unwrap_or_default();
        for text in [before.into(), format!("{before}{after}"), format!("{before}{c}{c}{after}")] {
            drop(read_scene_text(&mut world(), &text, Path::new("bad.ron")));
        }
    }
}

#[test]
fn every_form_of_a_value_is_read() {
    let mut world = with(
        r##"
        "a": [Sphere(radius: 1_0.5e-1), Color("#ff8000"), Diffuse(0.8), Ambient((0.1, 0.2, 0.3)), Mirror([0, 0.5, 1])],
        "b": [Sphere(2 /* a /* nested */ comment */), Transform([])],
        "##,
    );
    assert_eq!(get::<Sphere>(&mut world, "a").radius, 1.05);
    assert_eq!(get::<Sphere>(&mut world, "b").radius, 2.0);
    let orange = DVec3::new(1.0, linear_from_srgb(128.0 / 255.0), 0.0);
    assert_eq!(get::<Color>(&mut world, "a"), Color(orange));
    assert_eq!(get::<Diffuse>(&mut world, "a"), Diffuse(DVec3::splat(0.8)));
    assert_eq!(get::<Ambient>(&mut world, "a"), Ambient(DVec3::new(0.1, 0.2, 0.3)));
    assert_eq!(get::<Mirror>(&mut world, "a"), Mirror(DVec3::new(0.0, 0.5, 1.0)));

    let mut world = with(
        r##"
        "a": [Color(0.1, 0.2, 0.3), Camera(position: [1, 2, 3], target: Some((0, 0, 0)), screen_distance: None)],
        "b": [Color("#fff"), Camera(position: (1, 2, 3), direction: (0, 0, 1), screen_distance: 2)],
        "c": [Triangle(a: (0,0,0), b: (1,0,0), c: (0,1,0), uvs: [(0,0), [1,0], (0,1)])],
        "##,
    );
    assert_eq!(get::<Color>(&mut world, "a"), Color(DVec3::new(0.1, 0.2, 0.3)));
    assert_eq!(get::<Color>(&mut world, "b"), Color(DVec3::ONE));
    let (a, b) = (get::<Camera>(&mut world, "a"), get::<Camera>(&mut world, "b"));
    assert_eq!((a.target, a.screen_distance), (Some(DVec3::ZERO), None));
    assert_eq!((b.direction, b.screen_distance), (Some(DVec3::Z), Some(2.0)));
    assert_eq!(get::<Triangle>(&mut world, "c").uvs.len(), 3);
}

#[test]
fn steps_are_read_in_order() {
    let mut world = with(
        r#""a": [Transform([
            Scale(2), Scale((1, 2, 3)), Scale(1, 2, 3), Translate((1, 0, 0)), Translate(1, 0, 0), Translate([1, 0, 0]),
            RotateX(10), RotateY(-20), RotateZ(30.5), Rotate(axis: (0, 1, 0), degrees: 30),
        ])]"#,
    );
    let (scale, by) = (Step::Scale(DVec3::new(1.0, 2.0, 3.0)), Step::Translate(DVec3::X));
    let expected = [
        Step::Scale(DVec3::splat(2.0)),
        scale,
        scale,
        by,
        by,
        by,
        Step::RotateX(10.0),
        Step::RotateY(-20.0),
        Step::RotateZ(30.5),
        Step::Rotate { axis: DVec3::Y, degrees: 30.0 },
    ];
    assert_eq!(get::<Transform>(&mut world, "a"), Transform::new(expected));
}

#[test]
fn settings_are_those_of_the_scene_or_the_defaults() {
    assert_eq!(*good("(version: 1)").resource::<Settings>(), Settings::default());
    assert_eq!(*good("(version: 1, settings: ())").resource::<Settings>(), Settings::default());
    let world =
        good("(version: 1, settings: (width: 1_920, antialias: Four, shadows: false, background: (0.1, 0.2, 0.3)))");
    let background = DVec3::new(0.1, 0.2, 0.3);
    let expected = Settings {
        width: 1920,
        antialias: snell_components::settings::Antialias::Four,
        shadows: false,
        background,
        ..Settings::default()
    };
    assert_eq!(*world.resource::<Settings>(), expected);
}

#[test]
fn numbers_survive_the_round_trip_through_text() {
    for x in [0.1, 1.0 / 3.0, 1e-300, f64::MIN_POSITIVE, 123_456_789.123_456_79, f64::from(f32::MAX)] {
        let mut world = with(&format!("\"a\": [Sphere(radius: {x:e})]"));
        assert_eq!(get::<Sphere>(&mut world, "a").radius.to_bits(), x.to_bits());
    }
}

#[test]
fn relations_join_entities_however_they_are_ordered() {
    let mut world = with(
        r#"
        "child": [Parent("group"), Sphere(radius: 1), MadeOf("glass")],
        "group": [Transform([RotateY(45)])],
        "glass": [Dielectric(1.5)],
        "#,
    );
    let names = entities(&mut world);
    assert_eq!(get::<MadeOf>(&mut world, "child").0, names["glass"]);
    assert_eq!(get::<ChildOf>(&mut world, "child").0, names["group"]);
}

#[test]
fn like_takes_what_is_not_stated() {
    let mut world = with(
        r#"
        "last": [Like("moved"), Color(0.5)],
        "moved": [Like("ball"), Transform([Translate((3, 1, 0))])],
        "ball": [Sphere(radius: 2), Transform([Scale(2)]), MadeOf("glass"), Parent("group")],
        "glass": [Dielectric(1.5), Ambient(0.1)],
        "group": [],
        "box": [Like("ball"), Box(size: (1, 1, 1))],
        "mirror": [Like("glass"), Mirror(1)],
        "own": [Like("glass"), MadeOf("glass")],
        "tiled": [Like("own"), Checker()],
        "striped": [Like("tiled"), Checker(frequency: 2)],
        "#,
    );
    let names = entities(&mut world);
    let at = |x, y| Transform::at(DVec3::new(x, y, 0.0));
    assert_eq!(get::<Sphere>(&mut world, "last").radius, 2.0);
    assert_eq!(get::<Transform>(&mut world, "last"), at(3.0, 1.0));
    assert_eq!(get::<ChildOf>(&mut world, "last").0, names["group"]);
    assert_eq!(get::<MadeOf>(&mut world, "moved").0, names["glass"]);
    // An effect of its own takes the place of a material taken, a shape that of a shape.
    assert!(!has::<MadeOf>(&mut world, "last"));
    assert!(has::<Cuboid>(&mut world, "box") && !has::<Sphere>(&mut world, "box"));
    assert!(has::<Mirror>(&mut world, "mirror") && has::<Ambient>(&mut world, "mirror"));
    assert!(!has::<Dielectric>(&mut world, "mirror"));
    assert!(has::<MadeOf>(&mut world, "own") && !has::<Ambient>(&mut world, "own"));
    assert!(!has::<MadeOf>(&mut world, "tiled"));
    assert_eq!(get::<Checker>(&mut world, "striped").frequency, 2.0);
}

#[test]
fn chains_as_long_as_the_scene_are_followed() {
    let mut text = String::from("\"0\": [Sphere(radius: 1)],");
    for i in 1..20_000 {
        text += &format!("\"{i}\": [Like(\"{0}\"), Parent(\"{0}\")],", i - 1);
    }
    assert!(has::<Sphere>(&mut with(&text), "19999"));
}

#[test]
fn an_included_file_stands_where_it_is_placed() {
    let folder = folder(&[
        (
            "main.ron",
            r#"Scene(
                version: 1,
                include: [
                    "parts/paint.ron",
                    (path: "parts/chair.ron", prefix: "left/", transform: [Translate((1, 0, 0))]),
                    (path: "parts/chair.ron", prefix: "right/"),
                ],
                entities: { "cushion": [Sphere(radius: 1), Parent("left/seat")] },
            )"#,
        ),
        ("parts/paint.ron", r#"Scene(version: 1, entities: { "red": [Diffuse(1)] })"#),
        (
            "parts/chair.ron",
            r#"Scene(
                version: 1,
                include: [(path: "leg.ron", prefix: "leg/", transform: [Scale(2)])],
                entities: { "seat": [Mesh(model: "seat.obj"), MadeOf("red")], "back": [Parent("seat")] },
            )"#,
        ),
        ("parts/leg.ron", r#"Scene(version: 1, entities: { "rod": [Box(size: (1, 1, 1)), MadeOf("red")] })"#),
        ("parts/seat.obj", MODEL),
        ("parts/model.mtl", MATERIALS),
    ]);
    let mut world = world();
    read_scene(&mut world, &folder.path().join("main.ron")).unwrap_or_else(|faults| panic!("{faults}"));
    let names = entities(&mut world);
    let parent = |world: &mut World, name: &str| {
        let parent = world.get::<ChildOf>(names[name]).map(|parent| parent.0);
        parent.and_then(|parent| world.get::<Name>(parent)).map_or(String::new(), Name::to_string)
    };
    for (name, expected) in [
        ("red", ""),
        ("cushion", "left/seat"),
        ("left/seat", "left/(include)"),
        ("left/back", "left/seat"),
        ("left/leg/rod", "left/leg/(include)"),
        ("left/leg/(include)", "left/(include)"),
        ("left/(include)", ""),
        ("right/seat", ""),
        ("right/back", "right/seat"),
        ("right/leg/rod", "right/leg/(include)"),
    ] {
        assert_eq!(parent(&mut world, name), expected, "{name}");
    }
    assert_eq!(get::<MadeOf>(&mut world, "right/leg/rod").0, names["red"]);
    assert_eq!(get::<Transform>(&mut world, "left/(include)"), Transform::at(DVec3::X));
    let (left, right) = (get::<Mesh>(&mut world, "left/seat").model, get::<Mesh>(&mut world, "right/seat").model);
    assert_eq!(left.path, "parts/seat.obj");
    assert!(Arc::ptr_eq(&left.data.expect("a mesh"), &right.data.expect("a mesh")));
}

#[test]
fn files_that_multiply_each_other_are_a_fault() {
    let next =
        |i| format!(r#"(version: 1, include: [(path: "{i}.ron", prefix: "a"), (path: "{i}.ron", prefix: "b")])"#);
    let files: Vec<_> = (0..40).map(|i| (format!("{i}.ron"), next(i + 1))).collect();
    let mut files: Vec<_> = files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    files.push(("40.ron", "(version: 1)"));
    let folder = folder(&files);
    let faults = read_scene(&mut world(), &folder.path().join("0.ron")).expect_err("too many");
    assert!(faults.to_string().contains("more than 10000 inclusions"));
}

#[test]
fn models_bring_their_materials_and_are_read_once() {
    let folder = folder(&[("m.obj", MODEL), ("model.mtl", MATERIALS)]);
    save_image(&folder.path().join("m.png"));
    let text = r#"(version: 1, entities: {
        "plain": [Mesh(model: "m.obj")],
        "again": [Mesh(model: "./m.obj", shading: Flat)],
        "like": [Like("plain")],
        "filled": [Mesh(model: "m.obj"), Refraction(1.3), Absorption(0.5), Dispersion, MediumRank(1)],
        "own": [Mesh(model: "m.obj"), Diffuse(1)],
        "painted": [Mesh(model: "m.obj"), MadeOf("paint")],
        "paint": [Diffuse(1), ImageTexture("m.png")],
        "same": [Diffuse(1), ImageTexture("m.png")],
    })"#;
    let mut world = world();
    read_scene_text(&mut world, text, &folder.path().join("s.ron")).unwrap_or_else(|faults| panic!("{faults}"));
    let names = entities(&mut world);
    let slots = MaterialSlots(vec![names["m.obj#red"], names["m.obj#glass"]]);
    for name in ["plain", "again", "like", "filled"] {
        assert_eq!(get::<MaterialSlots>(&mut world, name), slots);
    }
    assert!(!has::<MaterialSlots>(&mut world, "own") && !has::<MaterialSlots>(&mut world, "painted"));
    let [plain, again, own] =
        ["plain", "again", "own"].map(|name| get::<Mesh>(&mut world, name).model.data.expect("a mesh"));
    assert!(Arc::ptr_eq(&plain, &again) && Arc::ptr_eq(&plain, &own));
    let [a, b] = ["paint", "same"].map(|name| get::<ImageTexture>(&mut world, name).image.data.expect("an image"));
    assert!(Arc::ptr_eq(&a, &b));
    assert!(has::<Color>(&mut world, "m.obj#red") && has::<Diffuse>(&mut world, "m.obj#red"));
}

#[test]
fn bad_files_collected_elsewhere_are_faults() {
    let data = std::env::var_os("SNELL_DATA").map_or("../../shared/data".into(), std::path::PathBuf::from);
    let Ok(groups) = fs::read_dir(data.join("bad/ron")) else {
        println!("skipped: no bad scenes in {}; set SNELL_DATA", data.display());
        return;
    };
    let files = groups.flatten().filter_map(|group| fs::read_dir(group.path()).ok()).flatten().flatten();
    for file in files {
        let faults = read_scene(&mut world(), &file.path()).expect_err("faults");
        assert!(!faults.0.is_empty(), "{}", file.path().display());
    }
}

/// Blocks of the reference: what stands behind "```", and the text.
fn blocks(markdown: &str) -> Vec<(&str, &str)> {
    let fenced = markdown.split("\n```").skip(1).step_by(2);
    fenced.filter_map(|block| block.split_once('\n')).collect()
}

#[test]
fn every_block_of_the_reference_is_read() {
    let folder = folder(&[("models/vase.obj", MODEL), ("models/model.mtl", MATERIALS), ("textures/a", "")]);
    save_image(&folder.path().join("textures/wood.png"));
    let blocks = blocks(include_str!("../../../../scenes/README.md"));
    let scene = |text: &str| match text.starts_with("Scene(") {
        true => String::from(text),
        false => format!("Scene(version: 1,\nentities: {{\n{text}\n}})"),
    };
    let path = folder.path().join("scene.ron");
    // Files that other blocks include: named in the block's first line.
    for (_, text) in blocks.iter().filter(|(kind, _)| kind.starts_with("ron")) {
        if let Some(name) =
            text.lines().next().and_then(|line| line.strip_prefix("// ")).filter(|name| name.ends_with(".ron"))
        {
            let file = folder.path().join(name);
            fs::create_dir_all(file.parent().expect("a folder")).expect("a folder");
            fs::write(file, text).expect("a file");
        }
    }
    let mut read = 0;
    let (mut shown, mut told) = (None, None);
    for (kind, text) in blocks {
        let without_name = text.strip_prefix("//").and_then(|text| text.split_once('\n'));
        let text = without_name.map_or(text, |(_, text)| text);
        match kind {
            "ron" => drop(read_scene_text(&mut world(), &scene(text), &path).unwrap_or_else(|f| panic!("{text}\n{f}"))),
            "ron,error" => {
                let faults = read_scene_text(&mut world(), &scene(text), &path).expect_err(text).to_string();
                told.get_or_insert(faults.replace(&format!("{}/", folder.path().display()), ""));
            }
            "text" => shown = Some(text.trim_end()),
            _ => continue,
        }
        read += 1;
    }
    assert!(read >= 20, "only {read} blocks were found");
    assert_eq!(shown, told.as_deref());
}

#[test]
fn the_reference_names_every_component_and_field() {
    struct Names<'a>(&'a str, &'static str);
    impl snell_components::describe::FieldVisitor for Names<'_> {
        fn field(
            &mut self,
            name: &'static str,
            _: snell_components::describe::Value<'_>,
            _: snell_components::describe::Spec,
        ) {
            assert!(self.0.contains(&format!("`{name}`")), "scenes/README.md does not name {}.{name}", self.1);
        }
    }
    let reference = include_str!("../../../../scenes/README.md");
    let world = world();
    let registry = world.resource::<Registry>();
    for tag in registry.tags() {
        assert!(reference.contains(&format!("`{tag}`")), "scenes/README.md does not name {tag}");
        let entry = registry.get(tag).expect("an entry");
        drop(entry.read(&mut Names(reference, tag)));
    }
    Settings::default().describe(&mut Names(reference, "settings"));
}
