//! The list of the scene's things, by group.

use super::{
    add::LOOKS,
    command::Command,
    names::{Group, words},
    state::Editor,
};
use crate::document::Document;
use egui::{RichText, ScrollArea, Ui};
use snell::{
    components::{describe::Describe, hidden::Hidden, name::Name},
    systems::{registry::Kind, scene::is_of_model},
};
use std::{collections::BTreeMap, sync::Arc};

/// Shows the list.
pub(super) fn show(editor: &mut Editor, ui: &mut Ui) {
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        ui.heading("Things");
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.menu_button("+ Add", |ui| add_menu(editor, ui))
                .response
                .on_hover_text("Add an object, a light, a material");
        });
    });
    ui.separator();
    ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        for group in Group::ALL {
            list(editor, ui, group);
        }
    });
}

/// The names of all things by group, in the order of the file; made anew only after an edit.
#[derive(Default)]
pub(super) struct Listed {
    groups: BTreeMap<Group, Arc<[Name]>>,
    /// The state of the document that they are of.
    state: Option<u64>,
}

impl Listed {
    /// Takes in what changed.
    pub(super) fn update(&mut self, document: &Document) {
        if self.state == Some(document.state()) {
            return;
        }
        let registry = document.registry();
        let mut groups: BTreeMap<Group, Vec<Name>> = BTreeMap::new();
        for (name, thing) in document.things().filter(|(name, _)| !is_of_model(name)) {
            groups.entry(Group::of(thing, registry)).or_default().push(name.clone());
        }
        self.groups = groups.into_iter().map(|(group, names)| (group, names.into())).collect();
        self.state = Some(document.state());
    }

    /// Those of a group.
    pub(super) fn of(&self, group: Group) -> Arc<[Name]> {
        self.groups.get(&group).cloned().unwrap_or_default()
    }

    /// All, as they are listed.
    pub(super) fn all(&self) -> Vec<Name> {
        self.groups.values().flat_map(|names| names.iter().cloned()).collect()
    }
}

fn list(editor: &mut Editor, ui: &mut Ui, group: Group) {
    let names = editor.listed.of(group);
    if names.is_empty() && group == Group::Groups {
        return;
    }
    ui.add_space(2.0);
    ui.label(RichText::new(group.heading()).strong().small());
    if names.is_empty() {
        ui.label(RichText::new("none").weak().italics());
    }
    // Long lists are shown as far as one looks.
    let height = ui.spacing().interact_size.y + ui.spacing().item_spacing.y;
    let top = ui.cursor().top();
    let seen = ui.clip_rect();
    let first = (((seen.top() - top) / height).floor().max(0.0) as usize).min(names.len());
    let last = (((seen.bottom() - top) / height).ceil().max(0.0) as usize + 1).min(names.len());
    ui.add_space(first as f32 * height);
    for name in &names[first..last.max(first)] {
        row(editor, ui, name, group);
    }
    ui.add_space((names.len() - last.max(first)) as f32 * height);
    ui.add_space(6.0);
}

fn row(editor: &mut Editor, ui: &mut Ui, name: &Name, group: Group) {
    let is_selected = editor.selected.as_ref() == Some(name);
    let height = ui.spacing().interact_size.y;
    let response = ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        // What can be seen or shines can be hidden.
        let can_hide = matches!(group, Group::Objects | Group::Lights);
        if let (true, Some(thing)) = (can_hide, editor.session.document.get(name)) {
            let is_hidden = thing.components.contains_key(Hidden::TAG);
            let mut is_shown = !is_hidden;
            let label = format!("Show {}", name.as_str());
            let tip = if is_hidden { "Hidden: tick to show it" } else { "Shown: take the tick away to hide it" };
            if ui.checkbox(&mut is_shown, "").accessible_name(label).on_hover_text(tip).changed() {
                editor.ask(Command::ToggleHidden(name.clone()));
            }
        } else {
            ui.add_space(ui.spacing().interact_size.y);
        }
        let size = egui::vec2(ui.available_width(), height);
        let text = RichText::new(name.as_str());
        let button = egui::Button::selectable(is_selected, text).truncate();
        let layout = egui::Layout::top_down_justified(egui::Align::Min);
        ui.allocate_ui_with_layout(size, layout, |ui| ui.add(button)).inner
    });
    let response = response.inner;
    if response.clicked() || response.secondary_clicked() {
        editor.ask(Command::Select(Some(name.clone())));
    }
    if response.double_clicked() {
        editor.ask(Command::Frame);
    }
    response.context_menu(|ui| {
        for label in ["Rename…", "Duplicate", "Hide", "Delete", "Show selected"] {
            super::menu::item(editor, ui, label);
        }
    });
}

/// What can be added, by group.
pub(super) fn add_menu(editor: &mut Editor, ui: &mut Ui) {
    let registry = editor.session.document.registry().clone();
    let tags = |kind: Kind| registry.entries().filter(move |(_, entry)| entry.kind == kind).map(|(tag, _)| tag);
    ui.label(RichText::new("Objects").weak().small());
    for tag in tags(Kind::Shape).filter(|tag| *tag != "Mesh") {
        if ui.button(words(tag)).clicked() {
            editor.ask(Command::Add(tag));
        }
    }
    if ui.button("Model from a file…").clicked() {
        editor.ask(Command::AskModel);
    }
    ui.separator();
    ui.label(RichText::new("Lights").weak().small());
    for tag in tags(Kind::Light) {
        if ui.button(words(tag)).clicked() {
            editor.ask(Command::Add(tag));
        }
    }
    ui.separator();
    ui.menu_button("Material", |ui| {
        for (number, look) in LOOKS.iter().enumerate() {
            if ui.button(look.name).on_hover_text(look.about).clicked() {
                editor.ask(Command::AddMaterial(number));
            }
        }
    });
    if super::camera::find(&editor.session.document).is_none() && ui.button("Camera").clicked() {
        editor.ask(Command::AddCamera);
    }
    if ui.button("Group").on_hover_text("Places the things whose parent it is").clicked() {
        editor.ask(Command::AddGroup);
    }
}
