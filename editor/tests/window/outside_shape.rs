//! A shape from outside the project has its place in the menus and its fields unasked; it is drawn, picked, edited, saved.

use crate::driver::Window;
use crate::torus::Torus;
use snell::{Options, Renderer, render};
use std::sync::Arc;

#[test]
fn a_shape_from_outside_is_added_edited_picked_and_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    let factory = || Renderer::new().with_primitive::<Torus>();
    let mut window = Window::open_with(Arc::new(factory), folder.path(), None);
    window.click("Empty");
    window.wait();
    window.menu(&["Picture"]);
    window.set("Width", "96");
    window.set("Height", "60");
    let empty = window.picture();
    window.menu(&["Add", "Torus"]);
    assert_ne!(window.picture(), empty, "it is seen as soon as it is added");
    window.set("Major", "1.2");
    window.set("Minor", "0.4");
    window.write("Minor", "0");
    assert!(window.has("Expected a number from 0.000000001 to 1000000000"), "its own limits hold");
    window.write("Minor", "0.4");

    // Picked by the tracer itself: the tube left of the hole in the middle.
    window.menu(&["Camera"]);
    assert_eq!(window.editor().selected().map(|name| name.as_str()), Some("Camera"));
    let middle = window.node("Viewport").rect().center();
    let scale = window.node("Viewport").rect().height() / 60.0;
    for column in 0..30 {
        window.drag(middle - egui::vec2(column as f32 * scale, 0.0), egui::Vec2::ZERO);
        if window.editor().selected().is_some_and(|name| name.as_str() == "Torus") {
            break;
        }
    }
    assert_eq!(window.editor().selected().map(|name| name.as_str()), Some("Torus"));

    let code = window.copied_code();
    assert!(code.contains("Renderer::new().with_primitive::<Torus>();"), "{code}");
    assert!(code.starts_with("// `Torus` is not Snell's: bring it in here with `use`."), "{code}");
    assert!(code.contains("Torus { major: 1.2, minor: 0.4 }"), "{code}");

    let text = window.text();
    assert!(text.contains("Torus(major: 1.2, minor: 0.4)"), "{text}");
    let mut renderer = factory();
    renderer.load_text(&text, "scene.ron").expect("a scene");
    let picture = render(&renderer.snapshot().expect("a snapshot"), &Options::default()).picture;
    assert_eq!(window.picture(), picture.hash());
}
