//! Lights, out of the world.

use super::Parts;
use crate::snapshot::Lights;
use bevy_ecs::prelude::*;
use snell_components::{
    color::Rgb,
    light::{AmbientLight, Lamp, Light},
    name::{Name, Rank},
    transform::GlobalTransform,
};
use std::sync::Arc;

/// A light's packed form, kept on its entity until light or placement change.
#[derive(Component, Clone)]
pub struct PackedLamp(Arc<dyn Lamp>);

/// Packs the lights of one type that were changed or moved.
pub fn pack_lights<L: Light>(
    changed: Query<(Entity, &L, &GlobalTransform), Or<(Changed<L>, Changed<GlobalTransform>)>>,
    mut removed: RemovedComponents<L>,
    packed: Query<(), With<PackedLamp>>,
    mut commands: Commands,
) {
    for entity in removed.read().filter(|entity| packed.contains(*entity)) {
        commands.entity(entity).remove::<PackedLamp>();
    }
    for (entity, light, placed) in &changed {
        commands.entity(entity).insert(PackedLamp(Arc::new(light.pack(&placed.0))));
    }
}

/// Gathers all lights when any of them changed.
pub fn gather_lights(
    changed: Query<(), Or<(Changed<PackedLamp>, Changed<AmbientLight>)>>,
    renamed: Query<(), (Or<(With<PackedLamp>, With<AmbientLight>)>, Changed<Name>)>,
    mut lamps_removed: RemovedComponents<PackedLamp>,
    mut ambient_removed: RemovedComponents<AmbientLight>,
    lamps: Query<(Entity, Option<&Name>, &PackedLamp)>,
    ambient: Query<(Entity, Option<&Name>, &AmbientLight)>,
    mut parts: ResMut<Parts>,
) {
    let removed = lamps_removed.read().count() + ambient_removed.read().count();
    if changed.is_empty() && renamed.is_empty() && removed == 0 {
        return;
    }
    let mut lamps: Vec<_> = lamps.iter().map(|(entity, name, lamp)| (Rank::of(entity, name), lamp)).collect();
    lamps.sort_unstable_by(|a, b| a.0.cmp(&b.0));
    let mut ambient: Vec<_> = ambient.iter().map(|(entity, name, light)| (Rank::of(entity, name), light)).collect();
    ambient.sort_unstable_by(|a, b| a.0.cmp(&b.0));
    parts.lights = Arc::new(Lights {
        ambient: ambient.iter().fold(Rgb::ZERO, |sum, (_, light)| sum + light.intensity),
        lamps: lamps.into_iter().map(|(_, lamp)| lamp.0.clone()).collect(),
    });
}
