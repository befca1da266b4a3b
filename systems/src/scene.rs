//! A scene by value, apart from any world: what a scene file says, and what an editor changes and keeps for undoing.
//!
//! [`Scene::of`] copies it out of a world, [`Thing::put`] brings an entity of a world to the state of a thing, and
//! [`Scene::to_text`] writes it as a scene file.

use crate::{
    load::MODEL_MARK,
    registry::{AnyComponent, Kind, Registry},
    save,
};
use bevy_ecs::prelude::*;
use snell_components::{
    describe::Describe,
    material::{MadeOf, MaterialSlots},
    name::{Name, Rank},
    settings::Settings,
    transform::Transform,
};
use std::{collections::BTreeMap, sync::Arc};

/// Settings and named things.
#[derive(Clone, Default)]
pub struct Scene {
    /// How the picture is taken.
    pub settings: Settings,
    /// Everything else, in the order in which it is written; each name stands once. Shared: a copy of a scene is cheap.
    pub things: Vec<(Name, Arc<Thing>)>,
}

/// One entity: its components and what it refers to.
#[derive(Clone, Default)]
pub struct Thing {
    /// Components by tag.
    pub components: BTreeMap<&'static str, Box<dyn AnyComponent>>,
    /// The entity that holds its material.
    pub made_of: Option<Name>,
    /// The entity in whose space it is placed.
    pub parent: Option<Name>,
    /// The materials of its model, by slot; they are shown only while it has no surface of its own.
    pub slots: Vec<Name>,
}

/// Whether a name is one that the loader gives to the material of a model, which comes with the model's file.
#[must_use]
pub fn is_of_model(name: &Name) -> bool {
    name.as_str().contains(MODEL_MARK)
}

impl Scene {
    /// The scene that a world holds, oldest entities first. Entities without a name get one that keeps their place in the
    /// order of everything.
    #[must_use]
    pub fn of(world: &World) -> Self {
        let empty = Registry::default();
        let registry = world.get_resource().unwrap_or(&empty);
        let mut ranked: Vec<(Rank, EntityRef<'_>)> = world
            .try_query::<EntityRef<'_>>()
            .map(|mut query| query.iter(world).map(|entity| (Rank::of(entity.id(), entity.get()), entity)).collect())
            .unwrap_or_default();
        ranked.retain(|(rank, entity)| {
            rank.name().is_some() || registry.entries().any(|(_, entry)| (entry.get)(*entity).is_some())
        });
        ranked.sort_by(|a, b| a.0.cmp(&b.0));
        let names = names(&ranked);
        let mut things: Vec<_> = ranked
            .iter()
            .filter_map(|(_, entity)| {
                Some((names.get(&entity.id())?.clone(), Arc::new(Thing::of(*entity, registry, &names))))
            })
            .zip(ranked.iter().map(|(_, entity)| Rank::of(entity.id(), None)))
            .collect();
        things.sort_by(|a, b| a.1.cmp(&b.1));
        let settings = world.get_resource().cloned().unwrap_or_default();
        Self { settings, things: things.into_iter().map(|(thing, _)| thing).collect() }
    }

    /// The thing of a name.
    #[must_use]
    pub fn get(&self, name: &Name) -> Option<&Thing> {
        self.things.iter().find(|(known, _)| known == name).map(|(_, thing)| &**thing)
    }

    /// The text of a scene file that reads back to the same scene, to the last bit of every number.
    ///
    /// # Errors
    /// All that no scene file can say.
    pub fn to_text(&self, registry: &Registry) -> Result<String, save::Unsayable> {
        save::scene_text(self, registry)
    }

    /// The same without what no scene file can say, and all of that: what there is to keep of any scene.
    #[must_use]
    pub fn to_text_in_part(&self, registry: &Registry) -> (String, save::Unsayable) {
        save::scene_text_in_part(self, registry)
    }
}

/// A name for every entity, given in the order of everything.
fn names(ranked: &[(Rank, EntityRef<'_>)]) -> BTreeMap<Entity, Name> {
    // Nameless entities come after those with names: so must the names that are made up.
    let last = ranked.iter().rev().find_map(|(rank, _)| rank.name()).map_or("", Name::as_str);
    let start = if last < "~" { "~" } else { &format!("{last}~") };
    let width = ranked.len().to_string().len();
    let name = |(number, (rank, entity)): (usize, &(Rank, EntityRef<'_>))| {
        let made_up = || Name::new(format!("{start}{number:0width$}"));
        (entity.id(), rank.name().cloned().unwrap_or_else(made_up))
    };
    ranked.iter().enumerate().map(name).collect()
}

impl Thing {
    /// A thing with one component more, or another in place of the one of its type.
    #[must_use]
    pub fn with(mut self, component: impl AnyComponent + 'static) -> Self {
        self.components.insert(component.tag(), Box::new(component));
        self
    }

    /// A component of a type.
    #[must_use]
    pub fn get<C: Describe + Component>(&self) -> Option<&C> {
        self.components.get(C::TAG)?.as_any().downcast_ref()
    }

    /// What an entity holds; `names` are those of all entities.
    fn of(entity: EntityRef<'_>, registry: &Registry, names: &BTreeMap<Entity, Name>) -> Self {
        let name = |entity: Entity| names.get(&entity).cloned();
        let components = registry.entries().filter_map(|(tag, entry)| Some((tag, (entry.get)(entity)?)));
        let slots = entity.get::<MaterialSlots>().map(|slots| slots.0.iter().filter_map(|slot| name(*slot)).collect());
        let mut this = Self {
            components: components.collect(),
            made_of: entity.get::<MadeOf>().and_then(|of| name(of.0)),
            parent: entity.get::<ChildOf>().and_then(|of| name(of.parent())),
            slots: slots.unwrap_or_default(),
        };
        // Shapes, lights and the camera have a placement whether or not it was stated.
        if entity.get::<Transform>().is_some_and(|placement| placement.0.is_empty()) {
            this.components.remove(Transform::TAG);
        }
        this
    }

    /// Whether the thing says what its surface is like, so that the materials of its model are not shown.
    #[must_use]
    pub fn has_surface(&self, registry: &Registry) -> bool {
        let mut kinds = self.components.keys().filter_map(|tag| registry.get(tag)).map(|entry| entry.kind);
        self.made_of.is_some() || kinds.any(|kind| matches!(kind, Kind::Effect | Kind::Texture))
    }

    /// Brings an entity from one state (nothing, for a new entity) to this one, touching only what differs; `find` gives
    /// the entity of a name.
    pub fn put(&self, before: &Self, entity: &mut EntityWorldMut<'_>, find: impl Fn(&Name) -> Option<Entity>) {
        let registry = entity.world().resource::<Registry>().clone();
        for (tag, entry) in registry.entries() {
            match (before.components.get(tag), self.components.get(tag)) {
                (Some(_), None) if tag == Transform::TAG => {
                    entity.insert(Transform::default());
                }
                (Some(_), None) => (entry.remove)(entity),
                (Some(old), Some(new)) if save::same(old.as_ref(), new.as_ref()) => {}
                (_, Some(new)) => new.clone().insert(entity),
                (None, None) => {}
            }
        }
        let [old, new] = [before, self].map(|thing| thing.shown_slots(&registry));
        if old != new {
            match new {
                Some(slots) => entity.insert(MaterialSlots(slots.iter().filter_map(&find).collect())),
                None => entity.remove::<MaterialSlots>(),
            };
        }
        if before.made_of != self.made_of {
            match self.made_of.as_ref().and_then(&find) {
                Some(material) => entity.insert(MadeOf(material)),
                None => entity.remove::<MadeOf>(),
            };
        }
        if before.parent != self.parent {
            match self.parent.as_ref().and_then(&find) {
                Some(parent) => entity.insert(ChildOf(parent)),
                None => entity.remove::<ChildOf>(),
            };
        }
    }

    /// The materials of the model where they are shown.
    fn shown_slots(&self, registry: &Registry) -> Option<&[Name]> {
        (!self.slots.is_empty() && !self.has_surface(registry)).then_some(&self.slots)
    }
}

impl PartialEq for Thing {
    fn eq(&self, other: &Self) -> bool {
        let relations = |thing: &Self| (thing.made_of.clone(), thing.parent.clone(), thing.slots.clone());
        relations(self) == relations(other)
            && self.components.len() == other.components.len()
            && self
                .components
                .iter()
                .zip(&other.components)
                .all(|(a, b)| a.0 == b.0 && save::same(a.1.as_ref(), b.1.as_ref()))
    }
}
