//! What entities take from each other, and whether that makes sense as a whole.

use super::{
    entity::{Part, Relation, Role, Stated},
    include::{Layout, Named},
    source::Report,
};
use crate::registry::Kind;
use glam::DAffine3;
use snell_components::{
    describe::Describe,
    material::{Dielectric, Dispersion, Refraction},
    transform::is_invertible,
};

/// Most names of a circle that are told.
const LONGEST_CIRCLE: usize = 8;

/// An entity with all that it states and takes.
#[derive(Clone, Debug, Default)]
pub(super) struct Whole {
    /// Components: the numbers of the entity that states each, and of the component there.
    pub(super) parts: Vec<(usize, usize)>,
    /// The entity that holds its material.
    pub(super) made_of: Option<usize>,
    /// The entity that places it.
    pub(super) parent: Option<usize>,
    broken: bool,
}

/// The component that a pair of numbers in [`Whole::parts`] means.
pub(super) fn part<'a, 's>(stated: &'a [Stated<'s>], (entity, part): (usize, usize)) -> Option<&'a Part<'s>> {
    stated.get(entity)?.parts.get(part)
}

/// Completes all entities; circles and references to what is not fit for them are reported.
pub(super) fn complete(layout: &Layout<'_>, stated: &[Stated<'_>], report: &mut Report) -> Vec<Whole> {
    let links = Links { layout, stated, report };
    links.complete()
}

struct Links<'a, 's> {
    layout: &'a Layout<'s>,
    stated: &'a [Stated<'s>],
    report: &'a mut Report,
}

impl<'s> Links<'_, 's> {
    fn complete(mut self) -> Vec<Whole> {
        let mut wholes = self.take();
        self.check_materials(&wholes);
        self.check_dispersion(&wholes);
        for (whole, entity) in wholes.iter_mut().zip(&self.layout.entities) {
            // Whoever has no parent in an included file stands where the file stands.
            let placement = self.layout.scopes.get(entity.scope).and_then(|scope| scope.placement);
            whole.parent = whole.parent.or(placement);
        }
        self.check_placements(&wholes);
        wholes
    }

    /// Follows `Like`: what an entity states drops what it takes that cannot stand beside it.
    fn take(&mut self) -> Vec<Whole> {
        let target = |stated: &Stated<'_>, relation| stated.link(relation).map(|link| link.target);
        let like: Vec<_> = self.stated.iter().map(|stated| target(stated, Relation::Like)).collect();
        let mut wholes = vec![Whole::default(); like.len()];
        for number in self.order(&like, Relation::Like) {
            let Some(own) = self.stated.get(number) else { continue };
            let base = like.get(number).copied().flatten().and_then(|base| wholes.get(base)).cloned();
            let base = base.unwrap_or_default();
            let takes = |role: Role<'_>| !own.roles().any(|stated| stated.excludes(role));
            let takes_part = |part: &Part<'_>| takes(Role::Component(part.entry.kind, part.tag));
            let taken = base.parts.into_iter().filter(|at| part(self.stated, *at).is_some_and(takes_part));
            let parts = (0..own.parts.len()).map(|part| (number, part)).chain(taken).collect();
            let relation = |relation, base: Option<usize>| {
                target(own, relation).or(base.filter(|_| takes(Role::Relation(relation))))
            };
            let whole = Whole {
                parts,
                made_of: relation(Relation::MadeOf, base.made_of),
                parent: relation(Relation::Parent, base.parent),
                broken: own.broken || base.broken,
            };
            if let Some(place) = wholes.get_mut(number) {
                *place = whole;
            }
        }
        wholes
    }

    /// Whether an entity has an effect or a texture.
    fn is_material(&self, whole: &Whole) -> bool {
        let mut parts = whole.parts.iter().filter_map(|at| part(self.stated, *at));
        parts.any(|part| matches!(part.entry.kind, Kind::Effect | Kind::Filling | Kind::Texture))
    }

    fn check_materials(&mut self, wholes: &[Whole]) {
        for (entity, stated) in self.layout.entities.iter().zip(self.stated) {
            let Some(link) = stated.link(Relation::MadeOf) else { continue };
            if let (Some(whole), Some(target)) = (wholes.get(link.target), self.layout.entities.get(link.target))
                && !whole.broken
                && !self.is_material(whole)
            {
                let (subject, name) = (entity.written, &target.name);
                let message =
                    format!("{subject:?}: MadeOf: expected an entity with effects of a material: {name:?} has none");
                self.report.add(link.place, message);
            }
        }
    }

    /// Checks that what disperses has an index to disperse.
    fn check_dispersion(&mut self, wholes: &[Whole]) {
        for ((entity, stated), whole) in self.layout.entities.iter().zip(self.stated).zip(wholes) {
            let Some(dispersion) = stated.parts.iter().find(|part| part.tag == Dispersion::TAG) else { continue };
            let mut parts = whole.parts.iter().filter_map(|at| part(self.stated, *at));
            if !whole.broken && !parts.any(|part| [Dielectric::TAG, Refraction::TAG].contains(&part.tag)) {
                let message =
                    format!("{:?}: Dispersion: expected `Refraction` or `Dielectric` beside it", entity.written);
                self.report.add(dispersion.written.place, message);
            }
        }
    }

    /// Checks the products of placements along parents.
    fn check_placements(&mut self, wholes: &[Whole]) {
        let parents: Vec<_> = wholes.iter().map(|whole| whole.parent).collect();
        // `None` where there is a fault already.
        let mut worlds: Vec<Option<DAffine3>> = vec![None; wholes.len()];
        for number in self.order(&parents, Relation::Parent) {
            let (Some(whole), Some(entity)) = (wholes.get(number), self.layout.entities.get(number)) else { continue };
            let mut parts = whole.parts.iter().filter_map(|at| part(self.stated, *at));
            let own = parts.find(|part| part.entry.kind == Kind::Placement);
            let local = own.map_or(Some(DAffine3::IDENTITY), |own| own.placement).filter(|_| !whole.broken);
            let outer = whole.parent.map_or(Some(DAffine3::IDENTITY), |parent| worlds.get(parent).copied().flatten());
            let (Some(local), Some(outer)) = (local, outer) else { continue };
            let world = outer * local;
            if is_invertible(&world) {
                if let Some(place) = worlds.get_mut(number) {
                    *place = Some(world);
                }
            } else {
                let place = own.map_or(entity.place, |own| own.written.place);
                let message = "its placement and those of its parents make one that is singular or not finite";
                self.report.add(place, format!("{:?}: {message}", entity.written));
            }
        }
    }

    /// An order in which everyone comes behind whom it refers to; circles are reported, each once.
    fn order(&mut self, next: &[Option<usize>], relation: Relation) -> Vec<usize> {
        let (order, circles) = order(next);
        for circle in circles {
            self.report_circle(circle, relation);
        }
        order
    }

    fn report_circle(&mut self, mut circle: Vec<usize>, relation: Relation) {
        let entity = |number: &usize| self.layout.entities.get(*number);
        // Told from the one that is written first.
        let place = |number: &usize| entity(number).map(|entity: &Named<'_>| entity.place);
        let first = (0..circle.len()).min_by_key(|i| circle.get(*i).map(place)).unwrap_or_default();
        circle.rotate_left(first);
        let Some(start) = circle.first().copied() else { return };
        let mut names: Vec<_> =
            circle.iter().take(LONGEST_CIRCLE).filter_map(|n| Some(format!("{:?}", entity(n)?.name))).collect();
        if circle.len() > LONGEST_CIRCLE {
            names.push(format!("… {} more", circle.len() - LONGEST_CIRCLE));
        }
        names.extend(names.first().cloned());
        let Some(entity) = entity(&start) else { return };
        let link = self.stated.get(start).and_then(|stated| stated.link(relation));
        let (subject, tag, names) = (entity.written, relation.tag(), names.join(" → "));
        let place = link.map_or(entity.place, |link| link.place);
        self.report.add(place, format!("{subject:?}: {tag}: entities refer to each other in a circle: {names}"));
    }
}

/// An order of all numbers in which each comes behind its next, and the circles that have no such order.
fn order(next: &[Option<usize>]) -> (Vec<usize>, Vec<Vec<usize>>) {
    #[derive(Clone, Copy, PartialEq)]
    enum State {
        Unseen,
        OnPath,
        Done,
    }
    let mut states = vec![State::Unseen; next.len()];
    let (mut order, mut circles) = (Vec::with_capacity(next.len()), vec![]);
    for start in 0..next.len() {
        // No recursion: a chain may be as long as the scene.
        let (mut path, mut at) = (vec![], Some(start));
        while let Some(number) = at.filter(|number| states.get(*number) == Some(&State::Unseen)) {
            states[number] = State::OnPath;
            path.push(number);
            at = next[number];
        }
        if let Some(number) = at.filter(|number| states.get(*number) == Some(&State::OnPath)) {
            circles.push(path.iter().copied().skip_while(|member| *member != number).collect());
        }
        for number in path.into_iter().rev() {
            states[number] = State::Done;
            order.push(number);
        }
    }
    (order, circles)
}
