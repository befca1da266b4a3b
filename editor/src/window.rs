//! The window on the screen.

use crate::{app::Editor, files, loader::Factory};
use std::path::{Path, PathBuf};

struct Window {
    editor: Editor,
    title: String,
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        self.editor.ui(ui);
        let title = self.editor.title();
        if title != self.title {
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }

    fn on_exit(&mut self, _: Option<&eframe::glow::Context>) {
        self.editor.finish();
    }
}

/// Opens the editor's window and returns when it is closed.
///
/// `factory` makes renderers that know all kinds of shapes, lights and textures that scenes may hold.
///
/// # Errors
/// Why there can be no window, such as no screen.
pub fn run(factory: Factory, file: Option<&Path>) -> Result<(), String> {
    let file: Option<PathBuf> = file.map(Into::into);
    let viewport = egui::ViewportBuilder::default()
        .with_inner_size([1280.0, 800.0])
        .with_min_inner_size([900.0, 560.0])
        .with_title("Snell");
    let options = eframe::NativeOptions { viewport, ..Default::default() };
    let make = move |cc: &eframe::CreationContext<'_>| {
        let editor = Editor::new(&cc.egui_ctx, factory, files::data_folder(), file.as_deref());
        Ok(Box::new(Window { editor, title: String::new() }) as Box<dyn eframe::App>)
    };
    eframe::run_native("snell-edit", options, Box::new(make))
        .map_err(|why| format!("the window cannot be opened: {}; it needs a screen", reason(&why.to_string())))
}

/// What was told, without the place in the sources of a library that some errors begin with.
fn reason(told: &str) -> &str {
    let after_line = |at: usize| told.get(at + 4..)?.split_once(": ").map(|(_, reason)| reason);
    told.rfind(".rs:").and_then(after_line).unwrap_or(told).trim_end_matches('.')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_are_told_without_the_sources_of_libraries() {
        let told = "os error at /home/me/winit/src/mod.rs:765: neither WAYLAND_DISPLAY nor DISPLAY is set.";
        assert_eq!(reason(told), "neither WAYLAND_DISPLAY nor DISPLAY is set");
        assert_eq!(reason("no OpenGL"), "no OpenGL");
    }
}
