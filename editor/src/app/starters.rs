//! Scenes to begin with, each shown as Snell draws it.

use super::{command::Command, state::Editor};
use crate::loader::Factory;
use egui::{Color32, ColorImage, Context, RichText, TextureHandle, TextureOptions, Ui, vec2};
use snell::{Options, render};
use std::sync::mpsc::{self, Receiver};

/// A ready scene.
pub(super) struct Starter {
    pub(super) name: &'static str,
    about: &'static str,
    pub(super) text: &'static str,
}

/// All of them; the first is what a window without a scene holds.
pub(super) const ALL: &[Starter] = &[
    Starter { name: "Empty", about: "A camera, light and ground", text: include_str!("../../starters/empty.ron") },
    Starter { name: "Ball", about: "One shiny ball", text: include_str!("../../starters/ball.ron") },
    Starter { name: "Glass", about: "Things behind and inside glass", text: include_str!("../../starters/glass.ron") },
    Starter {
        name: "Mirrors",
        about: "Balls that mirror each other",
        text: include_str!("../../starters/mirrors.ron"),
    },
    Starter { name: "Studio", about: "Soft light on a table", text: include_str!("../../starters/studio.ron") },
    Starter { name: "Shapes", about: "All that can be built from", text: include_str!("../../starters/shapes.ron") },
];

const SIZE: [u32; 2] = [208, 130];

/// Small pictures of the ready scenes, drawn in the background.
pub(super) struct Thumbnails {
    receiver: Receiver<(usize, ColorImage)>,
    textures: Vec<Option<TextureHandle>>,
}

impl Thumbnails {
    /// Begins to draw.
    pub(super) fn new(ctx: &Context, factory: &Factory) -> Self {
        let (sender, receiver) = mpsc::channel();
        let (ctx, factory) = (ctx.clone(), factory.clone());
        let work = move || {
            for (number, starter) in ALL.iter().enumerate() {
                let Some(image) = draw(&factory, starter.text) else { continue };
                if sender.send((number, image)).is_err() {
                    return;
                }
                ctx.request_repaint();
            }
        };
        // Without a thread there are names without pictures.
        let _ = std::thread::Builder::new().name("thumbnails".into()).spawn(work);
        Self { receiver, textures: ALL.iter().map(|_| None).collect() }
    }

    /// Whether some are still to come.
    pub(super) fn is_busy(&self) -> bool {
        self.textures.iter().any(Option::is_none)
    }

    fn receive(&mut self, ctx: &Context) {
        for (number, image) in self.receiver.try_iter() {
            self.textures[number] = Some(ctx.load_texture(ALL[number].name, image, TextureOptions::LINEAR));
        }
    }
}

fn draw(factory: &Factory, text: &str) -> Option<ColorImage> {
    let mut renderer = factory();
    renderer.load_text(text, "starter.ron").ok()?;
    let settings = &mut *renderer.settings();
    [settings.width, settings.height] = SIZE;
    let frame = render(&*renderer.snapshot().ok()?, &Options::default());
    let pixels = snell::systems::image::srgb8(&frame.picture);
    let pixels = pixels.into_iter().map(|[r, g, b]| Color32::from_rgb(r, g, b)).collect();
    Some(ColorImage::new(SIZE.map(|n| n as usize), pixels))
}

/// Shows them, and how else to begin.
pub(super) fn show(editor: &mut Editor, ui: &mut Ui) {
    let ctx = ui.ctx().clone();
    let factory = editor.session.factory().clone();
    let thumbnails = editor.thumbnails.get_or_insert_with(|| Thumbnails::new(&ctx, &factory));
    thumbnails.receive(&ctx);
    let textures = thumbnails.textures.clone();
    ui.heading("Begin with");
    for row in 0..2 {
        ui.horizontal(|ui| {
            for (starter, texture) in ALL.iter().zip(&textures).skip(3 * row).take(3) {
                if card(ui, starter, texture.as_ref()) {
                    editor.ask(Command::Start(starter.name));
                }
            }
        });
    }
    ui.separator();
    ui.horizontal_wrapped(|ui| {
        if ui.add(egui::Button::new("Open a file…").min_size(vec2(110.0, 26.0))).clicked() {
            editor.ask(Command::AskOpen);
        }
        let recent = crate::files::recent(editor.session.data());
        if !recent.is_empty() {
            ui.label(RichText::new("or go on with").weak());
        }
        for path in recent.into_iter().take(4) {
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                editor.ask(Command::Open(path));
            }
        }
    });
}

fn card(ui: &mut Ui, starter: &Starter, texture: Option<&TextureHandle>) -> bool {
    let size = vec2(SIZE[0] as f32, SIZE[1] as f32);
    let (rect, response) = ui.allocate_exact_size(size + vec2(12.0, 52.0), egui::Sense::click());
    let response = response.accessible_name(starter.name).on_hover_cursor(egui::CursorIcon::PointingHand);
    let visuals = ui.style().interact(&response);
    ui.painter().rect(rect, 6.0, visuals.weak_bg_fill, visuals.bg_stroke, egui::StrokeKind::Inside);
    let picture = egui::Rect::from_min_size(rect.min + vec2(6.0, 6.0), size);
    match texture {
        Some(texture) => {
            let whole = egui::Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
            ui.painter().image(texture.id(), picture, whole, Color32::WHITE);
        }
        None => {
            ui.painter().rect_filled(picture, 4.0, ui.visuals().extreme_bg_color);
        }
    }
    let font = |size: f32| egui::FontId::proportional(size);
    let below = picture.left_bottom() + vec2(2.0, 5.0);
    ui.painter().text(below, egui::Align2::LEFT_TOP, starter.name, font(15.0), ui.visuals().strong_text_color());
    ui.painter().text(
        below + vec2(0.0, 20.0),
        egui::Align2::LEFT_TOP,
        starter.about,
        font(12.5),
        ui.visuals().text_color(),
    );
    response.clicked()
}

#[cfg(test)]
mod tests {
    use super::*;
    use snell::Renderer;

    #[test]
    fn all_starting_scenes_are_sound() {
        for starter in ALL {
            let mut renderer = Renderer::new();
            let notices = renderer.load_text(starter.text, starter.name).expect(starter.name);
            assert!(notices.is_empty(), "{}", starter.name);
            let snapshot = renderer.snapshot().expect(starter.name);
            assert!(snapshot.left_out.is_empty(), "{}", starter.name);
        }
    }
}
