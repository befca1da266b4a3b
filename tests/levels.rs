//! Walks give the same bits at every level of the machine, and those of the exhaustive test.

mod support {
    pub(crate) mod gallery;
    pub(crate) mod random;
    pub(crate) mod scene;
}

use snell::components::{
    lanes::Level,
    primitive::{Cost, Hit, Primitive},
    space::Ray,
};
use snell::prelude::*;
use std::sync::Mutex;
use support::{gallery::gallery, random::Random};

/// The level is one for the whole process: tests take turns.
static TURN: Mutex<()> = Mutex::new(());

fn at_every_level<T>(mut work: impl FnMut() -> T) -> Vec<(Level, T)> {
    let _turn = TURN.lock().expect("no test failed while it had its turn");
    let levels = Level::ALL.into_iter().filter(|level| level.is_available());
    let results = levels
        .map(|level| {
            level.choose();
            assert_eq!(Level::current(), level);
            (level, work())
        })
        .collect();
    Level::ALL.into_iter().rfind(|level| level.is_available()).expect("the baseline").choose();
    results
}

#[test]
fn every_level_draws_the_same_pictures_with_the_same_counts() {
    for scene in gallery() {
        let snapshot = scene.build(0).0.snapshot().expect("a snapshot");
        let drawn = at_every_level(|| {
            let frame = render(&snapshot, &Options::default());
            (frame.picture.hash(), frame.counts)
        });
        for (level, drawn_at_level) in &drawn {
            assert_eq!(*drawn_at_level, drawn[0].1, "{}: {level:?}", scene.name);
        }
    }
}

/// Triangles on a grid of small integers, with doubles: ties, edges and rays in planes abound.
fn lattice(random: &mut Random, count: usize) -> TriangleMesh {
    let mut point = || [0; 3].map(|_| random.below(5) as f32);
    let mut positions: Vec<[f32; 3]> = (0..3 * count).map(|_| point()).collect();
    positions.extend_from_within(..count / 3 * 3);
    let triangles = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    TriangleMesh::new(positions, triangles).expect("a mesh")
}

/// Small triangles anywhere in a cube of an odd size far from the origin.
fn soup(random: &mut Random, count: usize) -> TriangleMesh {
    let positions = (0..count)
        .flat_map(|_| {
            let centre = [0; 3].map(|_| 100.0 + random.unit());
            [0; 3].map(|_| centre.map(|c| (c + 0.1 * random.unit()) as f32))
        })
        .collect();
    TriangleMesh::new(positions, (0..count as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect()).expect("a mesh")
}

/// Rays at vertices, edges and insides, along axes and in planes, from everywhere.
fn rays(random: &mut Random, mesh: &TriangleMesh, count: usize) -> Vec<Ray> {
    let span = mesh.corners(0)[0].abs().max_element().max(1.0);
    (0..count)
        .map(|i| {
            let corners = mesh.corners(random.below(mesh.len()));
            let [u, v] = [random.unit(), random.unit()];
            let target = match i % 4 {
                0 => corners[i / 4 % 3],
                1 => corners[0] + (corners[1] - corners[0]) * u,
                2 => (corners[0] + corners[1] + corners[2]) / 3.0,
                _ => corners[0] * u + corners[1] * v + corners[2] * (1.0 - u - v),
            };
            let step = DVec3::from_array([0; 3].map(|_| random.unit() * 2.0 - 1.0)) * span * 3.0;
            let axes = [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
            match i / 4 % 4 {
                0 => Ray { origin: target - axes[i / 16 % 6] * 7.0, direction: axes[i / 16 % 6] },
                1 => Ray { origin: target + step, direction: -step },
                2 => Ray { origin: target, direction: step },
                _ => Ray { origin: target + step.floor(), direction: -step.floor() },
            }
        })
        .filter(|ray| ray.is_valid())
        .collect()
}

#[test]
fn every_level_hits_what_the_exhaustive_test_hits_to_the_last_bit() {
    let mut random = Random::new(5);
    let placements = [DAffine3::IDENTITY, DAffine3::from_scale(DVec3::new(-3.0, 0.5, 1.0))];
    for (n, mesh) in [lattice(&mut random, 9), lattice(&mut random, 300), soup(&mut random, 1), soup(&mut random, 500)]
        .into_iter()
        .enumerate()
    {
        let rays = rays(&mut random, &mesh, 4000);
        let mesh = Mesh::new(mesh);
        for placement in &placements {
            let (_, packed) = mesh.pack(placement).expect("a mesh with area");
            let mut hits = 0;
            let expected: Vec<Option<Hit>> = rays
                .iter()
                .map(|ray| {
                    Mesh::hit_with(
                        &packed,
                        &world(ray, placement),
                        f64::INFINITY,
                        &Methods::BRUTE_FORCE,
                        &mut Cost::default(),
                    )
                })
                .collect();
            at_every_level(|| {
                let level = Level::current();
                for (ray, expected) in rays.iter().zip(&expected) {
                    let ray = world(ray, placement);
                    let cost = &mut Cost::default();
                    let found = Mesh::hit(&packed, &ray, f64::INFINITY, cost);
                    assert_eq!(bits(found), bits(*expected), "mesh {n} at {level:?}: {ray:?}");
                    assert_eq!(Mesh::blocks(&packed, &ray, f64::INFINITY, cost), expected.is_some(), "{level:?}");
                    if let Some(Hit { t, .. }) = expected {
                        hits += 1;
                        // The range is closed for hits and open for shadows.
                        assert_eq!(bits(Mesh::hit(&packed, &ray, *t, cost)), bits(*expected), "{level:?}: {ray:?}");
                        assert_eq!(Mesh::hit(&packed, &ray, t.next_down(), cost), None, "{level:?}: {ray:?}");
                        assert!(!Mesh::blocks(&packed, &ray, *t, cost), "{level:?}: {ray:?}");
                        assert!(Mesh::blocks(&packed, &ray, t.next_up(), cost), "{level:?}: {ray:?}");
                    }
                }
            });
            assert!(hits > 2000, "rays that hit nothing show nothing: {hits}");
        }
    }
}

fn world(ray: &Ray, placement: &DAffine3) -> Ray {
    ray.transformed(placement)
}

fn bits(hit: Option<Hit>) -> Option<(u64, u32)> {
    hit.map(|hit| (hit.t.to_bits(), hit.part))
}
