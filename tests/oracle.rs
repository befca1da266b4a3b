//! What rays meet, against oracles: testing everything one by one, the topology of closed meshes, exact arithmetic.

mod support {
    pub(crate) mod gallery;
    pub(crate) mod random;
    pub(crate) mod scene;
}

use num_bigint::{BigInt, Sign};
use snell::components::{
    math,
    packet::{PACKET, Packet},
    primitive::Cost,
    shape::RayFrame,
};
use snell::prelude::*;
use snell::systems::accelerate::{Bests, Intersection};
use std::sync::Arc;
use support::{
    gallery::{bumpy, gallery},
    random::Random,
};

/// Unit roundoff.
const U: f64 = f64::EPSILON / 2.0;

/// The trees of spheres of 2004.
const SPHERES: Methods = Methods { accelerator: Accelerator::SphereTree, ..Methods::BRUTE_FORCE };

fn vector(random: &mut Random, reach: f64) -> DVec3 {
    let [x, y, z] = [0; 3].map(|_| (random.unit() * 2.0 - 1.0) * reach);
    DVec3::new(x, y, z)
}

/// Integer coordinates from −`reach` to `reach`.
fn lattice(random: &mut Random, reach: usize) -> DVec3 {
    let [x, y, z] = [0; 3].map(|_| random.below(2 * reach + 1) as f64 - reach as f64);
    DVec3::new(x, y, z)
}

/// Any placement: turned, scaled unevenly, mirrored, sheared, or none of it.
fn placement(random: &mut Random) -> Transform {
    let at = Step::Translate(vector(random, 8.0));
    let turn = Step::Rotate { axis: vector(random, 1.0), degrees: 360.0 * random.unit() };
    let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
    let uneven = Step::Scale((vector(random, 2.0).abs() + 0.05) * DVec3::new(sign, 1.0, 1.0));
    Transform::new(match random.below(6) {
        0 => vec![],
        1 => vec![Step::Translate(lattice(random, 8))],
        2 => vec![turn, at],
        3 => vec![Step::Scale(DVec3::splat(0.1 + 2.0 * random.unit())), turn, at],
        4 => vec![uneven, turn, at],
        _ => vec![turn, uneven, Step::RotateX(50.0), at],
    })
}

/// A scene of every shape, some things twice in the very same place, and points of interest: corners, edges, centres.
fn jumble(seed: u64) -> (Arc<Snapshot>, Vec<DVec3>) {
    let mut random = Random::new(seed);
    let mut renderer = Renderer::new();
    renderer.world.spawn((Name::new("camera"), Camera::default()));
    let models = [Arc::new(bumpy(6, 4, false)), Arc::new(bumpy(11, 7, true))];
    let mut points = vec![];
    for i in 0..60 {
        let transform = placement(&mut random);
        let matrix = transform.matrix();
        let mut aim = |point: DVec3| points.push(matrix.transform_point3(point));
        // The later name first: the earlier one must win nevertheless.
        let names = [format!("twin of thing {i:02}"), format!("thing {i:02}")];
        let names = &names[if random.below(3) == 0 { 0 } else { 1 }..];
        let world = &mut renderer.world;
        match i % 6 {
            0 => {
                let radius = 0.2 + random.unit();
                [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::NEG_Z].into_iter().for_each(|p| aim(p * radius));
                spawn(world, names, (Sphere { radius }, transform));
            }
            1 => {
                let size = vector(&mut random, 1.5).abs() + 0.1;
                Bounds { min: size * -0.5, max: size * 0.5 }.corners().into_iter().for_each(&mut aim);
                aim(DVec3::new(0.5, 0.5, 0.0) * size);
                spawn(world, names, (Cuboid { size }, transform));
            }
            2 | 3 => {
                let [a, b, c] = [0; 3].map(|_| lattice(&mut random, 3));
                let normals = if i % 6 == 2 { vec![] } else { vec![DVec3::X, DVec3::Y, DVec3::ONE] };
                [a, b, c, (a + b) * 0.5, b * 0.25 + c * 0.75].into_iter().for_each(&mut aim);
                let triangle = Triangle { a, b, c, normals, ..Triangle::default() };
                spawn(world, names, (triangle.clone(), transform));
            }
            4 => {
                let model = &models[random.below(2)];
                for i in 0..model.len() {
                    let [a, b, c] = model.corners(i);
                    aim(a);
                    aim((b + c) * 0.5);
                }
                let mesh =
                    if random.below(2) == 0 { Mesh::new(model.clone()) } else { Mesh::new(model.clone()).smooth() };
                spawn(world, names, (mesh.clone(), transform));
            }
            // Few, for they hide the rest.
            _ if i < 12 => {
                let far = Transform::new([Step::RotateX(17.0), Step::Translate(DVec3::Y * (-9.0 - f64::from(i)))]);
                spawn(world, names, (Plane {}, far));
            }
            _ => {}
        }
    }
    (renderer.snapshot().expect("a snapshot"), points)
}

/// The same thing under each of some names.
fn spawn(world: &mut World, names: &[String], bundle: impl Bundle + Clone) {
    for name in names {
        world.spawn((Name::new(name.as_str()), bundle.clone()));
    }
}

/// A ray of any kind: random, along an axis, aimed at a point of interest, in its planes, from a surface.
fn ray(random: &mut Random, points: &[DVec3], last: Option<&Intersection>) -> Ray {
    let axis = |random: &mut Random| {
        let zero = if random.below(2) == 0 { 0.0 } else { -0.0 };
        let mut direction = DVec3::splat(zero);
        direction[random.below(3)] = [1.0, -1.0, 0.125, -3.0][random.below(4)];
        direction
    };
    let point = points[random.below(points.len())];
    let origin = match (random.below(4), last) {
        (0, Some(last)) => last.surface.point,
        (1, Some(last)) => last.surface.departure(last.surface.normal, last.t),
        (2, _) => lattice(random, 10),
        _ => vector(random, 12.0),
    };
    match random.below(6) {
        0 => Ray { origin, direction: vector(random, 1.0) },
        1 => Ray { origin, direction: lattice(random, 2) },
        2 => Ray { origin, direction: axis(random) },
        3 => {
            // Along an axis, exactly through a point of interest.
            let direction = axis(random);
            Ray { origin: point - direction * (1.0 + 10.0 * random.unit()), direction }
        }
        4 => Ray { origin, direction: (point - origin).normalize_or(DVec3::X) },
        _ => Ray { origin, direction: (point - origin) * (2.0 * random.unit()) },
    }
}

#[test]
fn the_nearest_hit_is_that_of_brute_force_bit_for_bit() {
    let (mut rays, mut hits) = (0, 0);
    for seed in 0..24 {
        let (snapshot, points) = jumble(seed);
        let geometry = &snapshot.geometry;
        let mut random = Random::new(seed + 1000);
        let mut last = None;
        for _ in 0..1500 {
            let ray = ray(&mut random, &points, last.as_ref());
            let t_max = if random.below(4) == 0 { 20.0 * random.unit() } else { f64::INFINITY };
            let closest = |with| geometry.closest(&ray, t_max, &with, &mut Cost::default());
            let (tree, brute) = (closest(Methods::default()), closest(Methods::BRUTE_FORCE));
            let spheres = closest(SPHERES);
            // The text of a number tells −0 from 0.
            assert_eq!(format!("{tree:?}"), format!("{brute:?}"), "seed {seed}: {ray:?}");
            assert_eq!(format!("{spheres:?}"), format!("{brute:?}"), "seed {seed}: {ray:?}");
            let mut limits = vec![20.0 * random.unit()];
            if let Some(met) = brute {
                limits.extend([met.t, met.t.next_up(), met.t.next_down()]);
                let name = snapshot.names[met.object as usize].as_ref().expect("a name");
                assert!(!name.as_str().starts_with("twin"), "seed {seed}: {name} hides its twin from {ray:?}");
            }
            for limit in limits.into_iter().filter(|limit| *limit <= t_max) {
                let blocked = |with| geometry.blocked(&ray, limit, &with, &mut Cost::default());
                let expected = brute.is_some_and(|met| met.t < limit);
                assert_eq!(blocked(Methods::default()), expected, "seed {seed}, limit {limit}: {ray:?}");
                if rays % 8 == 0 {
                    assert_eq!(blocked(Methods::BRUTE_FORCE), expected, "seed {seed}, limit {limit}: {ray:?}");
                    assert_eq!(blocked(SPHERES), expected, "seed {seed}, limit {limit}: {ray:?}");
                }
            }
            rays += 1;
            hits += usize::from(brute.is_some());
            last = brute.or(last);
        }
    }
    assert!(hits > rays / 3, "{hits} of {rays} rays hit: too few to show anything");
}

#[test]
fn rays_in_a_packet_meet_what_they_meet_alone_bit_for_bit() {
    let (mut rays, mut hits, mut blocks) = (0, 0, 0);
    let mut best = Bests::default();
    for seed in 0..40 {
        let (whole, points) = jumble(seed);
        // All shapes, and so few that no tree is over them.
        let few = whole.geometry.of_objects(|object| object % 29 == seed as u32 % 29);
        let mut random = Random::new(seed + 5000);
        for n in 0..30 {
            let geometry = if n % 3 == 0 { &few } else { &*whole.geometry };
            let (mut packet, mut t_max) = (Packet::default(), [0.0; PACKET]);
            let mut last = None;
            let common = ray(&mut random, &points, None);
            for _ in 0..1 + random.below(PACKET) {
                // Some that belong together, some that do not, and now and then one that no box knows, or that is none.
                let ray = match random.below(40) {
                    0 => Ray { origin: DVec3::splat(1e39), direction: DVec3::NEG_ONE },
                    1 => Ray { origin: common.origin, direction: DVec3::NAN },
                    _ if n % 2 == 0 => {
                        Ray { direction: common.direction + vector(&mut random, 0.05), origin: common.origin }
                    }
                    _ => ray(&mut random, &points, last.as_ref()),
                };
                let met = geometry.closest(&ray, f64::INFINITY, &Methods::default(), &mut Cost::default());
                let ends = [f64::INFINITY, 20.0 * random.unit(), met.map_or(1.0, |met| met.t)];
                t_max[packet.push(&ray)] = ends[random.below(3)];
                last = met.or(last);
            }
            let limit = if n % 5 == 0 { 15.0 * random.unit() } else { f64::INFINITY };
            let (with, mut cost) = (Methods::default(), Cost::default());
            best.begin(packet.all(), limit);
            geometry.nearest_packet(&packet, packet.all(), &with, &mut best, &mut cost);
            let asked = packet.all() & ((u64::MAX / 3) | n);
            let blocked = geometry.blocked_packet(&packet, asked, &t_max, &with, &mut cost);
            for (i, &t_max) in t_max[..packet.len()].iter().enumerate() {
                let ray = packet.ray(i);
                let alone = geometry.nearest(&ray, limit, &with, &mut cost);
                assert_eq!(format!("{:?}", best.nearest(i)), format!("{alone:?}"), "seed {seed}, {n}: {ray:?}");
                let alone = asked >> i & 1 == 1 && geometry.blocked(&ray, t_max, &with, &mut cost);
                assert_eq!(blocked >> i & 1 == 1, alone, "seed {seed}, {n}, up to {t_max}: {ray:?}");
                (rays, hits, blocks) =
                    (rays + 1, hits + usize::from(best.nearest(i).is_some()), blocks + usize::from(alone));
            }
        }
    }
    assert!(hits > rays / 5 && blocks > rays / 20, "{hits} hit and {blocks} blocked of {rays}");
}

#[test]
fn rays_that_are_none_meet_nothing() {
    let (snapshot, _) = jumble(1);
    for (origin, direction) in [
        (DVec3::NAN, DVec3::X),
        (DVec3::ZERO, DVec3::NAN),
        (DVec3::ZERO, DVec3::ZERO),
        (DVec3::INFINITY, DVec3::X),
        (DVec3::ZERO, DVec3::new(f64::INFINITY, 1.0, 0.0)),
    ] {
        for with in [&Methods::default(), &SPHERES, &Methods::BRUTE_FORCE] {
            let (ray, mut cost) = (Ray { origin, direction }, Cost::default());
            assert!(snapshot.geometry.closest(&ray, f64::INFINITY, with, &mut cost).is_none(), "{ray:?}");
            assert!(!snapshot.geometry.blocked(&ray, f64::INFINITY, with, &mut cost), "{ray:?}");
            assert_eq!(cost, Cost::default(), "{ray:?}");
        }
    }
}

#[test]
fn whole_pictures_are_the_same_without_trees() {
    for scene in gallery() {
        let snapshot = scene.build(0).0.snapshot().expect("a snapshot");
        let picture = |methods| render(&snapshot, &Options { methods, ..Options::default() }).picture.hash();
        assert_eq!(picture(Methods::default()), picture(Methods::BRUTE_FORCE), "{}", scene.name);
        assert_eq!(picture(SPHERES), picture(Methods::BRUTE_FORCE), "{}", scene.name);
    }
}

/// A ray from within the mesh to a vertex, or to a point of an edge of one of its triangles.
fn aimed(random: &mut Random, mesh: &TriangleMesh) -> Ray {
    let [a, b, _] = mesh.corners(random.below(mesh.len()));
    let along = if random.below(3) == 0 { 0.0 } else { random.unit() };
    let origin = vector(random, 0.25);
    Ray { origin, direction: (a + (b - a) * along - origin).normalize() }
}

/// The usual test, as it is usually written (Möller and Trumbore, 1997), without any tolerance.
fn moller_trumbore(ray: &Ray, [a, b, c]: [DVec3; 3]) -> bool {
    let (e1, e2) = (b - a, c - a);
    let p = ray.direction.cross(e2);
    let det = e1.dot(p);
    if det == 0.0 {
        return false;
    }
    let s = ray.origin - a;
    let u = s.dot(p) / det;
    let q = s.cross(e1);
    let v = ray.direction.dot(q) / det;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && e2.dot(q) / det > 0.0
}

/// Oracle: topology. Every ray from within a closed mesh leaves it somewhere.
#[test]
fn no_ray_leaks_out_of_a_closed_mesh() {
    let mesh = Arc::new(bumpy(8, 8, false));
    let placements = [
        Transform::default(),
        Transform::new([Step::Scale(DVec3::splat(1e-6)), Step::Translate(DVec3::new(1.0, 2.0, 3.0))]),
        Transform::new([Step::Scale(DVec3::splat(1e6)), Step::RotateX(33.0)]),
        Transform::new([Step::Scale(DVec3::new(-1.0, 0.3, 2.0)), Step::RotateZ(70.0), Step::Translate(DVec3::ONE)]),
        Transform::at(DVec3::new(148_376.0, 1234.0, -223_423.0)),
    ];
    let mut random = Random::new(1);
    for placement in placements {
        let matrix = placement.matrix();
        let mut renderer = Renderer::new();
        renderer.world.spawn(Camera::default());
        renderer.world.spawn((Mesh::new(mesh.clone()), placement.clone()));
        let geometry = renderer.snapshot().expect("a snapshot").geometry.clone();
        for i in 0..40_000 {
            let ray = aimed(&mut random, &mesh).transformed(&matrix);
            let mut cost = Cost::default();
            assert!(geometry.blocked(&ray, f64::INFINITY, &Methods::default(), &mut cost), "{placement:?}: {ray:?}");
            if i % 20 == 0 {
                assert!(geometry.blocked(&ray, f64::INFINITY, &Methods::BRUTE_FORCE, &mut cost), "{ray:?}");
                assert!(geometry.closest(&ray, f64::INFINITY, &Methods::default(), &mut cost).is_some(), "{ray:?}");
            }
        }
    }
}

#[test]
fn the_usual_triangle_test_leaks_on_the_same_rays() {
    let mesh = bumpy(8, 8, false);
    let mut random = Random::new(1);
    let leaks = |ray: &Ray| !(0..mesh.len()).any(|i| moller_trumbore(ray, mesh.corners(i)));
    let count = (0..20_000).filter(|_| leaks(&aimed(&mut random, &mesh))).count();
    assert!(count > 100, "{count} leaks: the rays are not aimed well enough to show anything");
}

/// Three integer coordinates.
fn integers(v: DVec3) -> [i128; 3] {
    v.to_array().map(|x| {
        assert_eq!(x, x.round());
        x as i128
    })
}

fn dot(a: [i128; 3], b: [i128; 3]) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [i128; 3], b: [i128; 3]) -> [i128; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// What holds for a ray and a triangle with integer coordinates, exactly.
struct Exact {
    /// Twice the signed areas that the edges make with the ray.
    edges: [i128; 3],
    /// The distance as a fraction.
    distance: (i128, i128),
}

impl Exact {
    fn of(ray: &Ray, vertices: [DVec3; 3]) -> Self {
        let [a, b, c] = vertices.map(|v| integers(v - ray.origin));
        let d = integers(ray.direction);
        let edges = [dot(d, cross(b, c)), dot(d, cross(c, a)), dot(d, cross(a, b))];
        let minus = |a: [i128; 3], b: [i128; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let normal = cross(minus(b, a), minus(c, a));
        Self { edges, distance: (dot(a, normal), dot(d, normal)) }
    }

    /// Whether the half-line meets the closed triangle other than edge-on or at its own start.
    fn hits(&self) -> bool {
        let (over, under) = self.distance;
        let inside = self.edges.iter().all(|e| *e >= 0) || self.edges.iter().all(|e| *e <= 0);
        inside && under != 0 && over.signum() * under.signum() > 0
    }
}

/// Oracle: integers. Where the shear is a power of two every operation is exact, and so must be the answer.
#[test]
fn on_a_lattice_triangles_are_hit_exactly_edges_and_vertices_included() {
    let mut random = Random::new(2);
    let (mut hits, mut on_edges) = (0, 0);
    for i in 0..60_000 {
        let reach = if i % 2 == 0 { 3 } else { 1000 };
        let vertices = [0; 3].map(|_| lattice(&mut random, reach));
        let size = 1 << random.below(4);
        let mut direction = lattice(&mut random, size);
        direction[random.below(3)] = if random.below(2) == 0 { size as f64 } else { -(size as f64) };
        let mut origin = lattice(&mut random, reach);
        if i % 3 == 0 {
            // Aimed at a vertex or beyond it.
            origin = vertices[0] - direction * random.below(5) as f64;
        }
        let ray = Ray { origin, direction };
        let exact = Exact::of(&ray, vertices);
        let found = RayFrame::new(&ray).hit(vertices, f64::INFINITY);
        assert_eq!(found.is_some(), exact.hits(), "{ray:?}, {vertices:?}");
        if let Some(found) = found {
            let (over, under) = exact.distance;
            assert_eq!(found.t, over as f64 / under as f64, "{ray:?}, {vertices:?}");
            hits += 1;
            on_edges += usize::from(exact.edges.contains(&0));
        }
    }
    assert!(hits > 5000 && on_edges > 1000, "{hits} hits, {on_edges} of them on edges: too few to show anything");
}

/// Oracle: integers. No edge of numbers below 2¹⁰ is so near a ray that rounding could turn its sign.
#[test]
fn whatever_the_direction_only_an_exact_zero_may_be_decided_either_way() {
    let mut random = Random::new(3);
    let (mut decided, mut hits) = (0, 0);
    for _ in 0..60_000 {
        let vertices = [0; 3].map(|_| lattice(&mut random, 1000));
        let origin = lattice(&mut random, 1000);
        let aim = vertices[0] + vertices[1] + vertices[2] - origin * 3.0 + lattice(&mut random, 1500);
        let ray = Ray { origin, direction: aim };
        let exact = Exact::of(&ray, vertices);
        if aim == DVec3::ZERO || exact.edges.contains(&0) || exact.distance.1 == 0 {
            continue;
        }
        decided += 1;
        let found = RayFrame::new(&ray).hit(vertices, f64::INFINITY);
        assert_eq!(found.is_some(), exact.hits(), "{ray:?}, {vertices:?}");
        if let Some(found) = found {
            hits += 1;
            let expected = exact.distance.0 as f64 / exact.distance.1 as f64;
            // Rounding of the weights, which are small beside their products at grazing angles, times the farthest
            // distance that they weigh.
            let sum = exact.edges.iter().map(|e| e.unsigned_abs()).sum::<u128>() as f64;
            let products = aim.length() * 3464.0 * 3464.0;
            let bar = 64.0 * U * (products / sum).max(1.0) * 3464.0 / aim.length();
            assert!((found.t - expected).abs() <= bar, "{} for {expected}: {ray:?}, {vertices:?}", found.t);
        }
    }
    assert!(decided > 50_000 && hits > 10_000, "{hits} hits of {decided}");
}

/// A binary fraction: every finite `f64` is one, and so are sums and products of them.
struct Binary {
    digits: BigInt,
    exponent: i64,
}

impl From<f64> for Binary {
    fn from(x: f64) -> Self {
        let bits = x.to_bits();
        let biased = (bits >> 52 & 0x7ff) as i64;
        assert!(biased != 0x7ff, "not finite");
        let digits = (bits & ((1 << 52) - 1)) | if biased == 0 { 0 } else { 1 << 52 };
        let digits = if x < 0.0 { -BigInt::from(digits) } else { BigInt::from(digits) };
        Self { digits, exponent: biased.max(1) - 1075 }
    }
}

impl Binary {
    fn times(&self, other: &Self) -> Self {
        Self { digits: &self.digits * &other.digits, exponent: self.exponent + other.exponent }
    }

    fn plus(&self, other: &Self) -> Self {
        let exponent = self.exponent.min(other.exponent);
        let at = |x: &Self| &x.digits << (x.exponent - exponent);
        Self { digits: at(self) + at(other), exponent }
    }

    fn minus(&self, other: &Self) -> Self {
        self.plus(&Self { digits: -&other.digits, exponent: other.exponent })
    }
}

/// Square of the distance from the centre less that of the radius, at a distance along a ray, exactly.
fn outside(ray: &Ray, center: DVec3, radius: f64, t: f64) -> Sign {
    let radius = Binary::from(radius);
    let mut sum = Binary::from(0.0);
    for axis in 0..3 {
        let [o, d, c, t] = [ray.origin[axis], ray.direction[axis], center[axis], t].map(Binary::from);
        let x = o.plus(&d.times(&t)).minus(&c);
        sum = sum.plus(&x.times(&x));
    }
    sum.minus(&radius.times(&radius)).digits.sign()
}

/// A geometry of one thing.
fn alone(bundle: impl Bundle) -> Arc<snell::systems::accelerate::Geometry> {
    let mut renderer = Renderer::new();
    renderer.world.spawn(Camera::default());
    renderer.world.spawn(bundle);
    renderer.snapshot().expect("a snapshot").geometry.clone()
}

/// Oracle: exact arithmetic on the bits. The true root lies within the bar of the distance found.
#[test]
fn the_distance_of_a_sphere_is_true_to_a_few_roundings_however_far_it_is() {
    let mut random = Random::new(4);
    for i in 0..4000 {
        let radius = 0.5 + random.unit();
        let away = 1.5 * math::pow(10.0, f64::from(i % 13));
        let center = vector(&mut random, 1.0).normalize_or(DVec3::X) * (radius + away);
        let side = center.cross(vector(&mut random, 1.0)).normalize_or(DVec3::X);
        let part = 0.99 * random.unit();
        let aim = center + side * (part * radius);
        let ray = Ray { origin: DVec3::ZERO, direction: aim.normalize() * (0.5 + random.unit()) };
        let geometry = alone((Sphere { radius }, Transform::at(center)));
        let met = geometry.closest(&ray, f64::INFINITY, &Methods::default(), &mut Cost::default());
        let t = met.unwrap_or_else(|| panic!("missed at {away}: {ray:?}")).t;
        let steep = 1.0 / (1.0 - part * part).sqrt();
        let bar = 16.0 * U * center.length() * steep / ray.direction.length();
        assert_eq!(outside(&ray, center, radius, t - bar), Sign::Plus, "too far: {t} at {away}, {ray:?}");
        assert_ne!(outside(&ray, center, radius, t + bar), Sign::Plus, "too near: {t} at {away}, {ray:?}");
    }
}

/// Oracle: exact arithmetic on the bits. `t·d − (p − o)` is the error times `d`.
#[test]
fn the_distance_of_a_plane_is_true_to_a_few_roundings_even_at_grazing_angles() {
    let mut random = Random::new(5);
    for i in 0..4000 {
        let height = vector(&mut random, 100.0).y;
        let origin = vector(&mut random, 100.0);
        let mut direction = vector(&mut random, 1.0);
        direction.y = (height - origin.y) * math::pow(10.0, -f64::from(i % 12));
        let geometry = alone((Plane {}, Transform::at(DVec3::Y * height)));
        let ray = Ray { origin, direction };
        let met = geometry.closest(&ray, f64::INFINITY, &Methods::default(), &mut Cost::default());
        let t = met.unwrap_or_else(|| panic!("missed: {ray:?}")).t;
        let [t_, d, o, p, bar] = [t, direction.y, origin.y, height, 4.0 * U].map(Binary::from);
        let rise = p.minus(&o);
        let error = t_.times(&d).minus(&rise);
        let allowed = bar.times(&rise);
        let within = allowed.times(&allowed).minus(&error.times(&error));
        assert_ne!(within.digits.sign(), Sign::Minus, "{t} for {ray:?} and {height}");
    }
}
