//! The open set of components that a scene may name.

use bevy_ecs::prelude::*;
use snell_components::describe::{Describe, Fault, FieldVisitor};
use std::{any::Any, collections::BTreeMap};

/// What a component makes of its entity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
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
    /// Whether the entity is seen.
    Visibility,
}

/// Why two components, by kind and tag, cannot stand on one entity; nothing if they can.
#[must_use]
pub fn conflict(one: (Kind, &str), other: (Kind, &str)) -> Option<&'static str> {
    use Kind::{Shape, Texture};
    const REPLACED: [&str; 3] = ["Mirror", "Transmission", "Refraction"];
    match (one, other) {
        ((Shape, _), (Shape, _)) => Some("an entity has one shape at most"),
        ((Texture, _), (Texture, _)) => Some("an entity has one texture at most"),
        ((_, "Dielectric"), (_, tag)) | ((_, tag), (_, "Dielectric")) if REPLACED.contains(&tag) => {
            Some("`Dielectric` takes the place of `Mirror`, `Transmission` and `Refraction`")
        }
        _ => None,
    }
}

/// A component of any registered type, by value: what scene files, editors and bindings hold of an entity.
pub trait AnyComponent: Send + Sync {
    /// The tag in scene files.
    fn tag(&self) -> &'static str;

    /// Shows every field, in the order of the description.
    fn visit(&mut self, fields: &mut dyn FieldVisitor);

    /// Checks the fields against each other.
    ///
    /// # Errors
    /// The fault, at one of the fields.
    fn validate(&self) -> Result<(), Fault>;

    /// A copy; files that the component holds are shared.
    fn copy(&self) -> Box<dyn AnyComponent>;

    /// Puts the component onto an entity, in place of the one of its type.
    fn insert(self: Box<Self>, entity: &mut EntityWorldMut<'_>);

    /// The component as what it is.
    fn as_any(&self) -> &dyn Any;
}

impl Clone for Box<dyn AnyComponent> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

impl<C: Describe + Component> AnyComponent for C {
    fn tag(&self) -> &'static str {
        C::TAG
    }

    fn visit(&mut self, fields: &mut dyn FieldVisitor) {
        self.describe(fields);
    }

    fn validate(&self) -> Result<(), Fault> {
        self.check()
    }

    fn copy(&self) -> Box<dyn AnyComponent> {
        Box::new(self.clone())
    }

    fn insert(self: Box<Self>, entity: &mut EntityWorldMut<'_>) {
        entity.insert(*self);
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

/// What can be done with components of one type.
#[derive(Clone, Copy)]
pub struct Entry {
    /// The tag.
    pub tag: &'static str,
    /// What the component makes of its entity.
    pub kind: Kind,
    /// A component with the default of every field.
    pub new: fn() -> Box<dyn AnyComponent>,
    /// A copy of an entity's component.
    pub get: fn(EntityRef<'_>) -> Option<Box<dyn AnyComponent>>,
    /// Takes the component off an entity.
    pub remove: fn(&mut EntityWorldMut<'_>),
}

impl Entry {
    /// Shows the fields of a new component to a visitor and checks them against each other.
    pub fn read(&self, fields: &mut dyn FieldVisitor) -> (Box<dyn AnyComponent>, Result<(), Fault>) {
        let mut component = (self.new)();
        component.visit(fields);
        let checked = component.validate();
        (component, checked)
    }
}

/// Components by tag; ordered, so that messages are the same every time.
#[derive(Resource, Default, Clone)]
pub struct Registry(BTreeMap<&'static str, Entry>);

impl Registry {
    /// Makes a component known under its tag.
    ///
    /// # Panics
    /// If the tag is taken: two types under one name are a fault of the program, not of a scene.
    pub(crate) fn register<C: Describe + Component>(&mut self, kind: Kind) {
        let entry = Entry {
            tag: C::TAG,
            kind,
            new: || Box::new(C::default()),
            get: |entity| Some(Box::new(entity.get::<C>()?.clone())),
            remove: |entity| {
                entity.remove::<C>();
            },
        };
        let taken = self.0.insert(C::TAG, entry);
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

    /// All tags with their entries, in order.
    pub fn entries(&self) -> impl Iterator<Item = (&'static str, &Entry)> {
        self.0.iter().map(|(tag, entry)| (*tag, entry))
    }
}
