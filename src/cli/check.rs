//! `snell check`.

use super::{
    Console, Failure,
    args::CheckArguments,
    draw::{of_scene, warn_of_left_out},
};
use crate::Renderer;
use bevy_ecs::{prelude::*, resource::IsResource};
use std::{collections::HashSet, path::Path};

/// Loads and builds scenes, each on its own, and tells all their faults.
pub(super) fn check(renderer: &mut Renderer, args: &CheckArguments, console: &mut Console<'_>) -> Result<(), Failure> {
    let before = entities(&mut renderer.world);
    let settings = renderer.settings().clone();
    let mut faults = vec![];
    for scene in &args.scenes {
        match check_one(renderer, scene, console) {
            Ok(()) => console.say(of_scene(scene, "ok")),
            Err(more) => faults.extend(more),
        }
        for entity in entities(&mut renderer.world).difference(&before) {
            // Others may be gone with one of them.
            let _ = renderer.world.try_despawn(*entity);
        }
        *renderer.settings() = settings.clone();
    }
    if faults.is_empty() { Ok(()) } else { Err(Failure::Scene(faults)) }
}

fn check_one(renderer: &mut Renderer, scene: &Path, console: &mut Console<'_>) -> Result<(), Vec<String>> {
    let notices =
        renderer.load(scene).map_err(|faults| faults.0.iter().map(ToString::to_string).collect::<Vec<_>>())?;
    notices.iter().for_each(|notice| console.warn(notice));
    let snapshot = renderer.snapshot().map_err(|why| vec![of_scene(scene, why)])?;
    warn_of_left_out(scene, &snapshot, console);
    Ok(())
}

/// Everything that a scene may hold.
pub(super) fn entities(world: &mut World) -> HashSet<Entity> {
    world.query_filtered::<Entity, Without<IsResource>>().iter(world).collect()
}
