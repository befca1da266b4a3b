//! F20 to F26: spheres far, huge, tiny or met from near their surface; planes at grazing angles. Oracle: double-doubles.

use super::U;
use crate::{
    exact::sphere_roots,
    random::Random,
    suite::{Bench, Case, Expected, Expected::*, Trial},
};
use glam::{DAffine3, DVec3};
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
        about: "the eye one above a sphere of up to 1e12 radii; |t − t*| ≤ 1e-15 of the radius",
        run: huge,
    },
    Case {
        id: "F22",
        name: "spheres of extreme size",
        about: "radius s seen from 3s, s from 1e-30 to 1e30: t = 2s to 4u",
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
        about: "the far side is wanted: residual of the surface ≤ 64u of the coordinates",
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
        about: "sines from 1e-3 to 1e-7; relative error ≤ 8u",
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
            let tries = if expected == Sound { bench.part(2) } else { bench.part(100) };
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
    let methods: [(&str, Root, bool); 3] = [
        ("quadratic f64", naive_root::<f64>, false),
        ("by the foot f32", nearest_root::<f32>, false),
        ("Snell", nearest_root::<f64>, true),
    ];
    for exponent in [0, 3, 6, 9, 12] {
        let radius = power(exponent);
        for (name, root, ours) in methods {
            let tries = bench.part(if ours { 5 } else { 100 });
            let tally = bench.tally(21, tries, |random| {
                let center = DVec3::new(0.0, -1.0 - radius, 0.0);
                let down = DVec3::new(random.signed(), -1.0, random.signed());
                let ray = Ray { origin: DVec3::ZERO, direction: down.normalize() };
                let Some([near, _]) = sphere_roots(&ray, center, radius) else { return Trial::Skip };
                match root(center, radius, &ray, f64::INFINITY) {
                    None => Trial::of(false),
                    Some(t) => Trial::within((t - near).abs(), 1e-15 * (radius + 1.0) * 4.0),
                }
            });
            bench.add(if ours { Sound } else { Shown }, name, format!("radius 1e{exponent}"), tally);
        }
    }
}

fn extreme(bench: &mut Bench) {
    let methods: [(&str, Root, Expected); 2] =
        [("by the foot f32", nearest_root::<f32>, Failing), ("Snell", nearest_root::<f64>, Sound)];
    for (name, root, expected) in methods {
        let tally = bench.tally(22, bench.part(1), |random| {
            let s = power(random.below(61) as i32 - 30) * (1.0 + random.unit());
            let toward = random.direction();
            let ray = Ray { origin: toward * (-3.0 * s), direction: toward };
            let bar = if name == "Snell" { 16.0 * U } else { 1e-5 };
            root(DVec3::ZERO, s, &ray, f64::INFINITY)
                .map_or(Trial::of(false), |t| Trial::within((t / (2.0 * s) - 1.0).abs(), bar))
        });
        bench.add(expected, name, "", tally);
    }
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
    let tally = bench.tally(23, bench.part(10), |random| {
        let y = [1.0f64, 1.0f64.next_up(), 1.0f64.next_down()][random.below(3)];
        let ray = Ray { origin: DVec3::new(-5.0, y, 0.0), direction: DVec3::X };
        let nearest = nearest_root::<f64>(DVec3::ZERO, 1.0, &ray, f64::INFINITY).is_some();
        Trial::of(nearest == (1.0 - y * y > 1e-10))
    });
    bench.add(Failing, "any hit with a tolerance", "", tally);
}

fn within(bench: &mut Bench) {
    let methods: [(&str, Root, Expected); 2] =
        [("quadratic f64", naive_root::<f64>, Shown), ("Snell", nearest_root::<f64>, Sound)];
    for (name, root, expected) in methods {
        let tally = bench.tally(24, bench.full(), |random| {
            let center = random.cube() * 10.0;
            let inward = random.direction();
            let depth = power(-1 - random.below(6) as i32);
            let direction = (inward + random.direction() * 0.9).normalize();
            let ray = Ray { origin: center - inward * (1.0 - depth), direction };
            match root(center, 1.0, &ray, f64::INFINITY) {
                None => Trial::of(false),
                Some(t) => {
                    let residual = ((ray.at(t) - center).length() - 1.0).abs();
                    Trial::within(residual, 64.0 * U * (center.length() + 1.0))
                }
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
    let tally = bench.tally(25, bench.part(10), |random| {
        let ray = ray(random);
        let foot = ray.at(ray.origin.dot(-ray.direction) / ray.direction.length_squared());
        Trial::of(1e-18 - foot.length_squared() > 1e-10)
    });
    bench.add(Failing, "half-chord² > 1e-10", "", tally);
}

fn grazing(bench: &mut Bench) {
    let Ok((_, plane)) = (Plane {}).pack(&DAffine3::IDENTITY) else { return };
    let scene = |random: &mut Random| {
        let sine = power(-3 - random.below(5) as i32) * (1.0 + random.unit());
        let origin = DVec3::new(random.signed(), 1.0 + random.unit(), random.signed());
        let flat = DVec3::new(random.signed(), 0.0, random.signed()).normalize_or(DVec3::X);
        Ray { origin, direction: flat - DVec3::Y * sine }
    };
    let tally = bench.tally(26, bench.full(), |random| {
        let ray = scene(random);
        let exact = ray.origin.y / -ray.direction.y;
        Plane::hit(&plane, &ray, f64::INFINITY, &mut Cost::default())
            .map_or(Trial::of(false), |hit| Trial::within((hit.t / exact - 1.0).abs(), 8.0 * U))
    });
    bench.add(Sound, "Snell", "", tally);
    let tally = bench.tally(26, bench.part(10), |random| {
        let ray = scene(random);
        let exact = ray.origin.y / -ray.direction.y;
        let d = ray.direction.normalize().as_vec3();
        let t = ray.origin.as_vec3().y / -d.y;
        Trial::within((f64::from(t) / ray.direction.length() / exact - 1.0).abs(), 8.0 * U)
    });
    bench.add(Failing, "f32", "", tally);
}
