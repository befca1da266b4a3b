//! The limits of what may be asked: placements that mirror, flatten and shear, cameras that look nowhere, trees of rays
//! that would never end, cones without an edge.

use glam::DMat3;
use snell::components::{primitive::Cost, space::Ray};
use snell::prelude::*;
use snell::systems::{accelerate::Geometry, render::pixel};
use snell::{Counts, components::light::Lamp};
use std::sync::Arc;

fn built(fill: impl FnOnce(&mut World)) -> Arc<Snapshot> {
    let mut renderer = Renderer::new();
    *renderer.settings() = Settings { width: 16, height: 12, ..Settings::default() };
    renderer.world.spawn(Camera { position: DVec3::Z * 9.0, ..Camera::default() });
    fill(&mut renderer.world);
    renderer.snapshot().expect("a snapshot")
}

fn drift(matrix: DMat3) -> f64 {
    let rest = matrix.transpose() * matrix - DMat3::IDENTITY;
    rest.to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max)
}

/// F57. A million edits of a turn; the same as one product after another drifts.
#[test]
fn a_million_turns_leave_a_rotation_a_rotation() {
    let mut placement = Transform::new([Step::RotateY(0.0), Step::Translate(DVec3::X)]);
    let one = Step::RotateY(1.0).matrix().matrix3;
    let mut product = DMat3::IDENTITY;
    let mut camera = Camera { target: Some(DVec3::NEG_Z), ..Camera::default() };
    for _ in 0..1_000_000 {
        if let Step::RotateY(degrees) = &mut placement.0[0] {
            *degrees += 1.0;
        }
        product = one * product;
        camera.step(Step::RotateY(1.0));
    }
    assert!(drift(placement.matrix().matrix3) <= 1e-15);
    // 1e6 degrees are 280 from the last full turn.
    assert_eq!(placement.matrix().matrix3, Step::RotateY(1_000_000.0).matrix().matrix3);
    let (sine, cosine) = snell::components::math::sin_cos_degrees(280.0);
    assert!((placement.matrix().matrix3.x_axis - DVec3::new(cosine, 0.0, -sine)).length() <= 1e-15);
    assert!(drift(product) > 1e-12, "products drift by {}", drift(product));
    // A camera that is stepped keeps what it is: its axes are made anew each time, its target as far away as it was.
    let forward = camera.view().normalize();
    let (right, up) = snell::components::camera::screen_axes(forward, camera.up, camera.roll);
    assert!(drift(DMat3::from_cols(right, up, -forward)) <= 1e-15);
    assert!((camera.view().length() - 1.0).abs() <= 1e-9, "{}", camera.view().length());
}

fn hits(geometry: &Geometry, ray: &Ray) -> Option<(f64, DVec3, DVec3)> {
    let met = geometry.closest(ray, f64::INFINITY, &Methods::default(), &mut Cost::default())?;
    Some((met.t, met.surface.normal, met.surface.point))
}

/// F58. Oracle: the same triangles placed by hand, their normals by the sign of the determinant.
#[test]
fn what_is_mirrored_stretched_and_sheared_is_what_its_points_become() {
    let corners =
        [DVec3::new(1.0, 0.0, 0.0), DVec3::new(-0.5, 0.9, 0.1), DVec3::new(-0.4, -0.8, 0.2), DVec3::new(0.1, 0.1, 1.3)];
    let faces = [[0, 1, 3], [1, 2, 3], [2, 0, 3], [0, 2, 1]];
    let steps = |steps: &[Step]| Transform::new(steps.iter().copied());
    // A shear is two turns about a stretch.
    let sheared = steps(&[Step::RotateZ(33.0), Step::Scale(DVec3::new(1.8, 0.6, 1.0)), Step::RotateZ(-20.0)]);
    for placement in [
        steps(&[Step::Scale(DVec3::new(-1.0, 1.0, 1.0))]),
        steps(&[Step::Scale(DVec3::new(-1.0, 2.0, -3.0)), Step::RotateX(40.0)]),
        steps(&[Step::Scale(DVec3::new(1e-6, 1.0, 1e6))]),
        sheared,
    ] {
        let matrix = placement.matrix();
        let side = matrix.matrix3.determinant().signum();
        let placed = built(|world| {
            for face in faces {
                let [a, b, c] = face.map(|i| corners[i]);
                world.spawn((Triangle { a, b, c, ..Triangle::default() }, placement.clone()));
            }
        });
        let by_hand = built(|world| {
            for face in faces {
                let [a, b, c] = face.map(|i| matrix.transform_point3(corners[i]));
                let (b, c) = if side < 0.0 { (c, b) } else { (b, c) };
                world.spawn(Triangle { a, b, c, ..Triangle::default() });
            }
        });
        let mut met = 0;
        for i in 0..500 {
            let share = |n: usize| ((i * n + 7) % 101) as f64 / 101.0;
            // From without toward a point within: in the space of the thing, whatever becomes of that.
            let inside = (corners[0] * share(3) + corners[1] * share(5) + corners[2] * share(11) + corners[3])
                / (share(3) + share(5) + share(11) + 1.0);
            let from = DVec3::new(share(17) - 0.5, share(29) - 0.5, share(41) - 0.5) * 20.0;
            let (origin, target) = (matrix.transform_point3(from), matrix.transform_point3(inside));
            let ray = Ray { origin, direction: target - origin };
            let (a, b) = (hits(&placed.geometry, &ray), hits(&by_hand.geometry, &ray));
            assert_eq!(a.is_some(), b.is_some(), "{placement:?}: {ray:?}");
            let (Some((t, normal, point)), Some((u, expected, at))) = (a, b) else { continue };
            met += 1;
            assert!((t - u).abs() <= 1e-10 * u, "{placement:?}: {t}, expected {u}");
            assert!((normal - expected).length() <= 1e-10, "{placement:?}: {normal}, expected {expected}");
            assert!((point - at).abs().max_element() <= 1e-10 * at.abs().max_element(), "{placement:?}");
            // A distance in the thing's own space counts in the world: nothing is made unit there.
            assert!((ray.at(t) - point).length() <= 1e-9 * (ray.origin.length() + point.length()));
        }
        assert!(met > 450, "{met} hits");
    }
    // What is flattened has no inside, and no inverse: it is left out and told.
    for flat in [DVec3::new(1.0, 1.0, 0.0), DVec3::ZERO, DVec3::new(f64::NAN, 1.0, 1.0)] {
        let snapshot = built(|world| {
            world.spawn((Sphere { radius: 1.0 }, Transform::new([Step::Scale(flat)])));
            world.spawn((Sphere { radius: 1.0 }, Transform::at(DVec3::X * 3.0)));
        });
        let ray = |x: f64| Ray { origin: DVec3::new(x, 0.0, 9.0), direction: DVec3::NEG_Z };
        assert_eq!(hits(&snapshot.geometry, &ray(0.0)), None, "{flat}");
        assert!(hits(&snapshot.geometry, &ray(3.0)).is_some(), "{flat}: what stands beside is gone");
    }
}

/// F59. A camera that looks somewhere gives a picture of numbers, whatever is up and wherever it stands.
#[test]
fn no_camera_that_looks_somewhere_gives_pixels_that_are_no_numbers() {
    let target = Some(DVec3::ZERO);
    let cameras = [
        ("up along the view", Camera { position: DVec3::Y * 5.0, target, up: DVec3::Y, ..Camera::default() }),
        ("up against the view", Camera { position: DVec3::Y * 5.0, target, up: DVec3::NEG_Y, ..Camera::default() }),
        ("no up", Camera { position: DVec3::Z * 5.0, target, up: DVec3::ZERO, ..Camera::default() }),
        ("a hair of a view", Camera { position: DVec3::Z * 1e-150, target, ..Camera::default() }),
        ("far away", Camera { position: DVec3::Z * 1e150, target, ..Camera::default() }),
        ("nearly no angle", Camera { position: DVec3::Z * 5.0, target, field_of_view: 1e-9, ..Camera::default() }),
        ("nearly all", Camera { position: DVec3::Z * 5.0, target, field_of_view: 179.9, ..Camera::default() }),
        ("inside a ball", Camera { position: DVec3::Z * 0.5, target, ..Camera::default() }),
        ("on a ball", Camera { position: DVec3::Z, target, ..Camera::default() }),
    ];
    for (name, camera) in cameras {
        let mut renderer = Renderer::new();
        let background = Rgb::new(1.0, 0.0, 1.0);
        *renderer.settings() = Settings { width: 16, height: 12, background, ..Settings::default() };
        let world = &mut renderer.world;
        world.spawn(camera);
        world.spawn(PointLight { position: DVec3::new(3.0, 5.0, 4.0), ..PointLight::default() });
        world.spawn((Sphere { radius: 1.0 }, Dielectric { index: 1.5 }, Diffuse(Rgb::splat(0.5))));
        world.spawn((Plane {}, Transform::at(DVec3::NEG_Y), Mirror(Rgb::splat(0.5))));
        let frame = render(&renderer.snapshot().expect(name), &Options::default());
        assert_eq!(frame.counts.not_finite, 0, "{name}");
        assert!(frame.picture.pixels.iter().flatten().all(|x| x.is_finite()), "{name}");
        // A ray that is none meets nothing: something must be seen.
        assert!(frame.picture.pixels.iter().any(|pixel| *pixel != [1.0, 0.0, 1.0]), "{name}: nothing is seen");
    }
    // What is no camera is refused: where it stands is where it looks, an angle of nothing or of all, no picture at all.
    let scene = |camera: &str, settings: &str| {
        let text = format!("Scene(version: 1, settings: ({settings}), entities: {{\"camera\": [Camera({camera})]}})");
        let mut renderer = Renderer::new();
        renderer.load_text(&text, "scene.ron").is_ok() && renderer.snapshot().is_ok()
    };
    assert!(scene("position: (0, 0, 5), target: (0, 0, 0)", "width: 4, height: 4"), "the scene as it should be");
    for camera in [
        "position: (0, 0, 5), target: (0, 0, 5)",
        "position: (0, 0, 5), target: (0, 0, 0), field_of_view: 0",
        "position: (0, 0, 5), target: (0, 0, 0), field_of_view: 180",
        "position: (0, 0, 5), direction: (0, 0, 0)",
    ] {
        assert!(!scene(camera, "width: 4, height: 4"), "{camera}");
    }
    for settings in ["width: 0, height: 4", "width: 4, height: 0"] {
        assert!(!scene("position: (0, 0, 5), target: (0, 0, 0)", settings), "{settings}");
    }
}

/// Rays of one pixel that looks out from within spheres about its eye, which reflect and let through everything.
fn rays(depth: u32, cutoff: f64, reflected: f64) -> u64 {
    let mut renderer = Renderer::new();
    *renderer.settings() = Settings { width: 1, height: 1, depth, cutoff, ..Settings::default() };
    let world = &mut renderer.world;
    world.spawn(Camera::default());
    let shell = (Diffuse(Rgb::ZERO), Mirror(Rgb::splat(reflected)), Transmission(Rgb::splat(1.0 - reflected)));
    for n in 0..=depth + 1 {
        world.spawn((Sphere { radius: f64::from(n + 1) }, shell));
    }
    let mut counts = Counts::default();
    let _ = pixel(&renderer.snapshot().expect("a snapshot"), 0, 0, &Methods::default(), &mut counts);
    counts.rays()
}

/// F66. Oracle: a tree of two branches at every surface has 2^(depth + 1) − 1 rays; cut where a branch weighs less than
/// 1/255, it has as many as there are ways to a weight above that.
#[test]
fn trees_of_rays_have_as_many_rays_as_they_must() {
    for (depth, all) in [(5, 63), (10, 2047), (15, 65_535)] {
        assert_eq!(rays(depth, 0.0, 0.5), all, "depth {depth}");
    }
    let cut = 1.0 / 255.0;
    for (depth, halves, glass) in [(5, 63, 21), (10, 255, 66), (15, 255, 136), (20, 255, 231)] {
        assert_eq!(rays(depth, cut, 0.5), halves, "halves, depth {depth}");
        assert_eq!(rays(depth, cut, 0.04), glass, "glass, depth {depth}");
    }
}

/// F71. Cones of no and of every angle, points on the axis, behind and in the lamp itself.
#[test]
fn cones_are_finite_everywhere_and_continuous_where_they_fall_off() {
    let at = |cone: &ConeLight, point: DVec3| {
        let light = cone.illuminate(point, DVec2::ZERO)?;
        assert!(light.intensity.is_finite() && light.to_light.is_finite() && light.distance.is_finite());
        Some(light.intensity.x)
    };
    for angle in [1e-12, 1e-3, 45.0, 89.999, 90.0, 90.001, 135.0, 180.0] {
        for fall_off in [FallOff::None, FallOff::Linear] {
            let cone = ConeLight { angle, fall_off, ..ConeLight::default() };
            assert_eq!(at(&cone, DVec3::ZERO), None, "at the lamp there is no direction to it");
            assert_eq!(at(&cone, DVec3::NEG_Y * 3.0), Some(1.0), "{angle}: on the axis");
            assert_eq!(at(&cone, DVec3::NEG_Y * 1e-300), Some(1.0), "{angle}: a hair from it");
            let behind = at(&cone, DVec3::Y * 3.0);
            assert_eq!(behind.is_some(), angle >= 180.0, "{angle}: behind");
            // From the axis to behind, step by step: never brighter, and with a fall-off never by more than the step.
            let mut last = 1.0;
            for i in 0..=18_000 {
                let degrees = f64::from(i) * 0.01;
                let (sin, cos) = snell::components::math::sin_cos_degrees(degrees);
                let light = at(&cone, DVec3::new(2.0 * sin, -2.0 * cos, 0.0)).unwrap_or(0.0);
                assert!((0.0..=last).contains(&light), "{angle}: {light} at {degrees} after {last}");
                if fall_off == FallOff::Linear {
                    assert!(last - light <= 0.01 / angle + 1e-12 || angle < 0.01, "{angle}: a step at {degrees}");
                }
                last = light;
            }
        }
    }
}
