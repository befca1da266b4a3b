//! F30 to F34: slabs. Oracle: fractions of whole numbers.

use crate::{
    exact::{Span, box_span, meets_box},
    random::Random,
    suite::{Bench, Case, Expected::*, Trial},
};
use glam::{DAffine3, DVec3};
use snell_components::{
    bvh::{Box32, Bvh},
    primitive::{Cost, Primitive},
    shape::Cuboid,
    space::{Bounds, Ray},
};

pub(super) const CASES: &[Case] = &[
    Case {
        id: "F30",
        name: "slabs and zeros",
        about: "boxes, flat ones, lines and points; origins and directions of −2..2, zeros of both signs; false misses",
        run: special,
    },
    Case {
        id: "F31",
        name: "boxes missed by rounding",
        about: "boxes of whole coordinates, rays from afar aimed at corners, edges and faces; false misses",
        run: aimed,
    },
    Case {
        id: "F32",
        name: "rays that are none",
        about: "not finite or without direction: no node is visited",
        run: none,
    },
    Case {
        id: "F33",
        name: "empty boxes are met",
        about: "the lanes of a node that hold no child: a walk visits the node once and what it holds, nothing else",
        run: empty,
    },
    Case {
        id: "F34",
        name: "rays along faces and edges of boxes",
        about: "the box shape against fractions: false hits, false misses; |t − t*| ≤ u·t, errors in units of that",
        run: shape,
    },
];

fn visited(tree: &Bvh, ray: &Ray) -> bool {
    tree.any(ray, f64::INFINITY, &mut Cost::default(), |_, _| true)
}

fn small(random: &mut Random) -> DVec3 {
    let mut one = || [-2.0, -1.0, -0.0, 0.0, 1.0, 2.0][random.below(6)];
    let (x, y) = (one(), one());
    DVec3::new(x, y, one())
}

/// The usual form: least and greatest of both distances, which NaN spoils.
fn usual(ray: &Ray, bounds: &Bounds) -> bool {
    let inverse = (DVec3::ONE / ray.direction).as_vec3();
    let (o, low, high) = (ray.origin.as_vec3(), bounds.min.as_vec3(), bounds.max.as_vec3());
    let (mut near, mut far) = (0.0f32, f32::INFINITY);
    for axis in 0..3 {
        let a = (low[axis] - o[axis]) * inverse[axis];
        let b = (high[axis] - o[axis]) * inverse[axis];
        near = near.max(if a < b { a } else { b });
        far = far.min(if a < b { b } else { a });
    }
    near <= far
}

fn special(bench: &mut Bench) {
    let scene = |random: &mut Random| {
        let half = [DVec3::ONE, DVec3::new(1.0, 0.0, 1.0), DVec3::new(0.0, 1.0, 0.0), DVec3::ZERO][random.below(4)];
        (Ray { origin: small(random), direction: small(random) }, Bounds { min: -half, max: half })
    };
    let meets = |ray: &Ray, b: &Bounds| ray.direction != DVec3::ZERO && meets_box(ray, b.min, b.max);
    let tally = bench.tally(30, bench.full(), |random| {
        let (ray, bounds) = scene(random);
        if !meets(&ray, &bounds) {
            return Trial::Skip;
        }
        Trial::of(visited(&Bvh::build([Box32::around(&bounds)].into_iter(), 1), &ray))
    });
    bench.add(Sound, "Snell", "", tally);
    let tally = bench.tally(30, bench.others(), |random| {
        let (ray, bounds) = scene(random);
        if meets(&ray, &bounds) { Trial::of(usual(&ray, &bounds)) } else { Trial::Skip }
    });
    bench.add(Failing, "min/max f32", "", tally);
}

fn aimed(bench: &mut Bench) {
    let scene = |random: &mut Random| {
        let center = random.lattice(1 << 22);
        let mut size = random.lattice(64).abs();
        if random.below(4) == 0 {
            size[random.below(3)] = 0.0;
        }
        // On each axis at one end or the other, or between: corners, edges and faces, and now and then within.
        let mut at = center;
        for axis in 0..3 {
            let reach = size[axis] as usize;
            at[axis] += match random.below(3) {
                0 => -size[axis],
                1 => size[axis],
                _ => random.below(2 * reach + 1) as f64 - size[axis],
            };
        }
        let reach = 1 << (4 + random.below(19));
        let origin = random.lattice(reach);
        (Ray { origin, direction: at - origin }, Bounds { min: center - size, max: center + size })
    };
    let tally = bench.tally(31, bench.full(), |random| {
        let (ray, bounds) = scene(random);
        if ray.direction == DVec3::ZERO {
            return Trial::Skip;
        }
        Trial::of(visited(&Bvh::build([Box32::around(&bounds)].into_iter(), 1), &ray))
    });
    bench.add(Sound, "Snell", "", tally);
    let tally = bench.tally(31, bench.others(), |random| {
        let (ray, bounds) = scene(random);
        if ray.direction == DVec3::ZERO { Trial::Skip } else { Trial::of(usual(&ray, &bounds)) }
    });
    bench.add(Failing, "min/max f32", "", tally);
}

fn none(bench: &mut Bench) {
    let unit = Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE };
    let tree = Bvh::build([Box32::around(&unit)].into_iter(), 1);
    let bad = |random: &mut Random| {
        let mut ray = Ray { origin: random.cube(), direction: random.direction() };
        let wrong = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY][random.below(3)];
        match random.below(3) {
            0 => ray.origin[random.below(3)] = wrong,
            1 => ray.direction[random.below(3)] = wrong,
            _ => ray.direction = DVec3::ZERO,
        }
        ray
    };
    let tally = bench.tally(32, bench.full(), |random| {
        let mut cost = Cost::default();
        Trial::of(!tree.any(&bad(random), f64::INFINITY, &mut cost, |_, _| true) && cost.nodes == 0)
    });
    bench.add(Sound, "Snell", "", tally);
    let tally = bench.tally(32, bench.others(), |random| Trial::of(!usual(&bad(random), &unit)));
    bench.add(Failing, "min/max f32", "", tally);
}

fn empty(bench: &mut Bench) {
    let scene = |random: &mut Random| {
        let special = random.below(2) == 0;
        let ray = if special {
            Ray { origin: small(random), direction: small(random) }
        } else {
            Ray { origin: random.cube() * 3.0, direction: random.direction() }
        };
        let boxes: Vec<Bounds> = (0..1 + random.below(7))
            .map(|_| {
                let (a, b) = (small(random), small(random));
                Bounds { min: a.min(b), max: a.max(b) }
            })
            .collect();
        (ray, boxes)
    };
    let tally = bench.tally(33, bench.full(), |random| {
        let (ray, boxes) = scene(random);
        if ray.direction == DVec3::ZERO {
            return Trial::Skip;
        }
        let tree = Bvh::build(boxes.iter().map(Box32::around).collect::<Vec<_>>().into_iter(), 1);
        let mut cost = Cost::default();
        let mut met = vec![];
        tree.walk(&ray, f64::INFINITY, &mut cost, |run, limit, _| {
            met.push(run);
            // An empty lane leads back to the root: for ever, if it were met.
            if met.len() > boxes.len() { f64::NEG_INFINITY } else { limit }
        });
        met.sort_by_key(|run| run.start);
        let once = met.windows(2).all(|pair| pair[0].end <= pair[1].start);
        Trial::of(once && cost.nodes == 1 && met.len() <= boxes.len())
    });
    bench.add(Sound, "Snell", "", tally);
    let tally = bench.tally(33, bench.others(), |random| Trial::of(!usual(&scene(random).0, &Bounds::EMPTY)));
    bench.add(Failing, "min/max f32", "", tally);
}

fn shape(bench: &mut Bench) {
    // Whole sizes about a whole centre, so that the box is the one of the oracle to the last bit.
    let scene = |random: &mut Random| {
        if random.below(2) == 0 {
            (DVec3::ZERO, DVec3::ONE, Ray { origin: small(random), direction: small(random) })
        } else {
            let center = random.lattice(1000);
            let half = random.lattice(20).abs() + 1.0;
            let corner = center + half * DVec3::from_array([0; 3].map(|_| [-1.0, 1.0, 0.0][random.below(3)]));
            let reach = 1 << (3 + random.below(14));
            let origin = random.lattice(reach);
            (center, half, Ray { origin, direction: corner - origin })
        }
    };
    // At its own start, on a face, either answer is right.
    let undecided = |center: DVec3, half: DVec3, ray: &Ray| {
        let off = (ray.origin - center).abs();
        ray.direction == DVec3::ZERO || off.cmple(half).all() && off.cmpeq(half).any()
    };
    let tally = bench.tally(34, bench.full(), |random| {
        let (center, half, ray) = scene(random);
        if undecided(center, half, &ray) {
            return Trial::Skip;
        }
        let Ok((_, cube)) = (Cuboid { size: half * 2.0 }).pack(&DAffine3::from_translation(center)) else {
            return Trial::of(false);
        };
        let hit = Cuboid::hit(&cube, &ray, f64::INFINITY, &mut Cost::default());
        match (hit, box_span(&ray, center - half, center + half)) {
            (None, None) => Trial::Pass(0.0),
            (Some(hit), Some(Span { enter, leave: Some(leave) })) => {
                let exact = if enter.0 > 0 { enter } else { leave };
                Trial::within(crate::exact::relative_error(hit.t, exact) / super::U, 1.0)
            }
            _ => Trial::of(false),
        }
    });
    bench.add(Sound, "Snell", "", tally);
    let tally = bench.tally(34, bench.others(), |random| {
        let (center, half, ray) = scene(random);
        if undecided(center, half, &ray) {
            return Trial::Skip;
        }
        let bounds = Bounds { min: center - half, max: center + half };
        Trial::of(usual(&ray, &bounds) == meets_box(&ray, bounds.min, bounds.max))
    });
    bench.add(Failing, "min/max f32", "", tally);
}
