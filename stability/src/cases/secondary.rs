//! F50 and F51: rays that leave a surface. Oracle: closed form, the surface is a plane.

use super::geometry;
use crate::{
    random::Random,
    suite::{Bench, Case, Expected, Expected::*, Trial},
};
use glam::DVec3;
use snell_components::{
    method::Methods,
    primitive::{Cost, Surface},
    shape::Triangle,
    space::Ray,
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "F50",
        name: "surfaces shade themselves",
        about: "from a hit of a triangle of that size, seen from 2 to 5 sizes, no ray within the hemisphere may meet it again",
        run: acne,
    },
    Case {
        id: "F51",
        name: "contacts cast no shadow",
        about: "a parallel occluder 1e-4 sizes above must be met by every ray that leaves steeply",
        run: contact,
    },
];

const SCALES: [f64; 5] = [1e-6, 1e-3, 1.0, 1e3, 1e6];
const OFFSETS: [f64; 4] = [0.0, 1e2, 1e4, 1e6];

/// Where a ray starts that leaves a surface.
type Start = fn(&Surface, DVec3, f64) -> DVec3;

/// Name, rule, and what is to come of it at a size, a distance in sizes, and with an occluder or none.
const STARTS: &[(&str, Start, fn(f64, f64, bool) -> Expected)] = &[
    ("Snell", |surface, direction, travelled| surface.departure(direction, travelled), |_, _, _| Sound),
    // Larger than the gap to the occluder, or lost in the rounding of coordinates of 1e12.
    (
        "fixed 1e-4",
        |surface, direction, _| surface.point + direction * 1e-4,
        |scale, offset, occluder| {
            let fails = if occluder { scale < 1.0 } else { scale * offset >= 1e12 };
            if fails { Failing } else { Shown }
        },
    ),
    ("none", |surface, _, _| surface.point, |_, _, occluder| if occluder { Shown } else { Failing }),
];

fn triangle(scale: f64, offset: DVec3, height: f64) -> Triangle {
    let at = |x: f64, z: f64| DVec3::new(x, height, z) * scale + offset;
    Triangle { a: at(-1.0, -1.0), b: at(1.0, -1.0), c: at(0.0, 1.2), ..Triangle::default() }
}

/// In every cell: the share of rays from a hit that the rule gets wrong.
fn matrix(bench: &mut Bench, occluder: Option<f64>) {
    for scale in SCALES {
        for offset in OFFSETS {
            let at = DVec3::new(0.7, -1.0, 0.45) * (offset * scale);
            let ground = geometry(|world| {
                world.spawn(triangle(scale, at, 0.0));
            });
            let above = geometry(|world| {
                world.spawn(triangle(scale, at, 0.0));
                if let Some(gap) = occluder {
                    // Larger than the ground, so that a steep ray cannot pass beside it.
                    let t = triangle(3.0 * scale, at + DVec3::Y * (gap * scale), 0.0);
                    world.spawn(t);
                }
            });
            for (name, start, expected) in STARTS {
                let expected = expected(scale, offset, occluder.is_some());
                let tries = if expected == Sound { bench.full() } else { bench.others() };
                let tally = bench.tally(50, tries, |random: &mut Random| {
                    let target = DVec3::new(random.signed() * 0.3, 0.0, random.signed() * 0.3 - 0.3) * scale + at;
                    let eye = random.direction();
                    let eye = DVec3::new(eye.x, eye.y.abs() + 0.05, eye.z).normalize();
                    let origin = target + eye * ((2.0 + 3.0 * random.unit()) * scale);
                    let ray = Ray { origin, direction: (target - origin).normalize() };
                    let cost = &mut Cost::default();
                    let Some(met) = ground.closest(&ray, f64::INFINITY, &Methods::default(), cost) else {
                        return Trial::Skip;
                    };
                    let mut surface = met.surface;
                    if surface.normal.dot(ray.direction) > 0.0 {
                        surface.normal = -surface.normal;
                    }
                    let away = random.direction();
                    let least = if occluder.is_some() { 0.5 } else { 0.01 };
                    let away = DVec3::new(away.x, away.y.abs() + least, away.z).normalize();
                    let ray = Ray { origin: start(&surface, away, met.t), direction: away };
                    let hit = above.blocked(&ray, f64::INFINITY, &Methods::default(), cost);
                    Trial::of(hit == occluder.is_some())
                });
                bench.add_at(expected, name, scale, offset * scale, tally);
            }
        }
    }
}

fn acne(bench: &mut Bench) {
    matrix(bench, None);
}

fn contact(bench: &mut Bench) {
    matrix(bench, Some(1e-4));
}
