//! The list of the scene's things, by group.

use super::{
    add::LOOKS,
    command::Command,
    names::{Group, words},
    state::Editor,
};
use egui::{RichText, ScrollArea, Ui};
use snell::{
    components::name::Name,
    systems::{registry::Kind, scene::is_of_model},
};

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

fn list(editor: &mut Editor, ui: &mut Ui, group: Group) {
    let document = &editor.session.document;
    let registry = document.registry();
    let names: Vec<Name> = document
        .things()
        .filter(|(name, thing)| !is_of_model(name) && Group::of(thing, registry) == group)
        .map(|(name, _)| name.clone())
        .collect();
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
        row(editor, ui, name);
    }
    ui.add_space((names.len() - last.max(first)) as f32 * height);
    ui.add_space(6.0);
}

fn row(editor: &mut Editor, ui: &mut Ui, name: &Name) {
    let is_selected = editor.selected.as_ref() == Some(name);
    let size = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
    let button = egui::Button::selectable(is_selected, name.as_str()).truncate();
    let response = ui.add_sized_left(size, button);
    if response.clicked() || response.secondary_clicked() {
        editor.ask(Command::Select(Some(name.clone())));
    }
    if response.double_clicked() {
        editor.ask(Command::Frame);
    }
    response.context_menu(|ui| {
        for label in ["Rename…", "Duplicate", "Delete", "Show selected"] {
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

trait AddSizedLeft {
    fn add_sized_left(&mut self, size: egui::Vec2, widget: impl egui::Widget) -> egui::Response;
}

impl AddSizedLeft for Ui {
    /// As `add_sized`, but with the text at the left.
    fn add_sized_left(&mut self, size: egui::Vec2, widget: impl egui::Widget) -> egui::Response {
        let layout = egui::Layout::top_down_justified(egui::Align::Min);
        self.allocate_ui_with_layout(size, layout, |ui| ui.add(widget)).inner
    }
}
