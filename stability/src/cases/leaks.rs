//! F01 to F08: rays that slip between the triangles of a closed mesh. Oracle: topology, a ray from within must hit.

use super::geometry;
use crate::{
    exact::{self, Crossing},
    kernels::{self, Spoiled},
    meshes::{spiky, triangles},
    random::Random,
    suite::{Bench, Case, Expected::*, Trial},
};
use glam::DVec3;
use snell_components::{
    method::Methods,
    primitive::Cost,
    shape::{Mesh, MollerTrumbore, Sheared, Triangle, TriangleKernel, TriangleMesh, Turned},
    space::Ray,
    transform::{Step, Transform},
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "F01",
        name: "rays leak through edges",
        about: "rays from within a closed mesh of 112 triangles, aimed at edges; none may leave without a hit",
        run: |bench| aimed(bench, false),
    },
    Case {
        id: "F02",
        name: "rays leak through vertices",
        about: "the same rays, aimed at vertices",
        run: |bench| aimed(bench, true),
    },
    Case {
        id: "F03",
        name: "exact hits of edges are lost",
        about: "whole coordinates, rays through quarter points of edges and vertices; oracle: integers; errors of t in u",
        run: exact_hits,
    },
    Case {
        id: "F04",
        name: "leaks depend on scale and offset",
        about: "rays aimed at edges and vertices of the mesh at every scale and offset",
        run: matrix,
    },
    Case {
        id: "F05",
        name: "a tolerance on u and v as a cure",
        about: "leaks stay, and rays hit two neighbours at once (counted as failures of `double hits`)",
        run: tolerance,
    },
    Case {
        id: "F06",
        name: "hits refused near the origin",
        about: "a test that refuses hits within the bound of their error leaks where the origin is near an edge",
        run: refused,
    },
    Case {
        id: "F07",
        name: "fused edge functions leak",
        about: "the sheared test with fused multiply-add",
        run: fused,
    },
    Case {
        id: "F08",
        name: "triangles that only look joined",
        about: "the mesh as loose triangles: with copied vertices none leaks; with vertices an ulp off gaps are real",
        run: soup,
    },
];

/// A ray from within to a point of an edge, or to a vertex.
fn aim(random: &mut Random, triangles: &[[DVec3; 3]], vertex: bool) -> Ray {
    let [a, b, _] = triangles[random.below(triangles.len())];
    let at = if vertex { a } else { a + (b - a) * random.unit() };
    let origin = random.cube() * 0.28;
    Ray { origin, direction: (at - origin).normalize() }
}

fn hit_by<K: TriangleKernel>(ray: &Ray, triangles: &[[DVec3; 3]]) -> bool {
    let kernel = K::new(ray);
    triangles.iter().any(|t| kernel.hit(*t, f64::INFINITY).is_some())
}

type Test = fn(&Ray, &[[DVec3; 3]]) -> bool;

const TESTS: &[(&str, Test, bool)] = &[
    ("Möller–Trumbore f32", hit_by::<MollerTrumbore<f32>>, true),
    ("Möller–Trumbore f64", hit_by::<MollerTrumbore<f64>>, true),
    ("Plücker f32", |ray, all| all.iter().any(|t| kernels::plucker::<f32>(ray, t, 0.0)), false),
    ("Plücker f64", |ray, all| all.iter().any(|t| kernels::plucker::<f64>(ray, t, 0.0)), false),
    (
        "Plücker f32, 1 ulp",
        |ray, all| all.iter().any(|t| kernels::plucker::<f32>(ray, t, f64::from(f32::EPSILON))),
        false,
    ),
    ("ray frame 2004 f32", hit_by::<Turned<f32>>, false),
    ("ray frame 2004 f64", hit_by::<Turned<f64>>, false),
    ("sheared f32", hit_by::<Sheared<f32>>, false),
];

fn aimed(bench: &mut Bench, vertex: bool) {
    let mesh = spiky();
    let all = triangles(&mesh);
    let seed = if vertex { 2 } else { 1 };
    for (name, test, fails) in TESTS {
        let tally = bench.tally(seed, bench.others(), |random| Trial::of(test(&aim(random, &all, vertex), &all)));
        bench.add(if *fails { Failing } else { Shown }, name, "", tally);
    }
    let tally =
        bench.tally(seed, bench.full(), |random| Trial::of(hit_by::<Sheared<f64>>(&aim(random, &all, vertex), &all)));
    bench.add(Sound, "Snell, triangle by triangle", "", tally);
    let geometry = geometry(|world| {
        world.spawn(Mesh::new(mesh.clone()));
    });
    let tally = bench.tally(seed, bench.full(), |random| {
        let ray = aim(random, &all, vertex);
        Trial::of(geometry.blocked(&ray, f64::INFINITY, &Methods::default(), &mut Cost::default()))
    });
    bench.add(Sound, "Snell", "", tally);
}

/// A mesh of whole coordinates; rays from whole origins along exact directions to quarter points and vertices.
fn exact_hits(bench: &mut Bench) {
    let whole: Vec<[DVec3; 3]> = triangles(&spiky()).into_iter().map(|t| t.map(|v| (v * 16.0).round() * 4.0)).collect();
    let ray = |random: &mut Random| {
        let [a, b, _] = whole[random.below(whole.len())];
        let at = a + (b - a) * (random.below(4) as f64 * 0.25);
        let origin = random.lattice(8);
        // A multiple is still exact, and its distances are not.
        Ray { origin, direction: (at - origin) * (1 + random.below(7)) as f64 }
    };
    // The nearest in integers, on equal distance the first.
    let nearest = |ray: &Ray| {
        let mut best: Option<(usize, Crossing)> = None;
        for (i, t) in whole.iter().enumerate() {
            let crossing = Crossing::of(ray, *t);
            if crossing.hits() && best.is_none_or(|(_, known)| crossing.nearer(&known)) {
                best = Some((i, crossing));
            }
        }
        best
    };
    fn first<K: TriangleKernel>(ray: &Ray, all: &[[DVec3; 3]]) -> Option<(f64, usize)> {
        let kernel = K::new(ray);
        let hits = all.iter().enumerate().filter_map(|(i, t)| kernel.hit(*t, f64::INFINITY).map(|hit| (hit.t, i)));
        hits.reduce(|best, hit| if hit.0 < best.0 { hit } else { best })
    }
    // How many triangles a ray meets says whether it starts inside: not where it meets edges, which belong to several.
    fn odd<K: TriangleKernel>(ray: &Ray, all: &[[DVec3; 3]]) -> bool {
        let kernel = K::new(ray);
        all.iter().filter(|t| kernel.hit(**t, f64::INFINITY).is_some()).count() % 2 == 1
    }
    let tally = bench.tally(3, bench.full(), |random| {
        let ray = ray(random);
        let Some((_, crossing)) = nearest(&ray) else { return Trial::Skip };
        match first::<Sheared<f64>>(&ray, &whole) {
            None => Trial::Fail(f64::NAN),
            Some((t, _)) => Trial::within(exact::relative_error(t, crossing.distance) / super::U, 16.0),
        }
    });
    bench.add(Sound, "Snell: hit, and t within 16u", "", tally);
    let tally = bench.tally(3, bench.others(), |random| {
        let ray = ray(random);
        let Some((lowest, _)) = nearest(&ray) else { return Trial::Skip };
        Trial::of(first::<Sheared<f64>>(&ray, &whole).is_some_and(|(_, i)| i == lowest))
    });
    bench.add(Shown, "Snell: the lowest of all that are as near in truth, not only in f64; no promise", "", tally);
    let tally = bench.tally(3, bench.others(), |random| {
        let ray = ray(random);
        let Some((_, crossing)) = nearest(&ray) else { return Trial::Skip };
        match first::<MollerTrumbore<f32>>(&ray, &whole) {
            None => Trial::Fail(f64::NAN),
            Some((t, _)) => Trial::within(exact::relative_error(t, crossing.distance) / super::U, 16.0),
        }
    });
    bench.add(Failing, "Möller–Trumbore f32: hit, and t within 16u", "", tally);
    type Odd = fn(&Ray, &[[DVec3; 3]]) -> bool;
    let parity: [(&str, Odd); 2] = [
        ("inside by an odd count of hits, Möller–Trumbore f64", odd::<MollerTrumbore<f64>>),
        ("inside by an odd count of hits, sheared f64", odd::<Sheared<f64>>),
    ];
    for (name, test) in parity {
        let tally = bench.tally(3, bench.others(), |random| Trial::of(test(&ray(random), &whole)));
        bench.add(Failing, name, "", tally);
    }
    // Which of exact ties is named: the lowest index, whatever the tree.
    let indexed: Vec<[f32; 3]> = whole.iter().flatten().map(|v| v.as_vec3().to_array()).collect();
    let corners = (0..whole.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mesh = TriangleMesh::new(indexed, corners).unwrap_or_default();
    let scene = geometry(|world| {
        world.spawn(Mesh::new(mesh));
    });
    let tally = bench.tally(3, bench.full(), |random| {
        let ray = ray(random);
        let [tree, brute] = [Methods::default(), Methods::BRUTE_FORCE]
            .map(|with| scene.closest(&ray, f64::INFINITY, &with, &mut Cost::default()).map(|met| met.surface));
        Trial::of(tree.is_some() && tree == brute)
    });
    bench.add(Sound, "Snell, tree against brute force", "", tally);
}

const SCALES: [f64; 5] = [1e-6, 1e-3, 1.0, 1e3, 1e6];

/// The last is Embree's own test offset.
const OFFSETS: [DVec3; 4] =
    [DVec3::ZERO, DVec3::splat(1e4), DVec3::splat(1e7), DVec3::new(148_376.0, 1234.0, -223_423.0)];

fn matrix(bench: &mut Bench) {
    let mesh = spiky();
    let unit = triangles(&mesh);
    for scale in SCALES {
        for offset in OFFSETS {
            let far = offset.abs().max_element();
            let placed: Vec<[DVec3; 3]> = unit.iter().map(|t| t.map(|v| v * scale + offset)).collect();
            // In the world, with the rounding that the numbers there have.
            let ray = |random: &mut Random| {
                let [a, b, _] = placed[random.below(placed.len())];
                let vertex = random.below(3) == 0;
                let at = if vertex { a } else { a + (b - a) * random.unit() };
                let origin = random.cube() * (0.28 * scale) + offset;
                Ray { origin, direction: (at - origin).normalize_or(DVec3::X) }
            };
            // Near the origin there is room for leaks in f32; far from it none for the mesh; between, it is a heap of
            // large steps, of which nothing is expected.
            let (near, gone) = (far <= 1e4 * scale, far >= 1e8 * scale);
            let tests: [(&str, Test, bool); 4] = [
                ("Möller–Trumbore f32", hit_by::<MollerTrumbore<f32>>, near || gone),
                (
                    "Möller–Trumbore f32, det ≥ 1e-6",
                    |ray, all| all.iter().any(|t| kernels::tolerant::<f32>(ray, t, 1e-6, 0.0).is_some()),
                    near || gone || scale <= 1e-3,
                ),
                ("Möller–Trumbore f64", hit_by::<MollerTrumbore<f64>>, true),
                ("sheared f32", hit_by::<Sheared<f32>>, gone),
            ];
            for (name, test, fails) in tests {
                let tally = bench.tally(4, bench.others(), |random| Trial::of(test(&ray(random), &placed)));
                bench.add_at(if fails { Failing } else { Shown }, name, scale, far, tally);
            }
            let placement = Transform::new([Step::Scale(DVec3::splat(scale)), Step::Translate(offset)]);
            let scene = geometry(|world| {
                world.spawn((Mesh::new(mesh.clone()), placement));
            });
            let tally = bench.tally(4, bench.full(), |random| {
                Trial::of(scene.blocked(&ray(random), f64::INFINITY, &Methods::default(), &mut Cost::default()))
            });
            bench.add_at(Sound, "Snell", scale, far, tally);
        }
    }
}

fn tolerance(bench: &mut Bench) {
    let all = triangles(&spiky());
    for slack in [1e-6, 1e-5] {
        let hits = |ray: &Ray| all.iter().filter(|t| kernels::tolerant::<f32>(ray, t, 0.0, slack).is_some()).count();
        let name = format!("Möller–Trumbore f32, u, v ≥ −{slack:e}");
        let tally = bench.tally(5, bench.others(), |random| Trial::of(hits(&aim(random, &all, false)) > 0));
        bench.add(Shown, &name, "leaks", tally);
        let tally = bench.tally(5, bench.others(), |random| Trial::of(hits(&aim(random, &all, false)) < 2));
        bench.add(Failing, &name, "double hits", tally);
    }
    let tally =
        bench.tally(5, bench.full(), |random| Trial::of(hit_by::<Sheared<f64>>(&aim(random, &all, false), &all)));
    bench.add(Sound, "Snell, which has none", "leaks", tally);
}

fn refused(bench: &mut Bench) {
    let all = triangles(&spiky());
    let leaks = |ray: &Ray| !all.iter().any(|t| kernels::sheared(ray, t, Spoiled::Conservative));
    // Near the surface, where the bound of the error matters: a hair within a vertex, aimed at the vertices about it.
    let near = |random: &mut Random| {
        let [a, b, _] = all[random.below(all.len())];
        let origin = (a * (1.0 - 1e-7 * random.unit())).as_vec3().as_dvec3();
        Ray { origin, direction: (b - origin).normalize() }
    };
    let tally = bench.tally(6, bench.others(), |random| Trial::of(!leaks(&aim(random, &all, false))));
    bench.add(Shown, "sheared f32, hits refused within their error", "from the middle", tally);
    let tally = bench.tally(6, bench.others(), |random| {
        let ray = near(random);
        if hit_by::<Sheared<f32>>(&ray, &all) { Trial::of(!leaks(&ray)) } else { Trial::Skip }
    });
    bench.add(Failing, "sheared f32, hits refused within their error", "from within a hair of the surface", tally);
    let tally = bench.tally(6, bench.full(), |random| {
        let ray = aim(random, &all, random.clone().below(2) == 0);
        Trial::of(hit_by::<Sheared<f64>>(&ray, &all))
    });
    bench.add(Sound, "Snell", "from the middle", tally);
}

fn fused(bench: &mut Bench) {
    let all = triangles(&spiky());
    let fused = |ray: &Ray| all.iter().any(|t| kernels::sheared(ray, t, Spoiled::Fused));
    let tally = bench.tally(7, bench.others(), |random| Trial::of(fused(&aim(random, &all, false))));
    bench.add(Failing, "sheared f64, fused", "", tally);
    let tally =
        bench.tally(7, bench.full(), |random| Trial::of(hit_by::<Sheared<f64>>(&aim(random, &all, false), &all)));
    bench.add(Sound, "Snell", "", tally);
}

fn soup(bench: &mut Bench) {
    let all = triangles(&spiky());
    let off = |random: &mut Random, v: DVec3| {
        v.map(|x| match random.below(3) {
            0 => x.next_up(),
            1 => x.next_down(),
            _ => x,
        })
    };
    let mut random = Random::new(8);
    let perturbed: Vec<[DVec3; 3]> = all.iter().map(|t| t.map(|v| off(&mut random, v))).collect();
    let apart: Vec<[DVec3; 3]> = all.iter().map(|t| t.map(|v| v + random.direction() * 1e-6)).collect();
    for (name, soup, expected) in [
        ("Snell, copied vertices", &all, Sound),
        ("Snell, vertices an ulp off: no promise", &perturbed, Shown),
        ("Snell, vertices up to 1e-6 off: gaps are gaps", &apart, Failing),
    ] {
        let scene = geometry(|world| {
            for [a, b, c] in soup {
                world.spawn(Triangle { a: *a, b: *b, c: *c, ..Triangle::default() });
            }
        });
        let tally = bench.tally(8, bench.full(), |random| {
            let ray = aim(random, &all, random.clone().below(2) == 0);
            Trial::of(scene.blocked(&ray, f64::INFINITY, &Methods::default(), &mut Cost::default()))
        });
        bench.add(expected, name, "", tally);
    }
}
