//! The bar at the top and the line at the bottom.

use super::{
    command::{self, Command},
    gizmo::Tool,
    state::{Editor, Tab},
};
use crate::session::Tone;
use egui::{Color32, RichText, Ui};

/// An item of a menu for a command with a key.
pub(super) fn item(editor: &mut Editor, ui: &mut Ui, label: &'static str) {
    let Some(shortcut) = command::find(label) else { return };
    let keys = shortcut.text(ui.ctx());
    let is_possible = editor.can(label);
    let button = ui.add_enabled(is_possible, egui::Button::new(label).shortcut_text(keys));
    if button.accessible_name(label).clicked() {
        editor.ask(shortcut.command());
        ui.close();
    }
}

/// Menus and the most used buttons.
pub(super) fn bar(editor: &mut Editor, ui: &mut Ui) {
    egui::MenuBar::new().ui(ui, |ui| {
        ui.menu_button("File", |ui| file(editor, ui));
        ui.menu_button("Edit", |ui| {
            for label in ["Undo", "Redo"] {
                item(editor, ui, label);
            }
            ui.separator();
            for label in ["Duplicate", "Rename…", "Hide", "Delete", "Show selected"] {
                item(editor, ui, label);
            }
            ui.separator();
            for label in ["Previous thing", "Next thing"] {
                item(editor, ui, label);
            }
        });
        ui.menu_button("Add", |ui| super::things::add_menu(editor, ui));
        ui.menu_button("Help", help);
        ui.separator();
        button(editor, ui, "Undo", || Command::Undo);
        button(editor, ui, "Redo", || Command::Redo);
        ui.separator();
        for tool in Tool::ALL {
            let label = tool.label();
            let keys = command::find(label).map(|shortcut| shortcut.text(ui.ctx())).unwrap_or_default();
            let response = ui
                .selectable_label(editor.tool == tool, label)
                .on_hover_text(format!("{label} the selected thing by its handles ({keys})"));
            if response.clicked() {
                editor.ask(Command::Tool(tool));
            }
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let title = editor.session.title();
            let mark = if editor.session.document.is_changed() { " •" } else { "" };
            ui.label(RichText::new(format!("{title}{mark}")).weak()).on_hover_text("• means: not saved yet");
        });
    });
}

fn button(editor: &mut Editor, ui: &mut Ui, label: &str, make: fn() -> Command) {
    let what = match label {
        "Undo" => editor.session.document.undo_label(),
        _ => editor.session.document.redo_label(),
    };
    let keys = command::find(label).map(|shortcut| shortcut.text(ui.ctx())).unwrap_or_default();
    let tip = format!("{label} {} ({keys})", what.unwrap_or_default());
    let response = ui.add_enabled(what.is_some(), egui::Button::new(label));
    if response.on_hover_text(tip).clicked() {
        editor.ask(make());
    }
}

fn file(editor: &mut Editor, ui: &mut Ui) {
    item(editor, ui, "New…");
    item(editor, ui, "Open…");
    ui.menu_button("Open recent", |ui| {
        let recent = crate::files::recent(editor.session.data());
        if recent.is_empty() {
            ui.label(RichText::new("nothing yet").weak());
        }
        for path in recent {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                editor.ask(Command::Open(path));
            }
        }
    });
    ui.separator();
    item(editor, ui, "Save");
    item(editor, ui, "Save as…");
    item(editor, ui, "Save picture…");
    if ui.button("Copy as Rust code").on_hover_text("A program that builds this scene, for the clipboard").clicked() {
        editor.ask(Command::CopyCode);
    }
    ui.separator();
    item(editor, ui, "Quit");
}

/// What the pointer and the keys do.
fn help(ui: &mut Ui) {
    ui.set_min_width(330.0);
    for (what, how) in [
        ("Select", "click a thing"),
        ("Go around", "drag with the right button"),
        ("Move sideways", "drag with the middle button, or Shift and right"),
        ("Nearer, farther", "turn the wheel; the point under the pointer stays"),
        ("Move the camera", "A D left, right; E Q up, down; W S in, out"),
        ("Turn the camera", "arrow keys; with Shift: roll"),
        ("Change a number", "type it, or drag ↔, x, y or z beside it"),
        ("In even steps", "hold Ctrl while dragging a handle"),
        ("Files", "drop a scene, an OBJ model or an image on the window"),
    ] {
        ui.horizontal(|ui| {
            ui.add_sized([120.0, 18.0], egui::Label::new(RichText::new(what).strong()));
            ui.label(how);
        });
    }
}

/// The tabs of the panel at the right.
pub(super) fn tabs(editor: &mut Editor, ui: &mut Ui) {
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        for tab in Tab::ALL {
            ui.selectable_value(&mut editor.tab, tab, RichText::new(tab.label()).size(15.0)).on_hover_text(tab.tip());
        }
    });
    ui.separator();
}

/// What was told last, and how far the picture is.
pub(super) fn status(editor: &mut Editor, ui: &mut Ui) {
    ui.horizontal(|ui| {
        if let Some(what) = editor.session.reading() {
            ui.spinner();
            ui.label(format!("Reading {what}"));
        } else if let Some(file) = editor.session.writing() {
            ui.spinner();
            ui.label(format!("Saving {}", file.display()));
        } else if let Some(told) = editor.told.clone() {
            let color = match told.tone {
                Tone::Done => ui.visuals().text_color(),
                Tone::Warning => ui.visuals().warn_fg_color,
                Tone::Fault => ui.visuals().error_fg_color,
            };
            ui.label(RichText::new(&told.title).color(color));
            if !told.lines.is_empty() && ui.small_button("Details").clicked() {
                editor.ask(Command::Show(super::dialog::Dialog::Told(told)));
            }
        } else {
            ui.label(RichText::new("Right-drag goes around, the wheel zooms, a click selects").weak());
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let view = editor.session.worker.view();
            let text = super::render::progress(&view);
            let size = (view.screen.width, view.screen.height);
            drop(view);
            if size.0 > 0 {
                ui.label(RichText::new(format!("{}×{}", size.0, size.1)).weak());
            }
            ui.label(text);
            let left_out = editor.left_out();
            if left_out > 0 {
                ui.label(RichText::new(format!("{left_out} left out")).color(Color32::from_rgb(230, 170, 60)))
                    .on_hover_text("Things that cannot be drawn as they are, such as a triangle without area");
            }
        });
    });
}
