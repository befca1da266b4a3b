//! F30 to F34: slabs. Oracle: fractions of whole numbers.

use crate::{
    exact::meets_box,
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
        about: "boxes of whole coordinates, rays from afar aimed at corners and edges; false misses",
        run: aimed,
    },
    Case {
        id: "F32",
        name: "rays that are none",
        about: "not finite or without direction: no node is visited",
        run: none,
    },
    Case {
        id: "F34",
        name: "rays along faces and edges of boxes",
        about: "the box shape against fractions, false hits and false misses",
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
        let tree = Bvh::build([Box32::around(&bounds)].into_iter(), 1);
        if meets(&ray, &bounds) { Trial::of(visited(&tree, &ray)) } else { Trial::Skip }
    });
    bench.add(Sound, "Snell", "", tally);
    let tally = bench.tally(30, bench.part(10), |random| {
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
        let bounds = Bounds { min: center - size, max: center + size };
        let corner = bounds.corners()[random.below(8)];
        let reach = 1 << (4 + random.below(19));
        let origin = random.lattice(reach);
        (Ray { origin, direction: corner - origin }, bounds)
    };
    let tally = bench.tally(31, bench.full(), |random| {
        let (ray, bounds) = scene(random);
        if ray.direction == DVec3::ZERO {
            return Trial::Skip;
        }
        let tree = Bvh::build([Box32::around(&bounds)].into_iter(), 1);
        Trial::of(visited(&tree, &ray))
    });
    bench.add(Sound, "Snell", "", tally);
    let tally = bench.tally(31, bench.part(10), |random| {
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
    let tally = bench.tally(32, bench.part(10), |random| Trial::of(!usual(&bad(random), &unit)));
    bench.add(Failing, "min/max f32", "", tally);
}

fn shape(bench: &mut Bench) {
    let Ok((_, cube)) = (Cuboid { size: DVec3::splat(2.0) }).pack(&DAffine3::IDENTITY) else { return };
    let unit = Bounds { min: DVec3::NEG_ONE, max: DVec3::ONE };
    let scene = |random: &mut Random| Ray { origin: small(random), direction: small(random) };
    // At its own start, on a face, either answer is right.
    let decided = |ray: &Ray| ray.direction != DVec3::ZERO && ray.origin.abs().max_element() > 1.0;
    let tally = bench.tally(34, bench.full(), |random| {
        let ray = scene(random);
        if !decided(&ray) {
            return Trial::Skip;
        }
        let hit = Cuboid::hit(&cube, &ray, f64::INFINITY, &mut Cost::default()).is_some();
        Trial::of(hit == meets_box(&ray, unit.min, unit.max))
    });
    bench.add(Sound, "Snell", "", tally);
    let tally = bench.tally(34, bench.part(10), |random| {
        let ray = scene(random);
        if decided(&ray) { Trial::of(usual(&ray, &unit) == meets_box(&ray, unit.min, unit.max)) } else { Trial::Skip }
    });
    bench.add(Failing, "min/max f32", "", tally);
}
