//! What the pointer does in the picture: the point under it stays, a handle moves along its own axis.

use crate::driver::Window;
use egui::{Key, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::kittest::Queryable;
use snell::{
    Methods,
    components::{camera::Camera, primitive::Cost},
    prelude::{DVec3, Transform},
};

fn open(folder: &std::path::Path) -> Window {
    let mut window = Window::open(folder, None);
    window.click("Glass");
    window.wait();
    window.menu(&["Picture"]);
    window.set("Width", "160");
    window.set("Height", "100");
    window.menu(&["Properties"]);
    window
}

/// Where the picture lies in the window: as large as it can be, but for a margin.
fn place(window: &Window) -> (egui::Rect, f32) {
    let snapshot = window.editor().session().worker.view().snapshot.clone().expect("a snapshot");
    let size = vec2(snapshot.settings.width as f32, snapshot.settings.height as f32);
    let room = window.node("Viewport").rect().shrink(8.0);
    let scale = (room.width() / size.x).min(room.height() / size.y).min(4.0);
    (egui::Rect::from_center_size(room.center(), size * scale), scale)
}

/// The point of the world that is seen at a point of the window, by the tracer.
fn seen(window: &Window, at: Pos2) -> DVec3 {
    let snapshot = window.editor().session().worker.view().snapshot.clone().expect("a snapshot");
    let (rect, scale) = place(window);
    let pixel = (at - rect.min) / scale;
    let (width, height) = (snapshot.settings.width, snapshot.settings.height);
    let ray = snapshot.view.ray(f64::from(pixel.x), f64::from(pixel.y), width, height);
    let met = snapshot.geometry.closest(&ray, f64::INFINITY, &Methods::default(), &mut Cost::default());
    met.expect("something there").surface.point
}

/// Where in the window a point of the world is: its pixel by the plane of the screen.
fn shown(window: &Window, point: DVec3) -> Pos2 {
    let snapshot = window.editor().session().worker.view().snapshot.clone().expect("a snapshot");
    let view = &snapshot.view;
    let (rect, _) = place(window);
    let arm = point - view.eye;
    let far = view.forward.length_squared() / arm.dot(view.forward);
    let height = f64::from(rect.height());
    let (right, up) = (arm.dot(view.right) * far * height, arm.dot(view.up) * far * height);
    rect.center() + vec2(right as f32, -up as f32)
}

fn camera(window: &Window) -> Camera {
    let document = &window.editor().session().document;
    document.things().find_map(|(_, thing)| thing.get::<Camera>().cloned()).expect("a camera")
}

fn wheel(window: &mut Window, at: Pos2, lines: f32) {
    window.harness.hover_at(at);
    window.step();
    window.harness.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Line,
        delta: vec2(0.0, lines),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Unknown,
        modifiers: Modifiers::NONE,
    });
    for _ in 0..20 {
        window.step();
    }
    window.wait();
}

#[test]
fn the_point_under_the_pointer_stays_under_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = open(folder.path());
    let middle = window.node("Viewport").rect().center();
    for off in [vec2(-120.0, 60.0), vec2(90.0, 110.0)] {
        let at = middle + off;
        let (start, point) = (camera(&window), seen(&window, at));
        assert!(shown(&window, point).distance(at) < 0.1, "what is seen there is shown there");

        // Zoom: nearer and farther, the point stays.
        for lines in [3.0, -5.0] {
            let before = camera(&window).position.distance(point);
            wheel(&mut window, at, lines);
            assert!(shown(&window, point).distance(at) < 0.5, "{lines}: {}", shown(&window, point));
            assert_eq!(camera(&window).position.distance(point) < before, lines > 0.0);
        }
        window.menu(&["Undo"]);
        assert_eq!(camera(&window), start, "turns of the wheel that follow each other are one step");

        // Pan: the point goes with the pointer.
        window.drag_with(PointerButton::Middle, at, vec2(50.0, -20.0));
        assert_ne!(camera(&window).position, start.position);
        assert!(shown(&window, point).distance(at + vec2(50.0, -20.0)) < 0.5, "{}", shown(&window, point));
        window.menu(&["Undo"]);
        assert_eq!(camera(&window), start);

        // Orbit: as far from the point as before, and the point stays.
        window.drag_with(PointerButton::Secondary, at, vec2(40.0, -15.0));
        let around = camera(&window);
        assert!(around.position.distance(start.position) > 0.1);
        assert!((around.position.distance(point) - start.position.distance(point)).abs() < 1e-9);
        assert!(shown(&window, point).distance(at) < 1.0, "{}", shown(&window, point));
        window.menu(&["Undo"]);
        assert_eq!(camera(&window), start, "one drag is one step");
    }
}

/// Where a handle is; fields at the right may have its name, too.
fn handle(window: &Window, label: &str) -> Pos2 {
    let viewport = window.node("Viewport").rect();
    let all = window.harness.query_all_by_label(label).map(|node| node.rect().center());
    all.into_iter().find(|at| viewport.contains(*at)).unwrap_or_else(|| panic!("no {label}"))
}

fn placed(window: &Window, name: &str) -> Transform {
    let name = snell::components::name::Name::new(name);
    let thing = window.editor().session().document.get(&name).cloned().expect("a thing");
    thing.get::<Transform>().cloned().unwrap_or_default()
}

#[test]
fn handles_move_turn_and_scale_along_their_own_axes() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = open(folder.path());
    window.menu(&["Cube"]);
    let start = placed(&window, "Cube").matrix();
    for (axis, unit) in [("x", DVec3::X), ("y", DVec3::Y), ("z", DVec3::Z)] {
        window.key(Modifiers::NONE, Key::G);
        let knob = handle(&window, &format!("Move along {axis}"));
        let middle = shown(&window, start.translation);
        window.drag(knob, (knob - middle) * 0.5);
        let by = placed(&window, "Cube").matrix().translation - start.translation;
        assert!(by.dot(unit) > 0.05 && (by - unit * by.dot(unit)).length() < 1e-12, "{axis}: {by}");
        window.menu(&["Undo"]);
        window.key(Modifiers::NONE, Key::R);
        let knob = handle(&window, &format!("Turn about {axis}"));
        window.drag(knob, vec2(25.0, 18.0));
        let turned = placed(&window, "Cube").matrix();
        assert!(turned.translation.distance(start.translation) < 1e-3, "{axis}: it turns about its middle");
        let relative = turned.matrix3 * start.matrix3.inverse();
        assert!(
            (relative * unit - unit).length() < 1e-9 && (relative.col(0) - DVec3::X).length() > 1e-3 || axis == "x"
        );
        window.menu(&["Undo"]);
        window.key(Modifiers::NONE, Key::T);
        let knob = handle(&window, &format!("Scale along {axis}"));
        window.drag(knob, (knob - middle) * 0.5);
        let scaled = placed(&window, "Cube").matrix().matrix3 * start.matrix3.inverse();
        let grown = (scaled * unit).dot(unit);
        assert!(grown > 1.1 && (scaled.determinant() - grown).abs() < 1e-9, "{axis}: {grown}");
        window.menu(&["Undo"]);
        assert_eq!(placed(&window, "Cube").matrix(), start);
    }
}

#[test]
fn escape_takes_a_drag_back_and_ctrl_makes_even_steps() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = open(folder.path());
    window.menu(&["Cube"]);
    let start = window.text();
    let knob = handle(&window, "Move along x");
    let press = |pos, pressed, modifiers| egui::Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers,
    };
    window.harness.hover_at(knob);
    window.step();
    window.harness.event(press(knob, true, Modifiers::NONE));
    window.step();
    window.harness.hover_at(knob + vec2(40.0, 0.0));
    window.step();
    window.wait();
    assert_ne!(window.text(), start);
    window.key(Modifiers::NONE, Key::Escape);
    window.wait();
    assert_eq!(window.text(), start);
    window.harness.event(press(knob + vec2(40.0, 0.0), false, Modifiers::NONE));
    window.step();
    assert_eq!(window.text(), start);

    let before = placed(&window, "Cube").matrix().translation;
    window.harness.event(egui::Event::ModifiersChanged(Modifiers::COMMAND));
    window.drag(knob, vec2(47.0, 3.0));
    window.harness.event(egui::Event::ModifiersChanged(Modifiers::NONE));
    let by = placed(&window, "Cube").matrix().translation - before;
    assert!(by.x > 0.1 && ((by.x * 4.0).round() - by.x * 4.0).abs() < 1e-9, "{by}");
}

#[test]
fn things_are_paged_through_by_keys_and_picked_where_the_tracer_sees_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = open(folder.path());
    let selected = |window: &Window| window.editor().selected().map(|name| name.as_str().to_owned());
    let mut order = vec![];
    loop {
        window.key(Modifiers::NONE, Key::PageDown);
        window.wait();
        let name = selected(&window).expect("something");
        if order.first() == Some(&name) {
            break;
        }
        order.push(name);
    }
    assert_eq!(order.len(), window.editor().session().document.things().count(), "{order:?}");
    assert_eq!(order.iter().filter(|name| ["Sky", "Lamp"].contains(&name.as_str())).count(), 2);
    window.key(Modifiers::NONE, Key::PageUp);
    assert_eq!(selected(&window), order.last().cloned());

    // A grid of clicks: what is picked is what the ray meets first.
    let (rect, scale) = place(&window);
    let mut picked = std::collections::BTreeSet::new();
    for (column, row) in (1..6).flat_map(|column| (1..5).map(move |row| (column, row))) {
        window.menu(&["Camera"]);
        let at = rect.min + vec2(rect.width() * column as f32 / 6.0, rect.height() * row as f32 / 5.0);
        let snapshot = window.editor().session().worker.view().snapshot.clone().expect("a snapshot");
        let pixel = (at - rect.min) / scale;
        let (width, height) = (snapshot.settings.width, snapshot.settings.height);
        let ray = snapshot.view.ray(f64::from(pixel.x), f64::from(pixel.y), width, height);
        let met = snapshot.geometry.closest(&ray, f64::INFINITY, &Methods::default(), &mut Cost::default());
        let name = met.and_then(|met| snapshot.names[met.object as usize].clone());
        window.drag(at, egui::Vec2::ZERO);
        assert_eq!(window.editor().selected(), name.as_ref(), "{at}");
        picked.extend(name.map(|name| name.as_str().to_owned()));
    }
    assert!(picked.len() >= 3, "{picked:?}");
}
