//! Textures seen from far away, against the mean over many rays to each pixel.

use snell::components::{color::Encoding, math};
use snell::prelude::*;
use snell::systems::render::pixel;
use std::sync::Arc;

const WIDTH: u32 = 48;
const HEIGHT: u32 = 36;
/// Rays to a pixel each way, for the picture that others are measured by; odd, so that one goes through the middle.
const FINE: u32 = 17;

/// Count of scenes.
const SCENES: usize = 4;

/// A scene with a texture, before its mean colour so that edges of things do not count.
fn scene(number: usize, background: Rgb, texture: impl Bundle) -> Arc<Snapshot> {
    let mut renderer = Renderer::new();
    *renderer.settings() = Settings { width: WIDTH, height: HEIGHT, cutoff: 0.0, background, ..Settings::default() };
    let world = &mut renderer.world;
    world.spawn(Camera { position: DVec3::new(0.0, 1.0, 4.0), target: Some(DVec3::Y * 0.7), ..Camera::default() });
    world.spawn(AmbientLight::default());
    let texture = world.spawn((texture, Ambient(Rgb::ONE))).id();
    match number {
        // To the horizon.
        0 => drop(world.spawn((Plane {}, Transform::new([Step::RotateY(20.0)]), MadeOf(texture)))),
        // Around a ball, and on a slanting board.
        1 => {
            world.spawn((Sphere { radius: 1.0 }, Transform::at(DVec3::new(-0.8, 1.0, 0.0)), MadeOf(texture)));
            let board =
                Transform::new([Step::RotateX(65.0), Step::RotateY(30.0), Step::Translate(DVec3::new(1.3, 0.8, 0.0))]);
            world.spawn((Cuboid { size: DVec3::new(2.0, 2.0, 0.1) }, board, MadeOf(texture)));
        }
        // By way of a curved mirror.
        2 => {
            world.spawn((Plane {}, MadeOf(texture)));
            world.spawn((Sphere { radius: 1.2 }, Transform::at(DVec3::Y * 1.2), Mirror(Rgb::ONE)));
        }
        // Through glass.
        _ => {
            world.spawn((Plane {}, MadeOf(texture)));
            let glass = (Transmission(Rgb::ONE), Refraction { index: 1.5 });
            world.spawn((Sphere { radius: 1.0 }, Transform::at(DVec3::Y * 1.1), glass));
        }
    }
    renderer.snapshot().expect("a snapshot")
}

fn picture(snapshot: &Snapshot) -> Vec<Rgb> {
    let all = (0..WIDTH * HEIGHT).map(|i| (i % WIDTH, i / WIDTH));
    all.map(|(x, y)| pixel(snapshot, x, y, &Methods::default(), &mut snell::Counts::default())).collect()
}

/// The mean over `FINE` by `FINE` rays to each pixel.
fn converged(snapshot: &Snapshot) -> Vec<Rgb> {
    let settings = Settings { width: WIDTH * FINE, height: HEIGHT * FINE, ..snapshot.settings.clone() };
    let frame = render(&Snapshot { settings, ..snapshot.clone() }, &Options::default());
    let fine = |x: u32, y: u32| Rgb::from_array(frame.picture.pixel(x, y).expect("a pixel").map(f64::from));
    let mean = |x: u32, y: u32| {
        let rays = (0..FINE * FINE).map(|i| fine(x * FINE + i % FINE, y * FINE + i / FINE));
        rays.fold(Rgb::ZERO, |sum, light| sum + light) / f64::from(FINE * FINE)
    };
    (0..WIDTH * HEIGHT).map(|i| mean(i % WIDTH, i / WIDTH)).collect()
}

fn rmse(a: &[Rgb], b: &[Rgb]) -> f64 {
    let squares: f64 = a.iter().zip(b).map(|(a, b)| (*a - *b).length_squared()).sum();
    (squares / (3 * a.len()) as f64).sqrt()
}

const SIZE: u32 = 256;

fn image(texel: impl Fn(u32, u32) -> [f32; 3]) -> Image {
    let texels = (0..SIZE * SIZE).map(|i| texel(i % SIZE, i / SIZE)).collect();
    Image::new(SIZE, SIZE, texels).expect("an image")
}

/// Squares of one texel each.
fn squares() -> Image {
    image(|x, y| if (x + y).is_multiple_of(2) { [1.0, 0.9, 0.8] } else { [0.0, 0.1, 0.2] })
}

/// Rings of all widths.
fn rings() -> Image {
    image(|x, y| {
        let across = |x: u32| f64::from(x) / f64::from(SIZE) - 0.5;
        let phase = (across(x) * across(x) + across(y) * across(y)) * 300.0;
        let ring = math::floor(phase);
        [(phase - ring) as f32, if ring % 2.0 == 0.0 { 1.0 } else { 0.0 }, 0.5]
    })
}

/// Thin lines on large squares.
fn grid() -> Image {
    image(|x, y| match (x % 16, y % 16) {
        (0, _) | (_, 0) => [0.0; 3],
        _ if (x / 64 + y / 64).is_multiple_of(2) => [0.9, 0.7, 0.2],
        _ => [0.2, 0.4, 0.8],
    })
}

fn mean(image: &Image) -> Rgb {
    let (width, height) = image.size();
    let texel = |i| Rgb::from_array(image.texel(i % width, i / width, Encoding::Srgb).map(f64::from));
    (0..width * height).fold(Rgb::ZERO, |sum, i| sum + texel(i)) / f64::from(width * height)
}

/// Errors of every filter in a scene.
fn errors(number: usize, image: &Image) -> [f64; 4] {
    let of = |filter| scene(number, mean(image), ImageTexture { filter, ..image.clone().into() });
    let exact = converged(&of(Filter::Nearest));
    let filters = [Filter::Nearest, Filter::Bilinear, Filter::Trilinear, Filter::Anisotropic];
    filters.map(|filter| rmse(&picture(&of(filter)), &exact))
}

#[test]
fn filters_bring_the_error_down() {
    for (name, image) in [("squares", squares()), ("rings", rings()), ("grid", grid())] {
        for number in 0..SCENES {
            let [nearest, bilinear, trilinear, anisotropic] = errors(number, &image);
            println!("{name} {number}: {nearest:.4} {bilinear:.4} {trilinear:.4} {anisotropic:.4}");
            assert!(bilinear < nearest, "{name}, scene {number}: {bilinear} against {nearest}");
            assert!(trilinear * 1.8 < nearest, "{name}, scene {number}: {trilinear} against {nearest}");
            assert!(anisotropic * 3.0 < nearest, "{name}, scene {number}: {anisotropic} against {nearest}");
        }
    }
}

#[test]
fn a_checkerboard_is_filtered_too() {
    for number in 0..SCENES {
        let of = |filtered| {
            let checker = Checker { filtered, frequency: 16.0, ..Checker::default() };
            scene(number, Rgb::splat(0.5), checker)
        };
        let exact = converged(&of(false));
        let [point, filtered] = [false, true].map(|filtered| rmse(&picture(&of(filtered)), &exact));
        println!("checker {number}: {point:.4} {filtered:.4}");
        assert!(filtered * 3.0 < point, "scene {number}: {filtered} against {point}");
    }
}
