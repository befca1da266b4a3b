//! Lights with area and cone through the whole renderer.

use snell::components::math;
use snell::prelude::*;
use snell::systems::render::{Key, pixel};

/// The light on a white ground under the origin of the picture, seen from above at a little slant.
fn on_the_ground(x: f64, build: impl FnOnce(&mut World)) -> f64 {
    let mut renderer = Renderer::new();
    *renderer.settings() = Settings { width: 1, height: 1, ..Settings::default() };
    let world = &mut renderer.world;
    world.spawn(Camera { position: DVec3::new(x, 0.1, 0.2), target: Some(DVec3::X * x), ..Camera::default() });
    world.spawn((Plane {}, Diffuse(Rgb::ONE)));
    build(world);
    let snapshot = renderer.snapshot().expect("a snapshot");
    pixel(&snapshot, 0, 0, &Methods::default(), &mut snell::Counts::default()).x
}

/// Puts one thing into a world.
fn put(bundle: impl Bundle) -> impl FnOnce(&mut World) {
    move |world| {
        world.spawn(bundle);
    }
}

fn disk(radius: f64) -> DiskLight {
    DiskLight { position: DVec3::Y * 2.0, radius, ..DiskLight::default() }
}

#[test]
fn a_disk_lights_the_point_below_it_by_its_closed_form() {
    for radius in [0.5, 1.0, 3.0] {
        let exact = DiskLight { error: 0.0, samples: 4096, ..disk(radius) };
        let slant = (4.0 + radius * radius).sqrt();
        // The mean over the disk of the cosine 2/√(4+ρ²).
        let even = 4.0 * (slant - 2.0) / (radius * radius);
        let found = on_the_ground(0.0, put(exact.clone()));
        assert!((found - even).abs() <= 1e-3 * even, "{radius}: {found}, expected {even}");
        let radiant = core::f64::consts::PI * radius * radius / (slant * slant);
        let found = on_the_ground(0.0, put(DiskLight { emission: Emission::Radiant, ..exact.clone() }));
        assert!((found - radiant).abs() <= 1e-3 * radiant, "{radius}: {found}, expected {radiant}");
    }
}

#[test]
fn a_disk_without_radius_is_a_point_and_from_behind_dark() {
    for x in [0.0, 0.7, 3.0] {
        let point = PointLight { position: DVec3::Y * 2.0, ..PointLight::default() };
        let expected = on_the_ground(x, put(point));
        assert_eq!(on_the_ground(x, put(disk(0.0))), expected);
        for direction in [DVec3::Y, DVec3::X] {
            let light = DiskLight { direction, position: DVec3::new(5.0, 2.0, 0.0), ..disk(1.0) };
            assert_eq!(on_the_ground(x, put(light)), 0.0);
        }
    }
}

#[test]
fn a_cone_lights_its_inside() {
    for (x, angle, share) in [(0.0, 30.0, 1.0), (1.0, 30.0, 1.0), (1.3, 30.0, 0.0)] {
        let light = ConeLight { position: DVec3::Y * 2.0, angle, ..ConeLight::default() };
        let cosine = 2.0 / (4.0f64 + x * x).sqrt();
        let found = on_the_ground(x, put(light.clone()));
        assert!((found - share * cosine).abs() < 1e-12, "{x}: {found}");
        let falling = on_the_ground(x, put(ConeLight { fall_off: FallOff::Linear, ..light }));
        let expected = cosine * (1.0 - math::atan2(x, 2.0).to_degrees() / angle).max(0.0);
        assert!((falling - expected).abs() < 1e-12, "{x}: {falling}");
    }
}

#[test]
fn a_light_without_shadows_shines_through_things() {
    for (shadows, expected) in [(true, 0.0), (false, 1.0)] {
        let found = on_the_ground(0.0, |world| {
            world.spawn((Sphere { radius: 0.3 }, Transform::at(DVec3::Y)));
            world.spawn(PointLight { position: DVec3::Y * 2.0, shadows, ..PointLight::default() });
        });
        assert!((found - expected).abs() < 1e-12, "{found}");
    }
}

#[test]
fn the_shadow_of_a_ball_darkens_as_it_lets_less_light_through() {
    let behind = |strength: f64| {
        on_the_ground(0.0, |world| {
            world.spawn((Sphere { radius: 0.3 }, Transform::at(DVec3::Y), Transmission(Rgb::splat(strength))));
            world.spawn(disk(0.4));
        })
    };
    let light: Vec<f64> = (0..=8).map(|i| behind(1.0 - f64::from(i) / 8.0)).collect();
    assert!(light.is_sorted_by(|a, b| a > b), "{light:?}");
}

/// By how much the error of a mean, over many keys, falls from 16 samples to 64 times as many.
fn fall(error: impl Fn(Key, u32) -> f64) -> f64 {
    let rms = |n| {
        let squares = (0..400).map(|i| error(Key::of_pixel(i, 1, 0), n)).map(|error| error * error);
        (squares.sum::<f64>() / 400.0).sqrt()
    };
    rms(1024) / rms(16)
}

fn mean(key: Key, n: u32, f: impl Fn(DVec2) -> f64) -> f64 {
    (0..n).map(|i| f(key.sample(i))).sum::<f64>() / f64::from(n)
}

#[test]
fn the_error_falls_as_fast_as_stratification_lets_it() {
    // A slanted edge through the middle of the square halves it.
    let edge = fall(|key, n| {
        let (sin, cos) = math::sin_cos_degrees(360.0 * key.child(9).sample(0).x);
        mean(key, n, |p| f64::from((p.x - 0.5) * cos + (p.y - 0.5) * sin > 0.0)) - 0.5
    });
    let slope = |exponent| math::pow(64.0, exponent);
    assert!(edge > slope(-0.83) && edge < slope(-0.67), "{edge}");
    let smooth = fall(|key, n| mean(key, n, |p| p.x * p.x * p.y) - 1.0 / 6.0);
    assert!(smooth < slope(-1.0), "{smooth}");
}

#[test]
fn the_error_asked_for_is_kept_in_the_penumbra() {
    let at = |x: f64, error: f64, samples: u32| {
        on_the_ground(x, |world| {
            let size = DVec3::new(8.0, 0.01, 8.0);
            world.spawn((Cuboid { size }, Transform::at(DVec3::new(4.0, 1.0, 0.0))));
            world.spawn(DiskLight { error, samples, ..disk(0.5) });
        })
    };
    for error in [0.02, 0.01] {
        let places = (0..100).map(|i| -0.48 + 0.96 * f64::from(i) / 99.0);
        let squares: Vec<f64> = places.map(|x| at(x, error, 1 << 16) - at(x, 0.0, 4096)).map(|d| d * d).collect();
        let rms = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
        assert!(rms <= 2.0 * error, "asked for {error}, found {rms}");
    }
}
