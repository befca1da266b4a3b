//! Materials, out of the world.

use super::{Parts, spectrum::spectrum};
use crate::{
    accelerate::Scenery,
    snapshot::{Effect, Material, MaterialOfObject, Materials, Medium},
};
use bevy_ecs::{prelude::*, query::QueryData, system::SystemParam};
use snell_components::{
    color::Rgb,
    material::{
        Absorption, Ambient, Color, Dielectric, Diffuse, Dispersion, Highlight, MadeOf, MaterialSlots, MediumRank,
        Mirror, Opacity, Refraction, Transmission,
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

/// Packs the textures of one type that were changed.
pub fn pack_textures<T: Texture>(
    changed: Query<(Entity, &T), Changed<T>>,
    mut removed: RemovedComponents<T>,
    packed: Query<(), With<PackedTexture>>,
    mut commands: Commands,
) {
    for entity in removed.read().filter(|entity| packed.contains(*entity)) {
        commands.entity(entity).remove::<PackedTexture>();
    }
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
    absorption: Option<&'static Absorption>,
    dispersion: Option<&'static Dispersion>,
    rank: Option<&'static MediumRank>,
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
    With<Absorption>,
    With<Dispersion>,
    With<MediumRank>,
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
    Changed<Absorption>,
    Changed<Dispersion>,
    Changed<MediumRank>,
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
    absorption: RemovedComponents<'w, 's, Absorption>,
    dispersion: RemovedComponents<'w, 's, Dispersion>,
    rank: RemovedComponents<'w, 's, MediumRank>,
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
            self.absorption.read().count(),
            self.dispersion.read().count(),
            self.rank.read().count(),
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
    scenery: Res<Scenery>,
    with_effects: Query<Effects, AnyEffect>,
    made_of: Query<&MadeOf>,
    slots: Query<&MaterialSlots>,
    mut parts: ResMut<Parts>,
) {
    let removed = removed.any();
    if changed.is_empty() && renamed.is_empty() && !removed && !scenery.is_changed() {
        return;
    }
    let mut ranked: BTreeMap<Rank, EffectsItem<'_, '_>> = BTreeMap::new();
    for effects in &with_effects {
        ranked.insert(Rank::of(effects.entity, effects.name), effects);
    }
    let mut all = vec![plain()];
    let mut media = vec![None];
    // Looked up only, never walked.
    let mut index_of: HashMap<Entity, u32> = HashMap::with_capacity(ranked.len());
    for effects in ranked.values() {
        index_of.insert(effects.entity, all.len() as u32);
        all.push(effects.pack());
        media.push(effects.medium());
    }
    let index = |entity: Entity| index_of.get(&entity).copied().unwrap_or(0);
    // A body with several materials may hold what fills it on its own entity.
    let fills_only = |entity: Entity| with_effects.get(entity).is_ok_and(|effects| effects.fills_only());
    let mut of_object = Vec::with_capacity(scenery.objects.len());
    let mut medium_of = Vec::with_capacity(scenery.objects.len());
    for &object in scenery.objects.iter() {
        let (material, medium) = match (made_of.get(object), slots.get(object)) {
            (Ok(material), _) => {
                (MaterialOfObject::Whole(index(material.0)), media[index(material.0) as usize].clone())
            }
            (_, Ok(slots)) if !slots.0.is_empty() && (fills_only(object) || !index_of.contains_key(&object)) => {
                let slots: Box<[u32]> = slots.0.iter().map(|entity| index(*entity)).collect();
                let own = media[index(object) as usize].clone();
                let medium = own.or_else(|| slots.iter().find_map(|&slot| media[slot as usize].clone()));
                (MaterialOfObject::Slots(slots), medium)
            }
            _ => (MaterialOfObject::Whole(index(object)), media[index(object) as usize].clone()),
        };
        of_object.push(material);
        medium_of.push(medium);
    }
    if medium_of.iter().all(Option::is_none) {
        medium_of.clear();
    }
    let any_transparent = all.iter().any(Material::is_transparent);
    parts.materials = Arc::new(Materials { all, of_object, media: medium_of, any_transparent });
}

/// What things without a material, and materials without a term of light, are made of: a matte surface.
/// Its ambient and diffuse strengths.
const PLAIN_STRENGTHS: [f64; 2] = [0.1, 0.9];

fn plain() -> Material {
    let [ambient, diffuse] = PLAIN_STRENGTHS;
    Material {
        color: Rgb::ONE,
        texture: None,
        effects: [Effect::Ambient(Rgb::splat(ambient)), Effect::Diffuse(Rgb::splat(diffuse))].into(),
    }
}

impl EffectsItem<'_, '_> {
    /// Whether some term of light is stated.
    fn has_light(&self) -> bool {
        self.ambient.is_some()
            || self.diffuse.is_some()
            || self.highlight.is_some()
            || self.mirror.is_some()
            || self.transmission.is_some()
            || self.dielectric.is_some()
    }

    /// Whether nothing is stated of the surface, only of what fills the body.
    fn fills_only(&self) -> bool {
        !self.has_light() && self.color.is_none() && self.texture.is_none() && self.opacity.is_none()
    }

    fn pack(&self) -> Material {
        let strength = |value: Option<Rgb>| value.unwrap_or(Rgb::ZERO);
        let [plain_ambient, plain_diffuse] = if self.has_light() { [0.0; 2] } else { PLAIN_STRENGTHS };
        let ambient = self.ambient.map_or(Rgb::splat(plain_ambient), |k| k.0);
        let diffuse = self.diffuse.map_or(Rgb::splat(plain_diffuse), |k| k.0);
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
            add(part, if index > Dielectric::OPAQUE_INDEX { &Effect::Mirror } else { &Effect::Split });
        } else {
            add(strength(self.mirror.map(|k| k.0)) * alpha, &Effect::Mirror);
            let transmission = strength(self.transmission.map(|k| k.0)) * alpha;
            if self.refraction.is_some() {
                add(transmission, &Effect::Refract);
            } else {
                behind += transmission;
            }
        }
        add(behind, &Effect::Through);
        Material {
            color: self.color.map_or(Rgb::ONE, |color| color.0),
            texture: self.texture.and_then(|texture| texture.0.clone()),
            effects: effects.into(),
        }
    }

    /// What a body of this material is filled with, if light goes on inside it in any way but as outside.
    fn medium(&self) -> Option<Medium> {
        let index = self.dielectric.map(|d| d.index).filter(|index| *index <= Dielectric::OPAQUE_INDEX);
        let index = index.or(self.refraction.map(|r| r.index));
        if index.is_none() && self.absorption.is_none() {
            return None;
        }
        let index = index.unwrap_or(1.0);
        Some(Medium {
            index,
            absorption: self.absorption.map_or(Rgb::ZERO, |absorption| absorption.0),
            rank: self.rank.map_or(0.0, |rank| rank.0),
            spectrum: self.dispersion.map(|dispersion| spectrum(index, *dispersion)),
        })
    }
}
