//! Rays in a pixel: the ways of placing them, against each other and against closed forms.

use snell::prelude::*;
use snell::systems::render::{Observer, pixel, pixel_observed};
use snell::{Counts, components::math};
use std::sync::Arc;

/// A picture of the unit square in the plane z = 0, all but parallel: its lower left corner is the origin.
fn of_the_wall(settings: Settings, build: impl FnOnce(&mut World)) -> Arc<Snapshot> {
    let mut renderer = Renderer::new();
    *renderer.settings() = settings;
    let world = &mut renderer.world;
    let position = DVec3::new(0.5, 0.5, 1e6);
    let camera = Camera { position, target: Some(position.with_z(0.0)), ..Camera::default() };
    world.spawn(Camera { screen_distance: Some(1e6), ..camera });
    world.spawn(AmbientLight::default());
    build(world);
    renderer.snapshot().expect("a snapshot")
}

fn square(size: u32, antialias: Antialias) -> Settings {
    Settings { width: size, height: size, antialias, ..Settings::default() }
}

/// A white strip that covers what lies within half a width of a line: `cos·x + sin·y = offset`.
fn strip(degrees: f64, offset: f64, width: f64) -> impl FnOnce(&mut World) {
    move |world: &mut World| {
        let (sin, cos) = math::sin_cos_degrees(degrees);
        let axis = Step::Rotate { axis: DVec3::Z, degrees };
        let place = Step::Translate(DVec3::new(cos, sin, 0.0) * offset);
        let size = DVec3::new(width, 10.0, 1e-3);
        world.spawn((Cuboid { size }, Transform([axis, place].into_iter().collect()), Ambient(Rgb::ONE)));
    }
}

/// Squares of which `count` stand in a row, in texture coordinates of the plane.
fn checkers(count: f64) -> impl FnOnce(&mut World) {
    move |world: &mut World| {
        let upright = Transform([Step::RotateX(90.0)].into_iter().collect());
        world.spawn((Plane {}, upright, Checker { frequency: count, ..Checker::default() }, Ambient(Rgb::ONE)));
    }
}

fn drawn(snapshot: &Snapshot) -> Frame {
    render(snapshot, &Options::default())
}

fn rms(frame: &Frame, exact: impl Fn(u32, u32) -> f64) -> f64 {
    let width = frame.picture.width;
    let pixels = frame.picture.pixels.iter().zip(0..);
    let squares = pixels.map(|(light, i)| f64::from(light[0]) - exact(i % width, i / width)).map(|off| off * off);
    (squares.sum::<f64>() / f64::from(width * frame.picture.height)).sqrt()
}

/// A scene of the gallery, small, with some settings changed.
fn gallery(name: &str, change: impl FnOnce(&mut Settings)) -> Arc<Snapshot> {
    let mut renderer = Renderer::new();
    renderer.load(format!("scenes/gallery/{name}.ron")).expect("a sound scene");
    let settings = &mut *renderer.settings();
    (settings.width, settings.height) = (60, 40);
    change(settings);
    renderer.snapshot().expect("a snapshot")
}

#[test]
fn grids_of_one_and_two_are_off_and_four() {
    for (antialias, grid) in [(Antialias::Off, 1), (Antialias::Four, 2)] {
        let plain = drawn(&gallery("behind-glass", |settings| settings.antialias = antialias));
        let grid = drawn(&gallery("behind-glass", |settings| {
            (settings.antialias, settings.grid) = (Antialias::Grid, grid);
        }));
        assert!(plain.picture == grid.picture && plain.counts == grid.counts, "{antialias:?}");
    }
}

#[test]
fn a_pixel_that_is_halved_is_a_function_of_its_place() {
    for (name, error) in [("behind-glass", 0.0), ("behind-glass", 0.05), ("soft-shadows", 0.0), ("soft-shadows", 0.2)] {
        let snapshot = gallery(name, |settings| {
            (settings.antialias, settings.error, settings.subdivisions) = (Antialias::Adaptive, error, 3);
        });
        let whole = drawn(&snapshot);
        assert!(whole.counts.refined > 100 && whole.counts.refined < 2400, "{name}: {:?}", whole.counts);
        for (threads, tile) in [(1, 64), (2, 7), (3, 1)] {
            let options = Options { threads: Some(threads), tile: Some(tile), ..Options::default() };
            assert!(render(&snapshot, &options).picture == whole.picture, "{name}: {threads} threads, tile {tile}");
        }
        let region = Region { x: 17, y: 9, width: 23, height: 20 };
        let part = render(&snapshot, &Options { region: Some(region), ..Options::default() }).picture;
        assert!(Some(part) == whole.picture.crop(region), "{name}");
        for (x, y) in [(0, 0), (30, 20), (31, 20), (30, 21), (59, 39)] {
            let alone = pixel(&snapshot, x, y, &Methods::default(), &mut Counts::default()).as_vec3().to_array();
            assert_eq!(whole.picture.pixel(x, y), Some(alone), "{name}: {x}, {y}");
        }
    }
}

/// The share of pixel (x, y) that lies left of the line `cos·x + sin·y = offset`, by many points.
fn covered(size: u32, degrees: f64, offset: f64, x: u32, y: u32) -> f64 {
    let (sin, cos) = math::sin_cos_degrees(degrees);
    let n = 200;
    let at = |i: u32, of: u32| (f64::from(of) + (f64::from(i) + 0.5) / f64::from(n)) / f64::from(size);
    let left = |i: u32| cos * at(i % n, x) + sin * (1.0 - at(i / n, y)) < offset;
    f64::from((0..n * n).filter(|i| left(*i)).count() as u32) / f64::from(n * n)
}

#[test]
fn halving_is_as_exact_as_the_grid_it_ends_at_for_a_part_of_the_rays() {
    let (mut grid, mut halved) = ((0.0, 0), (0.0, 0));
    for (degrees, offset) in [(20.0, 0.6), (67.0, 0.71), (3.0, 0.537), (48.0, 0.9)] {
        let edge = |antialias| {
            let settings = Settings { grid: 4, subdivisions: 2, ..square(32, antialias) };
            of_the_wall(settings, strip(degrees, offset - 5.0, 10.0))
        };
        for (antialias, (error, rays)) in [(Antialias::Grid, &mut grid), (Antialias::Adaptive, &mut halved)] {
            let frame = drawn(&edge(antialias));
            *error += rms(&frame, |x, y| covered(32, degrees, offset, x, y));
            *rays += frame.counts.primary;
        }
    }
    assert!(halved.0 <= 1.1 * grid.0 && halved.1 * 5 < grid.1, "grid {grid:?}, halved {halved:?}");
}

#[test]
fn edges_along_the_corners_of_pixels_are_exact() {
    // 16 by 16 squares of 2 by 2 pixels each: all edges run through corners, where the texture goes either way.
    let exact = |x: u32, y: u32| f64::from(1 - (x / 2 + (31 - y) / 2) % 2);
    let four = drawn(&of_the_wall(square(32, Antialias::Four), checkers(16.0)));
    assert_eq!(rms(&four, exact), 0.0, "the scene is not what it should be");
    let adaptive = Settings { subdivisions: 1, ..square(32, Antialias::Adaptive) };
    let halved = drawn(&of_the_wall(adaptive, checkers(16.0)));
    assert_eq!(rms(&halved, exact), 0.0);
    let within = Settings { error: 0.01, subdivisions: 6, ..square(32, Antialias::Adaptive) };
    // Here corners, which go either way, are taken off: what is left is within the error.
    assert!(rms(&drawn(&of_the_wall(within, checkers(16.0))), exact) < 0.005);
    // What that costs: less than six rays to a pixel in place of four.
    assert!(halved.counts.primary < 6 * 32 * 32, "{}", halved.counts.primary);
}

/// Whether the middle of a quarter stands for it, as it does if its corners are not alike; they are if all light is that
/// of corners, which come first or have a smaller share.
struct Last(bool);

impl Observer for Last {
    fn shared(&mut self, sample: u32, share: f64) {
        self.0 |= sample >= 4 && share == 0.25;
    }
}

#[test]
fn thin_lines_are_missed_as_often_as_geometry_says() {
    // Lines through one pixel at random angles and distances; the shares follow from the places of the rays alone.
    let missed = |antialias, grid: u32, width: f64, pixels: u32| {
        let mut random = 1u64;
        let mut next = || {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (random >> 11) as f64 / (1u64 << 53) as f64
        };
        // The pixel in the middle of a picture of 1 or 3 by 3: with or without others beside it.
        let middle = pixels / 2;
        let settings = Settings { grid, subdivisions: 1, ..square(pixels, antialias) };
        let upright = of_the_wall(settings, strip(0.0, 0.0, width));
        let (mut count, mut missed) = (0, 0);
        while count < 1000 {
            let (degrees, offset) = (180.0 * next(), (next() - 0.5) * core::f64::consts::SQRT_2);
            let (sin, cos) = math::sin_cos_degrees(degrees);
            if offset.abs() > 0.5 * (sin.abs() + cos.abs()) {
                continue;
            }
            count += 1;
            // The pixel is turned and shifted in place of the line.
            let mut snapshot = (*upright).clone();
            snapshot.view.eye = DVec3::new(offset, 0.0, 1e6);
            (snapshot.view.right, snapshot.view.up) = (DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0));
            let mut counts = Counts::default();
            let scale = f64::from(pixels);
            (snapshot.view.right, snapshot.view.up) = (snapshot.view.right * scale, snapshot.view.up * scale);
            let mut last = Last(false);
            let light = pixel_observed(&snapshot, middle, middle, &Methods::default(), &mut counts, &mut last);
            let seen = match (antialias, pixels) {
                (Antialias::Adaptive, 1) => counts.refined > 0,
                (Antialias::Adaptive, _) => last.0,
                _ => light != Rgb::ZERO,
            };
            missed += u32::from(!seen);
        }
        f64::from(missed) / f64::from(count)
    };
    for (width, four, corners, with_others, sixteen) in
        [(0.5, 0.110, 0.165, 0.052, 0.0), (0.25, 0.383, 0.501, 0.293, 0.056), (0.1, 0.712, 0.785, 0.724, 0.265)]
    {
        let found = [
            missed(Antialias::Four, 2, width, 1),
            missed(Antialias::Adaptive, 2, width, 1),
            missed(Antialias::Adaptive, 2, width, 3),
            missed(Antialias::Grid, 4, width, 1),
        ];
        let expected = [four, corners, with_others, sixteen];
        assert!(
            found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.05),
            "{width}: {found:?}, expected {expected:?}"
        );
    }
}
