//! Materials, out of the world.

use super::{Parts, spectrum::spectrum};
use crate::{
    accelerate::Scenery,
    snapshot::{Effect, Material, MaterialOfObject, Materials, Medium, Parted},
};
use bevy_ecs::{prelude::*, query::QueryData, system::SystemParam};
use snell_components::{
    color::{Encoding, Rgb},
    material::{
        Absorption, Ambient, Color, Dielectric, Diffuse, Dispersion, Highlight, MadeOf, MaterialSlots, MediumRank,
        Mirror, Opacity, Refraction, Transmission,
    },
    name::{Name, Rank},
    settings::Settings,
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

/// Packs the textures of one type that were changed; all of them if what numbers in files mean was changed.
pub fn pack_textures<T: Texture>(
    textures: Query<(Entity, Ref<T>)>,
    settings: Res<Settings>,
    mut packed_as: Local<Encoding>,
    mut commands: Commands,
) {
    let encoding = settings.encoding;
    let all = core::mem::replace(&mut *packed_as, encoding) != encoding;
    for (entity, texture) in &textures {
        if all || texture.is_changed() {
            commands.entity(entity).insert(PackedTexture(texture.pack_as(encoding)));
        }
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
    let mut names = vec![None];
    let mut fillings = vec![Filling::default()];
    // Looked up only, never walked.
    let mut index_of: HashMap<Entity, u32> = HashMap::with_capacity(ranked.len());
    for effects in ranked.values() {
        index_of.insert(effects.entity, all.len() as u32);
        all.push(effects.pack());
        names.push(effects.name.cloned());
        fillings.push(effects.filling());
    }
    let index = |entity: Entity| index_of.get(&entity).copied().unwrap_or(0);
    // A body with several materials may hold what fills it on its own entity.
    let fills_only = |entity: Entity| with_effects.get(entity).is_ok_and(|effects| effects.fills_only());
    let mut of_object = Vec::with_capacity(scenery.objects.len());
    let mut media = Vec::with_capacity(scenery.objects.len());
    for &object in scenery.objects.iter() {
        let (material, filling) = match (made_of.get(object), slots.get(object)) {
            (Ok(material), _) => (MaterialOfObject::Whole(index(material.0)), fillings[index(material.0) as usize]),
            (_, Ok(slots)) if !slots.0.is_empty() && (fills_only(object) || !index_of.contains_key(&object)) => {
                let slots: Box<[u32]> = slots.0.iter().map(|entity| index(*entity)).collect();
                let own = fillings[index(object) as usize];
                let filling = slots.iter().fold(own, |filling, &slot| filling.or(fillings[slot as usize]));
                (MaterialOfObject::Slots(slots), filling)
            }
            _ => (MaterialOfObject::Whole(index(object)), fillings[index(object) as usize]),
        };
        of_object.push(material);
        media.push(filling.medium());
    }
    let through = |number: &u32| all[*number as usize].is_transparent();
    let passes = |material: &MaterialOfObject| match material {
        MaterialOfObject::Whole(number) => through(number),
        MaterialOfObject::Slots(slots) => slots.iter().any(through),
    };
    let clear: Vec<bool> = of_object.iter().zip(&media).map(|(of, medium)| medium.is_some() || passes(of)).collect();
    parts.parted = clear.contains(&true).then(|| {
        let of = |wanted: bool| scenery.geometry.of_objects(|object| clear[object as usize] == wanted);
        Arc::new(Parted { opaque: of(false), clear: of(true) })
    });
    if media.iter().all(Option::is_none) {
        media.clear();
    }
    let any_transparent = all.iter().any(Material::is_transparent);
    let any_filtered = all.iter().any(Material::is_filtered);
    parts.materials = Arc::new(Materials { all, names, of_object, media, any_transparent, any_filtered });
}

/// Ambient and diffuse strengths of things without a material, and of materials without a term of light.
const PLAIN_STRENGTHS: [f64; 2] = [0.1, 0.9];

/// What things without a material are made of: a matte surface.
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

    /// What is stated of the inside of a body.
    fn filling(&self) -> Filling {
        let clear = self.dielectric.map(|dielectric| dielectric.index);
        let clear = clear.filter(|index| *index <= Dielectric::OPAQUE_INDEX);
        Filling {
            index: clear.or(self.refraction.map(|refraction| refraction.index)),
            absorption: self.absorption.map(|absorption| absorption.0),
            dispersion: self.dispersion.copied(),
            rank: self.rank.map(|rank| rank.0),
        }
    }
}

/// What is stated of the inside of a body.
#[derive(Clone, Copy, Default)]
struct Filling {
    index: Option<f64>,
    absorption: Option<Rgb>,
    dispersion: Option<Dispersion>,
    rank: Option<f64>,
}

impl Filling {
    /// Completed by another where it states nothing.
    fn or(self, other: Self) -> Self {
        Self {
            index: self.index.or(other.index),
            absorption: self.absorption.or(other.absorption),
            dispersion: self.dispersion.or(other.dispersion),
            rank: self.rank.or(other.rank),
        }
    }

    /// The medium, if light goes on in it in any way but as outside.
    fn medium(self) -> Option<Medium> {
        if self.index.is_none() && self.absorption.is_none() {
            return None;
        }
        Some(Medium {
            index: self.index.unwrap_or(1.0),
            absorption: self.absorption.unwrap_or(Rgb::ZERO),
            rank: self.rank.unwrap_or_default(),
            spectrum: self.index.zip(self.dispersion).map(|(index, dispersion)| spectrum(index, dispersion)),
        })
    }
}
