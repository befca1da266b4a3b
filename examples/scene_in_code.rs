//! How do I build a scene in code? `cargo run --example scene_in_code`
//!
//! As in a scene file: a name, and what the thing is made of. Names decide the order of everything, so that the picture is
//! the same however the scene was put together. What is added is an entity of `renderer.world`, an ordinary ECS world.

use snell::{
    prelude::*,
    systems::image::{self, Format, Metadata},
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut scene = Renderer::new();
    scene.set_size(320, 200);
    scene.settings().background = Rgb::new(0.4, 0.6, 0.8);
    scene.add("camera", Camera::at([0.0, 2.0, 6.0]).looking_at([0.0, 1.0, 0.0]));
    scene.add("sky", AmbientLight::grey(0.3));
    scene.add("sun", DirectionalLight::along([-1.0, -2.0, -1.0]));
    scene.add("ground", (Plane {}, Checker::default(), Ambient::grey(1.0), Diffuse::grey(1.0)));
    let brass = scene.add("brass", (Color::srgb(0xe8c27c), Diffuse::grey(0.7), Mirror::grey(0.25))).id();
    for i in -2..=2 {
        let place = [1.1 * f64::from(i), 0.5, 0.0];
        scene.add(format!("ball {i}"), Sphere { radius: 0.5 }).at(place).made_of(brass);
    }

    let snapshot = scene.snapshot()?;
    let frame = render(&snapshot, &Options::default());
    let file = std::env::temp_dir().join("scene_in_code.png");
    let told = Metadata::of(&frame, &snapshot.settings, "scene_in_code.rs".as_ref());
    image::write(&file, Format::Png8, &frame.picture, &told)?;
    println!("{}: {} rays", file.display(), frame.counts.rays());
    Ok(())
}
