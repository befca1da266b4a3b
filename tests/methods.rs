//! The methods that Snell is measured against: they work, they are the ones they are named after, and what they share
//! with ours they share to the last bit.

mod support {
    pub(crate) mod gallery;
    pub(crate) mod random;
    pub(crate) mod scene;
}

use snell::prelude::*;
use snell::{Precision, SphereTest, TriangleTest, components::shape::Sphere};
use std::sync::Arc;
use support::gallery::{bumpy, gallery};

const TRIANGLE_TESTS: [TriangleTest; 3] = [TriangleTest::Sheared, TriangleTest::MollerTrumbore, TriangleTest::RayFrame];

fn all() -> impl Iterator<Item = Methods> {
    let with = |triangle, sphere, precision| Methods { triangle, sphere, precision, ..Methods::default() };
    TRIANGLE_TESTS.into_iter().flat_map(move |triangle| {
        [SphereTest::Robust, SphereTest::Naive]
            .into_iter()
            .flat_map(move |sphere| [Precision::F64, Precision::F32].map(|precision| with(triangle, sphere, precision)))
    })
}

fn picture(snapshot: &Snapshot, methods: Methods) -> Picture {
    render(snapshot, &Options { methods, ..Options::default() }).picture
}

/// Share of pixels that differ by more than 1/255 in some channel.
fn off(a: &Picture, b: &Picture) -> f64 {
    let differ = |(a, b): &(&[f32; 3], &[f32; 3])| a.iter().zip(*b).any(|(a, b)| (a - b).abs() > 1.0 / 255.0);
    a.pixels.iter().zip(&b.pixels).filter(differ).count() as f64 / a.pixels.len() as f64
}

/// Oracle: the default methods. No scene of the gallery is hard for any test.
#[test]
fn every_method_draws_nearly_the_same_pictures() {
    for scene in gallery() {
        let snapshot = scene.build(0).0.snapshot().expect("a snapshot");
        let ours = picture(&snapshot, Methods::default());
        for methods in all() {
            let share = off(&picture(&snapshot, methods), &ours);
            let most = if methods.precision == Precision::F64 { 0.005 } else { 0.05 };
            assert!(share <= most, "{} with {methods}: {share} of the pixels differ", scene.name);
        }
    }
}

/// Oracle: brute force with the same tests.
#[test]
fn the_sphere_tree_gives_the_same_bits_with_every_test() {
    for scene in gallery() {
        let snapshot = scene.build(0).0.snapshot().expect("a snapshot");
        for methods in all() {
            let [spheres, brute] = [Accelerator::SphereTree, Accelerator::BruteForce]
                .map(|accelerator| picture(&snapshot, Methods { accelerator, ..methods }).hash());
            assert_eq!(spheres, brute, "{} with {methods}", scene.name);
        }
    }
}

/// Each choice reaches the code it names: in the last bits, all differ.
#[test]
fn no_method_is_another_in_disguise() {
    let mut renderer = Renderer::new();
    renderer.world.spawn(Camera { position: DVec3::new(0.3, 0.2, 5.0), ..Camera::default() });
    renderer.world.spawn((Mesh::new(Arc::new(bumpy(9, 7, false))), Transform::at(DVec3::new(0.1, 0.1, -1.0))));
    renderer.world.spawn((Sphere { radius: 0.7 }, Transform::at(DVec3::new(0.3, 0.5, 1.1))));
    let geometry = renderer.snapshot().expect("a snapshot").geometry.clone();
    let distances = |methods: &Methods| -> Vec<Option<f64>> {
        let at = |i: usize| DVec3::new((i % 40) as f64 / 20.0 - 1.0, (i / 40) as f64 / 20.0 - 1.0, -5.1);
        let ray = |i: usize| Ray { origin: DVec3::new(0.3, 0.2, 5.0), direction: at(i) };
        let hit = |i| geometry.closest(&ray(i), f64::INFINITY, methods, &mut Cost::default());
        (0..1600).map(|i| hit(i).map(|hit| hit.t)).collect()
    };
    let found: Vec<_> = all().map(|methods| distances(&methods)).collect();
    for (i, a) in found.iter().enumerate() {
        assert!(a.iter().flatten().count() > 500);
        for (j, b) in found.iter().enumerate().take(i) {
            assert_ne!(a, b, "methods {i} and {j}");
        }
    }
}

/// The costs that tell the trees apart: a chaos of large triangles is the worst case of the sphere tree.
#[test]
fn the_sphere_tree_is_a_list_where_triangles_are_large() {
    let mut random = support::random::Random::new(5);
    let mut soup = |size: f64| {
        let mut point =
            |about: DVec3, reach: f64| about + (DVec3::new(random.unit(), random.unit(), random.unit()) - 0.5) * reach;
        let mut positions = vec![];
        for _ in 0..2000 {
            let about = point(DVec3::ZERO, 10.0);
            positions.extend([0; 3].map(|_| point(about, size).as_vec3().to_array()));
        }
        let triangles = (0..2000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let mut renderer = Renderer::new();
        renderer.world.spawn(Camera { position: DVec3::Z * 20.0, ..Camera::default() });
        *renderer.settings() = Settings { width: 32, height: 24, ..Settings::default() };
        renderer.world.spawn(Mesh::new(TriangleMesh::new(positions, triangles).expect("a mesh")));
        let snapshot = renderer.snapshot().expect("a snapshot");
        let tests = |accelerator| {
            let methods = Methods { accelerator, ..Methods::default() };
            let counts = render(&snapshot, &Options { methods, ..Options::default() }).counts;
            counts.primitives as f64 / counts.rays() as f64
        };
        (tests(Accelerator::SphereTree), tests(Accelerator::Tree), tests(Accelerator::BruteForce))
    };
    let (spheres, boxes, _) = soup(0.1);
    assert!(spheres < 20.0 && boxes < 20.0, "small triangles: {spheres} and {boxes} tests a ray");
    let (spheres, boxes, brute) = soup(10.0);
    assert!(spheres > 0.5 * brute && boxes < 0.5 * spheres, "large triangles: {spheres} and {boxes} of {brute}");
}

/// F39. A height field of 4050 triangles a ten-thousandth large, with two triangles of ten beside it: a tree must not cost
/// more than two and a half times what the field alone does.
#[test]
fn a_teapot_in_a_stadium_costs_little_more_than_the_teapot() {
    let patch = |stadium: bool| {
        let mut random = support::random::Random::new(9);
        let (along, size) = (46u32, 1e-4);
        let mut positions = vec![];
        for i in 0..along * along {
            let at = |n: u32| (f64::from(n) / f64::from(along - 1) - 0.5) * size;
            positions.push(DVec3::new(at(i % along), 0.02 * size * random.unit(), at(i / along)).as_vec3().to_array());
        }
        let mut triangles = vec![];
        for i in (0..along * (along - 1)).filter(|i| i % along != along - 1) {
            triangles.extend([[i, i + along, i + 1], [i + 1, i + along, i + along + 1]]);
        }
        assert_eq!(triangles.len(), 4050);
        if stadium {
            let n = positions.len() as u32;
            positions.extend([[-5.0, -1e-5, -5.0], [5.0, -1e-5, -5.0], [5.0, -1e-5, 5.0], [-5.0, -1e-5, 5.0]]);
            triangles.extend([[n, n + 2, n + 1], [n, n + 3, n + 2]]);
        }
        let mut renderer = Renderer::new();
        let eye = DVec3::new(0.2, 0.9, 0.8) * size;
        renderer.world.spawn(Camera { position: eye, target: Some(DVec3::ZERO), ..Camera::default() });
        *renderer.settings() = Settings { width: 64, height: 48, ..Settings::default() };
        renderer.world.spawn(Mesh::new(TriangleMesh::new(positions, triangles).expect("a mesh")));
        let snapshot = renderer.snapshot().expect("a snapshot");
        let tests = |accelerator| {
            let methods = Methods { accelerator, ..Methods::default() };
            let counts = render(&snapshot, &Options { methods, ..Options::default() }).counts;
            (counts.nodes + counts.primitives) as f64 / counts.rays() as f64
        };
        (tests(Accelerator::Tree), tests(Accelerator::BruteForce))
    };
    let ((alone, _), (beside, brute)) = (patch(false), patch(true));
    assert!(beside <= 2.5 * alone, "{beside} tests a ray, {alone} without the stadium");
    assert!(brute > 100.0 * beside, "a list: {brute}");
}
