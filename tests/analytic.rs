//! Closed forms through the whole renderer: every expected value is worked out by hand, beside the test.

mod support {
    pub(crate) mod gallery;
    pub(crate) mod random;
    pub(crate) mod scene;
}

use snell::components::math;
use snell::prelude::*;
use snell::systems::{render::pixel, snapshot::View};
use support::gallery::gallery;

const SKY: Rgb = Rgb::new(0.3, 0.5, 0.7);

/// One pixel, nothing cut off.
fn settings() -> Settings {
    Settings { width: 1, height: 1, background: SKY, cutoff: 0.0, ..Settings::default() }
}

fn scene_with(settings: Settings, build: impl FnOnce(&mut World)) -> Snapshot {
    let mut renderer = Renderer::new();
    *renderer.settings() = settings;
    renderer.world.spawn(Camera::default());
    build(&mut renderer.world);
    (*renderer.snapshot().expect("a snapshot")).clone()
}

fn scene(build: impl FnOnce(&mut World)) -> Snapshot {
    scene_with(settings(), build)
}

/// Puts one thing into a world.
fn put(bundle: impl Bundle) -> impl FnOnce(&mut World) {
    move |world| {
        world.spawn(bundle);
    }
}

/// The light that comes to a point from a direction.
fn seen(snapshot: &Snapshot, eye: DVec3, toward: DVec3) -> Rgb {
    let view = View { eye, right: DVec3::ZERO, up: DVec3::ZERO, forward: toward };
    pixel(&Snapshot { view, ..snapshot.clone() }, 0, 0, &Methods::default(), &mut snell::Counts::default())
}

#[track_caller]
fn assert_near(found: Rgb, expected: Rgb) {
    let size = expected.abs().max_element().max(1.0);
    assert!((found - expected).abs().max_element() <= 1e-12 * size, "{found}, expected {expected}");
}

/// A surface that shines with its own colour and does nothing else; needs an ambient light of 1.
fn glow(color: Rgb) -> (Color, Ambient) {
    (Color(color), Ambient(Rgb::ONE))
}

fn lamp(position: DVec3, intensity: f64) -> PointLight {
    PointLight { position, intensity: Rgb::splat(intensity), ..PointLight::default() }
}

/// The least `x` between two at which a condition that holds at the first has ended.
fn edge(mut holds: f64, mut ended: f64, condition: impl Fn(f64) -> bool) -> f64 {
    assert!(condition(holds) && !condition(ended), "nothing to find between {holds} and {ended}");
    for _ in 0..60 {
        let middle = 0.5 * (holds + ended);
        if condition(middle) { holds = middle } else { ended = middle }
    }
    ended
}

/// Sine and cosine of some angles, from Pythagorean triples.
const ANGLES: [(f64, f64); 6] = [
    (0.0, 1.0),
    (0.6, 0.8),
    (0.8, 0.6),
    (5.0 / 13.0, 12.0 / 13.0),
    (12.0 / 13.0, 5.0 / 13.0),
    (40.0 / 41.0, 9.0 / 41.0),
];

// Local terms.

#[test]
fn lambert_on_a_plane_is_the_cosine_whatever_the_distance() {
    let (color, kd) = (Rgb::new(0.9, 0.5, 0.1), Rgb::new(0.5, 0.6, 0.7));
    for (sin, cos) in ANGLES {
        for distance in [0.5, 1.0, 1e4] {
            let position = DVec3::new(sin, cos, 0.0) * distance;
            let snapshot = scene(|world| {
                world.spawn((Plane {}, Color(color), Diffuse(kd)));
                world.spawn(PointLight { position, intensity: Rgb::new(0.8, 0.9, 1.0), ..PointLight::default() });
            });
            let found = seen(&snapshot, DVec3::new(-3.0, 2.0, 1.0), DVec3::new(3.0, -2.0, -1.0));
            assert_near(found, color * kd * Rgb::new(0.8, 0.9, 1.0) * cos);
        }
    }
}

#[test]
fn lambert_on_a_sphere_is_the_cosine_to_the_outward_normal() {
    let center = DVec3::new(1.0, -2.0, 3.0);
    let normal = DVec3::new(2.0, 3.0, 6.0) / 7.0;
    for to_light in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(-6.0, 2.0, 3.0) / 7.0, DVec3::new(3.0, -6.0, 2.0) / 7.0] {
        let snapshot = scene(|world| {
            world.spawn((Sphere { radius: 2.0 }, Transform::at(center), Diffuse(Rgb::splat(0.8))));
            world.spawn(DirectionalLight {
                direction: to_light * -5.0,
                intensity: Rgb::ONE,
                ..DirectionalLight::default()
            });
        });
        let found = seen(&snapshot, center + normal * 9.0, -normal);
        assert_near(found, Rgb::splat(0.8 * normal.dot(to_light).max(0.0)));
    }
}

#[test]
fn the_highlight_is_the_power_of_the_cosine_to_the_mirrored_light() {
    // Light from `L` is mirrored to `R`; the eye is elsewhere. The power is multiplied out.
    let power = |x: f64, p: u32| (0..p).fold(1.0, |product, _| product * x);
    let to_light = DVec3::new(-0.6, 0.8, 0.0);
    let mirrored = DVec3::new(0.6, 0.8, 0.0);
    let to_eye = DVec3::new(2.0, 6.0, 3.0) / 7.0;
    let cos = mirrored.dot(to_eye);
    for (exponent, expected) in [
        (1.0, cos),
        (2.0, cos * cos),
        (12.5, power(cos, 12) * cos.sqrt()),
        (50.0, power(cos, 50)),
        (200.0, power(cos, 200)),
    ] {
        let snapshot = scene(|world| {
            let highlight = Highlight { strength: Rgb::new(0.5, 0.6, 0.7), exponent };
            world.spawn((Plane {}, Color(Rgb::X), Diffuse(Rgb::splat(0.25)), highlight));
            world.spawn(lamp(to_light * 4.0, 2.0));
        });
        let found = seen(&snapshot, to_eye * 3.0, -to_eye);
        let matte = Rgb::X * (0.25 * 2.0 * 0.8);
        assert_near(found, matte + Rgb::new(0.5, 0.6, 0.7) * (2.0 * expected));
    }
}

#[test]
fn terms_with_a_negative_cosine_are_dropped() {
    let flat = Highlight { strength: Rgb::ONE, exponent: 0.0 };
    let shiny = |light: DVec3| {
        scene(|world| {
            world.spawn((Plane {}, Diffuse(Rgb::splat(0.5)), flat));
            world.spawn(lamp(light, 1.0));
        })
    };
    let eye = DVec3::new(-4.0, 3.0, 0.0);
    // From below there is nothing, not even a highlight of exponent 0, which is 1 wherever it is not dropped.
    assert_eq!(seen(&shiny(DVec3::new(4.0, -3.0, 0.0)), eye, -eye), Rgb::ZERO);
    // From above, but mirrored away from the viewer: the diffuse term alone. `R·S` = −0.48·… < 0.
    assert_near(seen(&shiny(DVec3::new(-40.0, 9.0, 0.0)), eye, -eye), Rgb::splat(0.5 * 9.0 / 41.0));
    assert_near(seen(&shiny(DVec3::new(4.0, 3.0, 0.0)), eye, -eye), Rgb::splat(0.5 * 0.6 + 1.0));
}

#[test]
fn surfaces_are_lit_on_the_side_that_is_seen() {
    let snapshot = scene(|world| {
        world.spawn((Plane {}, Diffuse(Rgb::ONE)));
        world.spawn(lamp(DVec3::Y, 0.25));
        world.spawn(lamp(DVec3::NEG_Y, 0.5));
    });
    assert_near(seen(&snapshot, DVec3::Y * 2.0, DVec3::NEG_Y), Rgb::splat(0.25));
    assert_near(seen(&snapshot, DVec3::Y * -2.0, DVec3::Y), Rgb::splat(0.5));
}

#[test]
fn ambient_lights_add_up_and_reach_everything() {
    let snapshot = scene(|world| {
        world.spawn((Plane {}, Color(Rgb::new(0.5, 0.6, 0.7)), Ambient(Rgb::new(0.2, 0.4, 0.6)), Diffuse(Rgb::ONE)));
        world.spawn(AmbientLight { intensity: Rgb::new(0.1, 0.2, 0.3) });
        world.spawn(AmbientLight { intensity: Rgb::new(0.3, 0.3, 0.3) });
    });
    let expected = Rgb::new(0.5 * 0.2 * 0.4, 0.6 * 0.4 * 0.5, 0.7 * 0.6 * 0.6);
    assert_near(seen(&snapshot, DVec3::Y, DVec3::NEG_Y), expected);
}

#[test]
fn the_light_of_several_lamps_is_the_sum() {
    let to_light = [DVec3::new(0.6, 0.8, 0.0), DVec3::new(0.0, 0.6, 0.8), DVec3::new(0.0, 5.0, -12.0) / 13.0];
    let snapshot = scene(|world| {
        world.spawn((Plane {}, Diffuse(Rgb::ONE)));
        world.spawn(lamp(to_light[0] * 3.0, 0.5));
        world.spawn(lamp(to_light[1] * 7.0, 0.25));
        world.spawn(DirectionalLight {
            direction: -to_light[2],
            intensity: Rgb::new(0.1, 0.2, 0.4),
            ..DirectionalLight::default()
        });
    });
    let expected = Rgb::splat(0.5 * 0.8 + 0.25 * 0.6) + Rgb::new(0.1, 0.2, 0.4) * (5.0 / 13.0);
    assert_near(seen(&snapshot, DVec3::new(0.1, 2.0, 0.0), DVec3::new(-0.1, -2.0, 0.0)), expected);
}

#[test]
fn what_has_no_material_is_matte_white() {
    let snapshot = scene(|world| {
        world.spawn(Plane {});
        world.spawn(lamp(DVec3::Y * 3.0, 0.5));
        world.spawn(AmbientLight::default());
    });
    assert_near(seen(&snapshot, DVec3::Y * 5.0, DVec3::NEG_Y), Rgb::splat(0.1 + 0.9 * 0.5));
}

#[test]
fn where_nothing_is_met_the_background_is_seen() {
    let snapshot = scene(|world| {
        world.spawn(Sphere { radius: 1.0 });
    });
    assert_eq!(seen(&snapshot, DVec3::Z * 5.0, DVec3::Z), SKY);
    assert_eq!(seen(&snapshot, DVec3::Z * 5.0, DVec3::new(1.0, 0.0, -4.0)), SKY);
}

// Shadows.

/// A lit ground of brightness 0.8 under a lamp ten above the origin, and things.
fn ground_and(build: impl FnOnce(&mut World)) -> Snapshot {
    scene(|world| {
        world.spawn((Plane {}, Diffuse(Rgb::splat(0.8))));
        world.spawn(lamp(DVec3::Y * 10.0, 1.0));
        build(world);
    })
}

/// What is seen of the ground's point beneath the lamp from a little aside.
fn beneath_the_lamp(snapshot: &Snapshot) -> Rgb {
    seen(snapshot, DVec3::new(0.0, 0.1, 5.0), DVec3::new(0.0, -0.1, -5.0))
}

#[test]
fn things_beyond_the_lamp_or_behind_the_surface_cast_no_shadow() {
    let ball = |height: f64| (Sphere { radius: 1.0 }, Transform::at(DVec3::Y * height));
    for (height, light) in [(5.0, 0.0), (8.9, 0.0), (11.1, 0.8), (1000.0, 0.8), (-1.5, 0.8)] {
        let snapshot = ground_and(put(ball(height)));
        assert_near(beneath_the_lamp(&snapshot), Rgb::splat(light));
    }
    // A light without a place has nothing beyond it.
    for (height, light) in [(1e6, 0.0), (-1.5, 1.0)] {
        let snapshot = scene(|world| {
            world.spawn((Plane {}, Diffuse(Rgb::ONE)));
            world.spawn(DirectionalLight::default());
            world.spawn(ball(height));
        });
        assert_near(beneath_the_lamp(&snapshot), Rgb::splat(light));
    }
}

#[test]
fn a_lamp_that_stands_on_a_surface_is_not_hidden_by_it() {
    // Slanted, so that the lamp is on the surface up to rounding only; opaque, or clear and then met over and over.
    let slant = Transform::new([Step::RotateX(197.0), Step::Translate(DVec3::new(0.3, 4.7, 0.1))]);
    let on_the_plane = slant.matrix().transform_point3(DVec3::new(0.37, 0.0, 0.11));
    let center = DVec3::new(0.1, 5.0, 0.2);
    for clear in [false, true] {
        for i in 0..200 {
            let aside = f64::from(i) / 100.0 - 1.0;
            let outward = DVec3::new(0.3 * aside, -1.0, 0.2 * aside * aside).normalize();
            for (sphere, position) in [(false, on_the_plane), (true, center + outward)] {
                let snapshot = scene(|world| {
                    world.spawn((Plane {}, Diffuse(Rgb::ONE)));
                    world.spawn(lamp(position, 1.0));
                    let mut holder = match sphere {
                        true => world.spawn((Sphere { radius: 1.0 }, Transform::at(center))),
                        false => world.spawn((Plane {}, slant.clone())),
                    };
                    if clear {
                        holder.insert(Transmission(Rgb::ONE));
                    }
                });
                let point = DVec3::new(aside, 0.0, 0.3);
                let to_light = position - point;
                let found = seen(&snapshot, point + DVec3::new(0.1, 0.5, 0.0), DVec3::new(-0.1, -0.5, 0.0));
                assert_near(found, Rgb::splat(to_light.y / to_light.length()));
            }
        }
    }
}

#[test]
fn shadows_can_be_switched_off() {
    let snapshot = ground_and(put((Sphere { radius: 1.0 }, Transform::at(DVec3::Y * 5.0))));
    assert_eq!(beneath_the_lamp(&snapshot), Rgb::ZERO);
    let settings = Settings { shadows: false, ..settings() };
    assert_near(beneath_the_lamp(&Snapshot { settings, ..snapshot }), Rgb::splat(0.8));
}

#[test]
fn the_shadow_of_a_box_ends_where_the_line_past_its_edge_meets_the_ground() {
    // Similar triangles: an edge at x = 1, y = 2 under a lamp at y = 10 reaches 1·10 / (10 − 2).
    let snapshot = ground_and(|world| {
        world.spawn((Cuboid { size: DVec3::splat(2.0) }, Transform::at(DVec3::Y)));
    });
    let dark = |x: f64| seen(&snapshot, DVec3::new(x, 0.5, 0.25), DVec3::NEG_Y) == Rgb::ZERO;
    assert!((edge(1.01, 3.0, dark) - 1.25).abs() < 1e-12);
}

#[test]
fn the_shadow_of_a_sphere_ends_where_the_tangent_meets_the_ground() {
    // The tangent from 10 above the ground to a sphere of radius 1 at height 3: sin α = 1/7, and 10·tan α is the reach.
    let snapshot = ground_and(put((Sphere { radius: 1.0 }, Transform::at(DVec3::Y * 3.0))));
    let dark = |x: f64| seen(&snapshot, DVec3::new(x, 0.5, 0.0), DVec3::NEG_Y) == Rgb::ZERO;
    assert!((edge(0.0, 3.0, dark) - 10.0 / 48.0f64.sqrt()).abs() < 1e-12);
}

#[test]
fn the_shadow_of_a_triangle_in_the_sun_is_its_projection() {
    // An edge at x = 1, y = 6; the sun goes down 4 for every 3 across.
    let snapshot = scene(|world| {
        world.spawn((Plane {}, Diffuse(Rgb::ONE)));
        world.spawn(DirectionalLight { direction: DVec3::new(3.0, -4.0, 0.0), ..DirectionalLight::default() });
        let [a, b, c] = [DVec3::new(-9.0, 6.0, 0.0), DVec3::new(1.0, 6.0, -9.0), DVec3::new(1.0, 6.0, 9.0)];
        world.spawn(Triangle { a, b, c, ..Triangle::default() });
    });
    let dark = |x: f64| seen(&snapshot, DVec3::new(x, 0.5, 0.0), DVec3::NEG_Y) == Rgb::ZERO;
    assert!((edge(5.0, 6.0, dark) - 5.5).abs() < 1e-12);
}

#[test]
fn transparent_things_weaken_the_light_by_the_product_of_their_transmissions() {
    let sheet = |height: f64| (Plane {}, Transform::at(DVec3::Y * height));
    let (red, dim) = (Rgb::new(0.9, 0.3, 0.2), Rgb::splat(0.5));
    let both = ground_and(|world| {
        world.spawn((sheet(3.0), Transmission(red)));
        world.spawn((sheet(5.0), Transmission(dim)));
        world.spawn((sheet(12.0), Transmission(Rgb::splat(0.1))));
    });
    assert_near(beneath_the_lamp(&both), red * dim * 0.8);
    // α lets 1 − α through, glass 1 − F at each of its two faces: upright, ((n − 1)/(n + 1))² = 0.04.
    let veil = ground_and(put((sheet(3.0), Opacity { alpha: 0.3 }, Diffuse(Rgb::ONE))));
    assert_near(beneath_the_lamp(&veil), Rgb::splat(0.8 * 0.7));
    let pane = ground_and(|world| {
        world.spawn((Cuboid { size: DVec3::splat(2.0) }, Transform::at(DVec3::Y * 4.0), Dielectric { index: 1.5 }));
    });
    assert_near(beneath_the_lamp(&pane), Rgb::splat(0.8 * 0.96 * 0.96));
    let blocked = ground_and(|world| {
        world.spawn((sheet(3.0), Transmission(red)));
        world.spawn((sheet(4.0), Mirror(Rgb::ONE)));
    });
    assert_eq!(beneath_the_lamp(&blocked), Rgb::ZERO);
}

#[test]
fn the_less_transparent_a_sphere_the_darker_its_shadow() {
    for transparency in [1.0, 0.8, 0.6, 0.4, 0.2, 0.0] {
        let snapshot = ground_and(|world| {
            let kt = Transmission(Rgb::splat(transparency));
            world.spawn((Sphere { radius: 1.0 }, Transform::at(DVec3::Y * 3.0), kt));
        });
        assert_near(beneath_the_lamp(&snapshot), Rgb::splat(0.8 * transparency * transparency));
    }
}

// Transparency.

#[test]
fn alpha_blends_a_surface_with_what_lies_behind() {
    let colors = [Rgb::new(0.9, 0.1, 0.2), Rgb::new(0.2, 0.8, 0.1), Rgb::new(0.0, 0.3, 1.0)];
    for alpha in [0.0, 0.25, 0.7, 1.0] {
        let snapshot = scene(|world| {
            world.spawn(AmbientLight::default());
            for (i, color) in colors.into_iter().enumerate() {
                let at = Transform::at(DVec3::Y * -(i as f64));
                world.spawn((Plane {}, at, glow(color), Opacity { alpha }));
            }
        });
        let expected = colors.into_iter().rev().fold(SKY, |behind, color| color * alpha + behind * (1.0 - alpha));
        assert_near(seen(&snapshot, DVec3::Y, DVec3::new(1.0, -1.0, 0.5)), expected);
    }
}

#[test]
fn simple_transparency_goes_straight_on_and_multiplies() {
    let kt = Rgb::new(0.9, 0.8, 0.7);
    let snapshot = scene(|world| {
        for i in 0..5 {
            world.spawn((Plane {}, Transform::at(DVec3::Y * -f64::from(i)), Transmission(kt)));
        }
    });
    assert_near(seen(&snapshot, DVec3::Y, DVec3::new(3.0, -1.0, 2.0)), kt * kt * kt * kt * kt * SKY);
}

/// A ground that is white where x < 0 and black elsewhere (for |x| < 1000 and −1000 < z < 0).
fn split_ground(world: &mut World) {
    world.spawn(AmbientLight::default());
    let squares = Checker { even: Rgb::ZERO, odd: Rgb::ONE, frequency: 1e-3, ..Checker::default() };
    world.spawn((Plane {}, squares, Ambient(Rgb::ONE)));
}

#[test]
fn a_plate_shifts_a_ray_by_its_thickness_and_the_angles() {
    let thickness = 2.0;
    for (sin, cos) in ANGLES {
        for index in [1.2f64, 1.5, 2.4] {
            let snapshot = scene(|world| {
                split_ground(world);
                let plate = Cuboid { size: DVec3::new(900.0, thickness, 900.0) };
                let clear = (Transmission(Rgb::ONE), Refraction { index });
                world.spawn((plate, Transform::at(DVec3::Y * 4.0), clear));
            });
            let white = |x: f64| seen(&snapshot, DVec3::new(x, 10.0, -0.5), DVec3::new(sin, -cos, 0.0)).x > 0.5;
            let found = edge(-200.0, 200.0, white);
            // The parallel shift across the ray, and along the ground.
            let shift = thickness * sin * (1.0 - cos / (index * index - sin * sin).sqrt());
            let expected = -10.0 * sin / cos + shift / cos;
            assert!((found - expected).abs() < 1e-10, "{sin}, {index}: {found}, expected {expected}");
        }
    }
}

#[test]
fn a_body_with_the_index_of_its_surroundings_is_not_there() {
    for fresnel in [false, true] {
        let picture = |with_body: bool| {
            let mut renderer = Renderer::new();
            *renderer.settings() = Settings { width: 40, height: 30, ..settings() };
            let world = &mut renderer.world;
            world.spawn(Camera { position: DVec3::new(0.0, 3.0, 6.0), target: Some(DVec3::ZERO), ..Camera::default() });
            world.spawn((Plane {}, Checker::default(), Diffuse(Rgb::splat(0.9))));
            world.spawn(lamp(DVec3::new(1.0, 9.0, 3.0), 1.0));
            if with_body {
                let body = (Cuboid { size: DVec3::new(3.0, 0.5, 3.0) }, Transform::at(DVec3::Y));
                match fresnel {
                    true => world.spawn((body, Dielectric { index: 1.0 })),
                    false => world.spawn((body, Transmission(Rgb::ONE), Refraction { index: 1.0 })),
                };
            }
            render(&renderer.snapshot().expect("a snapshot"), &Options::default()).picture
        };
        assert_eq!(picture(true).hash(), picture(false).hash(), "fresnel: {fresnel}");
    }
}

#[test]
fn beyond_the_critical_angle_nothing_passes() {
    // From within: sin γ = n·sin α reaches 1 at sin α = 1/n.
    let index = 1.5;
    for (sin, passes) in [(1.0 / index - 1e-9, true), (1.0 / index + 1e-9, false), (0.1, true), (0.999, false)] {
        let toward = DVec3::new(sin, (1.0f64 - sin * sin).sqrt(), 0.0);
        let (eye, kt) = (DVec3::Y * -1.0, Rgb::splat(0.5));
        let bent = scene(put((Plane {}, Transmission(kt), Refraction { index })));
        assert_near(seen(&bent, eye, toward), if passes { kt * SKY } else { Rgb::ZERO });
        // With Fresnel's split all of it is mirrored, down to the glow below.
        let split = scene(|world| {
            world.spawn(AmbientLight::default());
            world.spawn((Plane {}, Dielectric { index }));
            world.spawn((Plane {}, Transform::at(DVec3::Y * -2.0), glow(Rgb::X)));
        });
        let found = seen(&split, eye, toward);
        if passes {
            assert!(found.y > 0.0, "{sin}: {found}");
        } else {
            assert_near(found, Rgb::X);
        }
    }
}

/// Fresnel's reflectance by the angles themselves: half of sin²(i − t)/sin²(i + t) + tan²(i − t)/tan²(i + t).
fn reflectance(sin_in: f64, cos_in: f64, eta: f64) -> f64 {
    if sin_in == 0.0 {
        let r = (eta - 1.0) / (eta + 1.0);
        return r * r;
    }
    let sin_out = eta * sin_in;
    let cos_out = (1.0 - sin_out * sin_out).sqrt();
    let (sin_less, sin_more) = (sin_in * cos_out - cos_in * sin_out, sin_in * cos_out + cos_in * sin_out);
    let (cos_less, cos_more) = (cos_in * cos_out + sin_in * sin_out, cos_in * cos_out - sin_in * sin_out);
    let (s, t) = (sin_less / sin_more, cos_more / cos_less);
    0.5 * (s * s + s * s * t * t)
}

#[test]
fn fresnel_splits_light_between_the_mirror_image_and_what_lies_behind() {
    // A surface between a glow above and the sky below, seen from either side.
    for (sin, cos) in ANGLES {
        for index in [1.1, 1.5, 2.4, 9999.0] {
            let snapshot = scene(|world| {
                world.spawn(AmbientLight::default());
                world.spawn((Plane {}, Dielectric { index }));
                world.spawn((Plane {}, Transform::at(DVec3::Y * 2.0), glow(Rgb::X)));
            });
            let outer = reflectance(sin, cos, 1.0 / index);
            let found = seen(&snapshot, DVec3::Y, DVec3::new(sin, -cos, 0.0));
            assert_near(found, Rgb::X * outer + SKY * (1.0 - outer));
            if index * sin < 1.0 {
                let inner = reflectance(sin, cos, index);
                let found = seen(&snapshot, DVec3::NEG_Y, DVec3::new(sin, cos, 0.0));
                assert_near(found, SKY * inner + Rgb::X * (1.0 - inner));
            }
        }
    }
}

#[test]
fn a_body_too_dense_to_let_light_through_is_a_mirror() {
    let snapshot = scene(|world| {
        world.spawn((Plane {}, Dielectric { index: 10_001.0 }, Diffuse(Rgb::splat(0.25)), Ambient(Rgb::splat(0.15))));
        // Black, below: what got through would be lost.
        world.spawn((Plane {}, Transform::at(DVec3::NEG_Y)));
    });
    // Of the light, 1 − kd − ka = 0.6 is left for the mirror; no lamp shines.
    assert_near(seen(&snapshot, DVec3::Y, DVec3::new(0.6, -0.8, 0.0)), SKY * 0.6);
}

#[test]
fn what_the_local_terms_leave_is_shared_by_fresnel() {
    let (ka, kd, ks) = (0.1, 0.2, 0.3);
    let snapshot = scene(|world| {
        let highlight = Highlight { strength: Rgb::splat(ks), exponent: 10.0 };
        world.spawn((Plane {}, Dielectric { index: 1.5 }, Ambient(Rgb::splat(ka)), Diffuse(Rgb::splat(kd)), highlight));
    });
    // Sky above and below: both shares together.
    assert_near(seen(&snapshot, DVec3::Y, DVec3::new(0.6, -0.8, 0.0)), SKY * (1.0 - ka - kd - ks));
}

#[test]
fn glass_in_even_light_is_invisible_so_no_energy_is_lost() {
    // Every branch ends in light of 1, those beyond the depth included: R + T = 1 at every surface.
    let even = Settings { background: Rgb::ONE, depth: 9, ..settings() };
    let snapshot = scene_with(even, |world| {
        world.spawn((Sphere { radius: 1.0 }, Dielectric { index: 1.5 }));
        let leaning =
            Transform::new([Step::RotateX(30.0), Step::RotateZ(20.0), Step::Translate(DVec3::new(0.5, 0.0, -2.0))]);
        world.spawn((Cuboid::default(), leaning, Dielectric { index: 2.0 }));
    });
    for i in 0..40 {
        let toward = DVec3::new(f64::from(i) * 0.006, 0.03, -1.0);
        assert_near(seen(&snapshot, DVec3::Z * 5.0, toward), Rgb::ONE);
    }
}

#[test]
fn along_its_axis_a_glass_sphere_lets_one_less_f_through_at_each_surface() {
    let f = 0.04;
    for (spheres, depth, expected) in [
        (1, 2, (1.0 - f) * (1.0 - f)),
        // Mirrored to and fro once more within.
        (1, 4, (1.0 - f) * (1.0 - f) * (1.0 + f * f)),
        (1, 6, (1.0 - f) * (1.0 - f) * (1.0 + f * f + f * f * f * f)),
        (2, 4, (1.0 - f) * (1.0 - f) * (1.0 - f) * (1.0 - f)),
    ] {
        let black = Settings { background: Rgb::ZERO, depth, ..settings() };
        let snapshot = scene_with(black, |world| {
            world.spawn(AmbientLight::default());
            for i in 0..spheres {
                let at = Transform::at(DVec3::Y * (2.0 + 3.0 * f64::from(i)));
                world.spawn((Sphere { radius: 1.0 }, at, Dielectric { index: 1.5 }));
            }
            world.spawn((Plane {}, glow(SKY)));
        });
        assert_near(seen(&snapshot, DVec3::Y * 10.0, DVec3::NEG_Y), SKY * expected);
    }
}

// Mirrors.

#[test]
fn between_parallel_mirrors_the_light_is_a_geometric_series_that_ends_in_grey() {
    let (kr, own) = (Rgb::new(0.9, 0.5, 0.8), Rgb::new(0.05, 0.2, 0.1));
    let grey = Rgb::splat((SKY.x + SKY.y + SKY.z) / 3.0);
    for depth in [0, 1, 2, 7, 100, 10_000] {
        let snapshot = scene_with(Settings { depth, ..settings() }, |world| {
            world.spawn(AmbientLight::default());
            let mirror = world.spawn((Color(own), Ambient(Rgb::ONE), Mirror(kr))).id();
            world.spawn((Plane {}, MadeOf(mirror)));
            world.spawn((Plane {}, Transform::at(DVec3::Y * 2.0), MadeOf(mirror)));
        });
        let (mut expected, mut weight) = (Rgb::ZERO, Rgb::ONE);
        for _ in 0..=depth {
            expected += weight * own;
            weight *= kr;
        }
        assert_near(seen(&snapshot, DVec3::Y, DVec3::NEG_Y), expected + weight * grey);
    }
}

#[test]
fn a_mirror_shows_what_lies_in_the_mirrored_direction() {
    let snapshot = scene(|world| {
        world.spawn(AmbientLight::default());
        world.spawn((Plane {}, Mirror(Rgb::splat(0.5))));
        let at = Transform::at(DVec3::new(6.0, 6.0, 0.0));
        world.spawn((Sphere { radius: 1.0 }, at, glow(Rgb::X)));
    });
    // From (−3, 3) to the origin and on to (6, 6): the tangent from the origin leaves the sphere's centre by asin(1/√72).
    assert_near(seen(&snapshot, DVec3::new(-3.0, 3.0, 0.0), DVec3::new(1.0, -1.0, 0.0)), Rgb::X * 0.5);
    let hit = |slope: f64| {
        let toward = DVec3::new(1.0, -1.0, slope);
        seen(&snapshot, -toward * 3.0, toward).y == 0.0
    };
    // Aside by `z` over √2 the tangent of that angle: 1/√71.
    assert!((edge(0.0, 1.0, hit) - (2.0f64 / 71.0).sqrt()).abs() < 1e-12);
}

#[test]
fn branches_lighter_than_the_cutoff_are_not_followed() {
    let mirrors = |cutoff: f64| {
        scene_with(Settings { depth: 50, cutoff, background: Rgb::ZERO, ..settings() }, |world| {
            world.spawn(AmbientLight::default());
            let mirror = world.spawn((Color(Rgb::ONE), Ambient(Rgb::ONE), Mirror(Rgb::splat(0.5)))).id();
            world.spawn((Plane {}, MadeOf(mirror)));
            world.spawn((Plane {}, Transform::at(DVec3::Y * 2.0), MadeOf(mirror)));
        })
    };
    // 1 + ½ + ¼ + ⅛: weights of exactly the cut-off are still followed, those below are lost.
    assert_near(seen(&mirrors(0.125), DVec3::Y, DVec3::NEG_Y), Rgb::splat(1.875));
    assert_near(seen(&mirrors(0.126), DVec3::Y, DVec3::NEG_Y), Rgb::splat(1.75));
}

// Camera.

fn view_of(camera: Camera, placement: Transform) -> View {
    let mut renderer = Renderer::new();
    renderer.world.spawn((camera, placement));
    renderer.snapshot().expect("a snapshot").view
}

#[test]
fn rays_pass_through_the_centres_of_the_pixels() {
    let (eye, target) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, -2.0, 3.0));
    let camera = Camera { position: eye, target: Some(target), screen_distance: Some(2.0), ..Camera::default() };
    let view = view_of(camera, Transform::default());
    // Forward (3, −4, 0)/5, right +z, up (4, 3, 0)/5; the screen is one high at distance two.
    let (forward, right, up) = (DVec3::new(0.6, -0.8, 0.0), DVec3::Z, DVec3::new(0.8, 0.6, 0.0));
    for (x, y) in [(0, 0), (7, 3), (15, 9), (8, 5)] {
        let ray = view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5, 16, 10);
        let across = (f64::from(x) + 0.5 - 8.0) / 10.0;
        let high = (5.0 - f64::from(y) - 0.5) / 10.0;
        let expected = forward * 2.0 + right * across + up * high;
        assert_eq!(ray.origin, eye);
        assert!((ray.direction - expected.normalize()).length() < 1e-15, "{x}, {y}");
    }
}

#[track_caller]
fn assert_same_view(a: View, b: View) {
    for (a, b) in [(a.eye, b.eye), (a.right, b.right), (a.up, b.up), (a.forward, b.forward)] {
        assert!((a - b).length() < 1e-14 * (1.0 + b.length()), "{a}, expected {b}");
    }
}

#[test]
fn the_angle_of_view_and_the_distance_of_the_screen_say_the_same() {
    for (angle, distance) in [(90.0, 0.5), (60.0, 0.75f64.sqrt()), (45.0, (1.0 + 2.0f64.sqrt()) / 2.0)] {
        let by_angle = Camera { field_of_view: angle, ..Camera::default() };
        let by_distance = Camera { screen_distance: Some(distance), ..Camera::default() };
        assert_same_view(view_of(by_angle, Transform::default()), view_of(by_distance, Transform::default()));
    }
}

#[test]
fn up_need_not_be_upright_and_a_roll_turns_the_picture() {
    let camera = |up: DVec3, roll: f64| {
        view_of(Camera { up, roll, screen_distance: Some(1.0), ..Camera::default() }, Transform::default())
    };
    let upright = camera(DVec3::Y, 0.0);
    assert_same_view(camera(DVec3::new(0.0, 2.0, 1.9), 0.0), upright);
    // Turned to lean right by the angle of 3-4-5.
    let leaning = camera(DVec3::new(0.6, 0.8, 0.0), 0.0);
    assert!((leaning.right - DVec3::new(0.8, -0.6, 0.0)).length() < 1e-15);
    assert_same_view(camera(DVec3::Y, math::acos(0.8).to_degrees()), leaning);
    assert_same_view(camera(DVec3::Y, 360.0), upright);
}

#[test]
fn a_camera_is_placed_like_anything_else() {
    let steps = [Step::RotateY(90.0), Step::Translate(DVec3::new(5.0, 6.0, 7.0))];
    let placed = view_of(Camera { position: DVec3::Z, ..Camera::default() }, Transform::new(steps));
    // Turned a quarter left −z becomes −x, and z becomes x.
    let same = Camera { position: DVec3::new(6.0, 6.0, 7.0), direction: Some(DVec3::NEG_X), ..Camera::default() };
    assert_same_view(placed, view_of(same, Transform::default()));
}

#[test]
fn four_rays_a_pixel_are_the_mean_of_a_picture_of_twice_the_size() {
    // The rays at ±¼ of a pixel are those through the centres of the pixels of half the size.
    for scene in gallery() {
        let snapshot = scene.build(0).0.snapshot().expect("a snapshot");
        let Settings { width, height, .. } = snapshot.settings;
        let shot = |antialias, times| Snapshot {
            settings: Settings { antialias, width: width * times, height: height * times, ..snapshot.settings.clone() },
            ..(*snapshot).clone()
        };
        let (four, fine) = (shot(Antialias::Four, 1), shot(Antialias::Off, 2));
        for (x, y) in (0..height).step_by(3).flat_map(|y| (0..width).step_by(3).map(move |x| (x, y))) {
            let one = |snapshot, x, y| pixel(snapshot, x, y, &Methods::default(), &mut snell::Counts::default());
            let quarter = |dx, dy| one(&fine, 2 * x + dx, 2 * y + dy);
            let mean = (quarter(0, 0) + quarter(0, 1) + quarter(1, 0) + quarter(1, 1)) / 4.0;
            assert_eq!(one(&four, x, y), mean, "{}: {x}, {y}", scene.name);
        }
    }
}

// Textures.

/// Four by two texels, each of its own colour, the first row on top.
fn texel(column: usize, row_from_top: usize) -> [f32; 3] {
    [column as f32 * 0.25, row_from_top as f32 * 0.5, 0.125]
}

fn painted() -> (ImageTexture, Ambient) {
    let texels = (0..8).map(|i| texel(i % 4, i / 4)).collect();
    (Image::new(4, 2, texels).expect("an image").into(), Ambient(Rgb::ONE))
}

/// Checks that the ray from an eye to a point finds the texel that holds the texture coordinates.
#[track_caller]
fn assert_texel(snapshot: &Snapshot, eye: DVec3, point: DVec3, u: f64, v: f64) {
    let (column, row) = ((u * 4.0).rem_euclid(4.0) as usize, (v * 2.0).rem_euclid(2.0) as usize);
    let expected = Rgb::from_array(texel(column, 1 - row).map(f64::from));
    assert_eq!(seen(snapshot, eye, point - eye), expected, "u {u}, v {v}");
}

/// Texture coordinates in the middle of each texel and near its edges.
fn coordinates() -> impl Iterator<Item = (f64, f64)> {
    let along = |count: u32| (0..count * 8).map(move |i| (f64::from(i) + 0.5) / f64::from(count * 8));
    along(4).flat_map(move |u| along(2).map(move |v| (u, v)))
}

#[test]
fn an_image_runs_once_around_a_sphere_from_minus_x_through_plus_z() {
    let snapshot = scene(|world| {
        world.spawn(AmbientLight::default());
        world.spawn((Sphere { radius: 2.0 }, Transform::at(DVec3::ONE), painted()));
    });
    for (u, v) in coordinates() {
        let (sin, cos) = math::sin_cos_degrees(360.0 * u);
        let (sin_up, cos_up) = math::sin_cos_degrees(180.0 * v);
        let outward = DVec3::new(-cos * sin_up, -cos_up, sin * sin_up);
        assert_texel(&snapshot, DVec3::ONE + outward * 5.0, DVec3::ONE, u, v);
    }
}

#[test]
fn a_turned_sphere_takes_its_image_along() {
    let snapshot = scene(|world| {
        world.spawn(AmbientLight::default());
        world.spawn((Sphere { radius: 2.0 }, Transform::new([Step::RotateZ(90.0)]), painted()));
        world.spawn((
            Sphere { radius: 2.0 },
            Transform::new([
                Step::Scale(DVec3::new(1.0, 2.0, 3.0)),
                Step::RotateZ(90.0),
                Step::Translate(DVec3::X * 50.0),
            ]),
            painted(),
        ));
    });
    for (u, v) in coordinates() {
        let (sin, cos) = math::sin_cos_degrees(360.0 * u);
        let (sin_up, cos_up) = math::sin_cos_degrees(180.0 * v);
        let local = DVec3::new(-cos * sin_up, -cos_up, sin * sin_up);
        let outward = DVec3::new(-local.y, local.x, local.z);
        assert_texel(&snapshot, outward * 5.0, DVec3::ZERO, u, v);
        let point = DVec3::X * 50.0 + DVec3::new(-2.0 * local.y, local.x, 3.0 * local.z) * 2.0;
        assert_texel(&snapshot, DVec3::X * 50.0 + (point - DVec3::X * 50.0) * 3.0, point, u, v);
    }
}

#[test]
fn an_image_repeats_over_a_plane_with_x_to_the_right_and_minus_z_up() {
    let snapshot = scene(|world| {
        world.spawn(AmbientLight::default());
        world.spawn((Plane {}, painted()));
    });
    for (u, v) in coordinates() {
        for (du, dv) in [(0.0, 0.0), (-3.0, 5.0), (1.0, -1.0)] {
            let point = DVec3::new(u + du, 0.0, -v - dv);
            assert_texel(&snapshot, point + DVec3::new(0.1, 1.0, -0.3), point, u, v);
        }
    }
}

#[test]
fn an_image_is_mapped_to_a_triangle_by_its_weights() {
    let [a, b, c] = [DVec3::new(1.0, 2.0, 3.0), DVec3::new(5.0, 2.0, 1.0), DVec3::new(2.0, 6.0, 2.0)];
    let uvs = vec![DVec2::new(0.2, 0.1), DVec2::new(0.9, 0.3), DVec2::new(0.4, 1.7)];
    for uvs in [vec![], uvs] {
        let snapshot = scene(|world| {
            world.spawn(AmbientLight::default());
            world.spawn((Triangle { a, b, c, uvs: uvs.clone(), ..Triangle::default() }, painted()));
        });
        for (v, w) in coordinates().filter(|(v, w)| v + w < 1.0) {
            let blend = |[a, b, c]: [DVec2; 3]| a * (1.0 - v - w) + b * v + c * w;
            let uv = blend(uvs.clone().try_into().unwrap_or([DVec2::ZERO, DVec2::X, DVec2::Y]));
            let point = a * (1.0 - v - w) + b * v + c * w;
            assert_texel(&snapshot, point + DVec3::new(1.0, -2.0, 7.0), point, uv.x, uv.y);
        }
    }
}

#[test]
fn every_face_of_a_box_carries_the_image_upright() {
    let size = DVec3::new(2.0, 4.0, 6.0);
    let snapshot = scene(|world| {
        world.spawn(AmbientLight::default());
        world.spawn((Cuboid { size }, painted()));
    });
    // Seen from outside: the sides with +y up, the top with −z up, the bottom with +z up.
    for (outward, up) in [
        (DVec3::X, DVec3::Y),
        (DVec3::NEG_X, DVec3::Y),
        (DVec3::Z, DVec3::Y),
        (DVec3::NEG_Z, DVec3::Y),
        (DVec3::Y, DVec3::NEG_Z),
        (DVec3::NEG_Y, DVec3::Z),
    ] {
        let right = up.cross(outward);
        for (u, v) in coordinates() {
            let point = (outward + right * (2.0 * u - 1.0) + up * (2.0 * v - 1.0)) * 0.5 * size;
            assert_texel(&snapshot, point + outward * 3.0, point, u, v);
        }
    }
}

#[test]
fn a_texture_multiplies_the_colour() {
    let snapshot = scene(|world| {
        world.spawn(AmbientLight::default());
        let checker = Checker { even: Rgb::new(0.5, 1.0, 0.25), odd: Rgb::ZERO, ..Checker::default() };
        world.spawn((Plane {}, checker, Color(Rgb::new(0.5, 0.25, 1.0)), Ambient(Rgb::ONE)));
    });
    assert_eq!(seen(&snapshot, DVec3::new(0.5, 1.0, -0.5), DVec3::NEG_Y), Rgb::splat(0.25));
}

// Placement.

/// The picture of a triangle and a lamp, each put into the world by a function of its own.
fn picture_of(build: impl FnOnce(&mut World)) -> String {
    let mut renderer = Renderer::new();
    *renderer.settings() = Settings { width: 40, height: 30, ..settings() };
    renderer.world.spawn(Camera { position: DVec3::new(0.0, 3.0, 20.0), ..Camera::default() });
    build(&mut renderer.world);
    let snapshot = renderer.snapshot().expect("a snapshot");
    assert!(snapshot.left_out.is_empty());
    let picture = render(&snapshot, &Options::default()).picture;
    assert!(picture.pixels.iter().any(|pixel| *pixel != SKY.as_vec3().to_array()), "nothing to see");
    picture.hash()
}

const CORNERS: [DVec3; 3] = [DVec3::new(0.0, 0.0, 1.0), DVec3::new(3.0, 1.0, 0.0), DVec3::new(1.0, 2.0, -1.0)];

fn triangle([a, b, c]: [DVec3; 3]) -> Triangle {
    Triangle { a, b, c, ..Triangle::default() }
}

fn sun() -> DirectionalLight {
    DirectionalLight { direction: DVec3::new(-1.0, -2.0, -3.0), ..DirectionalLight::default() }
}

#[test]
fn steps_are_applied_in_the_written_order() {
    // Whole numbers and quarter turns are exact: the pictures are the same to the last bit.
    let steps =
        [Step::Scale(DVec3::new(2.0, 1.0, -1.0)), Step::RotateZ(90.0), Step::Translate(DVec3::new(1.0, -2.0, 3.0))];
    let by_hand = CORNERS.map(|p| DVec3::new(1.0 - p.y, -2.0 + 2.0 * p.x, 3.0 - p.z));
    let placed = |steps: &[Step]| {
        let transform = Transform::new(steps.iter().copied());
        picture_of(|world| {
            world.spawn((triangle(CORNERS), transform));
            world.spawn(sun());
        })
    };
    // Mirrored once, so the corners run the other way round.
    let [a, b, c] = by_hand;
    let expected = picture_of(|world| {
        world.spawn(triangle([a, c, b]));
        world.spawn(sun());
    });
    assert_eq!(placed(&steps), expected);
    let [first, second, third] = steps;
    assert_ne!(placed(&[second, first, third]), expected);
    assert_ne!(placed(&[first, third, second]), expected);
}

#[test]
fn placements_of_parents_come_after_those_of_their_children() {
    let (inner, outer) = (Step::RotateX(90.0), Step::Translate(DVec3::new(1.0, 2.0, 3.0)));
    let nested = picture_of(|world| {
        let root = world.spawn(Transform::new([outer])).id();
        // A parent without a placement passes on what it is given.
        let middle = world.spawn(ChildOf(root)).id();
        world.spawn((triangle(CORNERS), Transform::new([inner]), ChildOf(middle)));
        world.spawn((sun(), ChildOf(middle)));
    });
    let flat = picture_of(|world| {
        world.spawn((triangle(CORNERS), Transform::new([inner, outer])));
        world.spawn(sun());
    });
    assert_eq!(nested, flat);
}

#[test]
fn lights_are_placed_like_anything_else() {
    fn lit(light: impl Bundle) -> String {
        picture_of(|world| {
            world.spawn(triangle(CORNERS));
            world.spawn(light);
        })
    }
    let quarter = || Transform::new([Step::RotateY(90.0), Step::Translate(DVec3::Z * 2.0)]);
    // Turned a quarter left, (x, y, z) becomes (z, y, −x).
    assert_eq!(lit((lamp(DVec3::new(-6.0, 5.0, 4.0), 0.9), quarter())), lit(lamp(DVec3::new(4.0, 5.0, 8.0), 0.9)),);
    let beam = |direction| DirectionalLight { direction, ..DirectionalLight::default() };
    assert_eq!(lit((beam(DVec3::new(6.0, -5.0, -4.0)), quarter())), lit(beam(DVec3::new(-4.0, -5.0, -6.0))),);
}

#[test]
fn a_box_is_what_its_placement_makes_of_it() {
    // A sheared box is a parallelepiped: scale and turns, seen along the closed form of its faces.
    let size = DVec3::new(2.0, 2.0, 2.0);
    let shear = [Step::RotateZ(45.0), Step::Scale(DVec3::new(2.0, 1.0, 1.0))];
    let snapshot = scene(|world| {
        world.spawn(AmbientLight::default());
        world.spawn((Cuboid { size }, Transform::new(shear), glow(Rgb::X)));
    });
    // Turned by 45° its corners are √2 from the axis; stretched, it is the rhombus |x|/2 + |y| ≤ √2.
    for y in [-1.0, 0.0, 0.3, 1.2] {
        let inside = |x: f64| seen(&snapshot, DVec3::new(x, y, 9.0), DVec3::NEG_Z).y == 0.0;
        let expected = 2.0 * (2.0f64.sqrt() - f64::abs(y));
        assert!((edge(0.0, 5.0, inside) - expected).abs() < 1e-12, "{y}");
    }
}

#[test]
fn an_ellipsoid_has_its_outline_and_its_normals() {
    let snapshot = scene(|world| {
        let stretched = Transform::new([Step::Scale(DVec3::new(3.0, 1.0, 1.0)), Step::Translate(DVec3::Y)]);
        world.spawn((Sphere { radius: 1.0 }, stretched, Diffuse(Rgb::ONE)));
        world.spawn(DirectionalLight::default());
    });
    let inside = |x: f64| seen(&snapshot, DVec3::new(x, 1.5, 9.0), DVec3::NEG_Z) != SKY;
    // x²/9 + y² = 1 at y = ½.
    assert!((edge(0.0, 5.0, inside) - 3.0 * 0.75f64.sqrt()).abs() < 1e-12);
    // At x = 3·0.6, y = 0.8 the normal is (0.6/3, 0.8), and the light comes straight down.
    let found = seen(&snapshot, DVec3::new(1.8, 9.0, 0.0), DVec3::NEG_Y);
    assert_near(found, Rgb::splat(0.8 / (0.04f64 + 0.64).sqrt()));
}

#[test]
fn a_normal_that_is_turned_away_from_the_ray_bends_as_the_true_surface_does() {
    // Straight on glass whose interpolated normal faces away, as at the silhouette of a smoothed mesh: 4 % of the sky
    // behind the viewer, 96 % of what lies behind.
    let normals = vec![DVec3::new(1.0, 0.0, -0.2).normalize(); 3];
    let [a, b, c] = [DVec3::new(-1.0, -1.0, 0.0), DVec3::new(3.0, -1.0, 0.0), DVec3::new(-1.0, 3.0, 0.0)];
    let glow_behind = Rgb::new(0.9, 0.1, 0.2);
    let glass = scene(|world| {
        world.spawn(AmbientLight::default());
        world.spawn((Triangle { a, b, c, normals, ..Triangle::default() }, Dielectric { index: 1.5 }));
        let facing = Transform::new([Step::RotateX(90.0), Step::Translate(DVec3::NEG_Z)]);
        world.spawn((Plane {}, facing, glow(glow_behind)));
    });
    assert_near(seen(&glass, DVec3::Z, DVec3::NEG_Z), SKY * 0.04 + glow_behind * 0.96);
}
