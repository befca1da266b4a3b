//! How soon the editor answers on a scene of a million triangles: from an edit to its first coarse picture, and the longest
//! frame in a scripted minute of editing.
//!
//! `cargo bench -p snell_editor`; `SECONDS=5` for a shorter script.

#[path = "../tests/window/driver.rs"]
#[expect(dead_code, reason = "a part of it")]
mod driver;
#[path = "../tests/window/raster.rs"]
mod raster;

use driver::Window;
use egui::{Key, Modifiers, PointerButton, pos2, vec2};
use egui_kittest::kittest::Queryable;
use std::{
    collections::BTreeMap,
    time::{Duration, Instant},
};

/// Hills of 1 002 528 triangles, a ball on them, and four lights.
const SCENE: &str = r#"Scene(
    version: 1,
    settings: (width: 1280, height: 720, antialias: Four, background: (0.45, 0.62, 0.85)),
    entities: {
        "Camera": [Camera(position: (0, 6, 16), target: (0, 0.5, 0), field_of_view: 36)],
        "Sky": [AmbientLight(intensity: 0.5)],
        "Lamp": [PointLight(position: (-4, 9, 5), intensity: 0.6)],
        "Sun": [DirectionalLight(direction: (-1, -2, -1), intensity: 0.4)],
        "Hills": [HeightField(size: (14, 2, 14), cells: 708), Color(0.5, 0.6, 0.4), Ambient(0.4), Diffuse(0.8)],
        "Ball": [Sphere(1), Transform([Translate((0, 2.5, 0))]), Color(0.8, 0.2, 0.1), Diffuse(0.8), Mirror(0.2)],
    },
)
"#;

fn median(times: &mut [Duration]) -> Duration {
    times.sort();
    times.get(times.len() / 2).copied().unwrap_or_default()
}

fn ms(time: Duration) -> String {
    format!("{:.1} ms", 1000.0 * time.as_secs_f64())
}

/// What is looked at: frames as they are drawn, and answers by the kind of edit.
#[derive(Default)]
struct Seen {
    frames: Vec<Duration>,
    answers: BTreeMap<&'static str, Vec<Duration>>,
    /// The state of the document that was last answered for.
    state: u64,
}

impl Seen {
    /// One frame of the window, timed.
    fn frame(&mut self, window: &mut Window) {
        let begun = Instant::now();
        window.harness.step();
        self.frames.push(begun.elapsed());
        let waits = Duration::from_millis(16).saturating_sub(begun.elapsed());
        std::thread::sleep(waits);
    }

    /// Frames until the last edit shows, coarse.
    fn answered(&mut self, window: &mut Window, kind: &'static str) {
        let begun = Instant::now();
        loop {
            self.frame(window);
            let session = window.editor().session();
            let view = session.worker.view();
            let is_there = view.state == session.document.state() && view.first_coarse.is_some();
            if is_there || begun.elapsed() > Duration::from_secs(60) {
                // Where nothing was edited nothing is answered.
                if std::mem::replace(&mut self.state, view.state) != view.state {
                    self.answers.entry(kind).or_default().extend(view.first_coarse);
                }
                return;
            }
        }
    }

    /// A click on what has a name, and its answer.
    fn click(&mut self, window: &mut Window, label: &str, kind: &'static str) {
        let all: Vec<_> = window.harness.query_all_by_label(label).collect();
        let Some(node) = all.last() else { return };
        node.click();
        self.frame(window);
        self.answered(window, kind);
    }

    /// A key, and its answer.
    fn key(&mut self, window: &mut Window, modifiers: Modifiers, key: Key, kind: &'static str) {
        window.harness.key_press_modifiers(modifiers, key);
        self.answered(window, kind);
    }

    /// A number, and its answer.
    fn number(&mut self, window: &mut Window, field: &str, number: &str, kind: &'static str) {
        window.write(field, number);
        self.answered(window, kind);
        window.release_focus();
    }

    /// The ball is moved by its handle, a dozen edits in one drag.
    fn drag(&mut self, window: &mut Window, by: f32) {
        let handle = window.harness.query_by_label("Move along x").map(|node| node.rect().center());
        let Some(knob) = handle else { return };
        window.harness.hover_at(knob);
        self.frame(window);
        window.harness.drag_at(knob);
        for step in 0..12 {
            window.harness.hover_at(knob + vec2(by * step as f32, 0.0));
            self.answered(window, "a thing dragged");
        }
        window.harness.drop_at(knob);
        self.answered(window, "a thing dragged");
    }

    /// The camera goes around, a dozen edits.
    fn orbit(&mut self, window: &mut Window) {
        let at = pos2(640.0, 420.0);
        window.harness.event(egui::Event::PointerMoved(at));
        let press = |pressed| egui::Event::PointerButton {
            pos: at,
            button: PointerButton::Secondary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        window.harness.event(press(true));
        for step in 0..12 {
            window.harness.event(egui::Event::PointerMoved(at + vec2(6.0 * step as f32, 2.0)));
            self.answered(window, "the camera turned");
        }
        window.harness.event(press(false));
        self.frame(window);
    }
}

fn main() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("hills.ron");
    std::fs::write(&file, SCENE).expect("written");
    let mut window = Window::open(folder.path(), Some(&file));
    let seconds = std::env::var("SECONDS").ok().and_then(|text| text.parse().ok()).unwrap_or(60.0);
    let mut seen = Seen::default();
    let begun = Instant::now();
    let mut round = 0_u32;
    let none = Modifiers::NONE;
    while begun.elapsed().as_secs_f64() < seconds {
        round += 1;
        let (w, is_even) = (&mut window, round.is_multiple_of(2));
        w.click("Ball");
        seen.drag(w, if is_even { 4.0 } else { -4.0 });
        seen.number(w, "Radius", if is_even { "1" } else { "1.25" }, "a number of the ball");
        seen.orbit(w);
        for _ in 0..3 {
            seen.key(w, Modifiers::COMMAND, Key::Z, "taken back, done again");
        }
        for _ in 0..3 {
            seen.key(w, Modifiers::COMMAND, Key::Y, "taken back, done again");
        }
        // Of the million triangles themselves: where they are, what they are made of, whether they are there.
        w.click("Hills");
        seen.number(w, "Color", if is_even { "0.5, 0.6, 0.4" } else { "#7a6a50" }, "the colour of the million");
        seen.click(w, "See-through", "the million made clear");
        seen.key(w, Modifiers::COMMAND, Key::Z, "the million made clear");
        seen.key(w, none, Key::H, "the million hidden and shown");
        seen.key(w, none, Key::H, "the million hidden and shown");
        seen.drag(w, 3.0);
        seen.key(w, Modifiers::COMMAND, Key::D, "the million copied and the copy deleted");
        seen.key(w, none, Key::Delete, "the million copied and the copy deleted");
        w.click("Hills");
        seen.key(w, none, Key::Delete, "the million deleted and brought back");
        seen.key(w, Modifiers::COMMAND, Key::Z, "the million deleted and brought back");
        w.click("Hills");
        seen.number(w, "Hills", if is_even { "3" } else { "4" }, "a million other triangles");
        // Half a second of looking on while the picture is refined.
        (0..30).for_each(|_| seen.frame(w));
    }
    let Seen { mut frames, answers, .. } = seen;
    let longest = frames.iter().max().copied().unwrap_or_default();
    println!("{round} rounds in {:.0} s; from an edit to its first coarse picture:", begun.elapsed().as_secs_f64());
    for (kind, mut times) in answers {
        let longest = times.iter().max().copied().unwrap_or_default();
        println!("{kind:42} {:4} edits, median {:>9}, longest {:>9}", times.len(), ms(median(&mut times)), ms(longest));
    }
    println!("frames: {}, median {}, longest {}", frames.len(), ms(median(&mut frames)), ms(longest));
}
