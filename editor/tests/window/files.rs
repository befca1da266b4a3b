//! Files in the editor without a window: opening, faults, dropping, what is kept of scenes that were not saved.

use crate::driver::{Window, rendered};
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use std::{
    fs,
    path::{Path, PathBuf},
};

#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        fs::read(&self.0).map_err(|why| why.to_string())
    }
}

fn drop_file(window: &mut Window, file: &Path) {
    window.harness.input_mut().dropped_files.push(std::sync::Arc::new(Dropped(file.to_path_buf())));
    window.step();
    window.wait();
}

pub(crate) const SCENE: &str = r#"Scene(
    version: 1,
    settings: (width: 60, height: 40),
    entities: {
        "camera": [Camera(position: (0, 1, 6), target: (0, 1, 0))],
        "lamp": [PointLight(position: (3, 5, 4))],
        "ball": [Sphere(1), Transform([Translate((0, 1, 0))]), Diffuse(0.8)],
    },
)
"#;

fn scene(folder: &Path) -> PathBuf {
    let file = folder.join("scene.ron");
    fs::write(&file, SCENE).expect("written");
    file
}

#[test]
fn a_scene_with_faults_tells_all_with_lines_and_the_last_good_one_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = scene(folder.path());
    let mut window = Window::open(folder.path(), Some(&file));
    let picture = window.picture();
    let bad = folder.path().join("bad.ron");
    fs::write(&bad, SCENE.replace("Sphere(1)", "Shpere(1)").replace("width: 60", "width: 0")).expect("written");
    drop_file(&mut window, &bad);
    let told: Vec<String> =
        window.harness.query_all_by_label_contains("bad.ron:").filter_map(|node| node.value()).collect();
    assert!(told.iter().any(|line| line.contains(":3:") && line.contains("from 1 to 65536")), "{told:?}");
    assert!(told.iter().any(|line| line.contains(":7:") && line.contains("Sphere")), "{told:?}");
    window.click("Close");
    assert_eq!(window.picture(), picture);
    assert_eq!(window.editor().session().document.file(), Some(file.as_path()));
    // And goes on to be edited.
    window.menu(&["ball"]);
    window.set("Radius", "1.5");
    assert_ne!(window.picture(), picture);
}

#[test]
fn a_model_that_is_dropped_is_added_and_saved_by_its_path_from_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = scene(folder.path());
    fs::create_dir(folder.path().join("models")).expect("made");
    let model = folder.path().join("models/roof.obj");
    let mtl = "newmtl tiles\nKd 0.8 0.2 0.1\n";
    fs::write(folder.path().join("models/roof.mtl"), mtl).expect("written");
    fs::write(&model, "mtllib roof.mtl\nusemtl tiles\nv -2 2 0\nv 2 2 0\nv 0 3 0\nf 1 2 3\n").expect("written");
    let mut window = Window::open(folder.path(), Some(&file));
    let before = window.picture();
    drop_file(&mut window, &model);
    assert_eq!(window.editor().selected().map(|name| name.as_str()), Some("roof"));
    assert_ne!(window.picture(), before);
    window.key(Modifiers::COMMAND, Key::S);
    window.wait();
    let saved = fs::read_to_string(&file).expect("a text");
    assert!(saved.contains(r#"Mesh(model: "models/roof.obj")"#), "{saved}");
    assert_eq!(window.picture(), rendered(&file));
    window.menu(&["Undo"]);
    assert_eq!(window.picture(), before);
    // Something that is no file of ours is told, and nothing happens.
    let other = folder.path().join("notes.txt");
    fs::write(&other, "x").expect("written");
    drop_file(&mut window, &other);
    assert!(window.harness.query_all_by_label_contains("is no scene, model or image").next().is_some());
}

#[test]
fn an_image_that_is_dropped_goes_onto_the_selected_thing() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = scene(folder.path());
    let picture = folder.path().join("dots.png");
    image::RgbImage::from_fn(4, 4, |x, y| image::Rgb([(x * 60) as u8, (y * 60) as u8, 90]))
        .save(&picture)
        .expect("saved");
    let mut window = Window::open(folder.path(), Some(&file));
    window.menu(&["ball"]);
    let before = window.picture();
    drop_file(&mut window, &picture);
    assert_ne!(window.picture(), before);
    window.key(Modifiers::COMMAND, Key::S);
    window.wait();
    assert!(fs::read_to_string(&file).expect("a text").contains(r#"ImageTexture(image: "dots.png")"#));
    assert_eq!(window.picture(), rendered(&file));
}

#[test]
fn comments_of_a_file_that_is_replaced_are_kept_beside_it_and_an_unchanged_file_is_not_touched() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = scene(folder.path());
    let text = format!("// Mine.\n{SCENE}");
    fs::write(&file, &text).expect("written");
    let mut window = Window::open(folder.path(), Some(&file));
    window.key(Modifiers::COMMAND, Key::S);
    assert_eq!(fs::read_to_string(&file).expect("a text"), text);
    window.menu(&["ball"]);
    window.set("Radius", "2");
    window.key(Modifiers::COMMAND, Key::S);
    window.wait();
    assert!(!fs::read_to_string(&file).expect("a text").contains("Mine"));
    assert_eq!(fs::read_to_string(folder.path().join("scene.ron~")).expect("a text"), text);
}

#[test]
fn what_was_not_saved_is_offered_and_can_be_taken_or_thrown_away() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = scene(folder.path());
    let kept = folder.path().join(".scene.ron.autosave");
    let edited = {
        let mut window = Window::open(folder.path(), Some(&file));
        window.menu(&["ball"]);
        window.set("Radius", "2");
        window.editor().session().flush();
        assert!(kept.is_file());
        window.text()
        // Here the program ends without a word.
    };
    {
        let mut window = Window::open(folder.path(), Some(&file));
        window.click("Recover");
        window.wait();
        assert_eq!(window.text(), edited);
        assert!(window.editor().session().document.is_changed());
        window.key(Modifiers::COMMAND, Key::S);
        window.wait();
        window.editor().session().flush();
        assert!(fs::read_to_string(&file).expect("a text").contains("Sphere(2)") && !kept.exists());
        window.menu(&["ball"]);
        window.set("Radius", "3");
        window.editor().session().flush();
    }
    let mut window = Window::open(folder.path(), Some(&file));
    window.click("Throw away");
    window.wait();
    assert!(window.text().contains("Sphere(2)") && !kept.exists());
}

#[test]
fn another_scene_is_not_opened_before_changes_are_saved_or_not_wanted() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = scene(folder.path());
    let mut window = Window::open(folder.path(), Some(&file));
    window.menu(&["ball"]);
    window.set("Radius", "2");
    window.key(Modifiers::COMMAND, Key::N);
    window.click("Ball");
    window.step();
    assert!(window.text().contains("Sphere(2)"));
    window.click("Cancel");
    assert!(window.text().contains("Sphere(2)"));
    window.key(Modifiers::COMMAND, Key::N);
    window.click("Ball");
    window.click("Save");
    window.wait();
    assert!(fs::read_to_string(&file).expect("a text").contains("Sphere(2)"));
    assert!(window.text().contains("Checker"), "{}", window.text());
}

/// A question that was not answered once let the next scene be opened without one.
#[test]
fn a_question_that_is_closed_is_asked_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = Window::open(folder.path(), None);
    window.click("Ball");
    window.wait();
    window.menu(&["Ball"]);
    window.set("Radius", "2");
    let there = scene(folder.path());
    window.key(Modifiers::COMMAND, Key::N);
    window.click("Mirrors");
    // Saved first, but in place of another file, and that is not wanted either.
    window.click("Save");
    window.set("File name", there.to_str().expect("a path"));
    window.click("Cancel");
    window.wait();
    window.key(Modifiers::COMMAND, Key::N);
    window.click("Mirrors");
    window.wait();
    assert!(window.has("Don’t save") && window.text().contains("Sphere(2)"));
    assert_eq!(fs::read_to_string(&there).expect("a text"), SCENE);
    window.click("Don’t save");
    window.wait();
    assert!(window.text().contains("Silver"));
}

#[test]
fn a_scene_that_is_dropped_is_opened_and_those_opened_before_are_at_hand() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = scene(folder.path());
    let other = folder.path().join("other.ron");
    fs::write(&other, SCENE.replace("Sphere(1)", "Sphere(0.5)")).expect("written");
    let mut window = Window::open(folder.path(), Some(&file));
    drop_file(&mut window, &other);
    assert_eq!(window.picture(), rendered(&other));
    window.menu(&["File", "Open recent", "scene.ron"]);
    assert_eq!(window.editor().session().document.file().and_then(Path::file_name), file.file_name());
    assert_eq!(window.picture(), rendered(&file));
    // By its name, through the dialog; one that is not there is told in it.
    window.key(Modifiers::COMMAND, Key::O);
    window.set("File name", folder.path().join("no.ron").to_str().expect("a path"));
    assert!(window.harness.query_by_label_contains("there is no file").is_some());
    window.set("File name", other.to_str().expect("a path"));
    assert_eq!(window.picture(), rendered(&other));
}

#[test]
fn an_image_goes_onto_the_material_that_is_shared() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("shared.ron");
    let text = SCENE.replace(", Diffuse(0.8)]", r#", MadeOf("clay")], "clay": [Diffuse(0.8)]"#);
    fs::write(&file, text).expect("written");
    let picture = folder.path().join("dots.png");
    image::RgbImage::from_fn(4, 4, |x, y| image::Rgb([(x * 60) as u8, (y * 60) as u8, 90]))
        .save(&picture)
        .expect("saved");
    let mut window = Window::open(folder.path(), Some(&file));
    window.menu(&["ball"]);
    drop_file(&mut window, &picture);
    assert_eq!(window.editor().selected().map(|name| name.as_str()), Some("clay"));
    window.key(Modifiers::COMMAND, Key::S);
    window.wait();
    assert_eq!(window.picture(), rendered(&file));
}

/// A picture wider than the graphics card can hold is shown with fewer pixels, and saved with all.
#[test]
fn a_picture_wider_than_the_card_can_hold_is_shown() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("wide.ron");
    fs::write(&file, SCENE.replace("width: 60, height: 40", "width: 5000, height: 700")).expect("written");
    let window = Window::open(folder.path(), Some(&file));
    assert_eq!(window.harness.ctx.input(|input| input.max_texture_side), 2048);
    assert_eq!(window.picture(), rendered(&file));
    let shot = window.shot();
    let middle = window.node("Viewport").rect().center();
    let is_sky = |x: u32| shot.get_pixel(x, middle.y as u32).0.iter().all(|channel| *channel < 30);
    assert!(!is_sky(middle.x as u32), "the ball is in the middle");
}

#[test]
fn a_start_with_a_scene_that_has_faults_tells_them_and_offers_something_to_begin_with() {
    let folder = tempfile::tempdir().expect("a folder");
    let bad = folder.path().join("bad.ron");
    fs::write(&bad, SCENE.replace("Sphere(1)", "Shpere(1)")).expect("written");
    let mut window = Window::open(folder.path(), Some(&bad));
    assert!(window.has("bad.ron was not opened"));
    let told = window.harness.query_by_label_contains("bad.ron:7:").and_then(|node| node.value());
    assert!(told.is_some_and(|told| told.starts_with("bad.ron:7:")), "without its folder");
    window.click("Close");
    window.click("Ball");
    window.wait();
    assert!(window.text().contains("Sphere"));
}

#[test]
fn a_model_is_chosen_and_set_up_as_it_is_brought_in() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = scene(folder.path());
    let model = folder.path().join("tent.obj");
    let text = "v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nv 0 1.5 0\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
    fs::write(&model, text).expect("written");
    let mut window = Window::open(folder.path(), Some(&file));
    window.menu(&["Add", "Model from a file…"]);
    window.set("File name", model.to_str().expect("a path"));
    assert_eq!(window.editor().selected().map(|name| name.as_str()), Some("tent"));
    let mut pictures = vec![window.picture()];
    window.choose("Shading", "Smooth");
    pictures.push(window.picture());
    window.add_step("Turn about y");
    window.set("Turn about y", "30");
    pictures.push(window.picture());
    window.menu(&["Shiny"]);
    pictures.push(window.picture());
    pictures.sort();
    pictures.dedup();
    assert_eq!(pictures.len(), 4, "each changes the picture");
    window.key(Modifiers::COMMAND, Key::S);
    window.wait();
    assert_eq!(window.picture(), rendered(&file));
}
