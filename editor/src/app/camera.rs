//! Moving the camera: by the pointer, by buttons and by keys.

use crate::{
    document::{Document, Edit},
    view,
};
use egui::{Context, Key, Modifiers, Ui};
use snell::{
    components::{
        camera::Camera,
        math,
        name::Name,
        transform::{Step, Transform},
    },
    prelude::{DAffine3, DVec3},
    systems::scene::Thing,
};

/// A motion of the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Motion {
    /// In its own axes, as parts of the distance to what it looks at: to the right, up, forward.
    Shift(DVec3),
    /// Where it stands, in degrees: to the right and up.
    Look(f64, f64),
    /// Clockwise, in degrees.
    Roll(f64),
    /// About a point of the world, in degrees: around and over.
    Orbit(DVec3, f64, f64),
    /// To a point of the world: what its distance is multiplied by.
    Zoom(DVec3, f64),
    /// Sideways in the world.
    Pan(DVec3),
    /// About an axis through the origin of the world, in degrees.
    About(DVec3, f64),
}

/// What is done by a press of a button or key.
struct Press {
    label: &'static str,
    icon: &'static str,
    key: Key,
    modifiers: Modifiers,
    motion: Motion,
}

const fn press(label: &'static str, icon: &'static str, key: Key, modifiers: Modifiers, motion: Motion) -> Press {
    Press { label, icon, key, modifiers, motion }
}

const fn shift(x: f64, y: f64, z: f64) -> Motion {
    Motion::Shift(DVec3::new(0.1 * x, 0.1 * y, 0.1 * z))
}

const PLAIN: Modifiers = Modifiers::NONE;
const SHIFT: Modifiers = Modifiers::SHIFT;

/// Moves first, then turns: three each in a row.
const PRESSES: [[Press; 2]; 6] = [
    [
        press("Move left", "←", Key::A, PLAIN, shift(-1.0, 0.0, 0.0)),
        press("Move right", "→", Key::D, PLAIN, shift(1.0, 0.0, 0.0)),
    ],
    [
        press("Move up", "↑", Key::E, PLAIN, shift(0.0, 1.0, 0.0)),
        press("Move down", "↓", Key::Q, PLAIN, shift(0.0, -1.0, 0.0)),
    ],
    [
        press("Move in", "+", Key::W, PLAIN, shift(0.0, 0.0, 1.0)),
        press("Move out", "−", Key::S, PLAIN, shift(0.0, 0.0, -1.0)),
    ],
    [
        press("Turn left", "←", Key::ArrowLeft, PLAIN, Motion::Look(-5.0, 0.0)),
        press("Turn right", "→", Key::ArrowRight, PLAIN, Motion::Look(5.0, 0.0)),
    ],
    [
        press("Turn up", "↑", Key::ArrowUp, PLAIN, Motion::Look(0.0, 5.0)),
        press("Turn down", "↓", Key::ArrowDown, PLAIN, Motion::Look(0.0, -5.0)),
    ],
    [
        press("Roll left", "↺", Key::ArrowLeft, SHIFT, Motion::Roll(-5.0)),
        press("Roll right", "↻", Key::ArrowRight, SHIFT, Motion::Roll(5.0)),
    ],
];

/// Motions whose keys were pressed, unless text is being typed.
pub(super) fn pressed(ctx: &Context) -> Vec<Motion> {
    if ctx.text_edit_focused() {
        return vec![];
    }
    let mut motions = vec![];
    // Those with Shift first: without, a key is taken whatever is held besides.
    let (shifted, plain): (Vec<_>, Vec<_>) = PRESSES.iter().flatten().partition(|press| press.modifiers == SHIFT);
    for press in shifted.into_iter().chain(plain) {
        for _ in 0..ctx.input_mut(|input| input.count_and_consume_key(press.modifiers, press.key)) {
            motions.push(press.motion);
        }
    }
    motions
}

/// Buttons for all motions; the motion of one that is pressed.
pub(super) fn buttons(ui: &mut Ui) -> Option<Motion> {
    let mut motion = None;
    for row in PRESSES.chunks(3) {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 3.0;
            for press in row.iter().flatten() {
                let keys = ui.ctx().format_shortcut(&egui::KeyboardShortcut::new(press.modifiers, press.key));
                let button = ui.add(egui::Button::new(press.icon).min_size(egui::vec2(26.0, 22.0)));
                if button.accessible_name(press.label).on_hover_text(format!("{} ({keys})", press.label)).clicked() {
                    motion = Some(press.motion);
                }
            }
            let what = if matches!(row[0][0].motion, Motion::Shift(_)) { "move" } else { "turn, roll" };
            ui.label(egui::RichText::new(what).weak());
        });
    }
    motion
}

/// The camera of the scene: the first in the order of names, as the renderer takes it.
#[must_use]
pub(super) fn find(document: &Document) -> Option<(&Name, &Thing, &Camera)> {
    let cameras = document.things().filter_map(|(name, thing)| Some((name, &**thing, thing.get::<Camera>()?)));
    cameras.min_by(|a, b| a.0.cmp(b.0))
}

/// Maps the space in which a thing's component is stated to the world, without the placement of the scene as a whole.
#[must_use]
pub(super) fn world_from_object(document: &Document, thing: &Thing) -> DAffine3 {
    let own = thing.get::<Transform>().map(Transform::matrix).unwrap_or_default();
    world_from_parent(document, thing) * own
}

/// Maps the space in which a thing is placed to the world, without the placement of the scene as a whole.
#[must_use]
pub(super) fn world_from_parent(document: &Document, thing: &Thing) -> DAffine3 {
    let mut matrix = DAffine3::IDENTITY;
    let mut next = thing.parent.as_ref();
    // Parents in a circle are a fault that the loader tells; here it must only come to an end.
    for _ in 0..1000 {
        let Some(parent) = next.and_then(|name| document.get(name)) else { break };
        matrix = parent.get::<Transform>().map(Transform::matrix).unwrap_or_default() * matrix;
        next = parent.parent.as_ref();
    }
    matrix
}

/// The distance from the camera to what it looks at, object space.
fn reach(camera: &Camera) -> f64 {
    camera.target.map_or(5.0, |target| target.distance(camera.position))
}

/// The edit that moves the camera, if there is one.
#[must_use]
pub(super) fn moved(document: &Document, motion: Motion) -> Option<Edit> {
    let (name, thing, camera) = find(document)?;
    let world = world_from_object(document, thing);
    let inside = |point: DVec3| world.inverse().transform_point3(point);
    let at = camera.moved();
    let moved = match motion {
        Motion::Shift(by) => view::shift(&at, by * reach(&at)),
        Motion::Look(right, up) => view::look(&at, right, up),
        Motion::Roll(degrees) => view::roll(&at, degrees),
        Motion::Orbit(pivot, around, over) => view::orbit(&at, inside(pivot), around, over),
        Motion::Zoom(about, factor) => view::zoom(&at, inside(about), factor),
        Motion::Pan(by) => {
            let by = world.inverse().transform_vector3(by);
            let mut camera = at.clone();
            camera.move_to(at.position + by);
            camera
        }
        Motion::About(axis, degrees) => {
            let mut camera = at.clone();
            camera.place(Step::Rotate { axis, degrees });
            camera
        }
    };
    let is_fine = moved.position.is_finite() && moved.view().is_finite() && moved.view() != DVec3::ZERO;
    is_fine.then(|| Edit::of("Move camera", name, thing.clone().with(moved)))
}

/// The edit after which the camera sees a sphere whole.
#[must_use]
pub(super) fn framed(document: &Document, center: DVec3, radius: f64) -> Option<Edit> {
    let (name, thing, camera) = find(document)?;
    let world = world_from_object(document, thing);
    let scale = math::pow(world.matrix3.determinant().abs(), 1.0 / 3.0).max(1e-9);
    let moved = view::frame(&camera.moved(), world.inverse().transform_point3(center), radius / scale);
    Some(Edit::of("Show selected", name, thing.clone().with(moved)))
}
