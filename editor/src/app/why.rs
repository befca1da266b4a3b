//! The panel that tells how a pixel comes about: its tree of rays.

use super::{command::Command, state::Editor};
use egui::{CollapsingHeader, Color32, RichText, ScrollArea, Sense, Ui, vec2};
use snell::{
    Picture, RayTree, Snapshot,
    components::name::Name,
    systems::{
        image::srgb8,
        render::{Added, Way},
        why::{Sample, TracedRay},
    },
    why,
};
use std::sync::{
    Arc,
    mpsc::{self, Receiver, TryRecvError},
};

/// Most rays through a pixel that are shown one by one.
const MOST_SAMPLES: usize = 16;

/// The pixel that was asked about.
#[derive(Default)]
pub(super) struct Why {
    pub(super) pixel: Option<(u32, u32)>,
    tree: Option<Arc<RayTree>>,
    waiting: Option<Receiver<RayTree>>,
    /// The state of the document that the tree is of.
    state: u64,
}

impl Why {
    /// Asks about a pixel; the answer comes from another thread, as a pixel can have thousands of rays.
    pub(super) fn ask(
        &mut self,
        x: u32,
        y: u32,
        state: u64,
        snapshot: Arc<Snapshot>,
        wake: impl FnOnce() + Send + 'static,
    ) {
        let (sender, receiver) = mpsc::channel();
        let work = move || {
            // Nobody waits if another pixel is asked about meanwhile.
            let _ = sender.send(why(&snapshot, x, y));
            wake();
        };
        let _ = std::thread::Builder::new().name("why".into()).spawn(work);
        (self.pixel, self.waiting, self.state) = (Some((x, y)), Some(receiver), state);
    }

    fn receive(&mut self) {
        match self.waiting.as_ref().map(Receiver::try_recv) {
            Some(Ok(tree)) => (self.tree, self.waiting) = (Some(Arc::new(tree)), None),
            // The thread gave up: a shape from outside panicked.
            Some(Err(TryRecvError::Disconnected)) => (self.tree, self.waiting) = (None, None),
            Some(Err(TryRecvError::Empty)) | None => {}
        }
    }
}

/// Shows the panel.
pub(super) fn show(editor: &mut Editor, ui: &mut Ui) {
    editor.why.receive();
    // What was asked is asked again after an edit, once that is drawn.
    let (state, is_new) = {
        let view = editor.session.worker.view();
        (view.state, view.state != editor.why.state)
    };
    if let (Some((x, y)), true, true) = (editor.why.pixel, is_new, editor.why.waiting.is_none()) {
        editor.ask_why(x, y);
        editor.why.state = state;
    }
    let Some(tree) = editor.why.tree.clone() else {
        ui.add_space(24.0);
        let hint = "Click a point of the picture to see where its colour comes from";
        ui.vertical_centered(|ui| ui.label(RichText::new(hint).weak()));
        return;
    };
    ui.horizontal(|ui| {
        swatch(ui, tree.pixel, 20.0);
        ui.label(RichText::new(format!("Pixel {}, {}", tree.x, tree.y)).strong());
        let [r, g, b] = tree.light;
        ui.label(RichText::new(format!("{r:.4}  {g:.4}  {b:.4}")).monospace())
            .on_hover_text("Linear red, green and blue");
        if ui.small_button("Copy").on_hover_text("All of it as text").clicked() {
            ui.ctx().copy_text(tree.to_string());
        }
    });
    ui.label(RichText::new("The parts add up to the pixel, to the last bit").weak().small());
    ui.separator();
    ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        let count = tree.samples.len();
        for (number, sample) in tree.samples.iter().enumerate().take(MOST_SAMPLES) {
            if count == 1 {
                rays(editor, ui, sample, None, number);
                continue;
            }
            let share = 100.0 * tree.share_of(number);
            let title = format!("Ray {} of {count} through the pixel: {share:.3} % of it", number + 1);
            CollapsingHeader::new(title).id_salt(("sample", number)).default_open(number == 0).show(ui, |ui| {
                rays(editor, ui, sample, None, number);
            });
        }
        if count > MOST_SAMPLES {
            ui.label(RichText::new(format!("and {} more", count - MOST_SAMPLES)).weak());
        }
    });
}

/// The rays that one ray sent, or the first.
fn rays(editor: &mut Editor, ui: &mut Ui, sample: &Sample, parent: Option<usize>, salt: usize) {
    for (number, ray) in sample.rays.iter().enumerate().filter(|(_, ray)| ray.start.parent == parent) {
        let brought = brought(sample, number);
        ui.horizontal(|ui| {
            swatch(ui, brought.map(|x| x as f32), 14.0);
            let header = CollapsingHeader::new(title(ray)).id_salt((salt, number)).default_open(ray.depth < 3);
            header.show(ui, |ui| {
                of_ray(editor, ui, sample, ray, number);
                rays(editor, ui, sample, Some(number), salt);
            });
        });
    }
}

fn title(ray: &TracedRay) -> String {
    let way = match ray.start.way {
        Way::Camera => "From the camera",
        Way::Mirrored => "Mirrored",
        Way::Transmitted => "Let through",
        Way::Onward => "Goes on",
    };
    match &ray.met {
        Some(met) => format!("{way} → {}", met.object.name.as_deref().unwrap_or("a nameless thing")),
        None => format!("{way} → background"),
    }
}

fn of_ray(editor: &mut Editor, ui: &mut Ui, sample: &Sample, ray: &TracedRay, number: usize) {
    let triple = |[r, g, b]: [f64; 3]| format!("{r:.4}  {g:.4}  {b:.4}");
    let line = |ui: &mut Ui, what: &str, value: String| {
        ui.horizontal(|ui| {
            ui.label(RichText::new(what).weak().small());
            ui.label(RichText::new(value).monospace().size(12.0));
        });
    };
    line(ui, "weight", triple(ray.weight_at_end));
    if let Some(met) = &ray.met {
        line(ui, if met.from_outside { "from outside, at" } else { "from inside, at" }, format!("{:.4}", met.distance));
        if let Some(name) = &met.object.name
            && ui.small_button(format!("Select {name}")).clicked()
        {
            editor.ask(Command::Select(Some(Name::new(name.as_str()))));
        }
    }
    for term in &ray.terms {
        line(ui, term.effect.component.unwrap_or("light"), triple(term.amount));
        for lamp in &term.lamps {
            let name = lamp.lamp.name.as_deref().unwrap_or("a lamp");
            let hidden = match (lamp.hidden, lamp.in_the_way.first().and_then(|thing| thing.name.as_deref())) {
                (0, _) => String::new(),
                (_, Some(by)) => format!(", behind {by}"),
                (..) => ", hidden".into(),
            };
            line(ui, &format!("   {name}{hidden}"), triple(lamp.light));
        }
    }
    for part in sample.contributions.iter().filter(|part| part.ray == number) {
        let what = match part.what {
            Added::Background => "adds of the background",
            Added::BeyondDepth => "adds for rays beyond the depth",
            Added::Surface => "adds in all",
        };
        line(ui, what, triple(part.amount));
    }
}

/// What a ray itself adds to its sample.
fn brought(sample: &Sample, ray: usize) -> [f64; 3] {
    let parts = sample.contributions.iter().filter(|part| part.ray == ray);
    parts.fold([0.0; 3], |sum, part| [0, 1, 2].map(|channel| sum[channel] + part.amount[channel]))
}

fn swatch(ui: &mut Ui, light: [f32; 3], size: f32) {
    let (rect, _) = ui.allocate_exact_size(vec2(size, size), Sense::hover());
    let shown = srgb8(&Picture { width: 1, height: 1, pixels: vec![light] });
    let [r, g, b] = shown.first().copied().unwrap_or_default();
    ui.painter().rect(rect, 3.0, Color32::from_rgb(r, g, b), ui.visuals().window_stroke, egui::StrokeKind::Inside);
}
