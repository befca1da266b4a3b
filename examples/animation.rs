//! How do I draw the frames of an animation? `cargo run --example animation`
//!
//! The world is changed between frames; only what changed is prepared again, and a snapshot stays as it is, so frames
//! may be drawn while the next is prepared.

use snell::{
    prelude::*,
    systems::image::{self, Format, Metadata},
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut renderer = Renderer::new();
    renderer.set_size(160, 100);
    renderer.settings().background = Rgb::new(0.5, 0.7, 0.9);
    renderer.add("camera", Camera::at([0.0, 1.5, 5.0]).looking_at([0.0, 0.8, 0.0]));
    renderer.add("sun", DirectionalLight::along([-1.0, -2.0, -1.0]));
    renderer.add("ground", (Plane {}, Checker { odd: Rgb::splat(0.3), ..Checker::default() }));
    let ball = renderer.add("ball", (Sphere { radius: 0.5 }, Color::srgb(0xd04020))).id();

    let folder = std::env::temp_dir();
    let frames = 8;
    for number in 0..frames {
        let time = f64::from(number) / f64::from(frames);
        // Up and down again, as a thrown ball goes.
        let height = 0.5 + 4.0 * 1.2 * time * (1.0 - time);
        renderer.world.entity_mut(ball).insert(Transform::at(DVec3::new(-1.5 + 3.0 * time, height, 0.0)));
        let snapshot = renderer.snapshot()?;
        let frame = render(&snapshot, &Options::default());
        let file = folder.join(format!("animation-{number:03}.png"));
        let told = Metadata::of(&frame, &snapshot.settings, "animation.rs".as_ref());
        image::write(&file, Format::Png8, &frame.picture, &told)?;
        println!("{}: {}", file.display(), frame.picture.hash());
    }
    Ok(())
}
