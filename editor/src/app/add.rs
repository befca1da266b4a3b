//! What can be added to a scene, and what it is at first.

use super::names::words;
use crate::document::{Document, Edit};
use snell::{
    components::{
        camera::Camera,
        describe::{Describe, FieldVisitor, Spec, Value},
        name::Name,
        transform::Transform,
    },
    prelude::{
        Absorption, Ambient, Color, DVec2, DVec3, Dielectric, Diffuse, Highlight, Lathe, Mirror, Opacity, Rgb, Step,
        Triangle,
    },
    systems::{
        registry::{AnyComponent, Kind, Registry},
        scene::Thing,
    },
};

/// A material that is ready: what it is called, what it is like, and its effects.
pub(super) struct Look {
    pub(super) name: &'static str,
    pub(super) about: &'static str,
    pub(super) put: fn(Thing) -> Thing,
}

/// Materials to begin with.
pub(super) const LOOKS: &[Look] = &[
    Look {
        name: "Matte",
        about: "Like clay or paper",
        put: |thing| thing.with(Color(Rgb::splat(0.8))).with(Ambient(Rgb::splat(0.3))).with(Diffuse(Rgb::splat(0.8))),
    },
    Look {
        name: "Shiny",
        about: "Like plastic: with a highlight",
        put: |thing| {
            let highlight = Highlight { strength: Rgb::splat(0.6), exponent: 60.0 };
            thing
                .with(Color(Rgb::new(0.8, 0.25, 0.2)))
                .with(Ambient(Rgb::splat(0.3)))
                .with(Diffuse(Rgb::splat(0.8)))
                .with(highlight)
        },
    },
    Look {
        name: "Mirror",
        about: "Shows what is around it",
        put: |thing| {
            let highlight = Highlight { strength: Rgb::splat(0.7), exponent: 200.0 };
            thing
                .with(Ambient(Rgb::splat(0.02)))
                .with(Diffuse(Rgb::splat(0.05)))
                .with(Mirror(Rgb::splat(0.88)))
                .with(highlight)
        },
    },
    Look { name: "Glass", about: "Clear, bends the light", put: |thing| thing.with(Dielectric { index: 1.5 }) },
    Look {
        name: "Coloured glass",
        about: "Clear, swallows some of the light on its way",
        put: |thing| thing.with(Dielectric { index: 1.5 }).with(Absorption(Rgb::new(0.2, 0.6, 1.4))),
    },
    Look {
        name: "See-through",
        about: "Half of what lies behind shows, straight",
        put: |thing| {
            let highlight = Highlight { strength: Rgb::splat(0.4), exponent: 60.0 };
            thing
                .with(Color(Rgb::new(0.35, 0.55, 0.85)))
                .with(Ambient(Rgb::splat(0.4)))
                .with(Diffuse(Rgb::splat(0.7)))
                .with(highlight)
                .with(Opacity { alpha: 0.5 })
        },
    },
];

/// The thing with another look in place of all that says what its surface is like and what fills it.
pub(super) fn with_look(thing: &Thing, look: &Look, registry: &Registry) -> Thing {
    let mut thing = thing.clone();
    let is_surface =
        |tag: &str| registry.get(tag).is_some_and(|entry| matches!(entry.kind, Kind::Effect | Kind::Filling));
    thing.components.retain(|tag, _| !is_surface(tag));
    (look.put)(thing)
}

/// Whether a tag is of what a material consists of.
pub(super) fn is_of_material(tag: &str, registry: &Registry) -> bool {
    registry.get(tag).is_some_and(|entry| matches!(entry.kind, Kind::Effect | Kind::Filling | Kind::Texture))
}

/// A thing made of a material that is shared, or of its own again, which is then a copy of what it was made of.
pub(super) fn made_of(document: &Document, thing: &Thing, material: Option<Name>) -> Thing {
    let registry = document.registry();
    let mut new = thing.clone();
    match (&material, &thing.made_of) {
        (None, Some(before)) => {
            let before = document.get(before).map(|before| before.components.clone()).unwrap_or_default();
            new.components.extend(before.into_iter().filter(|(tag, _)| is_of_material(tag, registry)));
        }
        // A thing has a material of its own or that of another, not both.
        (Some(_), _) => new.components.retain(|tag, _| !is_of_material(tag, registry)),
        (None, None) => {}
    }
    new.made_of = material;
    new
}

/// A component as it is when it is added.
pub(super) fn fresh(tag: &str, registry: &Registry) -> Option<Box<dyn AnyComponent>> {
    let mut plain = (registry.get(tag)?.new)();
    plain.visit(&mut Mender);
    // Some shapes are nothing until they have points.
    Some(match tag {
        Lathe::TAG => {
            let profile = [(0.0, 0.0), (0.5, 0.0), (0.55, 0.4), (0.3, 0.8), (0.35, 1.2), (0.0, 1.2)];
            Box::new(Lathe { profile: profile.map(|(r, y)| DVec2::new(r, y)).to_vec(), ..Lathe::default() })
        }
        Triangle::TAG => Box::new(triangle()),
        _ => plain,
    })
}

/// Gives fields that a scene must state, and whose default no scene may state, a number that it may.
struct Mender;

impl FieldVisitor for Mender {
    fn field(&mut self, _: &'static str, value: Value<'_>, spec: Spec) {
        let mend = |x: &mut f64| {
            if !spec.range.contains(*x) {
                *x = super::fields::start_number(spec.range);
            }
        };
        match value {
            Value::Number(x) => mend(x),
            Value::Vector(v) => v.as_mut().iter_mut().for_each(mend),
            _ => {}
        }
    }
}

/// A triangle that stands upright.
fn triangle() -> Triangle {
    Triangle { a: DVec3::new(-1.0, 0.0, 0.0), b: DVec3::X, c: DVec3::new(0.0, 1.6, 0.0), ..Triangle::default() }
}

/// Whether a component has a place of its own, so that it needs none besides.
struct Places(Option<DVec3>);

impl FieldVisitor for Places {
    fn field(&mut self, name: &'static str, value: Value<'_>, _: Spec) {
        if let (true, Value::Vector(v)) = (name == "position", value) {
            self.0 = Some(*v);
        }
    }
}

/// The `position` of a component, if it has one.
pub(super) fn position(component: &dyn AnyComponent) -> Option<DVec3> {
    let mut places = Places(None);
    component.copy().visit(&mut places);
    places.0
}

/// Sets the `position` of a component that has one.
pub(super) fn set_position(component: &mut dyn AnyComponent, to: DVec3) {
    struct Setter(DVec3);
    impl FieldVisitor for Setter {
        fn field(&mut self, name: &'static str, value: Value<'_>, _: Spec) {
            if let (true, Value::Vector(v)) = (name == "position", value) {
                *v = self.0;
            }
        }
    }
    component.visit(&mut Setter(to));
}

/// An edit that adds a thing with a component, placed where the camera looks, and the thing's name.
pub(super) fn component(document: &Document, tag: &str, at: DVec3) -> Option<(Edit, Name)> {
    let registry = document.registry();
    let kind = registry.get(tag)?.kind;
    let mut made = fresh(tag, registry)?;
    let name = document.free_name(&words(tag));
    let mut thing = Thing::default();
    match kind {
        Kind::Shape => {
            // Planes are the ground.
            if tag != "Plane" && at != DVec3::ZERO {
                thing = thing.with(Transform::new([Step::Translate(at)]));
            }
            thing = (LOOKS[0].put)(thing);
        }
        Kind::Light if position(made.as_ref()).is_some() => {
            set_position(made.as_mut(), at + DVec3::new(2.0, 4.0, 3.0));
        }
        _ => {}
    }
    thing.components.insert(made.tag(), made);
    Some((Edit::new(format!("Add {}", name.as_str())).put(&name, thing), name))
}

/// An edit that adds a material, and its name.
pub(super) fn material(document: &Document, look: &Look) -> (Edit, Name) {
    let name = document.free_name(look.name);
    (Edit::of(format!("Add {}", name.as_str()), &name, (look.put)(Thing::default())), name)
}

/// An edit that adds a camera that sees the middle of the scene, and its name.
pub(super) fn camera(document: &Document) -> (Edit, Name) {
    let name = document.free_name("Camera");
    let camera =
        Camera { position: DVec3::new(0.0, 2.0, 7.0), target: Some(DVec3::new(0.0, 0.7, 0.0)), ..Camera::default() };
    (Edit::of("Add camera", &name, Thing::default().with(camera)), name)
}

/// An edit that adds a thing that only places others, and its name.
pub(super) fn group(document: &Document) -> (Edit, Name) {
    let name = document.free_name("Group");
    let thing = Thing::default().with(Transform::new([Step::Translate(DVec3::ZERO)]));
    (Edit::of("Add group", &name, thing), name)
}

/// An edit that adds a copy of a thing, and its name.
pub(super) fn duplicate(document: &Document, name: &Name) -> Option<(Edit, Name)> {
    let thing = document.get(name)?;
    let copy = document.free_name(name.as_str());
    Some((Edit::of(format!("Duplicate {}", name.as_str()), &copy, (**thing).clone()), copy))
}

/// An edit that takes a thing away; what referred to it no longer does.
pub(super) fn delete(document: &Document, name: &Name) -> Edit {
    let mut edit = Edit::new(format!("Delete {}", name.as_str()));
    for (other, thing) in document.things() {
        let refers = |to: &Option<Name>| to.as_ref() == Some(name);
        if refers(&thing.made_of) || refers(&thing.parent) {
            let mut thing = (**thing).clone();
            for link in [&mut thing.made_of, &mut thing.parent] {
                if link.as_ref() == Some(name) {
                    *link = None;
                }
            }
            edit = edit.put(other, thing);
        }
    }
    edit.take(name)
}
