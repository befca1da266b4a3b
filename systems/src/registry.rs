//! The open set of components that a scene may name.

use bevy_ecs::prelude::*;
use snell_components::describe::{Describe, Fault, FieldVisitor};
use std::collections::BTreeMap;

/// What a component makes of its entity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A shape: at most one on an entity.
    Shape,
    /// A light.
    Light,
    /// A texture: at most one on an entity.
    Texture,
    /// An optical effect of a material.
    Effect,
    /// An effect of what fills a body; its surface may be made of other materials.
    Filling,
    /// The camera.
    Camera,
    /// Where the entity is.
    Placement,
}

/// Puts a component that was read onto its entity.
pub type Insert = Box<dyn FnOnce(&mut EntityWorldMut<'_>) + Send>;

/// How a component of one type is read.
#[derive(Clone, Copy)]
pub struct Entry {
    /// The tag.
    pub tag: &'static str,
    /// What the component makes of its entity.
    pub kind: Kind,
    /// Shows the fields of a new component to a visitor, checks them against each other, and gives the component to be
    /// inserted once the whole scene is known to be sound.
    pub read: fn(&mut dyn FieldVisitor) -> (Insert, Result<(), Fault>),
}

/// Components by tag; ordered, so that messages are the same every time.
#[derive(Resource, Default)]
pub struct Registry(BTreeMap<&'static str, Entry>);

impl Registry {
    /// Makes a component known under its tag.
    ///
    /// # Panics
    /// If the tag is taken: two types under one name are a fault of the program, not of a scene.
    pub(crate) fn register<C: Describe + Component>(&mut self, kind: Kind) {
        let read = |fields: &mut dyn FieldVisitor| {
            let mut component = C::default();
            component.describe(fields);
            let checked = component.check();
            let insert: Insert = Box::new(move |entity| {
                entity.insert(component);
            });
            (insert, checked)
        };
        let taken = self.0.insert(C::TAG, Entry { tag: C::TAG, kind, read });
        assert!(taken.is_none(), "the tag `{}` is registered twice", C::TAG);
    }

    /// The entry of a tag.
    #[must_use]
    pub fn get(&self, tag: &str) -> Option<&Entry> {
        self.0.get(tag)
    }

    /// All tags, in order.
    pub fn tags(&self) -> impl Iterator<Item = &'static str> {
        self.0.keys().copied()
    }
}
