//! Lights, out of the world.

use super::Parts;
use crate::{snapshot::Lights, transform::ScenePlacement};
use bevy_ecs::prelude::*;
use snell_components::{
    color::Rgb,
    hidden::Hidden,
    light::{AmbientLight, Lamp, Light},
    name::{Name, Rank},
    transform::GlobalTransform,
};
use std::{collections::BTreeMap, sync::Arc};

/// The packed forms of an entity's lights by tag, kept until light or placement change.
#[derive(Component, Clone, Default)]
pub struct PackedLamps(BTreeMap<&'static str, Arc<dyn Lamp>>);

/// Takes away the packed form where a light of one type is gone.
pub fn unpack_lights<L: Light>(mut removed: RemovedComponents<L>, mut gone: Query<&mut PackedLamps, Without<L>>) {
    for entity in removed.read() {
        if let Ok(mut lamps) = gone.get_mut(entity) {
            lamps.0.remove(L::TAG);
        }
    }
}

/// Packs the lights of one type that were changed or moved.
pub fn pack_lights<L: Light>(
    lights: Query<(Entity, Ref<L>, Ref<GlobalTransform>)>,
    scene: Res<ScenePlacement>,
    mut commands: Commands,
) {
    for (entity, light, placed) in &lights {
        if !(light.is_changed() || placed.is_changed() || scene.is_changed()) {
            continue;
        }
        let lamp = Arc::new(light.pack(&scene.of_light(&placed)));
        commands.entity(entity).entry::<PackedLamps>().or_default().and_modify(move |mut lamps| {
            lamps.0.insert(L::TAG, lamp);
        });
    }
}

/// Gathers all lights when any of them changed.
pub fn gather_lights(
    changed: Query<(), Or<(Changed<PackedLamps>, Changed<AmbientLight>)>>,
    renamed: Query<(), (Or<(With<PackedLamps>, With<AmbientLight>)>, Or<(Changed<Name>, Changed<Hidden>)>)>,
    mut lamps_removed: RemovedComponents<PackedLamps>,
    mut ambient_removed: RemovedComponents<AmbientLight>,
    mut unnamed: RemovedComponents<Name>,
    mut shown: RemovedComponents<Hidden>,
    lamps: Query<(Entity, Option<&Name>, &PackedLamps), Without<Hidden>>,
    ambient: Query<(Entity, Option<&Name>, &AmbientLight), Without<Hidden>>,
    mut parts: ResMut<Parts>,
) {
    let shines = |entity: &Entity| lamps.contains(*entity) || ambient.contains(*entity);
    let other = unnamed.read().chain(shown.read()).filter(shines).count();
    let removed = lamps_removed.read().count() + ambient_removed.read().count() + other;
    if changed.is_empty() && renamed.is_empty() && removed == 0 {
        return;
    }
    let mut lamps: Vec<_> = lamps.iter().map(|(entity, name, lamp)| (Rank::of(entity, name), lamp)).collect();
    lamps.sort_unstable_by(|a, b| a.0.cmp(&b.0));
    let mut ambient: Vec<_> = ambient.iter().map(|(entity, name, light)| (Rank::of(entity, name), light)).collect();
    ambient.sort_unstable_by(|a, b| a.0.cmp(&b.0));
    let label = |rank: &Rank, tag| (rank.name().cloned(), tag);
    let shown: Vec<Arc<dyn Lamp>> = lamps.iter().flat_map(|(_, lamps)| lamps.0.values().cloned()).collect();
    parts.lights = Arc::new(Lights {
        labels: lamps.iter().flat_map(|(rank, lamps)| lamps.0.keys().map(|tag| label(rank, *tag))).collect(),
        ambient: ambient.iter().fold(Rgb::ZERO, |sum, (_, light)| sum + light.intensity),
        points: shown.iter().map(|lamp| lamp.as_point().cloned()).collect(),
        sampling: shown.iter().map(|lamp| lamp.sampling()).collect(),
        lamps: shown,
    });
}
