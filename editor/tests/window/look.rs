//! Looking around, hiding, regions, pictures, and where a colour comes from.

use crate::driver::{Window, rendered};
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use snell::{Options, Picture, components::camera::Camera, render, systems::image};

fn ball(folder: &std::path::Path) -> Window {
    let mut window = Window::open(folder, None);
    window.click("Ball");
    window.wait();
    window.menu(&["Picture"]);
    window.set("Width", "96");
    window.set("Height", "60");
    window
}

fn camera(window: &Window) -> Camera {
    let document = &window.editor().session().document;
    document.things().find_map(|(_, thing)| thing.get::<Camera>().cloned()).expect("a camera")
}

#[test]
fn the_camera_moves_and_turns_by_keys_and_by_buttons_alike() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = ball(folder.path());
    window.menu(&["Camera"]);
    let start = camera(&window);
    for (label, key, modifiers) in [
        ("Move left", Key::A, Modifiers::NONE),
        ("Move right", Key::D, Modifiers::NONE),
        ("Move up", Key::E, Modifiers::NONE),
        ("Move down", Key::Q, Modifiers::NONE),
        ("Move in", Key::W, Modifiers::NONE),
        ("Move out", Key::S, Modifiers::NONE),
        ("Turn left", Key::ArrowLeft, Modifiers::NONE),
        ("Turn right", Key::ArrowRight, Modifiers::NONE),
        ("Turn up", Key::ArrowUp, Modifiers::NONE),
        ("Turn down", Key::ArrowDown, Modifiers::NONE),
        ("Roll left", Key::ArrowLeft, Modifiers::SHIFT),
        ("Roll right", Key::ArrowRight, Modifiers::SHIFT),
    ] {
        window.click(label);
        let by_button = camera(&window);
        assert_ne!(by_button, start, "{label}");
        window.menu(&["Undo"]);
        assert_eq!(camera(&window), start, "{label}");
        window.release_focus();
        window.key(modifiers, key);
        assert_eq!(camera(&window), by_button, "{label}");
        window.menu(&["Undo"]);
    }
    // About an axis of the world.
    window.set("Degrees", "90");
    let turn = window.harness.get_all_by_role_and_label(egui::Role::Button, "Turn").last().expect("a button").rect();
    window.drag(turn.center(), egui::Vec2::ZERO);
    let turned = camera(&window).position;
    assert!((turned - snell::prelude::DVec3::new(6.5, 2.2, 0.0)).length() < 1e-9, "{turned}");
}

#[test]
fn the_pointer_goes_around_the_point_under_it_and_the_wheel_goes_nearer() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = ball(folder.path());
    let middle = window.node("Viewport").rect().center();
    let start = camera(&window);
    window.drag_with(egui::PointerButton::Secondary, middle, egui::vec2(30.0, 0.0));
    let around = camera(&window);
    assert_ne!(around.position, start.position);
    let label = window.editor().session().document.undo_label().map(str::to_owned);
    assert_eq!(label.as_deref(), Some("Move camera"));
    window.menu(&["Undo"]);
    assert_eq!(camera(&window), start, "one drag is one step");
    // A drag with the left button moves no camera.
    window.drag(middle + egui::vec2(200.0, 100.0), egui::vec2(30.0, 10.0));
    assert_eq!(camera(&window), start);
    window.harness.hover_at(middle);
    window.step();
    window.harness.event(egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Line,
        delta: egui::vec2(0.0, 3.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Unknown,
        modifiers: Modifiers::NONE,
    });
    for _ in 0..20 {
        window.step();
    }
    window.wait();
    let near = camera(&window);
    let target = start.target.expect("a target");
    assert!(near.position.distance(target) < start.position.distance(target), "{near:?}");
}

#[test]
fn what_is_hidden_is_not_in_the_picture_nor_in_that_of_the_saved_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("hidden.ron");
    let mut window = ball(folder.path());
    let whole = window.picture();
    window.click("Show Ball");
    window.wait();
    let hidden = window.picture();
    assert_ne!(hidden, whole);
    window.save_as(&file);
    assert_eq!(rendered(&file), hidden);
    window.click("Show Ball");
    window.wait();
    assert_eq!(window.picture(), whole);
}

#[test]
fn a_region_is_drawn_exactly_and_the_picture_is_saved_as_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = ball(folder.path());
    window.save_as(&folder.path().join("scene.ron"));
    let whole: Picture = {
        let view = window.editor().session().worker.view();
        view.frame.clone().expect("a frame").picture.clone()
    };
    for name in ["all.png", "all.exr"] {
        window.menu(&["Save picture…"]);
        window.set("File name", folder.path().join(name).to_str().expect("a path"));
    }
    let (read, told) = image::read(&folder.path().join("all.exr")).expect("a picture");
    assert_eq!(read.hash(), whole.hash());
    assert_eq!(told.get(image::key::HASH), Some(whole.hash().as_str()));
    let (read, _) = image::read(&folder.path().join("all.png")).expect("a picture");
    assert_eq!(image::srgb8(&read), image::srgb8(&whole));

    window.click("Choose region");
    let rect = window.node("Viewport").rect();
    window.drag(rect.center() - egui::vec2(60.0, 40.0), egui::vec2(120.0, 80.0));
    let frame = window.editor().session().worker.view().frame.clone().expect("a frame");
    assert!(frame.is_complete() && frame.region.area() < whole.pixels.len(), "{:?}", frame.region);
    assert_eq!(Some(&frame.picture), whole.crop(frame.region).as_ref());
    window.click("Whole picture");
    window.wait();
    assert_eq!(window.picture(), whole.hash());
}

/// Widgets that round what they show once changed scenes that were only looked at.
#[test]
fn looking_at_everything_changes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = Window::open(folder.path(), None);
    window.click("Glass");
    window.wait();
    let text = window.text();
    for tab in ["Picture", "Why", "Chart", "Properties"] {
        window.menu(&[tab]);
        if window.has("More") {
            window.menu(&["More"]);
        }
    }
    for thing in ["Globe", "Block", "Ground", "Sky", "Lamp", "Glass", "Green glass", "Camera"] {
        window.menu(&[thing]);
        assert_eq!(window.editor().selected().map(|name| name.as_str()), Some(thing));
    }
    assert_eq!(window.text(), text);
    assert_eq!(window.editor().session().document.undo_label(), None);
}

#[test]
fn the_rays_of_a_pixel_are_told_with_what_they_meet() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = ball(folder.path());
    window.menu(&["Why"]);
    let middle = window.node("Viewport").rect().center();
    window.drag(middle, egui::Vec2::ZERO);
    for _ in 0..100 {
        if window.harness.query_by_label_contains("From the camera → Ball").is_some() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(10));
        window.step();
    }
    let rays = window.harness.query_all_by_label_contains("→").count();
    assert!(window.harness.query_all_by_label_contains("From the camera → Ball").count() > 0 && rays > 1, "{rays}");
}

#[test]
fn things_are_renamed_copied_taken_away_and_looked_at() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = ball(folder.path());
    let start = window.text();
    window.menu(&["Ball"]);
    window.key(Modifiers::COMMAND, Key::D);
    window.wait();
    assert_eq!(window.editor().selected().map(|name| name.as_str()), Some("Ball 2"));
    window.write("Name", "Ball");
    assert!(window.has("“Ball” is taken"));
    window.set("Name", "Moon");
    assert!(window.text().contains("\"Moon\": ["), "{}", window.text());
    window.release_focus();
    window.key(Modifiers::NONE, Key::Delete);
    window.wait();
    assert_eq!(window.text(), start);
    window.menu(&["Ball"]);
    let before = camera(&window);
    window.key(Modifiers::NONE, Key::F);
    window.wait();
    assert_ne!(camera(&window), before);
    assert_eq!(camera(&window).target, Some(snell::prelude::DVec3::Y));
}

/// The program that was copied last is compiled here, so it is seen to be one: `SNELL_BLESS=1` writes it anew.
#[test]
fn the_scene_is_copied_as_a_program_that_makes_the_same_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = Window::open(folder.path(), None);
    window.click("Shapes");
    window.wait();
    let code = window.copied_code();
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/window/program.rs");
    if std::env::var_os("SNELL_BLESS").is_some() && std::env::var_os("CI").is_none() {
        std::fs::write(file, &code).expect("written");
    }
    assert_eq!(code, include_str!("program.rs"));
    let built = crate::program::scene().expect("a scene").snapshot().expect("a snapshot");
    assert_eq!(render(&built, &Options::default()).picture.hash(), window.picture());
}
