//! The panel that measures settings on the open scene: speed against accuracy.

use super::{command::Command, dialog::Dialog, state::Editor};
use crate::loader::Factory;
use egui::{ColorImage, Context, RichText, ScrollArea, TextureHandle, TextureOptions, Ui, vec2};
use snell::charts::{
    chart::png,
    measure::Effort,
    study::{ALL, Hindrance, Kind, Scene},
};
use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    path::PathBuf,
    sync::mpsc::{self, Receiver},
};

/// What was measured, and what is being.
#[derive(Default)]
pub(super) struct Chart {
    waiting: Option<Receiver<Result<Answer, String>>>,
    fault: Option<String>,
    picture: Option<TextureHandle>,
    says: Vec<String>,
    /// The state of the document that it is of.
    state: u64,
}

struct Answer {
    picture: ColorImage,
    says: Vec<String>,
}

impl Chart {
    /// Begins to measure a scene, which is given as text.
    fn start(&mut self, ctx: &Context, factory: &Factory, text: String, folder: PathBuf, state: u64) {
        let (sender, receiver) = mpsc::channel();
        let (ctx, factory) = (ctx.clone(), factory.clone());
        let work = move || {
            let measured = catch_unwind(AssertUnwindSafe(|| measure(&factory, &text, folder)));
            // Nobody waits if the window is closed meanwhile.
            let _ = sender.send(measured.unwrap_or_else(|_| Err("measuring failed".into())));
            ctx.request_repaint();
        };
        let _ = std::thread::Builder::new().name("chart".into()).spawn(work);
        (self.waiting, self.fault, self.state) = (Some(receiver), None, state);
    }

    fn receive(&mut self, ctx: &Context) {
        match self.waiting.as_ref().and_then(|receiver| receiver.try_recv().ok()) {
            Some(Ok(answer)) => {
                self.picture = Some(ctx.load_texture("chart", answer.picture, TextureOptions::LINEAR));
                self.says = answer.says;
                self.waiting = None;
            }
            Some(Err(why)) => (self.fault, self.waiting) = (Some(why), None),
            None => {}
        }
    }
}

/// The quick study of all settings side by side.
fn measure(factory: &Factory, text: &str, folder: PathBuf) -> Result<Answer, String> {
    let mut renderer = factory();
    renderer.load_text(text, folder.join("scene")).map_err(|faults| faults.to_string())?;
    let mut scene = Scene::new("scene", renderer);
    let study = ALL.iter().find_map(|study| match study.kind {
        Kind::OfScene(run) if study.name == "settings" => Some(run),
        _ => None,
    });
    let told = |why: Hindrance| match why {
        Hindrance::Nothing(why) | Hindrance::Scene(why) => why,
    };
    let found = study.ok_or("there is no such study")?(&mut scene, Effort::QUICK).map_err(told)?;
    let chart = found.charts.first().ok_or("nothing was measured")?;
    let bytes = png(chart).map_err(|why| why.to_string())?;
    let picture = image::load_from_memory(&bytes).map_err(|why| why.to_string())?.to_rgba8();
    let size = [picture.width() as usize, picture.height() as usize];
    Ok(Answer { picture: ColorImage::from_rgba_unmultiplied(size, picture.as_raw()), says: found.says })
}

/// Shows the panel.
pub(super) fn show(editor: &mut Editor, ui: &mut Ui) {
    editor.chart.receive(ui.ctx());
    ui.label("How exact is the picture for the time it takes, and which settings do better?");
    let is_busy = editor.chart.waiting.is_some();
    ui.horizontal(|ui| {
        let button = egui::Button::new("Measure this scene").min_size(vec2(0.0, 28.0));
        if ui.add_enabled(!is_busy, button).clicked() {
            let document = &editor.session.document;
            match document.text() {
                Ok(text) => {
                    let (factory, folder) = (editor.session.factory().clone(), editor.session.folder());
                    let state = document.state();
                    editor.chart.start(ui.ctx(), &factory, text, folder, state);
                }
                Err(why) => editor.chart.fault = Some(why.to_string()),
            }
        }
        if is_busy {
            ui.spinner();
            ui.label("Measuring in small pictures…");
        }
    });
    let wrong = super::number::wrong(ui);
    if let Some(fault) = &editor.chart.fault {
        ui.label(RichText::new(fault).color(wrong));
    }
    let Some(picture) = &editor.chart.picture else { return };
    if editor.chart.state != editor.session.document.state() {
        ui.label(RichText::new("The scene has changed since").weak().small());
    }
    let mut large = None;
    ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        let image =
            egui::Image::new(picture).max_width(ui.available_width()).alt_text("Chart").sense(egui::Sense::click());
        let tip = "Time to the right, error upward: the lower left is best.\nClick to see it large";
        if ui.add(image).on_hover_text(tip).clicked() {
            large = Some(picture.clone());
        }
        for sentence in editor.chart.says.iter().filter(|sentence| !sentence.is_empty()) {
            ui.label(sentence);
        }
    });
    if let Some(picture) = large {
        editor.ask(Command::Show(Dialog::Chart(picture)));
    }
}
