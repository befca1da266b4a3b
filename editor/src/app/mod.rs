//! The editor's window, drawn with egui; all that it shows and does, one thing in a file.
//!
//! Panels only look and wish: every wish is a `command::Command`, done at the end of the frame in `perform.rs`. So menus,
//! buttons, keys and tests have one way in, and no frame waits for drawing or reading.

mod add;
mod browser;
mod camera;
mod chart;
mod code;
mod command;
mod dialog;
mod fields;
mod gizmo;
mod inspector;
mod intake;
mod menu;
mod names;
mod number;
mod perform;
mod render;
mod starters;
mod state;
mod steps;
mod style;
mod things;
mod viewport;
mod why;

pub use state::Editor;

use egui::{CentralPanel, Frame, Margin, Panel, Ui};
use state::Tab;

impl Editor {
    /// Shows everything and does what was wished for.
    pub fn ui(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        self.receive(&ctx);
        self.listed.update(&self.session.document);
        let panel = Frame::side_top_panel(ui.style());
        let side = panel.inner_margin(Margin::symmetric(10, 6));
        Panel::top("menu").show(ui, |ui| menu::bar(self, ui));
        Panel::bottom("status").show(ui, |ui| menu::status(self, ui));
        Panel::left("things")
            .frame(side)
            .default_size(200.0)
            .size_range(150.0..=360.0)
            .show(ui, |ui| things::show(self, ui));
        Panel::right("details").frame(side).default_size(404.0).size_range(360.0..=560.0).show(ui, |ui| {
            // As wide whatever it shows, or everything would shift when another tab is chosen.
            ui.set_min_width(ui.available_width());
            menu::tabs(self, ui);
            match self.tab {
                Tab::Thing => inspector::show(self, ui),
                Tab::Render => render::show(self, ui),
                Tab::Why => why::show(self, ui),
                Tab::Chart => chart::show(self, ui),
            }
        });
        CentralPanel::no_frame().show(ui, |ui| viewport::show(self, ui));
        dialog::show(self, ui);
        self.perform(&ctx);
        if self.session.worker.is_busy() || self.session.writing().is_some() {
            // Time goes on where no tile comes for a while, and a thread ends a moment after it says so.
            ctx.request_repaint_after(std::time::Duration::from_millis(250));
        }
    }
}
