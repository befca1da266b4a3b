//! What a thing in the scene is called.

use bevy_ecs::prelude::*;
use std::sync::Arc;

/// The name of an entity: unique in a scene, and the key by which everything is ordered.
///
/// Sums over lights, ties between surfaces and the layout of the trees follow the order of names, never the order in
/// which entities were made, so a scene renders to the same bits however it was put together. Entities without a name
/// come after those with one, in the order of their creation.
#[derive(Component, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[component(immutable)]
pub struct Name(Arc<str>);

impl Name {
    /// A name; any text.
    #[must_use]
    pub fn new(name: impl Into<Arc<str>>) -> Self {
        Self(name.into())
    }

    /// The text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl core::fmt::Display for Name {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(&self.0)
    }
}

/// Where an entity stands in the order of everything: names first, in byte order, then nameless entities by age.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rank {
    nameless: bool,
    name: Option<Name>,
    age: u64,
}

impl Rank {
    /// The rank of an entity.
    #[must_use]
    pub fn of(entity: Entity, name: Option<&Name>) -> Self {
        // Not `to_bits`, which holds the index inverted.
        let age = u64::from(entity.generation().to_bits()) << 32 | u64::from(entity.index_u32());
        Self { nameless: name.is_none(), name: name.cloned(), age }
    }

    /// The name, if there is one.
    #[must_use]
    pub fn name(&self) -> Option<&Name> {
        self.name.as_ref()
    }
}
