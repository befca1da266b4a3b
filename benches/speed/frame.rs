//! Whole pictures.

use crate::{
    clock::spent,
    measure::{Case, Done, Row, interleave},
    subject::Subject,
};
use snell::{components::primitive::Cost, prelude::*};
use std::sync::Arc;

/// A field of triangles above a mirror, lit by one lamp with shadows: what took 5 to 30 seconds in 2004.
pub(crate) fn of_field(subject: &Subject, (width, height): (u32, u32)) -> Arc<Snapshot> {
    let mut renderer = scene(subject, (width, height));
    let (min, max) = subject.bounds();
    let floor = Transform::at(DVec3::new(0.0, min.y - 0.1 * (max.y - min.y), 0.0));
    renderer.world.spawn((Name::new("floor"), Plane {}, floor, Diffuse(Rgb::splat(0.3)), Mirror(Rgb::splat(0.6))));
    renderer.snapshot().expect("a scene that can be drawn")
}

/// A mesh seen from where [`crate::rays::Rays::about`] looks.
fn scene(subject: &Subject, (width, height): (u32, u32)) -> Renderer {
    let mut renderer = Renderer::new();
    (renderer.settings().width, renderer.settings().height) = (width, height);
    let (min, max) = subject.bounds();
    let (center, size) = (0.5 * (min + max), (max - min).length());
    let eye = center + 1.15 * size * DVec3::new(0.3, 0.25, 1.0).normalize();
    let light = center + size * DVec3::new(1.2, 1.6, 0.9);
    let world = &mut renderer.world;
    let camera = Camera { position: eye, target: Some(center), field_of_view: 38.0, ..Camera::default() };
    world.spawn((Name::new("camera"), camera));
    world.spawn((Name::new("lamp"), PointLight { position: light, ..PointLight::default() }));
    world.spawn((Name::new("mesh"), subject.mesh(), Diffuse(Rgb::splat(0.8))));
    renderer
}

/// Draws a frame.
pub(crate) fn draw(snapshot: &Snapshot, threads: usize) -> Done {
    let options = Options { threads: Some(threads), ..Options::default() };
    let (frame, spent) = spent(|| render(snapshot, &options));
    let cost = Cost { nodes: frame.counts.nodes, primitives: frame.counts.primitives };
    Done { spent, items: frame.counts.rays(), cost }
}

/// Frames of 800×600 pixels of all subjects.
pub(crate) fn bench(subjects: &[Subject], rounds: usize) -> Vec<Row> {
    let snapshots: Vec<_> = subjects.iter().map(|subject| of_field(subject, (800, 600))).collect();
    let pairs = subjects.iter().zip(&snapshots);
    let cases = pairs.flat_map(|(subject, snapshot)| {
        [1, 2].map(|threads| Case {
            bench: "frame",
            subject: subject.name.clone(),
            item: "rays",
            threads,
            run: Box::new(move || draw(snapshot, threads)),
        })
    });
    interleave(cases.collect(), rounds)
}
