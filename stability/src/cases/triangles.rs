//! F09 to F14 without F12, and F35: needles, triangles without area, bad data, coincident ones, normals that cancel.

use super::snapshot;
use crate::{
    exact::{self, Crossing},
    meshes::{spiky, triangles},
    random::Random,
    suite::{Bench, Case, Expected::*, Trial},
};
use glam::{DVec3, Vec3};
use snell_components::{
    bvh::{Box32, Bvh},
    method::{Accelerator, Methods},
    name::Name,
    primitive::{Cost, Primitive},
    shape::{Mesh, MollerTrumbore, RayFrame, Sheared, Triangle, TriangleHit, TriangleKernel, TriangleMesh},
    space::{BoundingSphere, Bounds, Ray},
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "F09",
        name: "needles are hit where they are not",
        about: "edges 1 : 1e-3 to 1e-7, whole coordinates; a hit must be one in integers, its t within 4u of the vertices' range",
        run: needles,
    },
    Case {
        id: "F10",
        name: "triangles without area",
        about: "dropped exactly when integers say so, and counted",
        run: without_area,
    },
    Case {
        id: "F11",
        name: "bad vertices",
        about: "random bits as coordinates: refused, or traced to finite numbers and the same hits by every tree and none",
        run: bad_data,
    },
    Case {
        id: "F13",
        name: "coincident triangles flicker",
        about: "a mesh and its copy under another name; the first name must win whatever the tree",
        run: coincident,
    },
    Case {
        id: "F14",
        name: "normals that cancel",
        about: "interpolated normals of random vectors and their opposites stay unit vectors",
        run: opposite_normals,
    },
    Case {
        id: "F35",
        name: "spheres around triangles",
        about: "the sphere holds all vertices, and is the least that does, to 1e-12; errors by how much it is larger",
        run: spheres_around,
    },
];

fn needles(bench: &mut Bench) {
    // 2^20 long and 1 to 2^10 wide, on a grid of 24 bits.
    let scene = |random: &mut Random| {
        let a = random.lattice(1 << 20);
        let b = random.lattice(1 << 20);
        let width = 1usize << random.below(11);
        let c = if random.below(2) == 0 { a + random.lattice(width) } else { b + random.lattice(width) };
        let origin = random.lattice(1 << 20);
        // Through a corner, or a lattice step beside it: rays that meet a needle are rare otherwise.
        let at = if random.below(3) == 0 { c } else { [a, b][random.below(2)] + random.lattice(2) };
        (Ray { origin, direction: at - origin }, [a, b, c])
    };
    fn check<K: TriangleKernel>(ray: &Ray, vertices: [DVec3; 3]) -> Trial {
        let exact = Crossing::of(ray, vertices);
        if ray.direction == DVec3::ZERO || exact.distance.1 == 0 {
            return Trial::Skip;
        }
        let hit = K::new(ray).hit(vertices, f64::INFINITY);
        // Within rounding of an edge either answer may be given; elsewhere the sign must be right.
        let d = ray.direction.abs().max_element();
        let reach = vertices.iter().map(|v| (*v - ray.origin).abs().max_element()).fold(0.0, f64::max);
        let band = 64.0 * super::U * d * reach * reach;
        let near = exact.edges.iter().any(|e| (*e as f64).abs() <= band);
        let Some(hit) = hit else { return if near { Trial::Skip } else { Trial::of(!exact.hits()) } };
        if !near && !exact.hits() {
            return Trial::of(false);
        }
        // Between the nearest and the farthest vertex, along the ray's main axis; but for the rounding of a quotient.
        let size = ray.direction.abs();
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let [a, b, c] = vertices.map(|v| (v - ray.origin)[axis] / ray.direction[axis]);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let beyond = if hit.t > high { hit.t - high } else { low - hit.t };
        Trial::within(beyond.max(0.0) / (super::U * hit.t), 4.0)
    }
    let tally = bench.tally(9, bench.full(), |random| {
        let (ray, vertices) = scene(random);
        check::<Sheared<f64>>(&ray, vertices)
    });
    bench.add(Sound, "Snell", "", tally);
    let tally = bench.tally(9, bench.others(), |random| {
        let (ray, vertices) = scene(random);
        check::<MollerTrumbore<f32>>(&ray, vertices)
    });
    bench.add(Failing, "Möller–Trumbore f32", "", tally);
    let tally = bench.tally(9, bench.others(), |random| {
        let (ray, vertices) = scene(random);
        check::<MollerTrumbore<f64>>(&ray, vertices)
    });
    bench.add(Failing, "Möller–Trumbore f64", "", tally);
}

fn without_area(bench: &mut Bench) {
    let lines = bench.tally(10, bench.full(), |random| {
        let triangles: Vec<[DVec3; 3]> = (0..8)
            .map(|_| {
                let (a, b) = (random.lattice(3), random.lattice(3));
                let c = if random.below(2) == 0 { a + (b - a) * random.below(3) as f64 } else { random.lattice(3) };
                [a, b, c]
            })
            .collect();
        let flat = |[a, b, c]: &[DVec3; 3]| exact::cross(exact::whole(*b - *a), exact::whole(*c - *a)) == [0; 3];
        let expected = triangles.iter().filter(|t| flat(t)).count();
        let positions = triangles.iter().flatten().map(|v| v.as_vec3().to_array()).collect();
        let corners = (0..8).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let dropped = TriangleMesh::new(positions, corners).map(|mesh| mesh.degenerate());
        Trial::of(dropped == Ok(expected))
    });
    bench.add(Sound, "Snell", "", lines);
    // The check can fail: an area that must exceed a tolerance drops sound triangles too.
    let tally = bench.tally(10, bench.others(), |random| {
        let [a, b, c] = [0; 3].map(|_| random.cube() * 1e-4);
        Trial::of((b - a).cross(c - a).length() > 1e-8)
    });
    bench.add(Failing, "area ≥ 1e-8, size 1e-4", "", tally);
}

fn bad_data(bench: &mut Bench) {
    let special = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, 1e-45, -0.0, 0.0, 1.0];
    let number = move |random: &mut Random, wild: usize| match random.below(wild) {
        0 => f32::from_bits(random.bits() as u32),
        1 => special[random.below(special.len())],
        _ => random.signed() as f32,
    };
    let trace = |random: &mut Random, checked: bool| {
        let wild = [2, 20, 400, 5][random.below(4)];
        let positions: Vec<[f32; 3]> = (0..30).map(|_| [0; 3].map(|_| number(random, wild))).collect();
        let last = if random.below(10) == 0 { 31 } else { 30 };
        let triangles: Vec<[u32; 3]> = (0..20).map(|_| [0; 3].map(|_| random.below(last) as u32)).collect();
        let finite = |v: u32| positions.get(v as usize).is_some_and(|p| p.iter().all(|x| x.is_finite()));
        let sound = triangles.iter().flatten().all(|v| finite(*v));
        let all: Vec<[DVec3; 3]> = if sound {
            triangles.iter().map(|t| t.map(|v| Vec3::from_array(positions[v as usize]).as_dvec3())).collect()
        } else {
            vec![]
        };
        let Ok(mesh) = TriangleMesh::new(positions, triangles) else { return Trial::of(!sound) };
        if !sound {
            return Trial::of(false);
        }
        let mesh = Mesh::new(mesh).smooth();
        // Nothing is left of a mesh without an area.
        let Ok((_, packed)) = mesh.pack(&glam::DAffine3::IDENTITY) else { return Trial::Pass(0.0) };
        let mut right = true;
        for _ in 0..8 {
            let ray = Ray { origin: random.cube() * 3.0, direction: random.direction() };
            let cost = &mut Cost::default();
            let hit = Mesh::hit(&packed, &ray, f64::INFINITY, cost);
            if !checked {
                // A list of all triangles, with nothing to tell which hits are real.
                let kernel = RayFrame::new(&ray);
                let nearest = |t: f64, hit: Option<TriangleHit>| hit.map_or(t, |hit| if hit.t < t { hit.t } else { t });
                let t = all.iter().fold(f64::INFINITY, |t, triangle| nearest(t, kernel.hit(*triangle, t)));
                right &= hit.map_or(f64::INFINITY, |hit| hit.t) == t;
                continue;
            }
            right &= hit.is_some() == Mesh::blocks(&packed, &ray, f64::INFINITY, cost);
            for accelerator in [Accelerator::BruteForce, Accelerator::SphereTree] {
                let with = Methods { accelerator, ..Methods::default() };
                right &= hit == Mesh::hit_with(&packed, &ray, f64::INFINITY, &with, cost);
                right &= hit.is_some() == Mesh::blocks_with(&packed, &ray, f64::INFINITY, &with, cost);
            }
            if let Some(hit) = hit {
                let surface = Mesh::surface(&packed, &ray, hit);
                right &= hit.t.is_finite() && surface.normal.is_finite() && surface.shading_normal.is_finite();
            }
        }
        Trial::of(right)
    };
    let tally = bench.tally(11, bench.full(), |random| trace(random, true));
    bench.add(Sound, "Snell: finite, and alike with every tree", "", tally);
    let tally = bench.tally(11, bench.full(), |random| trace(random, false));
    bench.add(Failing, "a list that takes every hit, against a tree", "", tally);
    // The check can fail: without the refusal, bounds of such vertices hold nothing.
    let tally = bench.tally(11, bench.others(), |random| {
        let points = [0; 3].map(|_| DVec3::from_array([0; 3].map(|_| f64::from(number(random, 5)))));
        let bounds = Bounds::of_points(points);
        Trial::of(points.iter().all(|p| bounds.contains(*p)))
    });
    bench.add(Failing, "bounds of unchecked vertices", "", tally);
}

fn coincident(bench: &mut Bench) {
    let mesh = spiky();
    let all = triangles(&mesh);
    let snapshot = snapshot(|world| {
        world.spawn((Name::new("b"), Mesh::new(mesh.clone())));
        world.spawn((Name::new("a"), Mesh::new(mesh.clone())));
    });
    let first = snapshot.names.iter().position(|name| name.as_ref().is_some_and(|name| name.as_str() == "a"));
    let ray = |random: &mut Random| Ray { origin: random.cube() * 0.28, direction: random.direction() };
    let tally = bench.tally(13, bench.full(), |random| {
        let met = snapshot.geometry.closest(&ray(random), f64::INFINITY, &Methods::default(), &mut Cost::default());
        Trial::of(met.map(|met| met.object as usize) == first)
    });
    bench.add(Sound, "Snell", "", tally);
    // Each triangle twice; whoever comes last in the walk wins.
    let twice: Vec<[DVec3; 3]> = all.iter().chain(&all).copied().collect();
    let boxes = twice.iter().map(|t| Box32::around(&Bounds::of_points(*t)));
    let tree = Bvh::build(boxes.collect::<Vec<_>>().into_iter(), 1);
    let tally = bench.tally(13, bench.others(), |random| {
        let ray = ray(random);
        let kernel = RayFrame::new(&ray);
        let mut best: Option<(f64, u32)> = None;
        tree.walk(&ray, f64::INFINITY, &mut Cost::default(), |run, limit, _| {
            for i in run {
                let i = tree.order()[i];
                let hit = kernel.hit(twice[i as usize], f64::INFINITY);
                if let Some(hit) = hit.filter(|hit| best.is_none_or(|best| hit.t <= best.0)) {
                    best = Some((hit.t, i));
                }
            }
            best.map_or(limit, |best| best.0)
        });
        Trial::of(best.is_some_and(|(_, i)| (i as usize) < all.len()))
    });
    bench.add(Failing, "last found in the tree", "", tally);
}

fn opposite_normals(bench: &mut Bench) {
    let setting = |random: &mut Random| {
        let n = random.direction();
        let other = if random.below(2) == 0 { -n } else { random.direction() };
        let normals = vec![n, other, if random.below(2) == 0 { -(n + other) } else { random.direction() }];
        let normals = if normals.iter().all(|n| *n != DVec3::ZERO) { normals } else { vec![n, -n, n] };
        let triangle = Triangle { b: DVec3::X * 3.0, c: DVec3::Y * 3.0, normals, ..Triangle::default() };
        // The middle of the edge and of the triangle, where they cancel.
        let at = [DVec3::new(1.5, 0.0, 0.0), DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 0.5, 0.0)][random.below(3)];
        (triangle, Ray { origin: at + DVec3::Z, direction: DVec3::NEG_Z })
    };
    let tally = bench.tally(14, bench.full(), |random| {
        let (triangle, ray) = setting(random);
        let Ok((_, packed)) = triangle.pack(&glam::DAffine3::IDENTITY) else { return Trial::Skip };
        let Some(hit) = Triangle::hit(&packed, &ray, f64::INFINITY, &mut Cost::default()) else {
            return Trial::of(false);
        };
        let normal = Triangle::surface(&packed, &ray, hit).shading_normal;
        Trial::within((normal.length() - 1.0).abs(), 4.0 * f64::EPSILON)
    });
    bench.add(Sound, "Snell", "", tally);
    let tally = bench.tally(14, bench.others(), |random| {
        let (triangle, ray) = setting(random);
        let weights = RayFrame::new(&ray).weights([triangle.a, triangle.b, triangle.c]);
        let sum = triangle.normals.iter().zip(weights).fold(DVec3::ZERO, |sum, (n, w)| sum + *n * w);
        Trial::of((sum / sum.length()).is_finite())
    });
    bench.add(Failing, "n over its length", "", tally);
}

fn spheres_around(bench: &mut Bench) {
    let triangle = |random: &mut Random| [0; 3].map(|_| random.cube() * 4.0);
    // Of the least sphere: about the longest edge, or through all three.
    let least = |[a, b, c]: [DVec3; 3]| {
        let mut sides = [a.distance(b), b.distance(c), c.distance(a)];
        sides.sort_by(f64::total_cmp);
        let [x, y, z] = sides;
        if x * x + y * y <= z * z { 0.5 * z } else { x * y * z / (2.0 * (b - a).cross(c - a).length()) }
    };
    let tally = bench.tally(35, bench.full(), |random| {
        let t = triangle(random);
        let sphere = BoundingSphere::of_triangle(t);
        let held = t.iter().all(|v| v.distance(sphere.center) <= sphere.radius);
        if held { Trial::within(sphere.radius / least(t) - 1.0, 1e-12) } else { Trial::of(false) }
    });
    bench.add(Sound, "Snell, the least", "", tally);
    let others: [(&str, fn([DVec3; 3]) -> DVec3); 2] = [
        ("about the middle of the box", |t| Bounds::of_points(t).center()),
        ("about the centroid", |[a, b, c]| (a + b + c) / 3.0),
    ];
    for (name, center) in others {
        let tally = bench.tally(35, bench.others(), |random| {
            let t = triangle(random);
            let radius = t.iter().map(|v| v.distance(center(t))).fold(0.0, f64::max);
            Trial::within(radius / least(t) - 1.0, 1e-12)
        });
        bench.add(Failing, name, "", tally);
    }
}
