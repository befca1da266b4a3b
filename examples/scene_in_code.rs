//! How do I build a scene in code? `cargo run --example scene_in_code`
//!
//! Entities are made of components; a relationship names the material. Names decide the order of everything, so that the
//! picture is the same however the scene was put together.

use snell::{
    prelude::*,
    systems::image::{self, Format, Metadata},
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut renderer = Renderer::new();
    let world = &mut renderer.world;
    world.spawn(Camera { position: DVec3::new(0.0, 2.0, 6.0), target: Some(DVec3::Y), ..Camera::default() });
    world.spawn(AmbientLight { intensity: Rgb::splat(0.3) });
    world.spawn(DirectionalLight { direction: DVec3::new(-1.0, -2.0, -1.0), ..DirectionalLight::default() });
    world.spawn((Name::new("ground"), Plane {}, Checker::default(), Ambient(Rgb::ONE), Diffuse(Rgb::ONE)));
    let brass = world.spawn((Color(Rgb::new(0.8, 0.55, 0.2)), Diffuse(Rgb::splat(0.7)), Mirror(Rgb::splat(0.25)))).id();
    for i in -2..=2 {
        let place = DVec3::new(f64::from(i) * 1.1, 0.5, 0.0);
        let name = Name::new(format!("ball {i}"));
        world.spawn((name, Sphere { radius: 0.5 }, Transform::at(place), MadeOf(brass)));
    }
    (renderer.settings().width, renderer.settings().height) = (320, 200);

    let snapshot = renderer.snapshot()?;
    let frame = render(&snapshot, &Options::default());
    let file = std::env::temp_dir().join("scene_in_code.png");
    let told = Metadata::of(&frame, &snapshot.settings, "scene_in_code.rs".as_ref());
    image::write(&file, Format::Png8, &frame.picture, &told)?;
    println!("{}: {} rays", file.display(), frame.counts.rays());
    Ok(())
}
