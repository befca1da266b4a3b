//! Five scenes that together use every feature.

use super::{random::Random, scene::Scene};
use snell::prelude::*;
use std::sync::Arc;

/// All five.
pub(crate) fn gallery() -> Vec<Scene> {
    vec![matte(), glass(), meshes(), crowd(), mirrors()]
}

fn small(settings: Settings) -> Settings {
    Settings { width: 40, height: 30, ..settings }
}

fn point(random: &mut Random, reach: f64) -> DVec3 {
    let mut coordinate = || (random.unit() - 0.5) * 2.0 * reach;
    let (x, y) = (coordinate(), coordinate());
    DVec3::new(x, y, coordinate())
}

/// Local terms: every light, every texture on every shape, four rays a pixel.
fn matte() -> Scene {
    let mut scene = Scene::new(
        "matte",
        small(Settings { antialias: Antialias::Four, background: Rgb::new(0.2, 0.3, 0.5), ..Settings::default() }),
    );
    scene.put("camera", Camera { position: DVec3::new(0.0, 2.0, 7.0), target: Some(DVec3::Y), ..Camera::default() });
    scene.put("ambient a", AmbientLight { intensity: Rgb::new(0.1, 0.2, 0.3) });
    scene.put("ambient b", AmbientLight { intensity: Rgb::new(0.3, 0.1, 0.1) });
    scene.put(
        "lamp a",
        PointLight { position: DVec3::new(3.0, 5.0, 4.0), intensity: Rgb::new(0.7, 0.6, 0.5), ..PointLight::default() },
    );
    scene.put(
        "lamp b",
        PointLight { position: DVec3::new(-4.0, 3.0, 2.0), intensity: Rgb::splat(0.3), ..PointLight::default() },
    );
    scene.put(
        "sun",
        DirectionalLight {
            direction: DVec3::new(-1.0, -2.0, -0.5),
            intensity: Rgb::splat(0.4),
            ..DirectionalLight::default()
        },
    );
    let texels = (0..16).map(|i| [i as f32 / 15.0, ((i * 5) % 16) as f32 / 15.0, ((i * 11) % 16) as f32 / 15.0]);
    let image = ImageTexture::from(Image::new(4, 4, texels.collect()).expect("an image"));
    scene.put("painted", (image, Diffuse(Rgb::splat(0.8)), Ambient(Rgb::splat(0.4))));
    let checker =
        Checker { even: Rgb::new(0.9, 0.9, 0.7), odd: Rgb::new(0.2, 0.1, 0.3), frequency: 3.0, ..Checker::default() };
    scene.put("checked", (checker, Diffuse(Rgb::ONE), Highlight { strength: Rgb::splat(0.5), exponent: 30.0 }));
    scene.put_of("ball", "painted", (Sphere { radius: 1.0 }, Transform::at(DVec3::new(-1.5, 1.0, 0.0))));
    scene.put_of(
        "egg",
        "checked",
        (
            Sphere { radius: 0.7 },
            Transform::new([
                Step::Scale(DVec3::new(1.0, 1.5, 0.6)),
                Step::RotateZ(20.0),
                Step::Translate(DVec3::new(0.3, 1.0, 0.5)),
            ]),
        ),
    );
    scene.put_of(
        "crate",
        "painted",
        (
            Cuboid { size: DVec3::new(1.0, 2.0, 1.0) },
            Transform::new([Step::RotateY(33.0), Step::Translate(DVec3::new(2.0, 1.0, -1.0))]),
        ),
    );
    let normals = vec![DVec3::new(-0.5, 0.0, 1.0), DVec3::new(0.5, 0.0, 1.0), DVec3::new(0.0, 0.5, 1.0)];
    let sail = Triangle {
        a: DVec3::new(-2.0, 0.0, -2.0),
        b: DVec3::new(1.0, 0.0, -2.0),
        c: DVec3::new(0.0, 4.0, -2.0),
        normals,
        ..Triangle::default()
    };
    scene.put_of("sail", "checked", sail);
    scene.put_of("ground", "checked", Plane {});
    scene.put("plain", (Sphere { radius: 0.3 }, Transform::at(DVec3::new(0.0, 0.3, 2.5))));
    scene
}

/// Everything that light passes through, nested and stacked.
fn glass() -> Scene {
    let mut scene = Scene::new(
        "glass",
        small(Settings { depth: 7, background: Rgb::new(0.5, 0.6, 0.8), cutoff: 0.004, ..Settings::default() }),
    );
    scene.put(
        "camera",
        Camera {
            position: DVec3::new(0.5, 1.5, 6.0),
            direction: Some(DVec3::new(-0.05, -0.1, -1.0)),
            ..Camera::default()
        },
    );
    scene.put("ambient", AmbientLight::default());
    scene.put(
        "lamp",
        PointLight { position: DVec3::new(2.0, 6.0, 3.0), intensity: Rgb::splat(0.8), ..PointLight::default() },
    );
    scene.put(
        "sun",
        DirectionalLight {
            direction: DVec3::new(1.0, -3.0, -1.0),
            intensity: Rgb::splat(0.3),
            ..DirectionalLight::default()
        },
    );
    scene.put(
        "crown",
        (
            Dielectric { index: 1.5 },
            Diffuse(Rgb::splat(0.05)),
            Highlight { strength: Rgb::splat(0.1), exponent: 100.0 },
        ),
    );
    scene.put("water", Dielectric { index: 1.33 });
    scene.put("bent", (Transmission(Rgb::new(0.9, 0.7, 0.8)), Refraction { index: 1.2 }, Mirror(Rgb::splat(0.1))));
    scene.put(
        "veil",
        (Opacity { alpha: 0.4 }, Color(Rgb::new(1.0, 0.3, 0.2)), Diffuse(Rgb::splat(0.7)), Ambient(Rgb::splat(0.1))),
    );
    scene.put("film", (Transmission(Rgb::new(0.5, 0.9, 0.6)), Diffuse(Rgb::splat(0.2))));
    scene.put("metal", Dielectric { index: 20_000.0 });
    scene.put_of("ball", "crown", (Sphere { radius: 1.0 }, Transform::at(DVec3::new(-1.0, 1.0, 0.0))));
    scene.put_of("bubble", "water", (Sphere { radius: 0.5 }, Transform::at(DVec3::new(-1.0, 1.0, 0.0))));
    scene.put_of(
        "slab",
        "bent",
        (
            Cuboid { size: DVec3::new(1.5, 2.0, 0.3) },
            Transform::new([Step::RotateY(25.0), Step::Translate(DVec3::new(1.2, 1.0, 1.0))]),
        ),
    );
    scene.put_of(
        "curtain",
        "veil",
        (Cuboid { size: DVec3::new(2.0, 2.0, 0.1) }, Transform::at(DVec3::new(0.0, 1.2, -2.0))),
    );
    scene.put_of(
        "pane",
        "film",
        Triangle {
            a: DVec3::new(0.0, 0.0, 2.0),
            b: DVec3::new(2.5, 0.0, 1.5),
            c: DVec3::new(1.0, 2.5, 2.0),
            ..Triangle::default()
        },
    );
    scene.put_of("drop", "metal", (Sphere { radius: 0.4 }, Transform::at(DVec3::new(0.4, 0.4, 1.8))));
    scene.put("ground", (Plane {}, Checker::default(), Diffuse(Rgb::splat(0.8)), Ambient(Rgb::splat(0.1))));
    scene
}

/// A sphere of unit radius with hills, its vertices shared; the flag gives every other triangle normals, texture
/// coordinates and a material slot.
pub(crate) fn bumpy(columns: u32, rows: u32, attributes: bool) -> TriangleMesh {
    let mut random = Random::new(u64::from(columns));
    let mut positions = vec![[0.0, 1.2, 0.0], [0.0, -1.2, 0.0]];
    for row in 1..rows {
        for column in 0..columns {
            let (theta, phi) = (f64::from(row) / f64::from(rows), f64::from(column) / f64::from(columns));
            let (sin, cos) = snell::components::math::sin_cos_degrees(theta * 180.0);
            let (sin_phi, cos_phi) = snell::components::math::sin_cos_degrees(phi * 360.0);
            let radius = 0.8 + 0.4 * random.unit();
            positions.push([radius * sin * cos_phi, radius * cos, radius * sin * sin_phi].map(|x| x as f32));
        }
    }
    let at = |row: u32, column: u32| match row {
        0 => 0,
        row if row == rows => 1,
        row => 2 + (row - 1) * columns + column % columns,
    };
    let mut triangles = vec![];
    for row in 0..rows {
        for column in 0..columns {
            let [a, b, c, d] = [at(row, column), at(row, column + 1), at(row + 1, column), at(row + 1, column + 1)];
            if row > 0 {
                triangles.push([a, b, c]);
            }
            if row + 1 < rows {
                triangles.push([b, d, c]);
            }
        }
    }
    if !attributes {
        return TriangleMesh::new(positions, triangles).expect("a mesh");
    }
    let every_other = || triangles.iter().enumerate().map(|(i, triangle)| (i % 2 == 0).then_some(*triangle)).collect();
    let normals = positions.clone();
    let uvs = positions.iter().map(|[x, y, _]| [x * 2.0, y * 2.0]).collect();
    let slots = (0..triangles.len()).map(|i| (i % 3) as u16).collect();
    TriangleMesh::with_attributes(positions, triangles.clone(), (normals, every_other()), (uvs, every_other()), slots)
        .expect("a mesh")
}

/// Instances of meshes: smoothed, flat and as modelled; mirrored, sheared, turned by their parents.
fn meshes() -> Scene {
    let mut scene = Scene::new("meshes", small(Settings { background: Rgb::splat(0.1), ..Settings::default() }));
    scene.put("stand", Transform::new([Step::RotateY(15.0), Step::Translate(DVec3::new(0.0, 1.0, 0.0))]));
    scene.put(
        "arm",
        Transform::new([Step::Scale(DVec3::new(-0.7, 0.6, 0.5)), Step::Translate(DVec3::new(2.2, 0.3, 0.0))]),
    );
    scene.put(
        "camera",
        Camera {
            position: DVec3::new(1.0, 2.5, 8.0),
            target: Some(DVec3::Y),
            field_of_view: 35.0,
            ..Camera::default()
        },
    );
    scene.put("ambient", AmbientLight { intensity: Rgb::splat(0.3) });
    scene.put(
        "lamp",
        PointLight { position: DVec3::new(5.0, 7.0, 6.0), intensity: Rgb::splat(0.9), ..PointLight::default() },
    );
    scene.put("red", (Color(Rgb::new(0.8, 0.2, 0.1)), Diffuse(Rgb::ONE), Ambient(Rgb::ONE)));
    scene.put(
        "shiny",
        (Color(Rgb::new(0.2, 0.3, 0.8)), Diffuse(Rgb::splat(0.6)), Highlight::default(), Mirror(Rgb::splat(0.3))),
    );
    scene.put("squares", (Checker { frequency: 2.0, ..Checker::default() }, Diffuse(Rgb::ONE)));
    scene.put("clear", (Dielectric { index: 1.4 }, Diffuse(Rgb::splat(0.1))));
    let plain = Arc::new(bumpy(16, 10, false));
    let modelled = Arc::new(bumpy(12, 9, true));
    scene.put_in("rock", "stand", "red", Mesh::new(plain.clone()));
    scene.put_in("pebble", "arm", "shiny", Mesh::new(plain.clone()).smooth());
    scene.put_slots(
        "gem",
        &["red", "squares", "shiny"],
        (
            Mesh::new(modelled.clone()),
            Transform::new([Step::RotateX(40.0), Step::Translate(DVec3::new(-2.3, 1.0, 0.0))]),
        ),
    );
    let leaning = Transform::new([
        Step::RotateZ(45.0),
        Step::Scale(DVec3::new(1.0, 0.4, 0.7)),
        Step::RotateZ(-30.0),
        Step::Translate(DVec3::new(0.5, 0.8, 2.5)),
    ]);
    scene.put_of("ice", "clear", (Mesh::new(modelled).smooth(), leaning));
    scene.put_in("tip", "rock", "shiny", (Cuboid { size: DVec3::splat(0.5) }, Transform::at(DVec3::Y * 1.2)));
    scene.put("ground", Plane {});
    scene
}

/// Many small things, some of them in the very same place.
fn crowd() -> Scene {
    let mut scene = Scene::new("crowd", small(Settings { background: Rgb::new(0.7, 0.8, 0.9), ..Settings::default() }));
    scene.put(
        "camera",
        (
            Camera { screen_distance: Some(1.5), ..Camera::default() },
            Transform::new([Step::RotateX(-20.0), Step::RotateY(10.0), Step::Translate(DVec3::new(2.0, 6.0, 14.0))]),
        ),
    );
    scene.put(
        "lamp",
        PointLight { position: DVec3::new(-9.0, 12.0, 9.0), intensity: Rgb::splat(0.9), ..PointLight::default() },
    );
    scene.put("ambient", AmbientLight { intensity: Rgb::splat(0.2) });
    let mut random = Random::new(7);
    for (name, x) in [("black", 0.1), ("grey", 0.5), ("white", 0.9)] {
        scene.put(name, (Color(Rgb::new(x, 0.5 * x, 1.0 - x)), Diffuse(Rgb::splat(0.8)), Ambient(Rgb::splat(0.2))));
    }
    for i in 0..120 {
        let material = ["black", "grey", "white"][random.below(3)];
        let (at, size) = (point(&mut random, 5.0), 0.2 + 0.5 * random.unit());
        match i % 3 {
            0 => scene.put_of(format!("thing {i}"), material, (Sphere { radius: size }, Transform::at(at))),
            1 => scene.put_of(
                format!("thing {i}"),
                material,
                (
                    Cuboid { size: DVec3::splat(size) },
                    Transform::new([Step::Rotate { axis: DVec3::ONE, degrees: size * 300.0 }, Step::Translate(at)]),
                ),
            ),
            _ => {
                let [a, b, c] = [0; 3].map(|_| at + point(&mut random, 1.0));
                scene.put_of(format!("thing {i}"), material, Triangle { a, b, c, ..Triangle::default() });
            }
        }
    }
    // The same place twice, of another material: the name decides.
    for (name, material) in [("twin b", "black"), ("twin a", "white")] {
        scene.put_of(name, material, (Cuboid { size: DVec3::splat(2.0) }, Transform::at(DVec3::new(0.0, 1.0, 3.0))));
    }
    scene.put_of("ground", "grey", (Plane {}, Transform::at(DVec3::Y * -5.0)));
    scene.put_of("ground, again", "white", (Plane {}, Transform::at(DVec3::Y * -5.0)));
    scene
}

/// Mirrors face to face, seen by a rolled camera, without shadows.
fn mirrors() -> Scene {
    let mut scene = Scene::new(
        "mirrors",
        small(Settings { depth: 20, shadows: false, background: Rgb::new(0.3, 0.2, 0.1), ..Settings::default() }),
    );
    scene.put(
        "camera",
        Camera {
            position: DVec3::new(0.3, 0.2, 1.5),
            target: Some(DVec3::new(-0.5, 0.0, -2.0)),
            roll: 12.0,
            up: DVec3::new(0.1, 1.0, 0.0),
            field_of_view: 70.0,
            ..Camera::default()
        },
    );
    scene.put(
        "lamp",
        PointLight { position: DVec3::new(0.0, 1.5, 0.5), intensity: Rgb::splat(0.7), ..PointLight::default() },
    );
    scene.put("silver", (Mirror(Rgb::new(0.85, 0.9, 0.8)), Diffuse(Rgb::splat(0.1))));
    scene.put(
        "wax",
        (
            Color(Rgb::new(0.9, 0.7, 0.2)),
            Diffuse(Rgb::splat(0.7)),
            Highlight { strength: Rgb::splat(0.4), exponent: 12.5 },
        ),
    );
    scene.put_of("back", "silver", (Plane {}, Transform::new([Step::RotateX(90.0), Step::Translate(DVec3::Z * -3.0)])));
    scene.put_of(
        "front",
        "silver",
        (Plane {}, Transform::new([Step::RotateX(-90.0), Step::Translate(DVec3::Z * 3.0)])),
    );
    scene.put_of("ball", "silver", (Sphere { radius: 0.6 }, Transform::at(DVec3::new(-0.7, -0.2, -1.0))));
    scene.put_of(
        "candle",
        "wax",
        (
            Cuboid { size: DVec3::new(0.3, 1.5, 0.3) },
            Transform::new([Step::RotateY(30.0), Step::Translate(DVec3::new(0.6, -0.3, -1.2))]),
        ),
    );
    scene
}
