//! One hash per scene, whatever draws it: every combination of threads, tiles, levels of the machine, accelerators, orders
//! of making, orders of the systems, whole pictures and such put together from parts.
//!
//! The oracle is the list of hashes on record, to which builds of every kind must come: see `tests/builds.sh` for those.

mod support {
    pub(crate) mod gallery;
    pub(crate) mod random;
    pub(crate) mod scene;
}

use snell::components::lanes::Level;
use snell::prelude::*;
use snell::systems::pipeline::BUILT_IN;
use support::{gallery::gallery, random::Random, scene::Scene};

const THREADS: [usize; 4] = [1, 2, 3, 8];
const TILES: [u32; 4] = [8, 16, 33, 64];
const ACCELERATORS: [Accelerator; 3] = [Accelerator::Tree, Accelerator::SphereTree, Accelerator::BruteForce];

/// A renderer whose systems stand in the schedule in an order by `seed`: as far as they may, which is where the schedule
/// itself, for which unwritten orders that matter are errors, leaves it open.
fn renderer(seed: u64) -> Renderer {
    let mut random = Random::new(seed);
    let mut kinds = BUILT_IN;
    for i in (1..kinds.len()).rev() {
        kinds.swap(i, random.below(i + 1));
    }
    kinds.into_iter().fold(Renderer::bare(), |renderer, add| add(renderer))
}

fn snapshot(scene: &Scene, seed: u64) -> std::sync::Arc<Snapshot> {
    scene.build_in(renderer(seed), seed).0.snapshot().expect("a snapshot")
}

/// The picture put together from four parts, each drawn by itself.
fn from_parts(snapshot: &Snapshot, options: &Options) -> Picture {
    let Settings { width, height, .. } = snapshot.settings;
    let (left, top) = (width / 3, height / 2 + 1);
    let mut whole = Picture::black(width, height);
    for (x, part_width) in [(0, left), (left, width - left)] {
        for (y, part_height) in [(0, top), (top, height - top)] {
            let region = Region { x, y, width: part_width, height: part_height };
            let part = render(snapshot, &Options { region: Some(region), ..options.clone() }).picture;
            for (i, pixel) in (0..).zip(part.pixels) {
                let (u, v) = (x + i % part_width, y + i / part_width);
                whole.pixels[(v * width + u) as usize] = pixel;
            }
        }
    }
    whole
}

#[test]
fn one_hash_per_scene() {
    let recorded: Vec<(&str, &str)> =
        include_str!("hashes.txt").lines().map(|line| line.split_once(' ').expect("a name and a hash")).collect();
    let levels: Vec<Level> = Level::ALL.into_iter().filter(|level| level.is_available()).collect();
    let mut seed = 0;
    for scene in gallery() {
        let expected = recorded.iter().find(|(name, _)| *name == scene.name).expect("a scene on record").1;
        for level in &levels {
            level.choose();
            for accelerator in ACCELERATORS {
                for threads in THREADS {
                    for tile in TILES {
                        seed += 1;
                        let snapshot = snapshot(&scene, seed);
                        let methods = Methods { accelerator, ..Methods::default() };
                        let options =
                            Options { threads: Some(threads), tile: Some(tile), methods, ..Options::default() };
                        let cell = format!(
                            "{}: {level:?}, {accelerator:?}, {threads} threads, tile {tile}, seed {seed}",
                            scene.name
                        );
                        assert_eq!(render(&snapshot, &options).picture.hash(), expected, "{cell}");
                        assert_eq!(from_parts(&snapshot, &options).hash(), expected, "{cell}, from parts");
                    }
                }
            }
        }
        levels.last().expect("the baseline").choose();
        // A check of the check: where anything of the picture is other, the hash is.
        let mut other = scene.build(0).0;
        for mut camera in other.world.query::<&mut Camera>().iter_mut(&mut other.world) {
            camera.position.x += 1e-3;
        }
        let other = render(&other.snapshot().expect("a snapshot"), &Options::default()).picture.hash();
        assert_ne!(other, expected, "{}: another place of the camera", scene.name);
    }
}
