//! Materials, out of the world.

use super::Parts;
use crate::{
    accelerate::Scenery,
    snapshot::{Effect, Material, MaterialOfObject, Materials},
};
use bevy_ecs::{prelude::*, query::QueryData, system::SystemParam};
use snell_components::{
    color::Rgb,
    material::{
        Ambient, Color, Dielectric, Diffuse, Highlight, MadeOf, MaterialSlots, Mirror, Opacity, Refraction,
        Transmission,
    },
    name::{Name, Rank},
    texture::{Pattern, Texture},
};
use std::{
    collections::{BTreeMap, HashMap},
    sync::Arc,
};

/// A texture's packed form, kept on its entity until the texture changes.
#[derive(Component, Clone)]
pub struct PackedTexture(Option<Arc<dyn Pattern>>);

/// Takes away the packed form where a texture of one type is gone.
pub fn unpack_textures<T: Texture>(
    mut removed: RemovedComponents<T>,
    gone: Query<(), (With<PackedTexture>, Without<T>)>,
    mut commands: Commands,
) {
    for entity in removed.read().filter(|entity| gone.contains(*entity)) {
        commands.entity(entity).remove::<PackedTexture>();
    }
}

/// Packs the textures of one type that were changed.
pub fn pack_textures<T: Texture>(changed: Query<(Entity, &T), Changed<T>>, mut commands: Commands) {
    for (entity, texture) in &changed {
        commands.entity(entity).insert(PackedTexture(texture.pack()));
    }
}

/// The effects of an entity.
#[derive(QueryData)]
pub struct Effects {
    entity: Entity,
    name: Option<&'static Name>,
    color: Option<&'static Color>,
    ambient: Option<&'static Ambient>,
    diffuse: Option<&'static Diffuse>,
    highlight: Option<&'static Highlight>,
    mirror: Option<&'static Mirror>,
    transmission: Option<&'static Transmission>,
    refraction: Option<&'static Refraction>,
    dielectric: Option<&'static Dielectric>,
    opacity: Option<&'static Opacity>,
    texture: Option<&'static PackedTexture>,
}

/// Entities that have any effect.
type AnyEffect = Or<(
    With<Color>,
    With<Ambient>,
    With<Diffuse>,
    With<Highlight>,
    With<Mirror>,
    With<Transmission>,
    With<Refraction>,
    With<Dielectric>,
    With<Opacity>,
    With<PackedTexture>,
)>;

/// Entities with an effect that changed.
type ChangedEffect = Or<(
    Changed<Color>,
    Changed<Ambient>,
    Changed<Diffuse>,
    Changed<Highlight>,
    Changed<Mirror>,
    Changed<Transmission>,
    Changed<Refraction>,
    Changed<Dielectric>,
    Changed<Opacity>,
    Changed<PackedTexture>,
)>;

/// Effects that were taken from entities.
#[derive(SystemParam)]
pub struct RemovedEffects<'w, 's> {
    color: RemovedComponents<'w, 's, Color>,
    ambient: RemovedComponents<'w, 's, Ambient>,
    diffuse: RemovedComponents<'w, 's, Diffuse>,
    highlight: RemovedComponents<'w, 's, Highlight>,
    mirror: RemovedComponents<'w, 's, Mirror>,
    transmission: RemovedComponents<'w, 's, Transmission>,
    refraction: RemovedComponents<'w, 's, Refraction>,
    dielectric: RemovedComponents<'w, 's, Dielectric>,
    opacity: RemovedComponents<'w, 's, Opacity>,
    texture: RemovedComponents<'w, 's, PackedTexture>,
    made_of: RemovedComponents<'w, 's, MadeOf>,
    slots: RemovedComponents<'w, 's, MaterialSlots>,
}

impl RemovedEffects<'_, '_> {
    fn any(&mut self) -> bool {
        // All are read, so that none is seen again next time.
        let counts = [
            self.color.read().count(),
            self.ambient.read().count(),
            self.diffuse.read().count(),
            self.highlight.read().count(),
            self.mirror.read().count(),
            self.transmission.read().count(),
            self.refraction.read().count(),
            self.dielectric.read().count(),
            self.opacity.read().count(),
            self.texture.read().count(),
            self.made_of.read().count(),
            self.slots.read().count(),
        ];
        counts.iter().any(|count| *count > 0)
    }
}

/// Gathers all materials, and which object is made of which, when any of it changed.
pub fn gather_materials(
    changed: Query<(), Or<(ChangedEffect, Changed<MadeOf>, Changed<MaterialSlots>)>>,
    renamed: Query<(), (AnyEffect, Changed<Name>)>,
    mut removed: RemovedEffects,
    mut unnamed: RemovedComponents<Name>,
    scenery: Res<Scenery>,
    with_effects: Query<Effects, AnyEffect>,
    made_of: Query<&MadeOf>,
    slots: Query<&MaterialSlots>,
    mut parts: ResMut<Parts>,
) {
    let unnamed = unnamed.read().filter(|entity| with_effects.contains(*entity)).count();
    let removed = removed.any() || unnamed > 0;
    if changed.is_empty() && renamed.is_empty() && !removed && !scenery.is_changed() {
        return;
    }
    let mut ranked: BTreeMap<Rank, EffectsItem<'_, '_>> = BTreeMap::new();
    for effects in &with_effects {
        ranked.insert(Rank::of(effects.entity, effects.name), effects);
    }
    let mut all = vec![plain()];
    // Looked up only, never walked.
    let mut index_of: HashMap<Entity, u32> = HashMap::with_capacity(ranked.len());
    for effects in ranked.values() {
        index_of.insert(effects.entity, all.len() as u32);
        all.push(effects.pack());
    }
    let index = |entity: Entity| index_of.get(&entity).copied().unwrap_or(0);
    let of_object = scenery
        .objects
        .iter()
        .map(|&object| match (made_of.get(object), slots.get(object)) {
            (Ok(material), _) => MaterialOfObject::Whole(index(material.0)),
            (_, Ok(slots)) if !slots.0.is_empty() && !index_of.contains_key(&object) => {
                MaterialOfObject::Slots(slots.0.iter().map(|entity| index(*entity)).collect())
            }
            _ => MaterialOfObject::Whole(index(object)),
        })
        .collect();
    let any_transparent = all.iter().any(Material::is_transparent);
    parts.materials = Arc::new(Materials { all, of_object, any_transparent });
}

/// The material of things that have none: matte white.
fn plain() -> Material {
    let effects = [Effect::Ambient(Rgb::splat(0.1)), Effect::Diffuse(Rgb::splat(0.9))];
    Material { color: Rgb::ONE, texture: None, effects: effects.into() }
}

impl EffectsItem<'_, '_> {
    fn pack(&self) -> Material {
        let strength = |value: Option<Rgb>| value.unwrap_or(Rgb::ZERO);
        let ambient = strength(self.ambient.map(|k| k.0));
        let diffuse = strength(self.diffuse.map(|k| k.0));
        let highlight = self.highlight.copied().unwrap_or(Highlight { strength: Rgb::ZERO, exponent: 1.0 });
        // Alpha blending weighs the surface's own light by α and what lies straight behind by 1 − α.
        let alpha = self.opacity.map_or(1.0, |opacity| opacity.alpha);
        let mut effects = vec![];
        let mut add = |strength: Rgb, effect: &dyn Fn(Rgb) -> Effect| {
            if strength != Rgb::ZERO {
                effects.push(effect(strength));
            }
        };
        add(ambient * alpha, &Effect::Ambient);
        if highlight.strength * alpha == Rgb::ZERO {
            add(diffuse * alpha, &Effect::Diffuse);
        } else {
            let diffuse = diffuse * alpha;
            let exponent = highlight.exponent;
            add(highlight.strength * alpha, &|highlight| Effect::Glossy { diffuse, highlight, exponent });
        }
        let mut behind = Rgb::splat(1.0 - alpha);
        if let Some(Dielectric { index }) = self.dielectric.copied() {
            let part = (Rgb::ONE - ambient - diffuse - highlight.strength).max(Rgb::ZERO) * alpha;
            if index > Dielectric::OPAQUE_INDEX {
                add(part, &Effect::Mirror);
            } else {
                add(part, &|part| Effect::Split { part, index });
            }
        } else {
            add(strength(self.mirror.map(|k| k.0)) * alpha, &Effect::Mirror);
            let transmission = strength(self.transmission.map(|k| k.0)) * alpha;
            match self.refraction {
                Some(Refraction { index }) => {
                    add(transmission, &|strength| Effect::Refract { strength, index: *index })
                }
                None => behind += transmission,
            }
        }
        add(behind, &Effect::Through);
        Material {
            color: self.color.map_or(Rgb::ONE, |color| color.0),
            texture: self.texture.and_then(|texture| texture.0.clone()),
            effects: effects.into(),
        }
    }
}
