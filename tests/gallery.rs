//! The scenes of the gallery and of the benches: sound, told in their README, and what they say they are.

use snell::prelude::*;
use std::{fs, path::Path};

fn scenes(folder: &str) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{folder}: {error}"));
    let mut scenes: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    scenes.retain(|path| path.extension().is_some_and(|extension| extension == "ron"));
    let mut names: Vec<_> = scenes.iter().map(|path| path.to_string_lossy().replace('\\', "/")).collect();
    names.sort();
    names
}

fn load(scene: impl AsRef<Path>) -> Renderer {
    let mut renderer = Renderer::new();
    renderer.load(scene).unwrap_or_else(|faults| panic!("{faults}"));
    renderer
}

/// The one component of a type on the entity of a name.
fn named<C: Component + Clone>(world: &mut World, name: &str) -> C {
    let mut all = world.query::<(&Name, &C)>();
    let found = all.iter(world).find(|(at, _)| at.as_str() == name);
    found.unwrap_or_else(|| panic!("no {name}")).1.clone()
}

#[test]
fn every_scene_is_sound_and_told_in_the_readme() {
    let readme = fs::read_to_string("scenes/gallery/README.md").expect("a README");
    let gallery = scenes("scenes/gallery");
    assert!(gallery.len() >= 20, "{gallery:?}");
    for scene in gallery.iter().chain(&scenes("scenes/bench")) {
        let name = Path::new(scene).file_name().expect("a name").to_string_lossy();
        assert!(readme.contains(&format!("`{name}`")), "scenes/gallery/README.md does not name {name}");
        if name == "big-mesh.ron" {
            continue;
        }
        let mut renderer = load(scene);
        *renderer.settings() = Settings { width: 24, height: 15, depth: 4, ..renderer.settings().clone() };
        let frame = render(&renderer.snapshot().expect("a snapshot"), &Options::default());
        let pixels = &frame.picture.pixels;
        assert!(pixels.iter().flatten().all(|channel| channel.is_finite()), "{scene}");
        let level = |pixel: &[f32; 3]| f64::from(pixel[0] + pixel[1] + pixel[2]) / 3.0;
        let (dark, bright) = pixels.iter().map(level).fold((1.0, 0.0), |(low, high), x| (x.min(low), x.max(high)));
        assert!(bright > 2.0 * dark, "{scene} shows nothing: {dark} to {bright}");
    }
}

#[test]
fn a_big_mesh_that_is_not_there_is_told_with_its_place() {
    if Path::new("scenes/bench/big.obj").exists() {
        println!("skipped: a model of yours is there");
        return;
    }
    let told = Renderer::new().load("scenes/bench/big-mesh.ron").expect_err("there is none").to_string();
    let expected = "\"model\": Mesh.model: cannot read `scenes/bench/big.obj`: no such file";
    assert!(told.starts_with("scenes/bench/big-mesh.ron:") && told.contains(expected), "{told}");
}

#[test]
fn many_balls_are_as_many_as_the_first_report_had() {
    let mut renderer = load("scenes/gallery/many-balls.ron");
    assert_eq!((renderer.settings().width, renderer.settings().height), (809, 817));
    let world = &mut renderer.world;
    let mut cones = world.query::<&Lathe>();
    let triangles = cones.iter(world).map(|cone| cone.triangles().expect("a cone").len());
    assert_eq!(triangles.sum::<usize>(), 642);
    assert_eq!(world.query::<&Lathe>().iter(world).count(), 4);
    assert_eq!(world.query::<&PointLight>().iter(world).count(), 2);
    let mut balls = world.query::<(&Sphere, &Mirror, Option<&Transmission>)>();
    let mirrors: Vec<_> = balls.iter(world).collect();
    let count = |from: f64, to: f64, clear: bool| {
        mirrors.iter().filter(|(_, m, t)| m.0.y > from && m.0.y < to && t.is_some() == clear).count()
    };
    assert_eq!([count(0.0, 0.2, false), count(0.7, 1.0, false), count(0.0, 0.2, true)], [12, 2, 1]);
}

/// Light of a picture where the camera sees a point of the ground.
fn at_ground(snapshot: &Snapshot, picture: &Picture, place: DVec3) -> f64 {
    let (width, height) = (picture.width, picture.height);
    let pixels = (0..width * height).map(|n| (n % width, n / width));
    let gap = |&(x, y): &(u32, u32)| {
        let ray = snapshot.view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5, width, height);
        let t = -ray.origin.y / ray.direction.y;
        if t > 0.0 { ray.at(t).distance_squared(place) } else { f64::INFINITY }
    };
    let (x, y) = pixels.min_by(|a, b| gap(a).total_cmp(&gap(b))).expect("pixels");
    f64::from(picture.pixel(x, y).expect("within")[1])
}

#[test]
fn as_a_ball_lets_less_through_its_shadow_darkens_and_those_inside_it_fade() {
    let mut renderer = load("scenes/gallery/transparency.ron");
    *renderer.settings() = Settings { antialias: Antialias::Off, depth: 12, ..renderer.settings().clone() };
    let world = &mut renderer.world;
    let lamp = named::<PointLight>(world, "lamp").position;
    let centre = |world: &mut World, name| named::<Transform>(world, name).matrix().transform_point3(DVec3::ZERO);
    let (ball, stone) = (centre(world, "ball"), centre(world, "stone inside"));
    let on_ground = |through: DVec3| lamp + (through - lamp) * (lamp.y / (lamp.y - through.y));
    // In the shadow of the stone, and in that of the ball alone.
    let of_stone = on_ground(stone);
    let of_ball = on_ground(ball + DVec3::new(0.6, 0.3, 0.3));
    let mut seen = vec![];
    for n in 0..=5 {
        let alpha = f64::from(n) / 5.0;
        let world = &mut renderer.world;
        world.query::<&mut Opacity>().iter_mut(world).for_each(|mut opacity| opacity.alpha = alpha);
        let snapshot = renderer.snapshot().expect("a snapshot");
        let picture = render(&snapshot, &Options::default()).picture;
        seen.push([of_stone, of_ball].map(|place| at_ground(&snapshot, &picture, place)));
    }
    println!("the stone's shadow, the ball's: {seen:.4?}");
    let column = |n: usize| seen.iter().map(|places| places[n]).collect::<Vec<_>>();
    let [of_stone, of_ball] = [0, 1].map(column);
    // The ball's shadow darkens, from full light to none.
    assert!(of_ball.is_sorted_by(|a, b| a > b), "{of_ball:?}");
    // The stone's fades against the shadow around it: light passes the surface of the ball twice.
    for (n, (ball, stone)) in (0..).zip(of_ball.iter().zip(&of_stone)) {
        let through = 1.0 - f64::from(n) / 5.0;
        let expected = through * through * (of_ball[0] - of_stone[0]);
        assert!((ball - stone - expected).abs() < 1e-6, "at {n}: {} instead of {expected}", ball - stone);
    }
}
