//! F09 to F14 and F35: needles, triangles without area, bad data, coincident ones, normals that cancel.

use super::snapshot;
use crate::{
    exact::{self, Crossing},
    meshes::{bumpy, spiky, triangles},
    random::Random,
    suite::{Bench, Case, Expected::*, Tally, Trial},
};
use glam::DVec3;
use snell_components::{
    bvh::{Box32, Bvh},
    method::Methods,
    name::Name,
    primitive::{Cost, Primitive},
    shape::{Mesh, MollerTrumbore, RayFrame, Sheared, Triangle, TriangleKernel, TriangleMesh},
    space::{BoundingSphere, Bounds, Ray},
    transform::Transform,
};
use snell_systems::render::{Options, render};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "F09",
        name: "needles are hit where they are not",
        about: "edges 1 : 1e-3 to 1e-7, whole coordinates; a hit must be one in integers and lie between the vertices",
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
        about: "random bits as coordinates: refused, or traced without a number that is not finite",
        run: bad_data,
    },
    Case {
        id: "F12",
        name: "size and place change the picture",
        about: "scaled by 2^k: the same bits; anywhere in range: within 1/255 but at edges",
        run: sizes,
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
        about: "the sphere holds all vertices; its radius over the least possible one is shown as the error",
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
        let along = |v: DVec3| (v - ray.origin).dot(ray.direction) / ray.direction.length_squared();
        let [a, b, c] = vertices.map(along);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        // The kernel measures along its main axis: as much more as a needle is oblique to that.
        let slack = 2.0 * reach / d;
        let beyond = if hit.t > high { hit.t - high } else { low - hit.t };
        Trial::within(beyond.max(0.0), slack)
    }
    let tally = bench.tally(9, bench.full(), |random| {
        let (ray, vertices) = scene(random);
        check::<Sheared<f64>>(&ray, vertices)
    });
    bench.add(Sound, "Snell", "", tally);
    let tally = bench.tally(9, bench.part(10), |random| {
        let (ray, vertices) = scene(random);
        check::<MollerTrumbore<f32>>(&ray, vertices)
    });
    bench.add(Failing, "Möller–Trumbore f32", "", tally);
    let tally = bench.tally(9, bench.part(10), |random| {
        let (ray, vertices) = scene(random);
        check::<MollerTrumbore<f64>>(&ray, vertices)
    });
    bench.add(Shown, "Möller–Trumbore f64", "", tally);
}

fn without_area(bench: &mut Bench) {
    let lines = bench.tally(10, bench.part(100), |random| {
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
    let tally = bench.tally(10, bench.part(10), |random| {
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
    let trace = |random: &mut Random, same: bool| {
        let wild = [2, 20, 400, 5][random.below(4)];
        let positions: Vec<[f32; 3]> = (0..30).map(|_| [0; 3].map(|_| number(random, wild))).collect();
        let last = if random.below(10) == 0 { 31 } else { 30 };
        let triangles = (0..20).map(|_| [0; 3].map(|_| random.below(last) as u32)).collect();
        let finite = |v: u32| positions.get(v as usize).is_some_and(|p| p.iter().all(|x| x.is_finite()));
        let triangles: Vec<[u32; 3]> = triangles;
        let sound = triangles.iter().flatten().all(|v| finite(*v));
        let mesh = TriangleMesh::new(positions.clone(), triangles);
        let Ok(mesh) = mesh else { return Trial::of(!sound) };
        if !sound {
            return Trial::of(false);
        }
        if mesh.is_empty() {
            return Trial::Pass(0.0);
        }
        let mut right = true;
        let mesh = Mesh::new(mesh).smooth();
        let Ok((_, packed)) = mesh.pack(&glam::DAffine3::IDENTITY) else { return Trial::Pass(0.0) };
        for _ in 0..8 {
            let ray = Ray { origin: random.cube() * 3.0, direction: random.direction() };
            let cost = &mut Cost::default();
            let hit = Mesh::hit(&packed, &ray, f64::INFINITY, cost);
            let brute = Mesh::hit_with(&packed, &ray, f64::INFINITY, &Methods::BRUTE_FORCE, cost);
            right &= !same || hit == brute;
            if let Some(hit) = hit {
                let surface = Mesh::surface(&packed, &ray, hit);
                right &= hit.t.is_finite() && surface.normal.is_finite() && surface.shading_normal.is_finite();
            }
        }
        Trial::of(right)
    };
    let tally = bench.tally(11, bench.part(50), |random| trace(random, false));
    bench.add(Sound, "Snell", "", tally);
    // Where coordinates of one triangle differ by fifteen digits and more, hits are a matter of rounding.
    let tally = bench.tally(11, bench.part(50), |random| trace(random, true));
    bench.add(Shown, "Snell, tree against brute force: no promise", "", tally);
    // The check can fail: without the refusal, bounds of such vertices hold nothing.
    let tally = bench.tally(11, bench.part(10), |random| {
        let points = [0; 3].map(|_| DVec3::from_array([0; 3].map(|_| f64::from(number(random, 5)))));
        let bounds = Bounds::of_points(points);
        Trial::of(points.iter().all(|p| bounds.contains(*p)))
    });
    bench.add(Failing, "bounds of unchecked vertices", "", tally);
}

/// The mesh lit and seen full-frame, all of it scaled and moved.
fn view(scale: f64, offset: DVec3) -> std::sync::Arc<snell_systems::snapshot::Snapshot> {
    use snell_components::{camera::Camera, light::PointLight, material, settings::Settings, transform::Step};
    let place = |p: DVec3| p * scale + offset;
    let mut renderer = snell_systems::pipeline::Renderer::new();
    *renderer.settings() = Settings { width: 64, height: 48, depth: 3, ..Settings::default() };
    let world = &mut renderer.world;
    let camera =
        Camera { position: place(DVec3::new(1.5, 2.5, 6.0)), target: Some(place(DVec3::ZERO)), ..Camera::default() };
    world.spawn((Name::new("camera"), camera));
    world
        .spawn((Name::new("lamp"), PointLight { position: place(DVec3::new(3.0, 6.0, 4.0)), ..PointLight::default() }));
    let placed =
        |at: DVec3| Transform::new([Step::Translate(at), Step::Scale(DVec3::splat(scale)), Step::Translate(offset)]);
    let shine = (material::Diffuse(DVec3::splat(0.6)), material::Mirror(DVec3::splat(0.3)));
    world.spawn((Name::new("mesh"), Mesh::new(bumpy(12, 10, 0.3, 5)), placed(DVec3::X * -1.2), shine));
    world.spawn((Name::new("ball"), snell_components::shape::Sphere { radius: 1.0 }, placed(DVec3::X * 1.2), shine));
    world.spawn((
        Name::new("floor"),
        snell_components::shape::Cuboid { size: DVec3::new(8.0, 0.5, 8.0) },
        placed(DVec3::Y * -1.6),
        shine,
    ));
    match renderer.snapshot() {
        Ok(snapshot) => snapshot,
        Err(why) => unreachable!("{why}"),
    }
}

fn sizes(bench: &mut Bench) {
    let picture = |scale, offset| render(&view(scale, offset), &Options::default()).picture;
    let original = picture(1.0, DVec3::ZERO);
    let mut tally = Tally::default();
    for k in [-40, -20, -3, 1, 10, 40] {
        let scale = if k < 0 { 1.0 / (1u64 << -k) as f64 } else { (1u64 << k) as f64 };
        tally.add(Trial::of(picture(scale, DVec3::ZERO) == original));
    }
    bench.add(Sound, "Snell, the same bits at 2^k", "", tally);
    for scale in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
        for offset in [0.0, 1e2, 1e4, 1e6] {
            let moved = picture(scale, DVec3::new(1.0, 0.25, -0.5) * (offset * scale));
            let mut tally = Tally::default();
            let mut off = 0u32;
            for (a, b) in moved.pixels.iter().zip(&original.pixels) {
                let error = a.iter().zip(b).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max);
                off += u32::from(error > 1.0 / 255.0);
            }
            // Edge pixels may fall on the other side: one in two hundred, no more.
            tally.add(Trial::within(f64::from(off) / moved.pixels.len() as f64, 0.005));
            bench.add_at(Sound, "Snell, share of pixels off by 1/255", scale, offset * scale, tally);
        }
    }
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
    let tally = bench.tally(13, bench.part(10), |random| {
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
    let tally = bench.tally(14, bench.part(10), |random| {
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
        let sphere = BoundingSphere::about(Bounds::of_points(t).center(), t);
        let held = t.iter().all(|v| v.distance(sphere.center) <= sphere.radius);
        // Never more than √1.5 of the least, as the box's half-diagonal is.
        if held { Trial::within(sphere.radius / least(t), 1.224_745) } else { Trial::of(false) }
    });
    bench.add(Sound, "Snell, middle of the box and farthest vertex", "", tally);
    let tally = bench.tally(35, bench.part(10), |random| {
        let t = triangle(random);
        let center = (t[0] + t[1] + t[2]) / 3.0;
        Trial::within(t.iter().map(|v| v.distance(center)).fold(0.0, f64::max) / least(t), 1.224_745)
    });
    bench.add(Failing, "about the centroid", "", tally);
}
