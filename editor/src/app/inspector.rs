//! All that there is to say of the selected thing, from the descriptions of its components.

use super::{
    add::{self, LOOKS},
    camera,
    command::Command,
    fields::Fields,
    names::{Group, words},
    number::wrong,
    state::Editor,
};
use crate::document::Edit;
use egui::{CollapsingHeader, ComboBox, RichText, ScrollArea, TextEdit, Ui};
use snell::{
    components::{describe::Describe, name::Name, transform::Transform},
    prelude::DVec3,
    systems::{
        registry::{AnyComponent, Kind, conflict},
        scene::Thing,
    },
};

/// Shows the selected thing.
pub(super) fn show(editor: &mut Editor, ui: &mut Ui) {
    let Some((name, thing)) = editor.selected_thing() else {
        ui.add_space(24.0);
        ui.vertical_centered(|ui| ui.label(RichText::new("Click a thing in the picture or in the list").weak()));
        return;
    };
    ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        ui.push_id(name.as_str(), |ui| {
            name_field(editor, ui, &name);
            let group = Group::of(&thing, editor.session.document.registry());
            if group == Group::Objects {
                material(editor, ui, &name, &thing);
            } else if group == Group::Materials {
                look(editor, ui, &name, &thing);
            }
            if group != Group::Materials {
                parent(editor, ui, &name, &thing);
            }
            if group == Group::Camera {
                move_camera(editor, ui);
            }
            components(editor, ui, &name, &thing);
            add_component(editor, ui, &name, &thing);
        });
    });
}

fn name_field(editor: &mut Editor, ui: &mut Ui, name: &Name) {
    let id = ui.make_persistent_id("name");
    let mut text: String = ui.data(|data| data.get_temp(id)).unwrap_or_else(|| name.as_str().into());
    let is_same = text == name.as_str();
    let fault = (!is_same).then(|| editor.session.document.name_fault(&text)).flatten();
    let response = ui.horizontal(|ui| {
        ui.label("Name");
        let field = TextEdit::singleline(&mut text).id(id.with("field")).desired_width(f32::INFINITY);
        ui.add(field).accessible_name("Name")
    });
    let response = response.inner;
    if editor.wants_name {
        editor.wants_name = false;
        response.request_focus();
    }
    if response.changed() {
        ui.data_mut(|data| data.insert_temp(id, text.clone()));
    }
    if let Some(fault) = &fault {
        ui.label(RichText::new(fault).color(wrong(ui)).small());
    }
    if response.lost_focus() {
        ui.data_mut(|data| data.remove::<String>(id));
        if !is_same && fault.is_none() && !ui.input(|input| input.key_pressed(egui::Key::Escape)) {
            editor.ask(Command::Rename(name.clone(), text));
        }
    }
    ui.add_space(4.0);
}

/// What an object is made of: its own material or one that is shared.
fn material(editor: &mut Editor, ui: &mut Ui, name: &Name, thing: &Thing) {
    let materials = editor.listed.of(Group::Materials);
    let mut chosen = thing.made_of.clone();
    ui.horizontal(|ui| {
        ui.label("Material");
        let shown = chosen.as_ref().map_or("Its own", |name| name.as_str()).to_owned();
        let combo = ComboBox::from_id_salt("material").selected_text(shown).show_ui(ui, |ui| {
            ui.selectable_value(&mut chosen, None, "Its own");
            for material in materials.iter() {
                ui.selectable_value(&mut chosen, Some(material.clone()), material.as_str());
            }
        });
        combo
            .response
            .accessible_name("Material")
            .on_hover_text("A material in the list is shared by all objects that are made of it");
        if let Some(material) = &thing.made_of
            && ui
                .button("Edit")
                .accessible_name("Edit material")
                .on_hover_text("Show the material that is shared")
                .clicked()
        {
            editor.ask(Command::Select(Some(material.clone())));
        }
    });
    if chosen != thing.made_of {
        let new = add::made_of(&editor.session.document, thing, chosen);
        editor.ask(Command::Apply(Edit::of(format!("Material of {}", name.as_str()), name, new)));
    } else if thing.made_of.is_none() {
        look(editor, ui, name, thing);
    }
}

/// Ready materials to take over.
fn look(editor: &mut Editor, ui: &mut Ui, name: &Name, thing: &Thing) {
    ui.horizontal_wrapped(|ui| {
        ui.label("Make it");
        for look in LOOKS {
            if ui.small_button(look.name).on_hover_text(look.about).clicked() {
                let new = add::with_look(thing, look, editor.session.document.registry());
                let label = format!("{} is {}", name.as_str(), look.name.to_lowercase());
                editor.ask(Command::Apply(Edit::of(label, name, new)));
            }
        }
    });
    ui.add_space(4.0);
}

/// In whose space it is placed.
fn parent(editor: &mut Editor, ui: &mut Ui, name: &Name, thing: &Thing) {
    let document = &editor.session.document;
    let is_possible = |other: &Name| {
        // Not itself, nor what is placed by it.
        let mut next = Some(other.clone());
        for _ in 0..1000 {
            match next {
                Some(at) if at == *name => return false,
                Some(at) => next = document.get(&at).and_then(|thing| thing.parent.clone()),
                None => return true,
            }
        }
        false
    };
    let registry = document.registry();
    let places = |thing: &Thing| !matches!(Group::of(thing, registry), Group::Materials | Group::Camera);
    let possible: Vec<Name> = document
        .things()
        .filter(|(other, thing)| places(thing) && is_possible(other))
        .map(|(name, _)| name.clone())
        .take(200)
        .collect();
    if possible.is_empty() && thing.parent.is_none() {
        return;
    }
    let mut chosen = thing.parent.clone();
    ui.horizontal(|ui| {
        ui.label("Moves with");
        let shown = chosen.as_ref().map_or("Nothing", |name| name.as_str()).to_owned();
        let combo = ComboBox::from_id_salt("parent").selected_text(shown).show_ui(ui, |ui| {
            ui.selectable_value(&mut chosen, None, "Nothing");
            for other in possible {
                let text = other.as_str().to_owned();
                ui.selectable_value(&mut chosen, Some(other), text);
            }
        });
        combo.response.accessible_name("Moves with");
    });
    if chosen != thing.parent {
        let edit = Edit::of(format!("Parent of {}", name.as_str()), name, Thing { parent: chosen, ..thing.clone() });
        editor.ask(Command::Apply(edit));
    }
}

/// Buttons that move the camera.
fn move_camera(editor: &mut Editor, ui: &mut Ui) {
    CollapsingHeader::new("Move it").default_open(true).show(ui, |ui| {
        if let Some(motion) = camera::buttons(ui) {
            editor.ask(Command::Move(motion));
        }
        ui.add_space(2.0);
        let (mut axis, mut degrees) = editor.turn_about;
        let any = snell::components::describe::Spec::any("").range;
        ui.horizontal(|ui| {
            ui.label("Turn about");
            for (name, x) in ["x", "y", "z"].iter().zip(&mut axis) {
                super::number::typed(ui, &format!("Axis {name}"), x, any, false, 26.0);
            }
            ui.label("by");
            super::number::typed(ui, "Degrees", &mut degrees, any, false, 34.0);
            ui.label("°");
            editor.turn_about = (axis, degrees);
            let axis = DVec3::from_array(axis);
            if ui
                .add_enabled(axis != DVec3::ZERO, egui::Button::new("Turn"))
                .on_hover_text("About an axis through the origin of the world")
                .clicked()
            {
                editor.ask(Command::Move(camera::Motion::About(axis, degrees)));
            }
        });
    });
}

fn components(editor: &mut Editor, ui: &mut Ui, name: &Name, thing: &Thing) {
    let registry = editor.session.document.registry().clone();
    let encoding = editor.session.document.settings().encoding;
    let mut parts: Vec<(Kind, &'static str, &dyn AnyComponent)> = thing
        .components
        .iter()
        .filter_map(|(tag, component)| Some((registry.get(tag)?.kind, *tag, component.as_ref())))
        .filter(|(kind, ..)| *kind != Kind::Visibility)
        .collect();
    parts.sort_by_key(|(kind, tag, _)| (*kind != Kind::Placement, *kind, *tag));
    let has_place = parts.iter().any(|(_, tag, _)| *tag == Transform::TAG);
    for (_, tag, component) in parts {
        let mut new = component.copy();
        let mut outcome = (false, None);
        let title = if tag == Transform::TAG { "Placement".into() } else { words(tag) };
        let header = CollapsingHeader::new(RichText::new(title).strong()).id_salt(tag).default_open(true);
        header.show(ui, |ui| {
            let mut fields = Fields::new(ui, encoding);
            new.visit(&mut fields);
            outcome = (fields.changed, fields.choose);
            if let Some(fault) = editor.field_fault(name, tag) {
                ui.label(RichText::new(fault).color(wrong(ui)).small());
            }
        });
        let (changed, choose) = outcome;
        if let Some((field, _)) = choose {
            editor.ask(Command::AskFile { tag, field });
        }
        if changed {
            editor.change_component(name, thing, tag, new);
        }
    }
    let group = Group::of(thing, &registry);
    if !has_place && matches!(group, Group::Objects | Group::Groups) {
        CollapsingHeader::new(RichText::new("Placement").strong()).id_salt("no placement").default_open(true).show(
            ui,
            |ui| {
                let mut new: Box<dyn AnyComponent> = Box::new(Transform::default());
                let mut fields = Fields::new(ui, encoding);
                new.visit(&mut fields);
                if fields.changed {
                    editor.change_component(name, thing, Transform::TAG, new);
                }
            },
        );
    }
}

/// Properties that the thing can have besides.
fn add_component(editor: &mut Editor, ui: &mut Ui, name: &Name, thing: &Thing) {
    let registry = editor.session.document.registry().clone();
    let group = Group::of(thing, &registry);
    let kinds: &[Kind] = match group {
        // The material that is shared has them.
        Group::Objects if thing.made_of.is_some() => &[],
        Group::Objects | Group::Materials => &[Kind::Effect, Kind::Filling, Kind::Texture],
        Group::Lights | Group::Camera => &[Kind::Placement],
        Group::Groups => &[],
    };
    let fits = |tag: &str, kind: Kind| {
        let mut others = thing.components.keys().filter_map(|other| Some((registry.get(other)?.kind, *other)));
        !thing.components.contains_key(tag) && others.all(|other| conflict(other, (kind, tag)).is_none())
    };
    let possible: Vec<(&'static str, Kind)> = kinds
        .iter()
        .flat_map(|kind| registry.entries().filter(move |(_, entry)| entry.kind == *kind))
        .map(|(tag, entry)| (tag, entry.kind))
        .filter(|(tag, kind)| fits(tag, *kind))
        .collect();
    ui.add_space(6.0);
    ui.horizontal(|ui| {
        if !possible.is_empty() {
            ui.menu_button("+ Add a property", |ui| {
                for (tag, _) in possible {
                    if ui.button(words(tag)).clicked() {
                        editor.add_property(name, thing, tag);
                    }
                }
            });
        }
        let removable: Vec<&'static str> = thing
            .components
            .keys()
            .copied()
            .filter(|tag| registry.get(tag).is_some_and(|entry| kinds.contains(&entry.kind)))
            .collect();
        // A material of nothing is none: what is made of it could not be read again.
        let is_last = group == Group::Materials && removable.len() == 1;
        if !removable.is_empty() && !is_last {
            ui.menu_button("− Remove one", |ui| {
                for tag in removable {
                    if ui.button(words(tag)).clicked() {
                        let mut without = thing.clone();
                        without.components.remove(tag);
                        let label = format!("Remove {} of {}", words(tag).to_lowercase(), name.as_str());
                        editor.ask(Command::Apply(Edit::of(label, name, without)));
                    }
                }
            });
        }
    });
    ui.add_space(12.0);
}
