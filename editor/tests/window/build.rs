//! The whole editor without a window: built, rendered, stopped, changed, undone, saved, opened again by accessible names.

use crate::driver::{Window, rendered};
use egui::{Key, Modifiers};
use snell_editor::worker::Phase;
use std::fs;

/// What is shown behind and inside a ball of which a part shows, built from an empty scene by names alone.
fn build(window: &mut Window) {
    window.click("Empty");
    window.wait();
    window.menu(&["Picture"]);
    window.set("Width", "128");
    window.set("Height", "80");
    window.menu(&["Add", "Sphere"]);
    window.set("Radius", "1.2");
    window.set("Move y", "1.2");
    window.menu(&["See-through"]);
    window.set("Alpha", "0.4");
    window.menu(&["Add", "Box"]);
    for axis in ["x", "y", "z"] {
        window.set(&format!("Size {axis}"), "0.55");
    }
    for (axis, at) in ["x", "y", "z"].iter().zip(["-0.15", "1.35", "0.1"]) {
        window.set(&format!("Move {axis}"), at);
    }
    window.set("Color", "0.85, 0.45, 0.15");
    window.menu(&["Add", "Cone"]);
    window.set("Move x", "-1.3");
    window.set("Move y", "0");
    window.set("Move z", "-1.5");
    window.set("Color", "#4a9a3a");
}

#[test]
fn a_scene_is_built_rendered_stopped_changed_undone_saved_and_opened_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("behind.ron");
    let mut window = Window::open(folder.path(), None);
    build(&mut window);

    // Saved, what is on the screen is what the file gives.
    window.save_as(&file);
    let first = window.picture();
    assert_eq!(first, rendered(&file));
    let saved = fs::read_to_string(&file).expect("a text");
    assert!(saved.contains("Opacity(0.4)") && saved.contains("Sphere(1.2)"), "{saved}");

    // A change is drawn; undone, the state of the file is back.
    window.menu(&["Sphere"]);
    window.set("Alpha", "0.8");
    assert_ne!(window.picture(), first);
    assert!(window.editor().session().document.is_changed());
    window.menu(&["Undo"]);
    assert_eq!(window.picture(), first);
    assert!(!window.editor().session().document.is_changed());
    window.menu(&["Redo"]);
    window.save_as(&file);
    assert_eq!(window.picture(), rendered(&file));

    // Stopped, the part that was drawn is kept.
    window.menu(&["Picture"]);
    for (field, pixels) in [("Width", "2400"), ("Height", "1600")] {
        window.write(field, pixels);
    }
    let is_half_done = |window: &Window| {
        let view = window.editor().session().worker.view();
        view.phase == Phase::Exact && view.screen.height == 1600 && view.done > 0
    };
    while !is_half_done(&window) {
        window.step();
    }
    window.click("Stop");
    window.wait();
    {
        let view = window.editor().session().worker.view();
        let frame = view.frame.clone().expect("the partial picture");
        assert!(frame.done > 0 && !frame.is_complete());
    }
    window.menu(&["Undo"]);
    window.menu(&["Undo"]);

    // Opened again it is the same.
    let again = Window::open(folder.path(), Some(&file));
    assert_eq!(again.picture(), rendered(&file));
    assert_eq!(again.text(), fs::read_to_string(&file).expect("a text"));
}

/// The colour of a field's text: red while what is typed is wrong.
#[test]
fn numbers_are_checked_as_they_are_typed_and_wrong_ones_change_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = Window::open(folder.path(), None);
    window.click("Ball");
    window.wait();
    window.menu(&["Ball"]);
    let text = window.text();
    for (field, wrong, expected) in [
        ("Radius", "-1", "Expected a number more than 0"),
        ("Radius", "wide", "Expected a number more than 0"),
        ("Exponent", "1e9", "Expected a number from 0 to 1000000"),
        ("Color", "red", "Expected one number, three numbers or #rrggbb, each at least 0"),
    ] {
        window.write(field, wrong);
        assert!(window.has(expected), "{field}: {wrong}");
        assert_eq!(window.text(), text);
        window.write(field, "1");
        assert!(!window.has(expected), "{field}: {wrong} was mended");
        window.key(Modifiers::NONE, Key::Enter);
        window.menu(&["Undo"]);
        assert_eq!(window.text(), text, "{field}: one edit is one step");
    }
}

#[test]
fn a_drag_of_a_handle_is_one_step() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = Window::open(folder.path(), None);
    window.click("Ball");
    window.wait();
    window.menu(&["Ball"]);
    let before = window.text();
    for (tool, handle) in [("Move", "Move along x"), ("Turn", "Turn about y"), ("Scale", "Scale all")] {
        window.menu(&[tool]);
        let knob = window.node(handle).rect().center();
        window.drag(knob, egui::vec2(40.0, -6.0));
        assert_ne!(window.text(), before, "{tool}");
        window.menu(&["Undo"]);
        assert_eq!(window.text(), before, "{tool}");
    }
}
