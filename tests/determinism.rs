//! A picture is the same to the last bit whatever made it: any threads, tiles and regions, any order of making the
//! scene, with or without trees, in any build.
//!
//! The oracle is the committed list of hashes: every build on every machine must arrive at it.

mod support {
    pub(crate) mod gallery;
    pub(crate) mod random;
    pub(crate) mod scene;
}

use snell::prelude::*;
use snell::systems::render::pixel;
use std::fmt::Write;
use support::{gallery::gallery, random::Random, scene::Scene};

const THREADS: [usize; 4] = [1, 2, 3, 8];
const TILES: [u32; 4] = [7, 16, 33, 64];

fn snapshot(scene: &Scene, order: u64) -> std::sync::Arc<Snapshot> {
    scene.build(order).0.snapshot().expect("a snapshot")
}

fn picture(scene: &Scene) -> Picture {
    render(&snapshot(scene, 0), &Options::default()).picture
}

#[test]
fn every_build_makes_the_pictures_on_record() {
    let mut hashes = String::new();
    for scene in gallery() {
        let frame = render(&snapshot(&scene, 0), &Options::default());
        assert_eq!(frame.counts.not_finite, 0, "{}: pixels that are no numbers", scene.name);
        writeln!(hashes, "{} {}", scene.name, frame.picture.hash()).expect("text");
    }
    let recorded = include_str!("hashes.txt");
    assert_eq!(recorded, hashes, "to put these pictures on record, tests/hashes.txt is to read\n{hashes}");
}

#[test]
fn neither_threads_nor_tiles_nor_the_order_of_making_matter() {
    for scene in gallery() {
        let expected = picture(&scene).hash();
        for (i, threads) in THREADS.into_iter().enumerate() {
            for (j, tile) in TILES.into_iter().enumerate() {
                let order = (i * TILES.len() + j) as u64;
                let options = Options { threads: Some(threads), tile: Some(tile), ..Options::default() };
                let found = render(&snapshot(&scene, order), &options).picture.hash();
                assert_eq!(found, expected, "{}: {threads} threads, tile {tile}, order {order}", scene.name);
            }
        }
    }
}

#[test]
fn sums_over_lights_follow_their_names_to_the_last_bit() {
    let brightness = |renamed: bool, order: u64| {
        let mut scene = Scene::new("lights", Settings { width: 1, height: 1, ..Settings::default() });
        scene.put(
            "camera",
            Camera { position: DVec3::new(0.1, 1.0, 0.2), target: Some(DVec3::ZERO), ..Camera::default() },
        );
        scene.put("ground", (Plane {}, Diffuse(Rgb::ONE), Ambient(Rgb::ONE)));
        for i in 0..9 {
            let name = if renamed { 4 * i % 9 } else { i };
            let intensity = Rgb::splat(1.0 / f64::from(3 + i * i % 11));
            scene.put(
                format!("lamp {name}"),
                PointLight { position: DVec3::new(f64::from(i), 3.0, 1.0), intensity, ..PointLight::default() },
            );
            scene.put(format!("sky {name}"), AmbientLight { intensity });
        }
        let snapshot = snapshot(&scene, order);
        let light = pixel(&snapshot, 0, 0, &Methods::default(), &mut snell::Counts::default());
        (light, snapshot.lights.ambient)
    };
    for order in 1..20 {
        assert_eq!(brightness(false, order), brightness(false, 0), "order {order}");
    }
    // Shown to matter: in another order of names the sums differ.
    let (named, renamed) = (brightness(false, 0), brightness(true, 0));
    assert!(named.0 != renamed.0 && named.1 != renamed.1);
}

#[test]
fn rendering_twice_gives_the_same_picture_and_the_same_counts() {
    for scene in gallery() {
        let snapshot = snapshot(&scene, 0);
        let [a, b] = [1, 2].map(|threads| render(&snapshot, &Options { threads: Some(threads), ..Options::default() }));
        assert_eq!((a.picture, a.counts), (b.picture, b.counts), "{}", scene.name);
    }
}

#[test]
fn a_region_is_the_part_of_the_whole() {
    for scene in gallery() {
        let (snapshot, whole) = (snapshot(&scene, 0), picture(&scene));
        for (x, y, width, height) in [(0, 0, 1, 1), (5, 3, 17, 20), (39, 29, 1, 1), (0, 10, 40, 1), (33, 0, 7, 30)] {
            let region = Region { x, y, width, height };
            for tile in TILES {
                let options = Options { region: Some(region), tile: Some(tile), ..Options::default() };
                let part = render(&snapshot, &options).picture;
                assert_eq!(Some(part), whole.crop(region), "{}: {region:?}, tile {tile}", scene.name);
            }
        }
    }
}

#[test]
fn the_trees_change_nothing() {
    for scene in gallery() {
        for accelerator in [Accelerator::SphereTree, Accelerator::BruteForce] {
            let options = Options { methods: Methods { accelerator, ..Methods::default() }, ..Options::default() };
            let found = render(&snapshot(&scene, 0), &options).picture.hash();
            assert_eq!(found, picture(&scene).hash(), "{}: {accelerator:?}", scene.name);
        }
    }
}

#[test]
fn a_hundred_edits_undone_leave_every_scene_as_it_was() {
    let mut random = Random::new(11);
    for scene in gallery() {
        let (mut renderer, entities) = scene.build(0);
        let placed: Vec<Entity> =
            entities.values().copied().filter(|entity| renderer.world.get::<Transform>(*entity).is_some()).collect();
        let mut undo = vec![];
        for i in 0..100 {
            let entity = placed[random.below(placed.len())];
            let mut transform = renderer.world.get_mut::<Transform>(entity).expect("a placement");
            undo.push((entity, transform.clone()));
            transform.0.push(Step::RotateY(360.0 * random.unit()));
            transform.0.push(Step::Translate(DVec3::new(random.unit(), random.unit(), random.unit())));
            if i % 10 == 0 {
                renderer.snapshot().expect("a snapshot");
            }
        }
        let edited = render(&renderer.snapshot().expect("a snapshot"), &Options::default()).picture;
        for (entity, transform) in undo.into_iter().rev() {
            *renderer.world.get_mut::<Transform>(entity).expect("a placement") = transform;
        }
        let undone = render(&renderer.snapshot().expect("a snapshot"), &Options::default()).picture;
        assert_eq!(undone.hash(), picture(&scene).hash(), "{}", scene.name);
        assert_ne!(undone.hash(), edited.hash(), "{}: the edits do not show", scene.name);
    }
}

#[test]
fn soft_shadows_are_the_same_on_any_thread_and_in_any_part() {
    let mut scene = Scene::new("soft", Settings { width: 40, height: 30, ..Settings::default() });
    scene.put("camera", Camera { position: DVec3::new(0.0, 2.0, 5.0), target: Some(DVec3::Y), ..Camera::default() });
    scene.put("panel", DiskLight { position: DVec3::new(1.0, 5.0, 1.0), radius: 1.0, ..DiskLight::default() });
    scene.put("ball", (Sphere { radius: 1.0 }, Transform::at(DVec3::Y), Dielectric { index: 1.5 }));
    scene.put("bar", (Cuboid { size: DVec3::new(0.3, 3.0, 0.3) }, Transform::at(DVec3::X)));
    scene.put("ground", Plane {});
    let whole = picture(&scene);
    let snapshot = snapshot(&scene, 5);
    for (threads, tile) in [(1, 7), (3, 16), (2, 64)] {
        let options = Options { threads: Some(threads), tile: Some(tile), ..Options::default() };
        assert_eq!(render(&snapshot, &options).picture.hash(), whole.hash(), "{threads} threads, tile {tile}");
    }
    let region = Region { x: 5, y: 13, width: 30, height: 10 };
    let part = render(&snapshot, &Options { region: Some(region), ..Options::default() }).picture;
    assert_eq!(Some(part), whole.crop(region));
}
