//! Where things are written: the lines of files that entities were read from.

use bevy_ecs::prelude::*;
use std::{fmt, path::Path, sync::Arc};

/// A line of a text file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Line {
    /// The file, as the user gave it or as found from there.
    pub file: Arc<Path>,
    /// From 1.
    pub number: usize,
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.file.display(), self.number)
    }
}

/// Where an entity was read from; entities made by a program have none. Written by the loader alone.
#[derive(Component, Clone, Debug, PartialEq, Eq)]
#[component(immutable)]
pub struct WrittenAt {
    line: Line,
    components: Box<[(&'static str, Line)]>,
}

impl WrittenAt {
    /// An entity with the line of its name, and its components by tag with theirs.
    #[must_use]
    pub fn new(line: Line, components: impl IntoIterator<Item = (&'static str, Line)>) -> Self {
        Self { line, components: components.into_iter().collect() }
    }

    /// The line of the entity.
    #[must_use]
    pub fn line(&self) -> &Line {
        &self.line
    }

    /// The line of the component with a tag, if it was read with the entity; it may be in another's place, from which the
    /// entity takes it.
    #[must_use]
    pub fn line_of(&self, tag: &str) -> Option<&Line> {
        self.components.iter().find(|(known, _)| *known == tag).map(|(_, line)| line)
    }
}
