//! Clear bodies and what fills them: closed forms, worked out beside each test.

use snell::components::math;
use snell::prelude::*;
use snell::systems::{
    render::{Forward, Interior, Observer, Way, pixel, pixel_observed},
    snapshot::View,
};

fn scene(settings: Settings, build: impl FnOnce(&mut World)) -> Snapshot {
    let mut renderer = Renderer::new();
    *renderer.settings() = Settings { width: 1, height: 1, background: Rgb::ONE, cutoff: 0.0, ..settings };
    renderer.world.spawn(Camera::default());
    build(&mut renderer.world);
    (*renderer.snapshot().expect("a snapshot")).clone()
}

/// The light that comes to a point from a direction, and the rays that it took.
fn traced(snapshot: &Snapshot, eye: DVec3, toward: DVec3) -> (Rgb, snell::Counts) {
    let view = View { eye, right: DVec3::ZERO, up: DVec3::ZERO, forward: toward };
    let inside = Interior::around(eye, &snapshot.geometry, &snapshot.materials);
    let mut counts = snell::Counts::default();
    let light = pixel(&Snapshot { view, inside, ..snapshot.clone() }, 0, 0, &Methods::default(), &mut counts);
    (light, counts)
}

fn seen(snapshot: &Snapshot, eye: DVec3, toward: DVec3) -> Rgb {
    traced(snapshot, eye, toward).0
}

#[track_caller]
fn assert_near(found: Rgb, expected: Rgb) {
    assert!((found - expected).abs().max_element() <= 1e-12, "{found}, expected {expected}");
}

fn left(coefficient: Rgb, length: f64) -> Rgb {
    Rgb::from_array(coefficient.to_array().map(|coefficient| math::exp(-coefficient * length)))
}

/// A ball about the origin that lets all light through and bends it.
fn ball(radius: f64, index: f64) -> (Sphere, Transmission, Refraction) {
    (Sphere { radius }, Transmission(Rgb::ONE), Refraction { index })
}

const TINT: Rgb = Rgb::new(0.0, 0.3, 2.0);

#[test]
fn what_is_left_after_a_body_is_the_exponential_of_the_way() {
    for length in [0.25, 1.0, 3.0] {
        let plate = Cuboid { size: DVec3::new(9.0, 9.0, length) };
        let shapes: [&dyn Fn(&mut World) -> Entity; 2] =
            [&|world| world.spawn(plate.clone()).id(), &|world| world.spawn(Sphere { radius: 0.5 * length }).id()];
        for shape in shapes {
            let snapshot = scene(Settings::default(), |world| {
                let body = shape(world);
                world.entity_mut(body).insert((Transmission(Rgb::ONE), Absorption(TINT)));
            });
            let found = seen(&snapshot, DVec3::Z * 5.0, DVec3::NEG_Z);
            assert_near(found, left(TINT, length));
            assert_eq!(found.x, 1.0, "a coefficient of zero");
        }
    }
}

#[test]
fn no_light_comes_from_infinitely_far_through_what_absorbs() {
    // From inside a half-space without end.
    let snapshot = scene(Settings::default(), |world| {
        world.spawn((Plane {}, Transmission(Rgb::ONE), Absorption(TINT)));
    });
    assert_eq!(seen(&snapshot, DVec3::NEG_Y, DVec3::NEG_Y), Rgb::X);
    assert_near(seen(&snapshot, DVec3::NEG_Y, DVec3::Y), left(TINT, 1.0));
}

#[test]
fn what_is_opaque_blocks_a_light_though_something_clear_coincides_with_it() {
    let lit_floor = |blocked: bool| {
        let snapshot = scene(Settings::default(), |world| {
            let (cube, above) = (Cuboid { size: DVec3::splat(2.0) }, Transform::at(DVec3::Y * 2.0));
            world.spawn((Name::new("floor"), Plane {}, Diffuse(Rgb::ONE)));
            world.spawn(PointLight { position: DVec3::Y * 5.0, ..PointLight::default() });
            // First in the order of names, so that of equal distances its surface is the one that is met.
            world.spawn((Name::new("a"), cube.clone(), above.clone(), Transmission(Rgb::ONE)));
            if blocked {
                world.spawn((Name::new("b"), cube, above, Diffuse(Rgb::ONE)));
            }
        });
        traced(&snapshot, DVec3::Y * 0.5, DVec3::NEG_Y)
    };
    let (light, counts) = lit_floor(true);
    assert_eq!((light, counts.shadow), (Rgb::ZERO, 1));
    // One ray more for each surface passed.
    let (light, counts) = lit_floor(false);
    assert_eq!((light, counts.shadow), (Rgb::ONE, 3));
}

/// Water in glass: on the axis of both.
fn nested() -> Snapshot {
    scene(Settings::default(), |world| {
        world.spawn((ball(2.0, 1.5), Absorption(TINT * 0.5)));
        world.spawn((ball(1.0, 1.33), Absorption(TINT)));
    })
}

#[test]
fn a_ray_on_the_axis_is_absorbed_by_each_medium_it_is_in() {
    let snapshot = nested();
    let (glass, water) = (left(TINT * 0.5, 1.0), left(TINT, 2.0));
    assert_near(seen(&snapshot, DVec3::Z * 5.0, DVec3::NEG_Z), glass * water * glass);
    assert_near(seen(&snapshot, DVec3::Z * 1.5, DVec3::NEG_Z), left(TINT * 0.5, 0.5) * water * glass);
    assert_near(seen(&snapshot, DVec3::ZERO, DVec3::NEG_Z), left(TINT, 1.0) * glass);
}

#[test]
fn a_surface_between_two_media_mirrors_by_the_indices_of_both() {
    // As deep as the way through: what is mirrored twice is too deep, what is mirrored once sees the dark.
    let mut snapshot = scene(Settings { depth: 4, ..Settings::default() }, |world| {
        world.spawn((Sphere { radius: 2.0 }, Dielectric { index: 1.5 }, Absorption(TINT * 0.5)));
        world.spawn((Sphere { radius: 1.0 }, Dielectric { index: 1.33 }, Absorption(TINT)));
        world.spawn((Cuboid { size: DVec3::ONE }, Transform::at(DVec3::Z * -5.0), Ambient(Rgb::ONE)));
        world.spawn(AmbientLight::default());
    });
    snapshot.settings.background = Rgb::ZERO;
    let passes = |a: f64, b: f64| 4.0 * a * b / ((a + b) * (a + b));
    let inward = passes(1.0, 1.5) * passes(1.5, 1.33);
    let expected = left(TINT * 0.5, 2.0) * left(TINT, 2.0) * inward * inward;
    assert_near(seen(&snapshot, DVec3::Z * 5.0, DVec3::NEG_Z), expected);
}

#[test]
fn the_body_of_higher_rank_counts_where_two_overlap_whichever_is_met_first() {
    let [a, b] = [Rgb::splat(0.5), Rgb::splat(2.0)];
    for (rank, in_a, in_b) in [(-1.0, 3.0, 1.0), (1.0, 2.0, 2.0)] {
        let snapshot = scene(Settings::default(), |world| {
            let size = DVec3::new(9.0, 9.0, 3.0);
            let body = (Cuboid { size }, Transmission(Rgb::ONE), Refraction { index: 1.5 }, Absorption(a));
            world.spawn(body);
            let size = DVec3::new(9.0, 9.0, 2.0);
            let body = (Cuboid { size }, Transmission(Rgb::ONE), Refraction { index: 1.2 }, Absorption(b));
            world.spawn((body, MediumRank(rank), Transform::at(DVec3::Z * 1.5)));
        });
        let expected = left(a, in_a) * left(b, in_b);
        assert_near(seen(&snapshot, DVec3::Z * 9.0, DVec3::NEG_Z), expected);
        assert_near(seen(&snapshot, DVec3::Z * -9.0, DVec3::Z), expected);
    }
}

#[test]
fn a_body_as_dense_as_what_is_around_it_is_not_seen() {
    let snapshot = scene(Settings::default(), |world| {
        world.spawn((Sphere { radius: 1.0 }, Dielectric { index: 1.0 }));
    });
    let (light, counts) = traced(&snapshot, DVec3::new(0.3, 0.4, 5.0), DVec3::NEG_Z);
    assert_eq!((light, counts.mirror), (Rgb::ONE, 0));
}

#[test]
fn a_dispersing_body_loses_no_light_and_fans_it_out() {
    let prism = |world: &mut World| {
        let turned = Transform::new([Step::RotateX(30.0), Step::Translate(DVec3::Y * 0.1)]);
        let glass = (Transmission(Rgb::ONE), Refraction { index: 1.6 }, Dispersion { abbe: 20.0, wavelengths: 8 });
        world.spawn((Plane {}, turned, glass));
    };
    let snapshot = scene(Settings::default(), prism);
    let (light, counts) = traced(&snapshot, DVec3::Y * 5.0, DVec3::NEG_Y);
    assert_near(light, Rgb::ONE);
    assert_eq!(counts.transmitted, 8);
    let straight = scene(Settings { refraction: false, ..Settings::default() }, prism);
    assert_eq!(traced(&straight, DVec3::Y * 5.0, DVec3::NEG_Y).1.transmitted, 1);
}

/// The ways of each wavelength out of the last surface, as rays come to them.
#[derive(Default)]
struct Exits(Vec<(f64, DVec3)>);

impl Observer for Exits {
    fn put_forward(&mut self, ray: &Forward<'_>) {
        let (Way::Transmitted, Some(wavelength)) = (ray.way, ray.wavelength) else { return };
        self.0.retain(|(known, _)| *known != wavelength);
        self.0.push((wavelength, ray.ray.direction));
    }
}

/// A prism along z, its edge on top at `(0, 1)`, its other edges at `(±1/2, 0)`: half its angle has the tangent 1/2.
fn prism(dispersion: Dispersion) -> Snapshot {
    let at = |x, y| [[x, y, -1.0f32], [x, y, 1.0]];
    let corners = [at(0.0, 1.0), at(-0.5, 0.0), at(0.5, 0.0)].concat();
    let sides = [[0, 2, 1], [1, 2, 3], [0, 1, 5], [0, 5, 4], [2, 4, 5], [2, 5, 3], [0, 4, 2], [1, 3, 5]];
    let mesh = TriangleMesh::new(corners, sides.to_vec()).expect("a prism");
    scene(Settings::default(), |world| {
        world.spawn((Mesh::new(mesh), Transmission(Rgb::ONE), Refraction { index: 1.5 }, dispersion));
    })
}

#[test]
fn a_prism_turns_each_wavelength_by_its_own_least_angle() {
    let dispersion = Dispersion { abbe: 25.0, wavelengths: 6 };
    let snapshot = prism(dispersion);
    let half = math::atan2(0.5, 1.0);
    // How far each wavelength is turned that comes to the middle of the left face at an angle to its normal.
    let turned = |incidence: f64| {
        let steep = incidence - half;
        let (sine, cosine) = math::sin_cos_degrees(steep.to_degrees());
        let toward = DVec3::new(cosine, sine, 0.0);
        let eye = DVec3::new(-0.25, 0.5, 0.1) - 3.0 * toward;
        let view = View { eye, right: DVec3::ZERO, up: DVec3::ZERO, forward: toward };
        let (mut exits, mut counts) = (Exits::default(), snell::Counts::default());
        let inside = Interior::around(eye, &snapshot.geometry, &snapshot.materials);
        let snapshot = Snapshot { view, inside, ..snapshot.clone() };
        let _ = pixel_observed(&snapshot, 0, 0, &Methods::default(), &mut counts, &mut exits);
        exits.0.into_iter().map(move |(wavelength, out)| {
            let along = toward.dot(out);
            (wavelength, math::atan2(toward.cross(out).length(), along))
        })
    };
    // Cauchy's formula through the index at the line d and Abbe's number.
    let square = |line: f64| 1.0 / (line * line);
    let b = 0.5 / (dispersion.abbe * (square(486.13) - square(656.27)));
    let index = |wavelength: f64| 1.5 + b * (square(wavelength) - square(587.56));
    let wavelengths: Vec<f64> = turned(half + 0.2).map(|(wavelength, _)| wavelength).collect();
    assert_eq!(wavelengths.len(), 6);
    let mut least = vec![];
    for wavelength in wavelengths {
        let through = |incidence| turned(incidence).find(|(other, _)| *other == wavelength).expect("the wavelength").1;
        // Fraunhofer: the way through is symmetric, and the turn `2·asin(n·sin(A/2)) − A`.
        let sine = index(wavelength) * 0.5 / 1.25f64.sqrt();
        let incidence = core::f64::consts::FRAC_PI_2 - math::acos(sine);
        let turn = through(incidence);
        let expected = 2.0 * incidence - 2.0 * half;
        assert!((turn - expected).abs() < 1e-12, "{wavelength} nm: {turn}, expected {expected}");
        for beside in [-0.02, 0.02] {
            assert!(through(incidence + beside) > turn, "{wavelength} nm: less at {beside}");
        }
        least.push((wavelength, turn));
    }
    least.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert!(least.is_sorted_by(|a, b| a.1 > b.1), "short waves are turned most: {least:?}");
}

#[test]
fn what_fills_a_body_is_its_own_while_each_triangle_lets_its_own_share_through() {
    // The prism, its two slanted sides of different materials, seen along x at half its height: half a unit of it.
    let at = |x, y| [[x, y, -1.0f32], [x, y, 1.0]];
    let corners = [at(0.0, 1.0), at(-0.5, 0.0), at(0.5, 0.0)].concat();
    let sides = [[0, 2, 1], [1, 2, 3], [0, 1, 5], [0, 5, 4], [2, 4, 5], [2, 5, 3], [0, 4, 2], [1, 3, 5]];
    let slots = vec![0, 0, 1, 1, 0, 0, 0, 0];
    let none = (vec![], vec![]);
    let mesh = TriangleMesh::with_attributes(corners, sides.to_vec(), none, (vec![], vec![]), slots).expect("a prism");
    let (left_side, right_side) = (Rgb::new(0.5, 1.0, 0.25), Rgb::new(0.5, 0.25, 1.0));
    let snapshot = scene(Settings::default(), |world| {
        let materials = [left_side, right_side].map(|share| world.spawn(Transmission(share)).id());
        world.spawn((Mesh::new(mesh), MaterialSlots(materials.to_vec()), Absorption(TINT)));
    });
    let found = seen(&snapshot, DVec3::new(-5.0, 0.5, 0.1), DVec3::X);
    assert_near(found, left_side * right_side * left(TINT, 0.5));
}

#[test]
fn without_refraction_light_goes_straight() {
    let behind = |refraction| {
        let snapshot = scene(Settings { refraction, ..Settings::default() }, |world| {
            world.spawn(ball(1.0, 1.5));
            world.spawn(AmbientLight::default());
            let spot = (Sphere { radius: 0.01 }, Transform::at(DVec3::new(0.5, 0.0, -5.0)));
            world.spawn((spot, Color(Rgb::X), Ambient(Rgb::ONE)));
        });
        seen(&snapshot, DVec3::new(0.5, 0.0, 5.0), DVec3::NEG_Z)
    };
    assert_eq!(behind(false), Rgb::X);
    assert_eq!(behind(true), Rgb::ONE);
}
