//! How do I use it in a program that has an ECS of its own? `cargo run --example in_a_schedule`
//!
//! The renderer is a value: keep it as a resource, and let a system carry over what changed. A Bevy app does the same in
//! its `Update`; nothing here needs a window, a plugin or the GPU.

use bevy_ecs::schedule::Schedule;
use snell::prelude::*;

/// The renderer, in the program's own world.
#[derive(Resource)]
struct Tracer(Renderer);

/// The program's own idea of a thing, with its entity in the renderer's world.
#[derive(Component)]
struct Body {
    height: f64,
    shown: Entity,
}

/// The program's own rules.
fn fall(mut bodies: Query<&mut Body>) {
    for mut body in &mut bodies {
        body.height -= 0.25;
    }
}

/// Carries over what changed.
fn show(bodies: Query<&Body, Changed<Body>>, mut tracer: ResMut<Tracer>) {
    for body in &bodies {
        tracer.0.world.entity_mut(body.shown).insert(Transform::at(DVec3::Y * body.height));
    }
}

/// Draws; a program that shows frames would hand the snapshot to another thread here.
fn draw(mut tracer: ResMut<Tracer>) {
    match tracer.0.snapshot() {
        Ok(snapshot) => println!("{}", render(&snapshot, &Options::default()).picture.hash()),
        Err(why) => println!("nothing to draw: {why}"),
    }
}

fn main() {
    let mut renderer = Renderer::new();
    renderer.set_size(64, 48);
    renderer.add("camera", Camera::at([0.0, 1.0, 6.0]));
    renderer.add("sun", DirectionalLight::along([-1.0, -2.0, -1.0]));
    let shown = renderer.add("body", (Sphere { radius: 0.5 }, Color::srgb(0xf0a858))).id();

    let mut world = World::new();
    world.spawn(Body { height: 2.0, shown });
    world.insert_resource(Tracer(renderer));
    let mut update = Schedule::default();
    update.add_systems((fall, show, draw).chain());
    for _ in 0..3 {
        update.run(&mut world);
    }
}
