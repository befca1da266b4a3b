use snell::{components::name::Name, prelude::*, systems::image};

/// The scene.
pub fn scene() -> Result<Renderer, Box<dyn std::error::Error>> {
    let mut renderer = Renderer::new();
    *renderer.settings() = Settings {
        width: 640,
        height: 400,
        antialias: Antialias::Four,
        background: Rgb::new(0.55, 0.7, 0.9),
        ..Settings::default()
    };
    let world = &mut renderer.world;
    world.spawn((
        Name::new("Camera"),
        Camera { position: DVec3::new(0.0, 4.0, 9.0), target: Some(DVec3::new(0.0, 0.6, 0.0)), direction: None, up: DVec3::new(0.0, 1.0, 0.0), roll: 0.0, field_of_view: 34.0, screen_distance: None, moves: [].into_iter().collect() },
    ));
    world.spawn((Name::new("Sky"), AmbientLight { intensity: Rgb::splat(0.55) }));
    world.spawn((
        Name::new("Sun"),
        DirectionalLight { direction: DVec3::new(-0.5, -1.0, -0.6), intensity: Rgb::splat(0.7), shadows: true },
    ));
    world.spawn((
        Name::new("Ground"),
        Ambient(Rgb::splat(0.4)),
        Color(Rgb::new(0.75, 0.78, 0.7)),
        Diffuse(Rgb::splat(0.75)),
        Plane {  },
    ));
    let red_4 = world.spawn((
        Name::new("Red"),
        Ambient(Rgb::splat(0.35)),
        Color(Rgb::new(0.85, 0.2, 0.15)),
        Diffuse(Rgb::splat(0.8)),
        Highlight { strength: Rgb::splat(0.4), exponent: 60.0 },
    )).id();
    let yellow_5 = world.spawn((
        Name::new("Yellow"),
        Ambient(Rgb::splat(0.35)),
        Color(Rgb::new(0.9, 0.7, 0.15)),
        Diffuse(Rgb::splat(0.8)),
        Highlight { strength: Rgb::splat(0.4), exponent: 60.0 },
    )).id();
    let blue_6 = world.spawn((
        Name::new("Blue"),
        Ambient(Rgb::splat(0.35)),
        Color(Rgb::new(0.15, 0.35, 0.8)),
        Diffuse(Rgb::splat(0.8)),
        Highlight { strength: Rgb::splat(0.4), exponent: 60.0 },
    )).id();
    world.spawn((
        Name::new("Ball"),
        Sphere { radius: 0.7 },
        Transform([Step::Translate(DVec3::new(-2.4, 0.7, 1.0))].into_iter().collect()),
        MadeOf(red_4),
    ));
    world.spawn((
        Name::new("Cube"),
        Cuboid { size: DVec3::new(1.2, 1.2, 1.2) },
        Transform([Step::RotateY(30.0), Step::Translate(DVec3::new(-0.7, 0.6, 0.6))].into_iter().collect()),
        MadeOf(yellow_5),
    ));
    world.spawn((
        Name::new("Cone"),
        Cone { radius: 0.7, top: 0.0, height: 1.5 },
        Transform([Step::Translate(DVec3::new(1.1, 0.0, 0.8))].into_iter().collect()),
        MadeOf(blue_6),
    ));
    world.spawn((
        Name::new("Can"),
        Cylinder { radius: 0.5, height: 1.2 },
        Transform([Step::Translate(DVec3::new(2.6, 0.0, 0.6))].into_iter().collect()),
        MadeOf(red_4),
    ));
    world.spawn((
        Name::new("Flake"),
        SphereFlake { radius: 0.55, depth: 2 },
        Transform([Step::Translate(DVec3::new(-1.7, 0.9, -1.8))].into_iter().collect()),
        MadeOf(blue_6),
    ));
    world.spawn((
        Name::new("Vase"),
        Lathe { profile: vec![DVec2::new(0.0, 0.0), DVec2::new(0.5, 0.0), DVec2::new(0.6, 0.5), DVec2::new(0.3, 1.0), DVec2::new(0.4, 1.3), DVec2::new(0.0, 1.3)], segments: 48, shading: Shading::Smooth },
        Transform([Step::Translate(DVec3::new(0.4, 0.0, -1.6))].into_iter().collect()),
        MadeOf(yellow_5),
    ));
    world.spawn((
        Name::new("Hills"),
        HeightField { size: DVec3::new(2.0, 0.5, 2.0), cells: 48, hills: 4.0, roughness: 0.4, seed: 0, smooth: true },
        Transform([Step::Translate(DVec3::new(2.4, 0.0, -1.9))].into_iter().collect()),
        MadeOf(red_4),
    ));
    Ok(renderer)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let snapshot = scene()?.snapshot()?;
    let frame = render(&snapshot, &Options::default());
    let metadata = image::Metadata::of(&frame, &snapshot.settings, "scene".as_ref());
    image::write("scene.png".as_ref(), image::Format::Png8, &frame.picture, &metadata)?;
    Ok(())
}
