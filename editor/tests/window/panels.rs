//! All that the menus and panels offer does what it says, and what the saved file gives is what is seen.

use crate::driver::{Window, rendered_text};
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use snell::{
    Renderer, cli,
    systems::{
        image,
        registry::{Kind, Registry},
    },
};
use snell_editor::worker::Phase;
use std::process::ExitCode;

fn small(folder: &std::path::Path, starter: &str) -> Window {
    let mut window = Window::open(folder, None);
    window.click(starter);
    window.wait();
    window.menu(&["Picture"]);
    window.set("Width", "64");
    window.set("Height", "40");
    window
}

fn assert_shows_what_is_saved(window: &Window, what: &str) {
    assert_eq!(window.picture(), rendered_text(&window.text()), "{what}");
}

#[test]
fn all_that_can_be_added_is_drawn_saved_and_taken_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = small(folder.path(), "Empty");
    let start = window.text();
    let registry = Renderer::new().world.resource::<Registry>().clone();
    let of = |kind: Kind| {
        let tags = registry.entries().filter(move |(_, entry)| entry.kind == kind).map(|(tag, _)| tag);
        tags.filter(|tag| *tag != "Mesh").collect::<Vec<_>>()
    };
    let (shapes, lights) = (of(Kind::Shape), of(Kind::Light));
    assert!(shapes.len() >= 10 && lights.len() >= 5, "{shapes:?} {lights:?}");
    for tag in shapes.iter().chain(&lights) {
        window.menu(&["Add", &crate::driver::words(tag)]);
        let text = window.text();
        assert!(text.matches(tag).count() > start.matches(tag).count(), "{tag}: {text}");
        assert_shows_what_is_saved(&window, tag);
        window.menu(&["Undo"]);
        assert_eq!(window.text(), start, "{tag}");
    }
    for look in ["Matte", "Shiny", "Mirror", "Glass", "See-through"] {
        window.menu(&["Add", "Material", look]);
        assert!(window.text().contains(&format!("\"{look}\": [")), "{look}: {}", window.text());
        window.menu(&["Undo"]);
    }
    window.menu(&["Add", "Group"]);
    assert!(window.text().contains("\"Group\": ["));
}

#[test]
fn settings_of_the_picture_are_those_of_the_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = small(folder.path(), "Glass");
    let mut last = (window.text(), window.picture());
    let mut check = |window: &mut Window, what: &str, changes_the_picture: bool| {
        let now = (window.text(), window.picture());
        assert_ne!(now.0, last.0, "{what}");
        assert_eq!(now.1 != last.1, changes_the_picture, "{what}");
        assert_shows_what_is_saved(window, what);
        last = now;
    };
    window.set("Depth", "1");
    check(&mut window, "depth", true);
    window.set("Depth", "6");
    check(&mut window, "depth", true);
    for (tick, what) in [("Shadows", "shadows"), ("Refraction", "the refraction model")] {
        window.menu(&[tick]);
        check(&mut window, what, true);
    }
    for way in ["Off", "Grid", "Adaptive"] {
        window.choose("Antialias", way);
        check(&mut window, way, true);
    }
    window.set("Background", "#203040");
    check(&mut window, "background", true);
    window.menu(&["Screen distance"]);
    window.set("Screen distance", "1.5");
    check(&mut window, "screen distance", true);
    window.menu(&["320×240"]);
    check(&mut window, "size", true);
    // The number of threads is nothing of the scene, and changes no bit.
    let (text, picture) = (window.text(), window.picture());
    let before = window.editor().session().how().threads;
    window.drag(window.slider("Threads"), egui::vec2(-200.0, 0.0));
    assert_eq!((before, window.editor().session().how().threads), (None, Some(1)));
    window.click("Render");
    window.wait();
    assert_eq!((window.text(), window.picture()), (text, picture));
}

#[test]
fn the_scene_as_a_whole_is_moved_turned_and_scaled_with_its_lights_or_without() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = small(folder.path(), "Ball");
    // So that all of the group is in sight.
    window.menu(&["Size and samples"]);
    let mut seen = vec![window.picture()];
    for (step, field, number) in
        [("Turn about y", "Turn about y", "90"), ("Move", "Move x", "0.5"), ("Scale", "Scale", "0.5")]
    {
        window.add_step(step);
        window.set(field, number);
        assert_shows_what_is_saved(&window, step);
        seen.push(window.picture());
    }
    assert!(window.text().contains("transform: ["), "{}", window.text());
    let lit = window.text();
    window.menu(&["Transform lights"]);
    assert_ne!(window.text(), lit);
    assert_shows_what_is_saved(&window, "lights");
    seen.push(window.picture());
    seen.sort();
    seen.dedup();
    assert_eq!(seen.len(), 5, "each changes the picture");
}

#[test]
fn the_picture_on_the_screen_is_that_of_the_command_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = small(folder.path(), "Mirrors");
    let (scene, picture) = (folder.path().join("mirrors.ron"), folder.path().join("mirrors.exr"));
    window.menu(&["Left"]);
    window.set("Radius", "0.8");
    window.save_as(&scene);
    let arguments = ["snell".as_ref(), "render".as_ref(), scene.as_os_str(), "-o".as_ref(), picture.as_os_str()];
    let code = cli::run(Renderer::new(), arguments.map(Into::into));
    assert_eq!(format!("{code:?}"), format!("{:?}", ExitCode::SUCCESS));
    let (read, _) = image::read(&picture).expect("a picture");
    assert_eq!(read.hash(), window.picture());
}

#[test]
fn a_stopped_picture_is_saved_as_far_as_it_came() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = small(folder.path(), "Glass");
    window.menu(&["Draw every change at once"]);
    for (field, pixels) in [("Width", "2400"), ("Height", "1600")] {
        window.set(field, pixels);
    }
    assert!(window.editor().session().worker.view().frame.is_none(), "nothing is drawn unasked");
    window.click("Render");
    let is_begun = |window: &Window| {
        let view = window.editor().session().worker.view();
        view.phase == Phase::Exact && view.done > 0
    };
    while !is_begun(&window) {
        window.step();
    }
    window.step();
    assert!(window.harness.query_all_by_label_contains(" %").next().is_some(), "how far it is");
    window.click("Stop");
    window.wait();
    assert!(window.harness.query_all_by_label_contains("Stopped at").next().is_some());
    assert!(window.harness.query_all_by_label_contains("a second").next().is_some(), "rays a second");
    let file = folder.path().join("part.png");
    window.menu(&["Save picture…"]);
    window.set("File name", file.to_str().expect("a path"));
    assert!(window.harness.query_all_by_label_contains("the part that was drawn").next().is_some());
    let (saved, _) = image::read(&file).expect("a picture");
    let view = window.editor().session().worker.view();
    let frame = view.frame.clone().expect("a frame");
    assert!(!frame.is_complete());
    assert_eq!(image::srgb8(&saved), image::srgb8(&frame.picture));
}

#[test]
fn the_chart_panel_measures_the_open_scene_and_gives_advice() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = small(folder.path(), "Ball");
    window.menu(&["Chart"]);
    window.click("Measure this scene");
    assert!(window.harness.query_by_label_contains("Measuring").is_some());
    let begun = std::time::Instant::now();
    while window.harness.query_by_label_contains("Measuring").is_some() {
        assert!(begun.elapsed().as_secs() < 300, "measuring does not come to an end");
        std::thread::sleep(std::time::Duration::from_millis(20));
        window.step();
    }
    assert!(window.has("Chart"), "a picture");
    assert!(window.harness.query_all_by_label_contains("error").count() > 0, "advice");
}

/// Everything that was done is taken back, one step each, and done again.
#[test]
fn all_kinds_of_edits_are_taken_back_and_done_again_one_by_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = small(folder.path(), "Glass");
    let steps: &[(&str, fn(&mut Window))] = &[
        ("a number", |window| {
            window.menu(&["Globe"]);
            window.set("Radius", "1.03");
        }),
        ("a look", |window| window.menu(&["Cube", "Shiny"])),
        ("a shared material", |window| window.choose("Material", "Green glass")),
        ("a name", |window| window.set("Name", "Die")),
        ("a parent", |window| window.choose("Moves with", "Globe")),
        ("a step of a placement", |window| window.add_step("Scale")),
        ("a copy", |window| window.menu(&["Edit", "Duplicate"])),
        ("hiding", |window| window.menu(&["Edit", "Hide"])),
        ("deleting", |window| window.menu(&["Edit", "Delete"])),
        ("deleting a parent", |window| window.menu(&["Globe", "Edit", "Delete"])),
        ("a light", |window| window.menu(&["Add", "Cone light"])),
        ("a material", |window| window.menu(&["Add", "Material", "Mirror"])),
        ("a property", |window| window.menu(&["+ Add a property", "Transmission"])),
        ("a property less", |window| window.menu(&["− Remove one", "Mirror"])),
        ("the camera", |window| window.key(Modifiers::NONE, Key::W)),
        ("a setting", |window| {
            window.menu(&["Picture"]);
            window.set("Depth", "3");
        }),
    ];
    let mut texts = vec![window.text()];
    for (what, step) in steps {
        step(&mut window);
        window.release_focus();
        window.wait();
        let text = window.text();
        assert_ne!(texts.last(), Some(&text), "{what} did nothing");
        texts.push(text);
    }
    assert_shows_what_is_saved(&window, "in the end");
    for text in texts.iter().rev().skip(1) {
        window.menu(&["Undo"]);
        assert_eq!(&window.text(), text);
    }
    assert_shows_what_is_saved(&window, "at the beginning");
    for text in &texts[1..] {
        window.menu(&["Redo"]);
        assert_eq!(&window.text(), text);
    }
    assert_shows_what_is_saved(&window, "done again");
}
