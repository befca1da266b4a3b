//! Entities of the world from entities of the scene, once all are known to be sound.

use super::{
    entity::{Relation, Stated},
    include::Layout,
    links::{Whole, part},
    source::{Place, Source},
};
use crate::{
    load::{assets::Assets, obj::ModelMaterial},
    registry::{AnyComponent, Kind},
};
use bevy_ecs::prelude::*;
use snell_components::{
    asset::Asset,
    color::Rgb,
    material::{Ambient, Color, Diffuse, MadeOf, MaterialSlots, Mirror, Opacity, Refraction, Transmission},
    name::Name,
    texture::ImageTexture,
    written::{Line, WrittenAt},
};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path,
    sync::Arc,
};

/// An entity that only needs to be made.
pub(super) struct Ready {
    name: String,
    written: WrittenAt,
    components: Vec<Box<dyn AnyComponent>>,
    made_of: Option<usize>,
    parent: Option<usize>,
    /// The model whose materials it shows.
    model: Option<usize>,
}

/// Makes the components of all entities.
pub(super) fn prepare(sources: &[Source], layout: Layout<'_>, stated: &[Stated<'_>], wholes: Vec<Whole>) -> Vec<Ready> {
    let files: Vec<Arc<Path>> = sources.iter().map(|source| source.path.as_path().into()).collect();
    let line = |place: Place| Line {
        file: files.get(place.file).cloned().unwrap_or_else(|| Path::new("").into()),
        number: sources.get(place.file).map_or(0, |source| source.line(place.offset)),
    };
    let mut ready = vec![];
    for (number, (entity, whole)) in layout.entities.into_iter().zip(wholes).enumerate() {
        let (mut components, mut model, mut has_surface) = (vec![], None, whole.made_of.is_some());
        let own = |relation: Relation| Some((relation.tag(), line(stated.get(number)?.link(relation)?.place)));
        let mut lines: Vec<_> = Relation::ALL.into_iter().filter_map(own).collect();
        for part in whole.parts.iter().filter_map(|at| part(stated, *at)) {
            lines.push((part.entry.tag, line(part.written.place)));
            model = model.or(part.model);
            has_surface |= matches!(part.entry.kind, Kind::Effect | Kind::Texture);
            components.extend(part.component.clone());
        }
        ready.push(Ready {
            name: entity.name,
            written: WrittenAt::new(line(entity.place), lines),
            components,
            made_of: whole.made_of,
            parent: whole.parent,
            model: model.filter(|_| !has_surface),
        });
    }
    ready
}

/// Spawns all entities.
pub(super) fn spawn(world: &mut World, ready: Vec<Ready>, assets: &Assets) {
    let entities: Vec<Entity> =
        ready.iter().map(|ready| world.spawn((Name::new(ready.name.as_str()), ready.written.clone())).id()).collect();
    let mut materials: BTreeMap<usize, Vec<Entity>> = BTreeMap::new();
    for (ready, id) in ready.into_iter().zip(&entities) {
        let slots = ready
            .model
            .map(|model| materials.entry(model).or_insert_with(|| spawn_materials(world, model, assets)).clone());
        let mut entity = world.entity_mut(*id);
        for component in ready.components {
            component.insert(&mut entity);
        }
        if let Some(slots) = slots.filter(|slots| !slots.is_empty()) {
            entity.insert(MaterialSlots(slots));
        }
        if let Some(material) = ready.made_of.and_then(|number| entities.get(number)) {
            entity.insert(MadeOf(*material));
        }
        if let Some(parent) = ready.parent.and_then(|number| entities.get(number)) {
            entity.insert(ChildOf(*parent));
        }
    }
}

/// Spawns the materials of a model, by slot.
fn spawn_materials(world: &mut World, model: usize, assets: &Assets) -> Vec<Entity> {
    let Some((path, model)) = assets.model_at(model) else { return vec![] };
    let mut names = BTreeSet::new();
    let mut unique = |material: &ModelMaterial| {
        let mut name = format!("{path}#{}", material.name);
        while !names.insert(name.clone()) {
            name.push('\'');
        }
        name
    };
    model.materials.iter().map(|material| spawn_material(world, unique(material), material)).collect()
}

fn spawn_material(world: &mut World, name: String, material: &ModelMaterial) -> Entity {
    let mut entity = world.spawn(Name::new(name));
    entity.insert((Color(material.color), Ambient(material.ambient), Diffuse(material.diffuse)));
    if let Some(highlight) = material.highlight {
        entity.insert(highlight);
    }
    if let Some(mirror) = material.mirror {
        entity.insert(Mirror(mirror));
    }
    match material.index {
        _ if material.opacity >= 1.0 => {}
        Some(index) => {
            entity.insert((Transmission(Rgb::splat(1.0 - material.opacity)), Refraction { index }));
        }
        None => {
            entity.insert(Opacity { alpha: material.opacity });
        }
    }
    if let Some((path, image)) = &material.texture {
        entity.insert(ImageTexture {
            image: Asset { path: path.clone(), data: Some(image.clone()) },
            ..ImageTexture::default()
        });
    }
    if let Some(line) = &material.line {
        entity.insert(WrittenAt::new(line.clone(), []));
    }
    entity.id()
}
