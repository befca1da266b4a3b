//! The picture in the middle: what was drawn, and what the pointer does in it.

use super::{
    camera::{self, Motion},
    command::Command,
    gizmo,
    state::Editor,
};
use crate::worker::{Phase, Worker};
use egui::{
    Color32, ColorImage, CursorIcon, PointerButton, Pos2, Rect, Sense, Stroke, StrokeKind, TextureHandle,
    TextureOptions, Ui, pos2, vec2,
};
use snell::{
    Methods, Region, Snapshot,
    components::{math, primitive::Cost, space::Ray},
    prelude::DVec3,
};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The picture as the graphics card has it.
#[derive(Default)]
pub(super) struct Viewport {
    texture: Option<TextureHandle>,
    size: [usize; 2],
    /// Where the picture was last shown.
    rect: Option<Rect>,
    /// The point of the world about which the camera is turned or dragged.
    pivot: Option<DVec3>,
    /// Where a region was begun, in pixels of the picture.
    region_start: Option<Pos2>,
    /// Whether the next drag draws a region.
    pub(super) picks_region: bool,
}

/// How a picture lies on the screen.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) rect: Rect,
    pub(super) width: u32,
    pub(super) height: u32,
}

impl Place {
    /// A point of the screen in pixels of the picture.
    pub(super) fn pixel(&self, at: Pos2) -> Pos2 {
        let scale = self.rect.width() / self.width as f32;
        pos2((at.x - self.rect.left()) / scale, (at.y - self.rect.top()) / scale)
    }

    /// The ray of the world through a point of the screen.
    pub(super) fn ray(&self, snapshot: &Snapshot, at: Pos2) -> Ray {
        let pixel = self.pixel(at);
        snapshot.view.ray(f64::from(pixel.x), f64::from(pixel.y), self.width, self.height)
    }

    /// Where on the screen a point of the world is, unless it is behind the camera.
    pub(super) fn project(&self, snapshot: &Snapshot, point: DVec3) -> Option<Pos2> {
        let view = &snapshot.view;
        let distance = view.forward.length();
        let from_eye = point - view.eye;
        let depth = from_eye.dot(view.forward) / distance;
        if depth <= 1e-9 * distance.max(from_eye.length()) {
            return None;
        }
        let scale = distance / depth * f64::from(self.rect.height());
        let right = from_eye.dot(view.right) * scale;
        let up = from_eye.dot(view.up) * scale;
        let center = self.rect.center();
        Some(pos2(center.x + right as f32, center.y - up as f32)).filter(|at| at.is_finite())
    }

    /// The region of the picture between two of its points.
    fn region(&self, a: Pos2, b: Pos2) -> Option<Region> {
        let whole = |x: f32, most: u32| (x.max(0.0).floor() as u32).min(most);
        let (left, right) = (whole(a.x.min(b.x), self.width), whole(a.x.max(b.x).ceil(), self.width));
        let (top, bottom) = (whole(a.y.min(b.y), self.height), whole(a.y.max(b.y).ceil(), self.height));
        let region = Region { x: left, y: top, width: right - left, height: bottom - top };
        region.fits(self.width, self.height).then_some(region)
    }
}

impl Viewport {
    /// Takes what is new on the worker's screen.
    fn update(&mut self, ui: &Ui, worker: &Worker) {
        let mut view = worker.view();
        let screen = &mut view.screen;
        let rows = screen.take_dirty();
        let size = [screen.width as usize, screen.height as usize];
        if screen.pixels.is_empty() || size[0] * size[1] == 0 {
            return;
        }
        // Every second pixel or fewer where the graphics card holds no picture of that size.
        let shrink = size[0].max(size[1]).div_ceil(ui.input(|input| input.max_texture_side).max(1));
        let image = |rows: std::ops::Range<usize>| {
            let (start, end) = (rows.start * size[0], rows.end * size[0]);
            let rows = screen.pixels[start..end].chunks_exact(size[0]).step_by(shrink);
            let pixels: Vec<_> = rows
                .flat_map(|row| row.iter().step_by(shrink).map(|[r, g, b]| Color32::from_rgb(*r, *g, *b)))
                .collect();
            let columns = size[0].div_ceil(shrink);
            ColorImage::new([columns, pixels.len() / columns], pixels)
        };
        let options = TextureOptions { magnification: egui::TextureFilter::Nearest, ..TextureOptions::LINEAR };
        match &mut self.texture {
            Some(texture) if self.size == size => {
                if !rows.is_empty() {
                    let first = rows.start as usize / shrink;
                    texture.set_partial([0, first], image(first * shrink..rows.end as usize), options);
                }
            }
            texture => {
                let image = image(0..size[1]);
                drop(view);
                self.size = size;
                match texture {
                    Some(texture) => texture.set(image, options),
                    None => *texture = Some(ui.ctx().load_texture("picture", image, options)),
                }
            }
        }
    }

    /// Where the picture is, if there is one.
    pub(super) fn place(&self) -> Option<Place> {
        let [width, height] = self.size;
        Some(Place { rect: self.rect?, width: width as u32, height: height as u32 }).filter(|place| place.width > 0)
    }
}

/// What a ray meets first: the point, and the name of the object. A shape from outside that panics is not met.
pub(super) fn meet(snapshot: &Snapshot, ray: &Ray) -> Option<(DVec3, Option<snell::components::name::Name>)> {
    let closest = || snapshot.geometry.closest(ray, f64::INFINITY, &Methods::default(), &mut Cost::default());
    let met = catch_unwind(AssertUnwindSafe(closest)).ok().flatten()?;
    Some((met.surface.point, snapshot.names.get(met.object as usize).cloned().flatten()))
}

/// Shows the picture and does what the pointer asks for.
pub(super) fn show(editor: &mut Editor, ui: &mut Ui) {
    let available = ui.available_rect_before_wrap();
    ui.painter().rect_filled(available, 0.0, ui.visuals().extreme_bg_color);
    editor.viewport.update(ui, &editor.session.worker);
    let response =
        ui.interact(available, ui.scope_id().with("picture"), Sense::click_and_drag()).accessible_name("Viewport");
    let (snapshot, error, is_empty) = {
        let view = editor.session.worker.view();
        (view.snapshot.clone(), view.error.clone(), view.phase == Phase::Empty)
    };
    let [width, height] = editor.viewport.size;
    if let Some(texture) = &editor.viewport.texture
        && !is_empty
        && width * height > 0
    {
        let room = available.shrink(8.0);
        let scale = (room.width() / width as f32).min(room.height() / height as f32);
        // Up to four times as large, so that a small picture shows its pixels and does not fill the window.
        let size = vec2(width as f32, height as f32) * scale.min(4.0);
        let rect = Rect::from_center_size(room.center(), size);
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let dim = if error.is_some() { Color32::from_gray(90) } else { Color32::WHITE };
        ui.painter().image(texture.id(), rect, whole, dim);
        editor.viewport.rect = Some(rect);
    }
    let (Some(place), Some(snapshot)) = (editor.viewport.place(), snapshot) else {
        return told(editor, ui, available, error);
    };
    let ui = &mut ui.new_child(egui::UiBuilder::new().max_rect(available));
    ui.set_clip_rect(available);
    show_region(editor, ui, &place);
    let is_handled = if error.is_none() { gizmo::show(editor, ui, &place, &snapshot) } else { false };
    if !is_handled {
        point(editor, ui, &response, &place, &snapshot);
    }
    told(editor, ui, available, error);
}

/// Says why there is no new picture.
fn told(editor: &mut Editor, ui: &mut Ui, available: Rect, error: Option<String>) {
    let Some(error) = error else { return };
    let is_about_camera = camera::find(&editor.session.document).is_none();
    egui::Area::new(ui.scope_id().with("error")).fixed_pos(available.center()).pivot(egui::Align2::CENTER_CENTER).show(
        ui.ctx(),
        |ui| {
            egui::Frame::popup(ui.style()).show(ui, |ui| {
                ui.set_max_width(360.0);
                ui.vertical_centered(|ui| {
                    let error = if is_about_camera {
                        "There is no camera yet, so there is nothing to see"
                    } else {
                        error.as_str()
                    };
                    ui.label(egui::RichText::new(error).color(super::number::wrong(ui)));
                    if is_about_camera && ui.button("Add a camera").clicked() {
                        editor.ask(Command::AddCamera);
                    }
                });
            });
        },
    );
}

/// The border of the region that is drawn exactly, and dragging a new one.
fn show_region(editor: &Editor, ui: &Ui, place: &Place) {
    let Some(region) = editor.session.how().region.filter(|region| region.fits(place.width, place.height)) else {
        return;
    };
    let scale = place.rect.width() / place.width as f32;
    let corner = place.rect.min + vec2(region.x as f32, region.y as f32) * scale;
    let rect = Rect::from_min_size(corner, vec2(region.width as f32, region.height as f32) * scale);
    ui.painter().rect_stroke(rect, 0.0, Stroke::new(1.0, Color32::BLACK), StrokeKind::Outside);
    ui.painter().rect_stroke(
        rect.expand(1.0),
        0.0,
        Stroke::new(1.5, Color32::from_rgb(255, 190, 60)),
        StrokeKind::Outside,
    );
}

/// What the pointer does where no handle is.
fn point(editor: &mut Editor, ui: &Ui, response: &egui::Response, place: &Place, snapshot: &Snapshot) {
    let pointer = response.interact_pointer_pos().or(response.hover_pos());
    if editor.viewport.picks_region {
        return pick_region(editor, response, place, pointer);
    }
    let Some(at) = pointer else { return };
    let is_within = place.rect.contains(at);
    if response.clicked() && is_within {
        if editor.is_asking_why() {
            let pixel = place.pixel(at);
            editor.ask_why(pixel.x as u32, pixel.y as u32);
        } else {
            let picked = meet(snapshot, &place.ray(snapshot, at)).and_then(|(_, name)| name);
            editor.ask(Command::Select(picked));
        }
    }
    let [orbits, pans] = [PointerButton::Secondary, PointerButton::Middle].map(|button| response.dragged_by(button));
    let mut delta = response.drag_delta();
    if response.drag_started() {
        // A drag is one only after a few points, but begins where the button was pressed.
        let origin = ui.input(|input| input.pointer.press_origin()).unwrap_or(at);
        editor.viewport.pivot = Some(pivot(editor, place, snapshot, origin));
        delta = at - origin;
    }
    if (orbits || pans) && delta != egui::Vec2::ZERO {
        let pivot = editor.viewport.pivot.unwrap_or_else(|| pivot(editor, place, snapshot, at));
        let is_pan = pans || ui.input(|input| input.modifiers.shift);
        let motion = if is_pan {
            Motion::Pan(pan(place, snapshot, pivot, delta))
        } else {
            Motion::Orbit(pivot, f64::from(-delta.x) * 0.4, f64::from(delta.y) * 0.4)
        };
        editor.ask(Command::Move(motion));
        ui.ctx().set_cursor_icon(if is_pan { CursorIcon::Grabbing } else { CursorIcon::AllScroll });
    }
    let scroll = if response.hovered() {
        ui.input(|input| input.smooth_scroll_delta().y + 200.0 * (input.zoom_delta() - 1.0))
    } else {
        0.0
    };
    if scroll != 0.0 && is_within {
        let about = pivot(editor, place, snapshot, at);
        editor.ask(Command::Move(Motion::Zoom(about, math::pow(0.998, f64::from(scroll)))));
    }
}

/// The point of the world under the pointer; where nothing is, one as far away as what the camera looks at.
fn pivot(editor: &Editor, place: &Place, snapshot: &Snapshot, at: Pos2) -> DVec3 {
    let ray = place.ray(snapshot, at);
    if let Some((point, _)) = meet(snapshot, &ray) {
        return point;
    }
    let target = editor.looked_at();
    let forward = snapshot.view.forward.normalize();
    let depth = (target - snapshot.view.eye).dot(forward).max(1e-6);
    ray.at(depth / ray.direction.dot(forward).max(1e-6))
}

/// How far the camera moves in the world so that a point follows the pointer.
fn pan(place: &Place, snapshot: &Snapshot, pivot: DVec3, delta: egui::Vec2) -> DVec3 {
    let view = &snapshot.view;
    let distance = view.forward.length();
    let depth = (pivot - view.eye).dot(view.forward) / distance;
    let scale = depth / distance / f64::from(place.rect.height());
    view.right * (-f64::from(delta.x) * scale) + view.up * (f64::from(delta.y) * scale)
}

fn pick_region(editor: &mut Editor, response: &egui::Response, place: &Place, pointer: Option<Pos2>) {
    if let Some(at) = pointer {
        if response.drag_started() {
            editor.viewport.region_start = Some(place.pixel(at));
        }
        if let (Some(start), true) = (editor.viewport.region_start, response.dragged() || response.drag_stopped())
            && let Some(region) = place.region(start, place.pixel(at))
        {
            editor.pending_region = Some(region);
        }
    }
    if response.drag_stopped() {
        editor.viewport.region_start = None;
        editor.viewport.picks_region = false;
        if let Some(region) = editor.pending_region.take() {
            let how = editor.session.how();
            editor.session.set_how(crate::worker::How { region: Some(region), ..how });
        }
    }
}
