//! The cases, one file per family.

mod boxes;
mod leaks;
mod secondary;
mod size;
mod spheres;
mod triangles;

use crate::suite::Case;
use bevy_ecs::prelude::*;
use snell_components::{camera::Camera, name::Name};
use snell_systems::{accelerate::Geometry, pipeline::Renderer, snapshot::Snapshot};
use std::sync::Arc;

/// Unit roundoff of `f64`.
const U: f64 = f64::EPSILON / 2.0;

/// In the order of the catalogue.
pub(crate) fn all() -> Vec<Case> {
    let mut all: Vec<Case> =
        [leaks::CASES, triangles::CASES, spheres::CASES, boxes::CASES, secondary::CASES, size::CASES]
            .into_iter()
            .flat_map(|cases| cases.iter().map(|case| Case { ..*case }))
            .collect();
    all.sort_by_key(|case| case.id);
    all
}

/// A world with a camera and some things, drawn from by name in the order given.
fn snapshot(fill: impl FnOnce(&mut World)) -> Arc<Snapshot> {
    let mut renderer = Renderer::new();
    renderer.world.spawn((Name::new("camera"), Camera::default()));
    fill(&mut renderer.world);
    match renderer.snapshot() {
        Ok(snapshot) => snapshot,
        // Every case has a camera, the one thing that a scene must have.
        Err(why) => unreachable!("{why}"),
    }
}

/// The shapes of such a world.
fn geometry(fill: impl FnOnce(&mut World)) -> Arc<Geometry> {
    snapshot(fill).geometry.clone()
}
