//! Choosing a file: a list of a folder's files, and a name.

use super::command::Command;
use egui::{Key, RichText, ScrollArea, TextEdit, Ui};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// What is made of the chosen file.
pub(super) type Make = Box<dyn Fn(PathBuf) -> Command>;

/// A dialog for a file.
pub(super) struct Browser {
    title: &'static str,
    /// What the button says.
    verb: &'static str,
    extensions: &'static [&'static str],
    /// Whether the file is to be written.
    writes: bool,
    folder: PathBuf,
    name: String,
    /// Folders and then files, as last read; none before.
    entries: Option<Vec<(String, bool)>>,
    fault: Option<String>,
    make: Make,
}

impl Browser {
    /// A dialog for a file to be read.
    pub(super) fn open(title: &'static str, extensions: &'static [&'static str], folder: PathBuf, make: Make) -> Self {
        Self {
            title,
            verb: "Open",
            extensions,
            writes: false,
            folder,
            name: String::new(),
            entries: None,
            fault: None,
            make,
        }
    }

    /// A dialog for a file to be written, with a name to begin with.
    pub(super) fn save(
        title: &'static str,
        extensions: &'static [&'static str],
        folder: PathBuf,
        name: String,
        make: Make,
    ) -> Self {
        Self { title, verb: "Save", extensions, writes: true, folder, name, entries: None, fault: None, make }
    }

    fn enter(&mut self, folder: PathBuf) {
        self.folder = folder;
        self.entries = None;
        self.fault = None;
        if !self.writes {
            self.name.clear();
        }
    }

    fn read(&mut self) {
        let entries = match fs::read_dir(&self.folder) {
            Ok(entries) => entries,
            Err(why) => {
                self.fault = Some(format!("{}: {why}", self.folder.display()));
                self.entries = Some(vec![]);
                return;
            }
        };
        let fits = |name: &str| {
            let extension =
                Path::new(name).extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
            extension.is_some_and(|extension| self.extensions.contains(&extension.as_str()))
        };
        let mut known: Vec<(String, bool)> = entries
            .filter_map(Result::ok)
            .filter_map(|entry| Some((entry.file_name().into_string().ok()?, entry.path().is_dir())))
            .filter(|(name, is_folder)| !name.starts_with('.') && (*is_folder || fits(name)))
            .collect();
        known.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.to_lowercase().cmp(&b.0.to_lowercase())));
        self.entries = Some(known);
    }

    /// Shows the dialog; the command of the file that was chosen, or of closing it.
    pub(super) fn show(&mut self, ui: &mut Ui, data: &Path) -> Option<Command> {
        if self.entries.is_none() {
            self.read();
        }
        ui.heading(self.title);
        ui.horizontal(|ui| {
            if ui.button("↑ Up").accessible_name("Up").on_hover_text("The folder around this one").clicked()
                && let Some(parent) = self.folder.parent()
            {
                self.enter(parent.to_path_buf());
            }
            for (label, place) in places(data) {
                if ui.button(label).on_hover_text(place.display().to_string()).clicked() {
                    self.enter(place);
                }
            }
            ui.add(egui::Label::new(RichText::new(self.folder.display().to_string()).weak()).truncate());
        });
        let mut chosen = None;
        let mut entered = None;
        egui::Frame::group(ui.style()).show(ui, |ui| {
            ScrollArea::vertical().max_height(280.0).min_scrolled_height(280.0).auto_shrink([false, false]).show(
                ui,
                |ui| {
                    let entries = self.entries.as_deref().unwrap_or_default();
                    if entries.is_empty() {
                        ui.label(RichText::new(format!("no {} files here", self.extensions.join(" or "))).weak());
                    }
                    for (name, is_folder) in entries {
                        let shown = if *is_folder { format!("▸ {name}") } else { name.clone() };
                        let response = ui.selectable_label(self.name == *name, shown).on_hover_text(name.as_str());
                        let response = response.accessible_name(name.as_str());
                        if *is_folder && response.clicked() {
                            entered = Some(self.folder.join(name));
                        } else if response.clicked() {
                            chosen = Some((name.clone(), response.double_clicked()));
                        }
                    }
                },
            );
        });
        if let Some(folder) = entered {
            self.enter(folder);
        }
        let mut is_done = false;
        if let Some((name, is_final)) = chosen {
            self.name = name;
            is_done = is_final;
            self.fault = None;
        }
        ui.horizontal(|ui| {
            ui.label("File name");
            let field =
                ui.add(TextEdit::singleline(&mut self.name).desired_width(f32::INFINITY)).accessible_name("File name");
            is_done |= field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        });
        if let Some(fault) = &self.fault {
            ui.label(RichText::new(fault).color(super::number::wrong(ui)));
        }
        let mut is_closed = false;
        ui.horizontal(|ui| {
            let size = egui::vec2(84.0, 26.0);
            is_done |= ui.add(egui::Button::new(self.verb).min_size(size)).clicked();
            is_closed = ui.add(egui::Button::new("Cancel").min_size(size)).clicked();
        });
        if is_closed {
            return Some(Command::Close);
        }
        if is_done { self.done() } else { None }
    }

    fn done(&mut self) -> Option<Command> {
        let name = self.name.trim();
        if name.is_empty() {
            self.fault = Some("choose a file or type its name".into());
            return None;
        }
        let mut file = self.folder.join(name);
        if file.is_dir() {
            self.enter(file);
            return None;
        }
        let extension = file.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
        let fits = extension.as_deref().is_some_and(|extension| self.extensions.contains(&extension));
        if !fits && self.writes {
            if extension.is_some() && self.extensions.len() > 1 {
                self.fault = Some(format!("the name must end in .{}", self.extensions.join(" or .")));
                return None;
            }
            let mut whole = file.into_os_string();
            whole.push(format!(".{}", self.extensions[0]));
            file = whole.into();
        }
        if !self.writes && !file.is_file() {
            self.fault = Some(format!("there is no file {}", file.display()));
            return None;
        }
        let command = (self.make)(file.clone());
        Some(if self.writes && file.exists() {
            Command::Show(super::dialog::Dialog::Replace(file, Box::new(command)))
        } else {
            command
        })
    }
}

/// Folders that one may want to go to.
fn places(data: &Path) -> Vec<(&'static str, PathBuf)> {
    let mut places = vec![];
    if let Some(home) = std::env::home_dir().filter(|home| home.is_dir()) {
        places.push(("Home", home));
    }
    if let Ok(here) = std::env::current_dir() {
        places.push(("Here", here));
    }
    if let Some(last) = crate::files::recent(data).first().and_then(|file| file.parent().map(Into::into)) {
        places.push(("Last", last));
    }
    places
}
