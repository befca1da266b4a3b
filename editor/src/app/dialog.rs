//! Questions and messages over the window.

use super::{browser::Browser, command::Command, starters, state::Editor};
use crate::session::{Told, Tone};
use egui::{Id, Key, Modal, RichText, ScrollArea, Ui};
use std::path::PathBuf;

/// What is asked or told.
pub(super) enum Dialog {
    /// Scenes to begin with.
    Start,
    /// A file to open or to write.
    Files(Browser),
    /// A chart, as large as it is.
    Chart(egui::TextureHandle),
    /// What was told, in full.
    Told(Told),
    /// There are changes that are not saved, and something is to be done that loses them.
    Unsaved,
    /// A file is there already.
    Replace(PathBuf, Box<Command>),
    /// Changes of a scene were kept that were never saved.
    Recover(Option<PathBuf>),
}

/// Shows the dialog that is open.
pub(super) fn show(editor: &mut Editor, ui: &mut Ui) {
    let Some(mut dialog) = editor.dialog.take() else { return };
    let mut stays = true;
    let frame = egui::Frame::popup(ui.style()).inner_margin(16);
    // Each kind has a place of its own, or one would be laid out as large as the one before.
    let modal = Modal::new(Id::unique(("dialog", std::mem::discriminant(&dialog)))).frame(frame).show(ui.ctx(), |ui| {
        ui.spacing_mut().item_spacing.y = 8.0;
        match &mut dialog {
            Dialog::Start => {
                ui.set_width(676.0);
                starters::show(editor, ui);
            }
            Dialog::Files(browser) => {
                ui.set_width(560.0);
                if let Some(command) = browser.show(ui, editor.session.data()) {
                    stays = false;
                    editor.ask(command);
                }
            }
            Dialog::Chart(chart) => {
                let room = ui.ctx().content_rect().size() - egui::vec2(80.0, 120.0);
                ui.add(egui::Image::new(&*chart).max_size(room).alt_text("Chart, large"));
                stays &= !button(ui, "Close");
            }
            Dialog::Told(told) => {
                ui.set_width(620.0);
                tell(ui, told);
                ui.horizontal(|ui| {
                    stays &= !button(ui, "Close");
                    if !told.lines.is_empty() && button(ui, "Copy all") {
                        ui.ctx().copy_text(told.lines.join("\n"));
                    }
                });
            }
            Dialog::Unsaved => {
                ui.set_width(380.0);
                ui.heading("Save the changes?");
                ui.label(format!("{} has changes that are not saved.", editor.session.title()));
                ui.horizontal(|ui| {
                    for (label, command) in [
                        ("Save", Command::Proceed { save: true }),
                        ("Don’t save", Command::Proceed { save: false }),
                        ("Cancel", Command::Close),
                    ] {
                        if button(ui, label) {
                            editor.ask(command);
                        }
                    }
                });
            }
            Dialog::Replace(file, command) => {
                ui.set_width(420.0);
                ui.heading("Replace the file?");
                ui.label(format!("{} is there already.", file.display()));
                ui.horizontal(|ui| {
                    if button(ui, "Replace") {
                        stays = false;
                        editor.ask(std::mem::replace(command, Command::Close));
                    }
                    stays &= !button(ui, "Cancel");
                });
            }
            Dialog::Recover(file) => {
                ui.set_width(440.0);
                ui.heading("Recover what was not saved?");
                let what = match file {
                    Some(file) => {
                        format!("The program ended before changes of {} were saved; they were kept.", name(file))
                    }
                    None => "The program ended before a scene was saved; it was kept.".into(),
                };
                ui.label(what);
                ui.horizontal(|ui| {
                    if button(ui, "Recover") {
                        stays = false;
                        editor.ask(Command::Recover(file.clone()));
                    }
                    if button(ui, "Throw away") {
                        stays = false;
                        editor.ask(Command::OpenSaved(file.clone()));
                    }
                });
            }
        }
    });
    // Questions want one of their buttons; what was kept must not be lost by a slip.
    let is_question = matches!(dialog, Dialog::Unsaved | Dialog::Replace(..) | Dialog::Recover(_));
    let escaped = ui.input(|input| input.key_pressed(Key::Escape));
    if (escaped && !matches!(dialog, Dialog::Recover(_))) || (modal.backdrop_response.clicked() && !is_question) {
        editor.ask(Command::Close);
        stays = false;
    }
    if stays && editor.dialog.is_none() {
        editor.dialog = Some(dialog);
    }
}

fn button(ui: &mut Ui, label: &str) -> bool {
    ui.add(egui::Button::new(label).min_size(egui::vec2(84.0, 26.0))).clicked()
}

fn name(file: &std::path::Path) -> String {
    file.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// What was told, with all its lines, to be read and copied.
fn tell(ui: &mut Ui, told: &Told) {
    let color = match told.tone {
        Tone::Done => ui.visuals().text_color(),
        Tone::Warning => ui.visuals().warn_fg_color,
        Tone::Fault => ui.visuals().error_fg_color,
    };
    ui.label(RichText::new(&told.title).heading().color(color));
    ScrollArea::vertical().max_height(320.0).auto_shrink([false, true]).show(ui, |ui| {
        for line in &told.lines {
            ui.label(RichText::new(line).monospace());
        }
    });
}
