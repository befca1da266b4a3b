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
use std::time::{Duration, Instant};

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

/// What is looked at: frames as they are drawn, and answers.
#[derive(Default)]
struct Seen {
    frames: Vec<Duration>,
    answers: Vec<Duration>,
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
    fn answered(&mut self, window: &mut Window) {
        let begun = Instant::now();
        loop {
            self.frame(window);
            let session = window.editor().session();
            let view = session.worker.view();
            let is_there = view.state == session.document.state() && view.first_coarse.is_some();
            if is_there || begun.elapsed() > Duration::from_secs(60) {
                self.answers.extend(view.first_coarse);
                return;
            }
        }
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
    window.click("Ball");
    while begun.elapsed().as_secs_f64() < seconds {
        round += 1;
        match round % 5 {
            // The ball is moved by its handle, a dozen edits in one drag.
            0 => {
                let handle = window.harness.query_by_label("Move along x").map(|node| node.rect().center());
                let Some(knob) = handle else { continue };
                window.harness.hover_at(knob);
                seen.frame(&mut window);
                window.harness.drag_at(knob);
                for step in 0..12 {
                    let by = if round.is_multiple_of(2) { 4.0 } else { -4.0 };
                    window.harness.hover_at(knob + vec2(by * step as f32, 0.0));
                    seen.answered(&mut window);
                }
                window.harness.drop_at(knob);
                seen.answered(&mut window);
            }
            // A number is typed.
            1 => {
                window.write("Radius", if round.is_multiple_of(2) { "1" } else { "1.25" });
                seen.answered(&mut window);
            }
            // The camera goes around, a dozen edits.
            2 => {
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
                    seen.answered(&mut window);
                }
                window.harness.event(press(false));
                seen.frame(&mut window);
            }
            // Taken back and done again.
            3 => {
                for _ in 0..4 {
                    window.harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
                    seen.answered(&mut window);
                }
                for _ in 0..4 {
                    window.harness.key_press_modifiers(Modifiers::COMMAND, Key::Y);
                    seen.answered(&mut window);
                }
            }
            // Half a second of looking on while the picture is refined.
            _ => (0..30).for_each(|_| seen.frame(&mut window)),
        }
    }
    let Seen { mut frames, mut answers } = seen;
    let (longest_frame, longest_answer) = (frames.iter().max().copied(), answers.iter().max().copied());
    println!(
        "{round} rounds in {:.0} s; first coarse picture after an edit: median {}, longest {} of {}; frames: median {}, longest {} of {}",
        begun.elapsed().as_secs_f64(),
        ms(median(&mut answers)),
        ms(longest_answer.unwrap_or_default()),
        answers.len(),
        ms(median(&mut frames)),
        ms(longest_frame.unwrap_or_default()),
        frames.len(),
    );
}
