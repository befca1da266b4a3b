//! Handles by which the selected thing is moved, turned and scaled.
//!
//! They stand at the thing's middle, along the axes of the space in which it is placed, and always have the same size on
//! the screen.

use super::{
    add,
    camera::{world_from_object, world_from_parent},
    command::Command,
    state::Editor,
    viewport::Place,
};
use crate::{document::Edit, placement};
use egui::{Color32, Pos2, Rect, Sense, Stroke, Ui, Vec2, vec2};
use snell::{
    Snapshot,
    components::{camera::Camera, name::Name, space::BoundingSphere, transform::Transform},
    prelude::{DAffine3, DVec3},
    systems::scene::Thing,
};

/// What the handles do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Tool {
    /// Along the axes.
    #[default]
    Move,
    /// About the axes.
    Turn,
    /// All at once, or along an axis.
    Scale,
}

impl Tool {
    pub(super) const ALL: [Self; 3] = [Self::Move, Self::Turn, Self::Scale];

    pub(super) fn label(self) -> &'static str {
        match self {
            Self::Move => "Move",
            Self::Turn => "Turn",
            Self::Scale => "Scale",
        }
    }
}

/// A drag that is going on.
pub(super) struct Drag {
    tool: Tool,
    /// 0 to 2: an axis; 3: all.
    axis: usize,
    name: Name,
    start: Thing,
    /// The pivot in the space in which the thing is placed.
    pivot: DVec3,
    /// Where on the handle it was taken: a length, an angle in degrees, a distance on the screen.
    taken: f64,
}

const AXES: [DVec3; 3] = [DVec3::X, DVec3::Y, DVec3::Z];
const COLOURS: [Color32; 3] =
    [Color32::from_rgb(235, 80, 75), Color32::from_rgb(110, 200, 80), Color32::from_rgb(80, 140, 250)];
/// Length of the handles on the screen, points.
const LENGTH: f32 = 78.0;
const KNOB: f32 = 7.0;

/// Where the handles stand and along what.
struct Frame {
    world_from_parent: DAffine3,
    /// World.
    pivot: DVec3,
    at: Pos2,
    /// Length in the world of what is [`LENGTH`] on the screen.
    length: f64,
}

impl Frame {
    /// Along an axis of the space of the parent, in the world; unit.
    fn axis(&self, number: usize) -> DVec3 {
        self.world_from_parent.transform_vector3(AXES[number]).normalize_or(AXES[number])
    }
}

/// Shows the handles of the selected thing, if it has any; whether the pointer is busy with them.
pub(super) fn show(editor: &mut Editor, ui: &Ui, place: &Place, snapshot: &Snapshot) -> bool {
    let Some((name, thing)) = editor.selected_thing() else { return false };
    if thing.get::<Camera>().is_some() {
        return false;
    }
    let Some(frame) = frame(editor, &name, &thing, place, snapshot) else { return false };
    outline(ui, place, snapshot, &name);
    let tool = editor.tool;
    let mut busy = false;
    let knobs = knobs(&frame, place, snapshot, tool);
    for (axis, knob) in knobs.iter().enumerate() {
        let Some(knob) = knob else { continue };
        let rect = Rect::from_center_size(knob.at, Vec2::splat(3.0 * KNOB));
        let response = ui.interact(rect, ui.scope_id().with(("handle", axis)), Sense::drag());
        let along = if tool == Tool::Turn { "about" } else { "along" };
        let label =
            if axis == 3 { "Scale all".into() } else { format!("{} {along} {}", tool.label(), ["x", "y", "z"][axis]) };
        let response = response.accessible_name(label);
        let is_hot = response.hovered() || response.dragged();
        knob.draw(ui, &frame, axis, tool, is_hot);
        busy |= is_hot;
        let Some(pointer) = response.interact_pointer_pos() else { continue };
        if response.drag_started() {
            let pivot = frame.world_from_parent.inverse().transform_point3(frame.pivot);
            let taken = measure(&frame, place, snapshot, tool, axis, pointer);
            let Some(taken) = taken else { continue };
            editor.drag = Some(Drag { tool, axis, name: name.clone(), start: thing.clone(), pivot, taken });
        } else if response.dragged()
            && let Some(drag) = editor.drag.as_ref().filter(|drag| drag.tool == tool && drag.axis == axis)
            && let Some(now) =
                measure(&frame_at_start(&frame, drag, place, snapshot), place, snapshot, tool, axis, pointer)
        {
            let fine = ui.input(|input| input.modifiers.command);
            let edit = drag.edit(now, fine, editor);
            editor.ask(Command::Gesture(edit));
        }
        if response.drag_stopped() {
            editor.drag = None;
        }
    }
    busy
}

/// The frame as it was when the drag began: handles that run away from the pointer cannot be measured by.
fn frame_at_start(now: &Frame, drag: &Drag, place: &Place, snapshot: &Snapshot) -> Frame {
    let pivot = now.world_from_parent.transform_point3(drag.pivot);
    let at = place.project(snapshot, pivot).unwrap_or(now.at);
    Frame { world_from_parent: now.world_from_parent, pivot, at, length: now.length }
}

fn frame(editor: &Editor, name: &Name, thing: &Thing, place: &Place, snapshot: &Snapshot) -> Option<Frame> {
    let document = &editor.session.document;
    let scene = &document.settings().transform;
    let is_light = thing.components.values().any(|component| add::position(component.as_ref()).is_some());
    let world_from_scene = if scene.0.is_empty() || (is_light && !document.settings().transform_lights) {
        DAffine3::IDENTITY
    } else {
        scene.matrix()
    };
    let pivot = match sphere(snapshot, name) {
        Some(sphere) => sphere.center,
        None => {
            let own = thing.components.values().find_map(|component| add::position(component.as_ref()));
            (world_from_scene * world_from_object(document, thing)).transform_point3(own.unwrap_or_default())
        }
    };
    let at = place.project(snapshot, pivot)?;
    let view = &snapshot.view;
    let distance = view.forward.length();
    let depth = (pivot - view.eye).dot(view.forward) / distance;
    let length = f64::from(LENGTH / place.rect.height()) * depth / distance;
    let world_from_parent = world_from_scene * world_from_parent(document, thing);
    Some(Frame { world_from_parent, pivot, at, length })
}

struct Knob {
    at: Pos2,
    /// What leads to it on the screen.
    line: Vec<Pos2>,
}

impl Knob {
    fn draw(&self, ui: &Ui, frame: &Frame, axis: usize, tool: Tool, is_hot: bool) {
        let color = COLOURS.get(axis).copied().unwrap_or(Color32::from_gray(230));
        let color = if is_hot { Color32::from_rgb(255, 220, 90) } else { color };
        let painter = ui.painter();
        let dark = Color32::from_black_alpha(150);
        painter.line(self.line.clone(), Stroke::new(4.0, dark));
        painter.line(self.line.clone(), Stroke::new(2.0, color));
        let size = if is_hot { KNOB + 1.0 } else { KNOB };
        match tool {
            Tool::Move => {
                let along = (self.at - frame.at).normalized();
                let side = vec2(-along.y, along.x);
                let tip = [self.at + along * size * 1.6, self.at + side * size * 0.9, self.at - side * size * 0.9];
                painter.add(egui::Shape::convex_polygon(tip.to_vec(), color, Stroke::new(1.0, dark)));
            }
            Tool::Turn => {
                painter.circle(self.at, size, color, Stroke::new(1.0, dark));
            }
            Tool::Scale => {
                let rect = Rect::from_center_size(self.at, Vec2::splat(size * 1.7));
                painter.rect(rect, 2.0, color, Stroke::new(1.0, dark), egui::StrokeKind::Inside);
            }
        }
    }
}

/// The handles: one for each axis and one for all; none where an axis points at the camera.
fn knobs(frame: &Frame, place: &Place, snapshot: &Snapshot, tool: Tool) -> [Option<Knob>; 4] {
    let along = |number: usize| {
        let at = place.project(snapshot, frame.pivot + frame.axis(number) * frame.length)?;
        ((at - frame.at).length() > 14.0).then(|| Knob { at, line: vec![frame.at, at] })
    };
    let around = |number: usize| {
        // A quarter of a circle on the side of the camera, its knob in the middle.
        let axis = frame.axis(number);
        let to_eye = (snapshot.view.eye - frame.pivot).normalize();
        let near = (to_eye - axis * to_eye.dot(axis)).try_normalize()?;
        let side = axis.cross(near);
        let point = |degrees: f64| {
            let (sin, cos) = snell::components::math::sin_cos_degrees(degrees);
            place.project(snapshot, frame.pivot + (near * cos + side * sin) * frame.length)
        };
        // Apart from each other: those of the three axes would meet where the eye is on a diagonal.
        let middle = [-38.0, 0.0, 38.0][number];
        let line: Vec<Pos2> = (-40..=40).filter_map(|step| point(f64::from(2 * step))).collect();
        Some(Knob { at: point(middle)?, line })
    };
    match tool {
        Tool::Turn => [around(0), around(1), around(2), None],
        Tool::Move => [along(0), along(1), along(2), None],
        Tool::Scale => [along(0), along(1), along(2), Some(Knob { at: frame.at, line: vec![] })],
    }
}

/// Where the pointer is on a handle: a length along it, an angle in degrees about it, a distance on the screen.
fn measure(frame: &Frame, place: &Place, snapshot: &Snapshot, tool: Tool, axis: usize, pointer: Pos2) -> Option<f64> {
    if axis == 3 {
        return Some(f64::from(pointer.x - frame.at.x) - f64::from(pointer.y - frame.at.y));
    }
    let ray = place.ray(snapshot, pointer);
    let along = frame.axis(axis);
    if tool == Tool::Turn {
        let facing = ray.direction.dot(along);
        if facing.abs() < 0.05 {
            // Seen from the side: along the ring on the screen.
            let to_eye = (snapshot.view.eye - frame.pivot).normalize();
            let side = along.cross(to_eye).try_normalize()?;
            let tip = place.project(snapshot, frame.pivot + side * frame.length)?;
            let on_screen = tip - frame.at;
            return Some(f64::from((pointer - frame.at).dot(on_screen) / on_screen.length_sq()) * 57.3);
        }
        let t = (frame.pivot - ray.origin).dot(along) / facing;
        let arm = ray.at(t) - frame.pivot;
        let first = along.any_orthonormal_vector();
        let second = along.cross(first);
        return Some(snell::components::math::atan2(arm.dot(second), arm.dot(first)).to_degrees());
    }
    // The point of the axis nearest to the ray.
    let between = ray.origin - frame.pivot;
    let cosine = along.dot(ray.direction);
    let slant = 1.0 - cosine * cosine;
    if slant < 1e-6 {
        return None;
    }
    Some((between.dot(along) - cosine * between.dot(ray.direction)) / slant)
}

impl Drag {
    /// The edit that brings the thing from where it was to where the pointer is.
    fn edit(&self, now: f64, in_steps: bool, editor: &Editor) -> Edit {
        let snap = |x: f64, step: f64| if in_steps { (x / step).round() * step } else { x };
        let start = self.start.get::<Transform>().cloned().unwrap_or_default();
        let world_from_parent = world_from_parent(&editor.session.document, &self.start);
        let unit = |axis: usize| world_from_parent.transform_vector3(AXES[axis]).length().max(1e-9);
        let mut thing = self.start.clone();
        let placed = match self.tool {
            Tool::Move => {
                let by = AXES[self.axis] * tidy(snap((now - self.taken) / unit(self.axis), 0.25));
                if start.0.is_empty() && self.move_position(&mut thing, by) {
                    return self.of(thing);
                }
                placement::moved(&start, by)
            }
            Tool::Turn => {
                let turned = (now - self.taken + 540.0).rem_euclid(360.0) - 180.0;
                placement::turned(&start, tidy_vector(self.pivot), AXES[self.axis], tidy(snap(turned, 15.0)))
            }
            Tool::Scale => {
                let factor = if self.axis == 3 {
                    snell::components::math::pow(1.01, now - self.taken)
                } else if self.taken.abs() > 1e-9 {
                    (now / self.taken).max(0.01)
                } else {
                    1.0
                };
                let factor = tidy(snap(factor, 0.25)).max(0.01);
                let by =
                    if self.axis == 3 { DVec3::splat(factor) } else { DVec3::ONE + AXES[self.axis] * (factor - 1.0) };
                placement::scaled(&start, tidy_vector(self.pivot), by)
            }
        };
        self.of(thing.with(placed))
    }

    fn of(&self, thing: Thing) -> Edit {
        Edit::of(format!("{} {}", self.tool.label(), self.name.as_str()), &self.name, thing)
    }

    /// Moves what says itself where it is, as lights do; whether it does.
    fn move_position(&self, thing: &mut Thing, by: DVec3) -> bool {
        let mut is_moved = false;
        for component in thing.components.values_mut() {
            if let Some(at) = add::position(component.as_ref()) {
                add::set_position(component.as_mut(), at + by);
                is_moved = true;
            }
        }
        is_moved
    }
}

/// A number with few digits, as a hand can hold a pointer: files stay legible.
fn tidy(x: f64) -> f64 {
    (x * 1000.0).round() / 1000.0
}

fn tidy_vector(v: DVec3) -> DVec3 {
    DVec3::new(tidy(v.x), tidy(v.y), tidy(v.z))
}

/// The sphere around a thing, if it is in the picture and bounded.
pub(super) fn sphere(snapshot: &Snapshot, name: &Name) -> Option<BoundingSphere> {
    let object = snapshot.names.iter().position(|known| known.as_ref() == Some(name))?;
    snapshot.geometry.bounding_sphere(object as u32)
}

/// A circle around the selected thing.
fn outline(ui: &Ui, place: &Place, snapshot: &Snapshot, name: &Name) {
    let Some(sphere) = sphere(snapshot, name) else { return };
    let Some(center) = place.project(snapshot, sphere.center) else { return };
    let up = snapshot.view.up;
    let Some(edge) = place.project(snapshot, sphere.center + up * sphere.radius) else { return };
    let radius = (edge - center).length();
    ui.painter().circle_stroke(center, radius + 2.0, Stroke::new(2.5, Color32::from_black_alpha(120)));
    ui.painter().circle_stroke(center, radius + 2.0, Stroke::new(1.0, Color32::from_rgb(255, 190, 60)));
}
