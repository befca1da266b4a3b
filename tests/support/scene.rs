//! Scenes as lists of named things, so that the same scene can be put together in any order.

use super::random::Random;
use snell::prelude::*;
use std::collections::BTreeMap;

/// The entities of a scene by name.
pub(crate) type Entities = BTreeMap<String, Entity>;

/// Gives an entity its components; may refer to any other by name.
type Put = Box<dyn Fn(&mut EntityWorldMut<'_>, &Entities)>;

/// Settings and named things.
#[derive(Default)]
pub(crate) struct Scene {
    pub(crate) name: &'static str,
    pub(crate) settings: Settings,
    things: Vec<(String, Put)>,
}

impl Scene {
    /// An empty scene.
    pub(crate) fn new(name: &'static str, settings: Settings) -> Self {
        Self { name, settings, things: vec![] }
    }

    /// Adds a thing.
    pub(crate) fn put<B: Bundle + Clone>(&mut self, name: impl Into<String>, bundle: B) {
        let put = move |entity: &mut EntityWorldMut<'_>, _: &Entities| {
            entity.insert(bundle.clone());
        };
        self.things.push((name.into(), Box::new(put)));
    }

    /// Adds an object made of the material of that name.
    pub(crate) fn put_of<B: Bundle + Clone>(&mut self, name: impl Into<String>, material: &'static str, bundle: B) {
        let put = move |entity: &mut EntityWorldMut<'_>, all: &Entities| {
            entity.insert((bundle.clone(), MadeOf(all[material])));
        };
        self.things.push((name.into(), Box::new(put)));
    }

    /// Adds an object made of several materials, by slot.
    pub(crate) fn put_slots<B: Bundle + Clone>(&mut self, name: &str, materials: &'static [&str], bundle: B) {
        let put = move |entity: &mut EntityWorldMut<'_>, all: &Entities| {
            entity.insert((bundle.clone(), MaterialSlots(materials.iter().map(|name| all[*name]).collect())));
        };
        self.things.push((name.into(), Box::new(put)));
    }

    /// Adds an object made of a material, placed in the space of another entity.
    pub(crate) fn put_in<B: Bundle + Clone>(
        &mut self,
        name: impl Into<String>,
        parent: &'static str,
        material: &'static str,
        bundle: B,
    ) {
        let put = move |entity: &mut EntityWorldMut<'_>, all: &Entities| {
            entity.insert((bundle.clone(), MadeOf(all[material]), ChildOf(all[parent])));
        };
        self.things.push((name.into(), Box::new(put)));
    }

    /// A world with the scene in it; `order` 0 makes the things in the order in which they were put, any other number
    /// shuffles both the making of the entities and the giving of components.
    pub(crate) fn build(&self, order: u64) -> (Renderer, Entities) {
        self.build_in(Renderer::new(), order)
    }

    /// The same in a world of one's own.
    pub(crate) fn build_in(&self, mut renderer: Renderer, order: u64) -> (Renderer, Entities) {
        let mut random = Random::new(order);
        let mut shuffled = || {
            let mut indices: Vec<usize> = (0..self.things.len()).collect();
            if order != 0 {
                for i in (1..indices.len()).rev() {
                    indices.swap(i, random.below(i + 1));
                }
            }
            indices
        };
        *renderer.settings() = self.settings.clone();
        let mut entities = Entities::new();
        for i in shuffled() {
            let name = &self.things[i].0;
            let entity = renderer.world.spawn(Name::new(name.as_str())).id();
            assert!(entities.insert(name.clone(), entity).is_none(), "two things are named {name}");
        }
        for i in shuffled() {
            let (name, put) = &self.things[i];
            put(&mut renderer.world.entity_mut(entities[name]), &entities);
        }
        (renderer, entities)
    }
}
