//! What a scene does not have costs it nothing: no ray, no byte.

use snell::prelude::*;

const SIZE: u32 = 16;

/// A matte floor that fills the picture, under a lamp.
fn plain() -> Renderer {
    let mut renderer = Renderer::new();
    *renderer.settings() = Settings { width: SIZE, height: SIZE, ..Settings::default() };
    let world = &mut renderer.world;
    world.spawn(Camera { position: DVec3::Y * 5.0, direction: Some(DVec3::NEG_Y), up: DVec3::Z, ..Camera::default() });
    world.spawn(PointLight { position: DVec3::Y * 9.0, ..PointLight::default() });
    world.spawn((Name::new("floor"), Plane {}, Diffuse(Rgb::ONE)));
    renderer
}

#[test]
fn a_plain_scene_takes_a_ray_and_a_shadow_ray_for_each_pixel_and_nothing_else() {
    let snapshot = plain().snapshot().expect("a snapshot");
    let counts = render(&snapshot, &Options::default()).counts;
    let pixels = u64::from(SIZE * SIZE);
    assert_eq!((counts.primary, counts.shadow), (pixels, pixels));
    assert_eq!((counts.mirror, counts.transmitted, counts.cut, counts.too_deep, counts.nodes), (0, 0, 0, 0, 0));
    // The floor alone, once for each ray.
    assert_eq!(counts.primitives, 2 * pixels);
}

#[test]
fn absent_effects_take_no_byte_of_the_snapshot() {
    let snapshot = plain().snapshot().expect("a snapshot");
    let materials = &snapshot.materials;
    assert!(materials.media.is_empty() && !materials.any_transparent && snapshot.parted.is_none());
    assert_eq!(snapshot.lights.lamps.len(), 1);
    // The first is that of objects without one.
    let [_, floor] = &materials.all[..] else { panic!("{} materials", materials.all.len()) };
    assert!(floor.texture.is_none());
    assert_eq!(floor.effects.len(), 1, "{:?}", floor.effects);
    // An effect is a tag, two colours and a number, whatever else the renderer knows.
    assert!(size_of_val(&floor.effects[0]) <= 64);
}

#[test]
fn effects_that_nothing_shown_has_change_no_count() {
    let counts =
        |renderer: &mut Renderer| render(&renderer.snapshot().expect("a snapshot"), &Options::default()).counts;
    let before = counts(&mut plain());
    let mut rich = plain();
    // Materials of no object: an index that depends on the wavelength, absorption, a filtered texture.
    rich.world.spawn((Dielectric { index: 1.5 }, Dispersion::default(), Absorption(Rgb::ONE)));
    rich.world.spawn((Checker::default(), Diffuse(Rgb::ONE)));
    assert_eq!(counts(&mut rich), before);
}
