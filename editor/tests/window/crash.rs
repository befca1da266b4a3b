//! What goes wrong costs no more than it must: a shape that panics its picture, a crash of the program the last edit.

use crate::driver::Window;
use egui_kittest::kittest::Queryable;
use snell::{Renderer, prelude::*};
use std::{
    env, fs,
    path::Path,
    process::{Command, Stdio},
    sync::Arc,
    time::{Duration, Instant},
};

/// A shape from outside with a fault in it.
#[derive(Component, Clone, Default, Describe)]
struct Bomb {
    /// At 13 it goes off.
    #[describe(within(0.0, 100.0))]
    fuse: f64,
}

impl Primitive for Bomb {
    type Packed = f64;

    fn pack(&self, world_from_object: &DAffine3) -> Result<(Extent, f64), Degenerate> {
        let bounds = Bounds { min: -DVec3::ONE, max: DVec3::ONE }.transformed(world_from_object);
        Ok((Extent::Bounded(bounds), self.fuse))
    }

    fn hit(fuse: &f64, ray: &Ray, t_max: f64, _: &mut Cost) -> Option<Hit> {
        assert!(*fuse != 13.0, "it went off");
        let t = 0.5 * (ray.origin.length() / ray.direction.length()).min(t_max);
        Some(Hit { t, part: 0 })
    }

    fn surface(_: &f64, ray: &Ray, hit: Hit) -> Surface {
        let normal = -ray.direction.normalize();
        let error = Surface::rounding(10.0);
        Surface { point: ray.at(hit.t), normal, shading_normal: normal, uv: DVec2::ZERO, slot: 0, error }
    }
}

#[test]
fn a_shape_that_panics_costs_its_picture_and_not_the_window() {
    let folder = tempfile::tempdir().expect("a folder");
    let factory = || Renderer::new().with_primitive::<Bomb>();
    let mut window = Window::open_with(Arc::new(factory), folder.path(), None);
    window.click("Empty");
    window.wait();
    window.menu(&["Picture"]);
    window.set("Width", "64");
    window.set("Height", "40");
    window.menu(&["Add", "Bomb"]);
    let (sound, text) = (window.picture(), window.text());
    window.set("Fuse", "13");
    assert!(window.harness.query_by_label_contains("drawing failed").is_some());
    // It can be clicked at, gone around and asked about.
    let middle = window.node("Viewport").rect().center();
    window.drag(middle, egui::Vec2::ZERO);
    let aside = middle + egui::vec2(0.0, -120.0);
    window.drag_with(egui::PointerButton::Secondary, aside, egui::vec2(20.0, 0.0));
    window.menu(&["Undo", "Why"]);
    window.drag(aside, egui::Vec2::ZERO);
    for _ in 0..10 {
        window.step();
        std::thread::sleep(Duration::from_millis(5));
    }
    // And mended.
    window.menu(&["Undo"]);
    assert_eq!(window.text(), text);
    assert_eq!(window.picture(), sound);
    assert!(window.harness.query_by_label_contains("drawing failed").is_none());
}

#[test]
fn a_scene_without_a_camera_says_so_and_offers_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = Window::open(folder.path(), None);
    window.click("Ball");
    window.wait();
    window.menu(&["Camera", "Edit", "Delete"]);
    assert!(window.has("There is no camera yet, so there is nothing to see"));
    window.click("Add a camera");
    window.wait();
    assert_eq!(window.picture().len(), 64);
}

/// Edits without end in the editor of a process that is killed; each is told once it was made.
fn edit_without_end(folder: &Path) {
    let mut window = Window::open(folder, Some(&folder.join("scene.ron")));
    window.menu(&["ball"]);
    for number in 1.. {
        window.set("Radius", &number.to_string());
        fs::write(folder.join("count.new"), number.to_string()).expect("written");
        fs::rename(folder.join("count.new"), folder.join("count")).expect("told");
    }
}

#[test]
fn a_window_that_is_killed_loses_the_last_edit_at_most() {
    if let Some(folder) = env::var_os("SNELL_EDITOR_TEST_CHILD") {
        return edit_without_end(Path::new(&folder));
    }
    let mut all = 0;
    for round in 0..5 {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("scene.ron");
        fs::write(&file, crate::files::SCENE).expect("written");
        let mut child = Command::new(env::current_exe().expect("this test"))
            .args(["--exact", "crash::a_window_that_is_killed_loses_the_last_edit_at_most"])
            .env("SNELL_EDITOR_TEST_CHILD", folder.path())
            .stdout(Stdio::null())
            .spawn()
            .expect("a child");
        let count = || -> u32 {
            fs::read_to_string(folder.path().join("count")).map_or(0, |text| text.parse().expect("a number"))
        };
        let begun = Instant::now();
        while count() < 3 {
            assert!(begun.elapsed() < Duration::from_secs(120), "the child does nothing");
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(Duration::from_millis(11 * round));
        child.kill().expect("killed");
        child.wait().expect("ended");
        let made = count();
        assert_eq!(fs::read_to_string(&file).expect("a text"), crate::files::SCENE);
        let mut window = Window::open(folder.path(), Some(&file));
        window.click("Recover");
        window.wait();
        let text = window.text();
        let radius = text.split("Sphere(").nth(1).and_then(|rest| rest.split(')').next()?.parse::<u32>().ok());
        let radius = radius.unwrap_or_else(|| panic!("no ball: {text}"));
        assert!(radius + 1 >= made && radius <= made + 1, "made {made}, kept {radius}");
        all += radius;
    }
    assert!(all >= 15, "{all}");
}
