//! Entities: the components that each states, which of them may stand together, and what it refers to.

use super::{
    component::{self, Given, Written},
    include::{Content, Layout, Named},
    node::{Form, Node},
    source::{Place, Report, Source, did_you_mean, excerpt, listed},
};
use crate::{
    load::assets::Assets,
    registry::{self, AnyComponent, Entry, Kind, Registry},
};
use glam::DAffine3;
use snell_components::{describe::Describe, transform::Transform};
use std::collections::BTreeMap;

/// How entities refer to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Relation {
    /// Takes the other's components.
    Like,
    /// The other is its material.
    MadeOf,
    /// The other's placement places it.
    Parent,
}

impl Relation {
    pub(super) const ALL: [Self; 3] = [Self::Like, Self::MadeOf, Self::Parent];

    pub(super) fn tag(self) -> &'static str {
        match self {
            Self::Like => "Like",
            Self::MadeOf => "MadeOf",
            Self::Parent => "Parent",
        }
    }
}

/// What a component is in the rules of what may stand together.
#[derive(Clone, Copy, Debug)]
pub(super) enum Role<'t> {
    Component(Kind, &'t str),
    Relation(Relation),
}

impl Role<'_> {
    /// Why two cannot stand on one entity; nothing if they can.
    fn conflict(self, other: Self) -> Option<&'static str> {
        use Kind::{Effect, Filling, Texture};
        match (self, other) {
            (Self::Component(kind, tag), Self::Component(other_kind, other)) => {
                registry::conflict((kind, tag), (other_kind, other))
            }
            (Self::Component(Effect | Filling | Texture, _), Self::Relation(Relation::MadeOf))
            | (Self::Relation(Relation::MadeOf), Self::Component(Effect | Filling | Texture, _)) => {
                Some("an entity has a material of its own or that of another, not both")
            }
            _ => None,
        }
    }

    fn tag(&self) -> &str {
        match self {
            Self::Component(_, tag) => tag,
            Self::Relation(relation) => relation.tag(),
        }
    }

    /// Whether the two cannot stand on one entity.
    pub(super) fn excludes(self, other: Self) -> bool {
        self.tag() == other.tag() || self.conflict(other).is_some()
    }
}

/// A registered component that an entity states.
pub(super) struct Part<'s> {
    pub(super) tag: &'s str,
    pub(super) entry: Entry,
    pub(super) written: Written<'s>,
    /// What was read; nothing if something is wrong with it.
    pub(super) component: Option<Box<dyn AnyComponent>>,
    pub(super) placement: Option<DAffine3>,
    pub(super) model: Option<usize>,
}

/// A reference to another entity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    pub(super) place: Place,
    /// The other's number.
    pub(super) target: usize,
}

/// An entity as stated.
pub(super) struct Stated<'s> {
    pub(super) parts: Vec<Part<'s>>,
    /// By [`Relation`].
    pub(super) links: [Option<Link>; 3],
    /// Whether something is wrong with it, so that what follows from it is not worth saying.
    pub(super) broken: bool,
}

impl Stated<'_> {
    pub(super) fn link(&self, relation: Relation) -> Option<Link> {
        self.links[relation as usize]
    }

    /// All that the entity states.
    pub(super) fn roles(&self) -> impl Iterator<Item = Role<'_>> {
        let parts = self.parts.iter().map(|part| Role::Component(part.entry.kind, part.tag));
        let links = Relation::ALL.into_iter().filter(|relation| self.link(*relation).is_some());
        parts.chain(links.map(Role::Relation))
    }
}

/// Reads entities.
pub(super) struct Reader<'a, 's> {
    pub(super) registry: &'a Registry,
    pub(super) layout: &'a Layout<'s>,
    pub(super) sources: &'s [Source],
    pub(super) assets: &'a mut Assets,
    pub(super) report: &'a mut Report,
    /// Names that were looked up and not found, by scope, with what may have been meant: one misspelt material of many
    /// objects is searched for once.
    pub(super) unknown: BTreeMap<(usize, String), String>,
}

impl<'s> Reader<'_, 's> {
    /// Reads one entity; what is wrong is reported and left out.
    pub(super) fn entity(&mut self, entity: &Named<'s>) -> Stated<'s> {
        let mut stated = Stated { parts: vec![], links: [None; 3], broken: false };
        let Some(source) = self.sources.get(entity.place.file) else { return stated };
        match entity.content {
            Content::Steps(steps) => {
                let written = Written { source, place: entity.place, given: Given::Value(steps) };
                self.part(&mut stated, Transform::TAG, written, "include.transform");
            }
            Content::Components(components) => {
                let mut tags = vec![];
                for node in components {
                    let place = Place { offset: node.span.start, ..entity.place };
                    let written = Written { source, place, given: Given::of(node) };
                    let known = self.tag(entity, node, written, &mut tags);
                    stated.broken |= known.is_none();
                    if let Some((tag, role)) = known {
                        self.component(&mut stated, entity, (tag, role), written);
                    }
                }
            }
        }
        stated
    }

    /// The tag of a component and what it is, if it is known and not among the `tags` so far, to which it is added.
    fn tag(
        &mut self,
        entity: &Named<'s>,
        node: &Node,
        written: Written<'s>,
        tags: &mut Vec<(&'s str, Place)>,
    ) -> Option<(&'s str, Role<'s>)> {
        let (source, place, subject) = (written.source, written.place, entity.written);
        let Some(tag) = node.tag(&source.text) else {
            let found = excerpt(node.text(&source.text));
            let message = format!("{subject:?}: expected a component, as `Sphere(radius: 1)`, found {found}");
            self.report.add(place, message);
            return None;
        };
        if let Some((_, first)) = tags.iter().find(|(known, _)| *known == tag) {
            let line = source.line(first.offset);
            self.report.add(place, format!("{subject:?}: `{tag}` is given twice, first in line {line}"));
            return None;
        }
        let relation = Relation::ALL.into_iter().find(|relation| relation.tag() == tag).map(Role::Relation);
        let role = relation.or_else(|| Some(Role::Component(self.registry.get(tag)?.kind, tag)));
        if role.is_none() {
            let known = || self.registry.tags().chain(Relation::ALL.map(Relation::tag));
            let near = did_you_mean(tag, known());
            let near = if near.is_empty() { format!("; known are {}", listed(known(), "and")) } else { near };
            self.report.add(place, format!("{subject:?}: unknown component {}{near}", excerpt(tag)));
        } else {
            tags.push((tag, place));
        }
        Some((tag, role?))
    }

    /// Reads one component.
    fn component(
        &mut self,
        stated: &mut Stated<'s>,
        entity: &Named<'s>,
        (tag, role): (&'s str, Role<'_>),
        written: Written<'s>,
    ) {
        let subject = format!("{:?}", entity.written);
        let conflict = stated.roles().find_map(|before| Some((before.tag().to_owned(), role.conflict(before)?)));
        if let Some((before, why)) = conflict {
            self.report.add(written.place, format!("{subject}: `{tag}` beside `{before}`: {why}"));
        }
        match role {
            Role::Component(..) => self.part(stated, tag, written, &format!("{subject}: {tag}")),
            Role::Relation(relation) => {
                let link = self.link(entity, written, &subject, relation);
                stated.broken |= link.is_none();
                stated.links[relation as usize] = link;
            }
        }
    }

    /// Reads a registered component.
    fn part(&mut self, stated: &mut Stated<'s>, tag: &'s str, written: Written<'s>, subject: &str) {
        let Some(entry) = self.registry.get(tag).copied() else { return };
        let filled = component::fill(written, subject, self.assets, self.report, |fields| entry.read(fields));
        stated.broken |= filled.is_none();
        let (component, placement, model) = match filled {
            Some(filled) => (Some(filled.value), filled.placement, filled.model),
            None => (None, None, None),
        };
        stated.parts.push(Part { tag, entry, written, component, placement, model });
    }

    /// Reads a reference.
    fn link(&mut self, entity: &Named<'s>, written: Written<'s>, subject: &str, relation: Relation) -> Option<Link> {
        let (text, place, tag) = (&written.source.text, written.place, relation.tag());
        let node = match written.given {
            Given::Value(node) if matches!(node.form, Form::Text) => node,
            _ => {
                self.report.add(place, format!("{subject}: {tag}: expected a name in quotes, as `{tag}(\"name\")`"));
                return None;
            }
        };
        let name = node.string(text)?;
        let place = Place { offset: node.span.start, ..place };
        let target = self.layout.resolve(entity.scope, &name);
        if target.is_none() {
            let unknown = self.unknown.entry((entity.scope, name.clone()));
            let near = unknown.or_insert_with(|| did_you_mean(&name, self.layout.names(entity.scope)));
            self.report.add(place, format!("{subject}: {tag}: there is no entity {name:?}{near}"));
        }
        Some(Link { place, target: target? })
    }
}
