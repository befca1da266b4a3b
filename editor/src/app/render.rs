//! The panel that starts and stops the render, and says how the picture is taken.

use super::{camera, command::Command, fields::Fields, state::Editor};
use crate::{
    document::Edit,
    worker::{How, Phase, View},
};
use egui::{CollapsingHeader, ProgressBar, RichText, ScrollArea, Ui};
use snell::components::{camera::Camera, describe::Describe, settings::Settings};
use std::time::Duration;

/// Shows the panel.
pub(super) fn show(editor: &mut Editor, ui: &mut Ui) {
    ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        run(editor, ui);
        ui.separator();
        how(editor, ui);
        ui.separator();
        settings(editor, ui);
    });
}

/// Start, stop and how far it is.
fn run(editor: &mut Editor, ui: &mut Ui) {
    let (phase, has_picture) = {
        let view = editor.session.worker.view();
        (view.phase, view.frame.is_some())
    };
    let is_drawing = matches!(phase, Phase::Building | Phase::Coarse | Phase::Exact);
    ui.horizontal(|ui| {
        let size = egui::vec2(96.0, 28.0);
        if is_drawing {
            if ui
                .add(egui::Button::new("■ Stop").min_size(size))
                .accessible_name("Stop")
                .on_hover_text("Stop; what was drawn is kept (F5)")
                .clicked()
            {
                editor.ask(Command::Stop);
            }
        } else if ui
            .add(egui::Button::new("▶ Render").min_size(size))
            .accessible_name("Render")
            .on_hover_text("Draw the picture (F5)")
            .clicked()
        {
            editor.ask(Command::Render);
        }
        let button = egui::Button::new("Save picture…").min_size(egui::vec2(0.0, 28.0));
        let tip = if has_picture { "As PNG or OpenEXR" } else { "There is no picture yet, or it is being drawn" };
        if ui
            .add_enabled(has_picture, button)
            .accessible_name("Save picture…")
            .on_hover_text(tip)
            .on_disabled_hover_text(tip)
            .clicked()
        {
            editor.ask(Command::AskSavePicture);
        }
    });
    let view = editor.session.worker.view();
    let share = view.done as f32 / view.total.max(1) as f32;
    ui.add(ProgressBar::new(share).desired_height(14.0).text(RichText::new(progress(&view)).small()));
    if let Some(text) = speed(&view) {
        ui.label(RichText::new(text).weak().small());
    }
}

/// How far the picture is, in words.
pub(super) fn progress(view: &View) -> String {
    let percent = 100 * view.done / view.total.max(1);
    match view.phase {
        Phase::Empty => "Nothing drawn yet".into(),
        Phase::Building => "Preparing…".into(),
        Phase::Coarse => "First look…".into(),
        Phase::Exact => match left(view) {
            Some(left) => format!("{percent} %, {} left", duration(left)),
            None => format!("{percent} %"),
        },
        Phase::Stopped if view.frame.is_some() => format!("Stopped at {percent} %"),
        Phase::Stopped => "Not drawn".into(),
        Phase::Done => format!("Done in {}", duration(view.took)),
    }
}

/// How long it will take from here, by how long it took so far.
fn left(view: &View) -> Option<Duration> {
    let so_far = view.begun?.elapsed();
    let rest = view.total.saturating_sub(view.done) as f64 / view.done as f64;
    (view.done > 0 && so_far > Duration::from_millis(500)).then(|| so_far.mul_f64(rest))
}

/// A duration as people say it.
fn duration(d: Duration) -> String {
    let seconds = d.as_secs_f64();
    match seconds {
        _ if seconds < 0.95 => format!("{:.0} ms", 1000.0 * seconds),
        _ if seconds < 9.95 => format!("{seconds:.1} s"),
        _ if seconds < 59.5 => format!("{seconds:.0} s"),
        _ if seconds < 3600.0 => format!("{} min {:02} s", seconds as u64 / 60, seconds as u64 % 60),
        _ => format!("{} h {:02} min", seconds as u64 / 3600, seconds as u64 / 60 % 60),
    }
}

/// Rays and how many a second.
fn speed(view: &View) -> Option<String> {
    let rays = view.frame.as_ref()?.counts.rays();
    let pace = rays as f64 / view.took.as_secs_f64().max(1e-9);
    Some(format!("{} rays, {} a second", large(rays as f64), large(pace)))
}

/// A large number in short.
fn large(x: f64) -> String {
    match x {
        _ if x < 1e4 => format!("{x:.0}"),
        _ if x < 1e6 => format!("{:.0} thousand", x / 1e3),
        _ if x < 1e9 => format!("{:.1} million", x / 1e6),
        _ => format!("{:.1} billion", x / 1e9),
    }
}

/// What changes no bit of the picture.
fn how(editor: &mut Editor, ui: &mut Ui) {
    let how = editor.session.how();
    let mut new = how;
    ui.checkbox(&mut new.live, "Draw every change at once").on_hover_text("If not, only a press of Render draws");
    let most = std::thread::available_parallelism().map_or(1, usize::from);
    ui.horizontal(|ui| {
        ui.label("Threads").on_hover_text("How many processors work on the picture");
        let mut threads = how.threads.unwrap_or(most);
        ui.spacing_mut().slider_width = 110.0;
        if ui.add(egui::Slider::new(&mut threads, 1..=most.max(2))).accessible_name("Threads").changed() {
            new.threads = (threads != most).then_some(threads);
        }
    });
    ui.horizontal(|ui| {
        ui.label("Region").on_hover_text("Draw a part of the picture exactly; the rest stays coarse");
        if editor.viewport.picks_region {
            ui.label(RichText::new("drag over the picture").italics());
        } else if ui.button("Choose").accessible_name("Choose region").clicked() {
            editor.viewport.picks_region = true;
        }
        if let Some(region) = how.region {
            ui.label(format!("{}×{} at {}, {}", region.width, region.height, region.x, region.y));
            if ui.small_button("×").accessible_name("Whole picture").on_hover_text("Draw the whole picture").clicked()
            {
                new.region = None;
            }
        }
    });
    if new != how {
        editor.session.set_how(How { ..new });
    }
}

/// The settings of the scene by group; those that no group names come last.
const GROUPS: [(&str, &[&str]); 3] = [
    ("Size and samples", &["width", "height", "antialias", "grid", "subdivisions", "contrast"]),
    ("Light", &["depth", "shadows", "refraction", "background", "cutoff", "error"]),
    ("Whole scene", &["transform", "transform_lights"]),
];

fn settings(editor: &mut Editor, ui: &mut Ui) {
    let old = editor.session.document.settings().clone();
    let mut new = old.clone();
    let mut changed = false;
    let is_named = |name: &str| GROUPS.iter().any(|(_, names)| names.contains(&name));
    for (heading, names) in GROUPS {
        CollapsingHeader::new(RichText::new(heading).strong()).default_open(true).show(ui, |ui| {
            if heading == "Size and samples" {
                sizes(ui, &mut new);
                screen(editor, ui);
            }
            if heading == "Whole scene" {
                ui.label(RichText::new("Moves, turns and scales all things before the camera").weak().small());
            }
            let is_used = |name: &str| match name {
                "grid" => old.antialias == snell::components::settings::Antialias::Grid,
                "subdivisions" | "contrast" => old.antialias == snell::components::settings::Antialias::Adaptive,
                _ => true,
            };
            let only = |name: &str| names.contains(&name) && is_used(name);
            let mut fields = Fields::new(ui, old.encoding).only(&only);
            new.describe(&mut fields);
            changed |= fields.changed;
        });
    }
    CollapsingHeader::new(RichText::new("More").strong()).default_open(false).show(ui, |ui| {
        let only = |name: &str| !is_named(name);
        let mut fields = Fields::new(ui, old.encoding).only(&only);
        new.describe(&mut fields);
        changed |= fields.changed;
    });
    if (changed || new != old) && new.check().is_ok() {
        editor.ask(Command::Gesture(Edit { settings: Some(new), ..Edit::new("Change settings") }));
    }
}

/// Usual sizes.
fn sizes(ui: &mut Ui, settings: &mut Settings) {
    ui.horizontal(|ui| {
        ui.label("Size");
        for (width, height) in [(320, 240), (640, 480), (1280, 720), (1920, 1080)] {
            let is_it = (settings.width, settings.height) == (width, height);
            if ui.selectable_label(is_it, format!("{width}×{height}")).clicked() {
                (settings.width, settings.height) = (width, height);
            }
        }
    });
}

/// The distance of the screen, which belongs to the camera but shows in the whole picture.
fn screen(editor: &mut Editor, ui: &mut Ui) {
    let Some((name, thing, camera)) = camera::find(&editor.session.document) else { return };
    let (name, thing, mut new) = (name.clone(), thing.clone(), camera.clone());
    let only = |name: &str| matches!(name, "field_of_view" | "screen_distance");
    let mut fields = Fields::new(ui, snell::components::color::Encoding::Srgb).only(&only);
    new.describe(&mut fields);
    if fields.changed {
        editor.change_component(&name, &thing, Camera::TAG, Box::new(new));
    }
}
