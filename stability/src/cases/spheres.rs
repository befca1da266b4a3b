//! F20 to F26: spheres far, huge, tiny or met from near their surface; planes at grazing angles. Oracle: double-doubles.

use super::U;
use crate::{
    exact::{plane_distance, sphere_residual, sphere_roots},
    random::Random,
    suite::{Bench, Case, Expected, Expected::*, Trial},
};
use glam::{DAffine3, DMat3, DVec3};
use snell_components::{
    primitive::{Cost, Primitive},
    shape::{Plane, Sphere, naive_root, nearest_root},
    space::Ray,
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "F20",
        name: "far spheres are lost or lose their digits",
        about: "radius 1, aimed within .99 of the disk; |t − t*| ≤ 16u·‖o−c‖·max(1, r/√(r²−b²)); errors in units of that",
        run: far,
    },
    Case {
        id: "F21",
        name: "huge spheres seen from just above",
        about: "the eye one above a sphere of radius up to 1e12; |t − t*| ≤ 1e-15·(r + 1)/cos of the angle to the surface; in units of that",
        run: huge,
    },
    Case {
        id: "F22",
        name: "spheres of extreme size",
        about: "radius s seen from 3s, s from 1e-30 to 1e30: |t − t*| ≤ 4u·t* along an axis, 8u·t* elsewhere; errors in u·t*",
        run: extreme,
    },
    Case {
        id: "F23",
        name: "tangent rays",
        about: "rays that touch a sphere: hit or missed, but alike for nearest and any hit, and never not a number",
        run: tangent,
    },
    Case {
        id: "F24",
        name: "from within, near the surface",
        about: "1e-1 to 1e-6 deep, the far side is wanted: its residual ≤ 8u·(|c| + r); errors in units of u·(|c| + r)",
        run: within,
    },
    Case {
        id: "F25",
        name: "tiny spheres vanish in an absolute tolerance",
        about: "radius 1e-9, seen from 1",
        run: tiny,
    },
    Case {
        id: "F26",
        name: "planes at grazing angles",
        about: "sines from 1e-3 to 1e-7; relative error ≤ 8u/|sin θ|·(1 + |o|/h); errors in units of u/|sin θ|·(1 + |o|/h)",
        run: grazing,
    },
];

type Root = fn(DVec3, f64, &Ray, f64) -> Option<f64>;

fn power(exponent: i32) -> f64 {
    let ten = (0..exponent.abs()).fold(1.0, |x, _| x * 10.0);
    if exponent < 0 { 1.0 / ten } else { ten }
}

fn far(bench: &mut Bench) {
    let methods: [(&str, Root, fn(i32) -> Expected); 4] = [
        ("quadratic f32", naive_root::<f32>, |e| if e >= 4 { Failing } else { Shown }),
        ("by the foot f32", nearest_root::<f32>, |_| Shown),
        ("quadratic f64", naive_root::<f64>, |e| if e >= 8 { Failing } else { Shown }),
        ("Snell", nearest_root::<f64>, |_| Sound),
    ];
    for exponent in 0..=12 {
        let away = power(exponent);
        for (name, root, expected) in methods {
            let expected = expected(exponent);
            let tries = if expected == Sound { bench.full() } else { bench.others() };
            let tally = bench.tally(20, tries, |random| {
                let center = random.direction() * (1.0 + away);
                let side = center.cross(random.direction()).normalize_or(DVec3::X);
                let part = 0.99 * random.unit();
                let ray = Ray { origin: DVec3::ZERO, direction: (center + side * part).normalize() };
                let Some([near, _]) = sphere_roots(&ray, center, 1.0) else { return Trial::Skip };
                let bar = 16.0 * U * center.length() / (1.0 - part * part).sqrt();
                match root(center, 1.0, &ray, f64::INFINITY) {
                    None => Trial::of(false),
                    Some(t) => Trial::within((t - near).abs() / bar, if name.ends_with("f32") { 1e9 } else { 1.0 }),
                }
            });
            bench.add(expected, name, format!("distance 1e{exponent}"), tally);
        }
    }
}

fn huge(bench: &mut Bench) {
    let methods: [(&str, Root, fn(i32) -> Expected); 3] = [
        ("quadratic f64", naive_root::<f64>, |_| Shown),
        ("by the foot f32", nearest_root::<f32>, |_| Failing),
        ("Snell", nearest_root::<f64>, |_| Sound),
    ];
    for exponent in [0, 3, 6, 9, 12] {
        let radius = power(exponent);
        for (name, root, expected) in methods {
            let expected = expected(exponent);
            let tries = if expected == Sound { bench.full() } else { bench.others() };
            let tally = bench.tally(21, tries, |random| {
                let center = DVec3::new(0.0, -1.0 - radius, 0.0);
                let down = DVec3::new(random.signed(), -1.0, random.signed());
                let ray = Ray { origin: DVec3::ZERO, direction: down.normalize() };
                let Some([near, _]) = sphere_roots(&ray, center, radius) else { return Trial::Skip };
                match root(center, radius, &ray, f64::INFINITY) {
                    None => Trial::of(false),
                    Some(t) => {
                        // How much a rounding of the sphere's surface moves the crossing: more, the more grazing.
                        let foot = center.reject_from_normalized(ray.direction).length() / radius;
                        let bar = 1e-15 * (radius + 1.0) / (1.0 - foot * foot).max(1e-30).sqrt();
                        Trial::within((t - near).abs() / bar, 1.0)
                    }
                }
            });
            bench.add(expected, name, format!("radius 1e{exponent}"), tally);
        }
    }
}

fn extreme(bench: &mut Bench) {
    // Along an axis from three radii, where the distance is exact; and from anywhere, against double-doubles.
    let straight = |random: &mut Random| {
        let s = power(random.below(61) as i32 - 30) * (1.0 + random.unit());
        let axis = [DVec3::X, DVec3::Y, DVec3::Z][random.below(3)] * [1.0, -1.0][random.below(2)];
        (s, Ray { origin: axis * (-3.0 * s), direction: axis }, 2.0 * s)
    };
    let oblique = |random: &mut Random| {
        let s = power(random.below(61) as i32 - 30) * (1.0 + random.unit());
        let toward = random.direction();
        let ray = Ray { origin: toward * (-3.0 * s), direction: toward };
        // Scaled by a power of two, which changes no digit: squares of 1e-30 would leave the double-doubles no room.
        let unit = power_of_two_above(s);
        let small = Ray { origin: ray.origin / unit, ..ray };
        let near = sphere_roots(&small, DVec3::ZERO, s / unit).map_or(f64::NAN, |[near, _]| near * unit);
        (s, ray, near)
    };
    type Scene = fn(&mut Random) -> (f64, Ray, f64);
    let scenes: [(&str, Scene, f64); 2] = [("along an axis", straight, 4.0), ("oblique", oblique, 8.0)];
    for (cell, scene, bar) in scenes {
        let methods: [(&str, Root, Expected); 2] =
            [("by the foot f32", nearest_root::<f32>, Failing), ("Snell", nearest_root::<f64>, Sound)];
        for (name, root, expected) in methods {
            // In f32, only what is off by more than a few of its own roundings.
            let (tries, bar) = if expected == Sound { (bench.full(), bar) } else { (bench.others(), 1e10) };
            let tally = bench.tally(22, tries, |random| {
                let (s, ray, exact) = scene(random);
                root(DVec3::ZERO, s, &ray, f64::INFINITY)
                    .map_or(Trial::of(false), |t| Trial::within((t / exact - 1.0).abs() / U, bar))
            });
            bench.add(expected, name, cell, tally);
        }
    }
    let refused = [0.0, -1.0, f64::NAN, f64::INFINITY, 1e155];
    let tally = bench.tally(22, bench.full(), |random| {
        let radius = refused[random.below(refused.len())];
        Trial::of((Sphere { radius }).pack(&DAffine3::IDENTITY).is_err())
    });
    bench.add(Sound, "Snell: no radius, or one whose square is no number, is refused", "", tally);
}

/// The least power of two that is not below a number above zero.
fn power_of_two_above(x: f64) -> f64 {
    let mut power = 1.0;
    while power < x {
        power *= 2.0;
    }
    while power * 0.5 >= x {
        power *= 0.5;
    }
    power
}

fn tangent(bench: &mut Bench) {
    let tally = bench.tally(23, bench.full(), |random| {
        let radius = 1.0 + random.below(9) as f64;
        let Ok((_, ball)) = (Sphere { radius }).pack(&DAffine3::IDENTITY) else { return Trial::of(false) };
        let mut origin = DVec3::new(-5.0, radius, random.below(3) as f64 * 1e-16);
        origin.y = [radius, radius.next_up(), radius.next_down()][random.below(3)];
        let ray = Ray { origin, direction: DVec3::X * (0.5 + random.unit()) };
        let hit = Sphere::hit(&ball, &ray, f64::INFINITY, &mut Cost::default());
        let blocked = Sphere::blocks(&ball, &ray, f64::INFINITY, &mut Cost::default());
        Trial::of(hit.is_some() == blocked && hit.is_none_or(|hit| hit.t.is_finite() && hit.t > 0.0))
    });
    bench.add(Sound, "Snell", "", tally);
    // The check can fail: one of the two with a tolerance.
    let tally = bench.tally(23, bench.others(), |random| {
        let y = [1.0f64, 1.0f64.next_up(), 1.0f64.next_down()][random.below(3)];
        let ray = Ray { origin: DVec3::new(-5.0, y, 0.0), direction: DVec3::X };
        let nearest = nearest_root::<f64>(DVec3::ZERO, 1.0, &ray, f64::INFINITY).is_some();
        Trial::of(nearest == (1.0 - y * y > 1e-10))
    });
    bench.add(Failing, "any hit with a tolerance", "", tally);
}

fn within(bench: &mut Bench) {
    // The root that is not the nearest by a tolerance: from near the surface, where the ray starts.
    fn tolerant(center: DVec3, radius: f64, ray: &Ray, t_max: f64) -> Option<f64> {
        let f = ray.origin - center;
        let (b, c) = (f.dot(ray.direction), f.length_squared() - radius * radius);
        let root = (b * b - c).sqrt();
        [-b - root, -b + root].into_iter().find(|t| *t > -1e-3 && *t <= t_max)
    }
    let methods: [(&str, Root, Expected); 4] = [
        ("quadratic f64", naive_root::<f64>, Shown),
        ("quadratic f32", naive_root::<f32>, Failing),
        ("quadratic f64, t > −1e-3", tolerant, Failing),
        ("Snell", nearest_root::<f64>, Sound),
    ];
    for (name, root, expected) in methods {
        let tries = if expected == Sound { bench.full() } else { bench.others() };
        let tally = bench.tally(24, tries, |random| {
            let center = random.cube() * 10.0;
            let inward = random.direction();
            let depth = power(-1 - random.below(6) as i32);
            let direction = (inward + random.direction() * 0.9).normalize();
            let ray = Ray { origin: center - inward * (1.0 - depth), direction };
            match root(center, 1.0, &ray, f64::INFINITY) {
                None => Trial::of(false),
                // Behind or at the start is the near side again.
                Some(t) if t <= 0.5 * depth => Trial::of(false),
                Some(t) => Trial::within(sphere_residual(&ray, t, center, 1.0) / (U * (center.length() + 1.0)), 8.0),
            }
        });
        bench.add(expected, name, "", tally);
    }
}

fn tiny(bench: &mut Bench) {
    let ray = |random: &mut Random| {
        let side = DVec3::new(random.signed(), random.signed(), 0.0) * 0.5e-9;
        Ray { origin: DVec3::Z, direction: side - DVec3::Z }
    };
    let tally = bench.tally(25, bench.full(), |random| {
        Trial::of(nearest_root::<f64>(DVec3::ZERO, 1e-9, &ray(random), f64::INFINITY).is_some())
    });
    bench.add(Sound, "Snell", "", tally);
    let tally = bench.tally(25, bench.others(), |random| {
        let ray = ray(random);
        let foot = ray.at(ray.origin.dot(-ray.direction) / ray.direction.length_squared());
        Trial::of(1e-18 - foot.length_squared() > 1e-10)
    });
    bench.add(Failing, "half-chord² > 1e-10", "", tally);
}

/// Placements of whole numbers, so that the plane is known exactly: a point of it and its normal, of any length.
fn plane_placements() -> [(DAffine3, DVec3, DVec3); 3] {
    let tilted = DMat3::from_cols(DVec3::new(3.0, 4.0, 0.0), DVec3::new(-4.0, 3.0, 0.0), DVec3::new(0.0, 0.0, 5.0));
    let skew = DMat3::from_cols(DVec3::new(2.0, 1.0, -1.0), DVec3::new(0.0, 3.0, 1.0), DVec3::new(1.0, -2.0, 2.0));
    [(DMat3::IDENTITY, DVec3::ZERO), (tilted, DVec3::new(7.0, -3.0, 5.0)), (skew, DVec3::new(-2.0, 9.0, 4.0))].map(
        |(matrix, point)| {
            let normal = matrix.z_axis.cross(matrix.x_axis);
            (DAffine3::from_mat3_translation(matrix, point), point, normal)
        },
    )
}

fn grazing(bench: &mut Bench) {
    let planes = plane_placements().map(|(placement, point, normal)| {
        let packed = Plane {}.pack(&placement).map(|(_, packed)| packed);
        (packed, placement, point, normal)
    });
    // A ray that comes down on the plane by a small sine, its origin one or two above.
    let scene = |random: &mut Random, (placement, point, normal): (DAffine3, DVec3, DVec3)| {
        let up = normal.normalize();
        let sine = power(-3 - random.below(5) as i32) * (1.0 + random.unit());
        let across = placement.matrix3.x_axis * random.signed() + placement.matrix3.z_axis * random.signed();
        let flat = across.normalize_or(placement.matrix3.x_axis.normalize());
        let height = 1.0 + random.unit();
        let origin = point + up * height + placement.matrix3.x_axis * random.signed();
        let ray = Ray { origin, direction: flat - up * sine };
        // In units of the catalogue's bar: u/|sin θ| · (1 + |o|/h).
        let unit = U / sine * (1.0 + (origin.length() + point.length()) / height);
        (ray, plane_distance(&ray, point, normal), unit)
    };
    let tally = bench.tally(26, bench.full(), |random| {
        let (packed, placement, point, normal) = &planes[random.below(3)];
        let Ok(packed) = packed else { return Trial::of(false) };
        let (ray, exact, unit) = scene(random, (*placement, *point, *normal));
        Plane::hit(packed, &ray, f64::INFINITY, &mut Cost::default())
            .map_or(Trial::of(false), |hit| Trial::within((hit.t / exact - 1.0).abs() / unit, 8.0))
    });
    bench.add(Sound, "Snell", "any", tally);
    let level = (planes[0].1, planes[0].2, planes[0].3);
    let tally = bench.tally(26, bench.full(), |random| {
        let Ok(packed) = &planes[0].0 else { return Trial::of(false) };
        let (ray, exact, _) = scene(random, level);
        Plane::hit(packed, &ray, f64::INFINITY, &mut Cost::default())
            .map_or(Trial::of(false), |hit| Trial::within((hit.t / exact - 1.0).abs() / U, 2.0))
    });
    bench.add(Sound, "Snell, level planes: within 2u", "level", tally);
    let tally = bench.tally(26, bench.full(), |random| {
        let (packed, placement, point, _) = &planes[random.below(3)];
        let Ok(packed) = packed else { return Trial::of(false) };
        // In the plane, along it; whole numbers, so that it is so to the last bit.
        let (x, z) = (random.below(9) as f64 - 4.0, random.below(9) as f64 - 4.0);
        let along = placement.matrix3.x_axis * (x + 0.5) + placement.matrix3.z_axis * z;
        let ray = Ray { origin: *point + placement.matrix3.x_axis * z, direction: along };
        let hit = Plane::hit(packed, &ray, f64::INFINITY, &mut Cost::default());
        Trial::of(hit.is_none_or(|hit| hit.t.is_finite() && hit.t > 0.0))
    });
    bench.add(Sound, "Snell, rays in the plane: no number that is none", "any", tally);
    let tally = bench.tally(26, bench.others(), |random| {
        let (ray, exact, unit) = scene(random, level);
        let d = ray.direction.as_vec3();
        Trial::within((f64::from(ray.origin.as_vec3().y / -d.y) / exact - 1.0).abs() / unit, 8.0)
    });
    bench.add(Failing, "f32", "level", tally);
}
