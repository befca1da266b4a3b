//! The editor without a window: driven by the names that screen readers see.

use crate::raster::Raster;
use egui::{Key, Modifiers, Role};
use egui_kittest::{Harness, Node, kittest::Queryable};
use snell::{Options, Renderer, render};
use snell_editor::{app::Editor, loader::Factory};
use std::{
    path::Path,
    sync::Arc,
    time::{Duration, Instant},
};

/// The editor under test; it is there from the first frame on.
pub(crate) struct Window {
    pub(crate) harness: Harness<'static, Option<Editor>>,
    raster: Raster,
}

/// Points, and pixels.
const SIZE: [u32; 2] = [1280, 800];

impl Window {
    /// A window with the built-in shapes that opens a file, or shows scenes to begin with.
    pub(crate) fn open(data: &Path, file: Option<&Path>) -> Self {
        Self::open_with(Arc::new(Renderer::new), data, file)
    }

    /// As [`Window::open`] with shapes of others.
    pub(crate) fn open_with(factory: Factory, data: &Path, file: Option<&Path>) -> Self {
        let (data, file) = (data.to_path_buf(), file.map(Path::to_path_buf));
        let show = move |ui: &mut egui::Ui, editor: &mut Option<Editor>| {
            let make = || Editor::new(ui.ctx(), factory.clone(), data.clone(), file.as_deref());
            editor.get_or_insert_with(make).ui(ui);
        };
        let raster = Raster::default();
        let builder = Harness::builder().with_size(SIZE.map(|n| n as f32)).with_step_dt(1.0 / 60.0);
        let mut this = Self { harness: builder.renderer(raster.clone()).build_ui_state(show, None), raster };
        this.wait();
        this
    }

    pub(crate) fn editor(&self) -> &Editor {
        self.harness.state().as_ref().expect("shown once")
    }

    /// What the window looks like.
    pub(crate) fn shot(&self) -> image::RgbImage {
        self.raster.picture(&self.harness.ctx, self.harness.output(), SIZE)
    }

    pub(crate) fn step(&mut self) {
        self.harness.run_steps(3);
    }

    /// Until nothing is read or drawn any more.
    pub(crate) fn wait(&mut self) {
        let begun = Instant::now();
        loop {
            self.step();
            let session = self.editor().session();
            let is_shown = session.worker.view().state == session.document.state();
            if session.reading().is_none() && session.writing().is_none() && !session.worker.is_busy() && is_shown {
                break;
            }
            assert!(begun.elapsed() < Duration::from_secs(120), "the editor does not come to rest");
            std::thread::sleep(Duration::from_millis(3));
        }
        self.step();
    }

    pub(crate) fn node<'a>(&'a self, label: &'a str) -> Node<'a> {
        self.harness.get_by_label(label)
    }

    pub(crate) fn has(&self, label: &str) -> bool {
        self.harness.query_all_by_label(label).next().is_some()
    }

    /// Clicks what has a name.
    pub(crate) fn click(&mut self, label: &str) {
        self.node(label).click();
        self.step();
    }

    /// Clicks through menus.
    pub(crate) fn menu(&mut self, path: &[&str]) {
        for label in path {
            let matching: Vec<_> = self.harness.query_all_by_label(label).collect();
            let node = matching.last().unwrap_or_else(|| panic!("there is no “{label}”"));
            node.click();
            self.step();
        }
        self.wait();
    }

    /// Types into a field in place of what is there.
    pub(crate) fn set(&mut self, field: &str, text: &str) {
        self.write(field, text);
        self.key(Modifiers::NONE, Key::Enter);
        self.wait();
    }

    /// As [`Window::set`], but without leaving the field.
    pub(crate) fn write(&mut self, field: &str, text: &str) {
        self.harness.get_by_role_and_label(Role::TextInput, field).focus();
        self.step();
        self.key(Modifiers::COMMAND, Key::A);
        self.harness.get_by_role_and_label(Role::TextInput, field).type_text(text);
        self.step();
    }

    /// Adds a step to the last placement in sight.
    pub(crate) fn add_step(&mut self, kind: &str) {
        self.menu(&["Add a step"]);
        // The tools at the top have some of these names, too.
        let lowest = self.harness.query_all_by_label(kind).max_by(|a, b| a.rect().top().total_cmp(&b.rect().top()));
        lowest.unwrap_or_else(|| panic!("there is no step “{kind}”")).click();
        self.step();
        self.wait();
    }

    /// Chooses from a list that opens.
    pub(crate) fn choose(&mut self, list: &str, word: &str) {
        self.harness.get_by_role_and_label(Role::ComboBox, list).click();
        self.step();
        self.menu(&[word]);
    }

    /// Where the knob of a slider is.
    pub(crate) fn slider(&self, label: &str) -> egui::Pos2 {
        self.harness.get_by_role_and_label(Role::Slider, label).rect().center()
    }

    pub(crate) fn key(&mut self, modifiers: Modifiers, key: Key) {
        self.harness.key_press_modifiers(modifiers, key);
        self.step();
    }

    /// Takes the keys away from what has them.
    pub(crate) fn release_focus(&mut self) {
        let ctx = self.harness.ctx.clone();
        ctx.memory_mut(|memory| memory.focused().map(|id| memory.surrender_focus(id)));
        self.step();
    }

    /// Saves the scene to a file.
    pub(crate) fn save_as(&mut self, file: &Path) {
        self.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
        self.set("File name", file.to_str().expect("a path"));
        if self.has("Replace") {
            self.click("Replace");
        }
        self.wait();
        assert!(file.is_file(), "not saved");
    }

    /// Drags from one point of the window to another.
    pub(crate) fn drag(&mut self, from: egui::Pos2, by: egui::Vec2) {
        self.drag_with(egui::PointerButton::Primary, from, by);
    }

    /// As [`Window::drag`] with a button.
    pub(crate) fn drag_with(&mut self, button: egui::PointerButton, from: egui::Pos2, by: egui::Vec2) {
        let press = |pos, pressed| egui::Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE };
        self.harness.hover_at(from);
        self.step();
        self.harness.event(press(from, true));
        self.step();
        for part in 1..=4 {
            self.harness.hover_at(from + by * part as f32 / 4.0);
            self.step();
        }
        self.harness.event(press(from + by, false));
        self.step();
        self.wait();
    }

    /// The hash of the picture on the screen, which must be complete.
    pub(crate) fn picture(&self) -> String {
        let view = self.editor().session().worker.view();
        let frame = view.frame.clone().expect("a picture");
        assert!(frame.is_complete());
        // What the screen shows is what a PNG file holds.
        assert_eq!(view.screen.pixels, snell::systems::image::srgb8(&frame.picture));
        frame.picture.hash()
    }

    /// The program that the menu copies.
    pub(crate) fn copied_code(&mut self) -> String {
        self.click("File");
        self.node("Copy as Rust code").click();
        for _ in 0..4 {
            self.harness.step();
            let commands = &self.harness.output().platform_output.commands;
            let copied = commands.iter().find_map(|command| match command {
                egui::OutputCommand::CopyText(text) => Some(text.clone()),
                _ => None,
            });
            if let Some(text) = copied {
                return text;
            }
        }
        panic!("nothing was copied");
    }

    pub(crate) fn text(&self) -> String {
        self.editor().session().document.text().expect("a text")
    }
}

/// The hash of the picture that `snell render` makes of a file.
pub(crate) fn rendered(file: &Path) -> String {
    let mut renderer = Renderer::new();
    renderer.load(file).unwrap_or_else(|faults| panic!("{faults}"));
    render(&renderer.snapshot().expect("a snapshot"), &Options::default()).picture.hash()
}

/// As [`rendered`] of a text.
pub(crate) fn rendered_text(text: &str) -> String {
    let mut renderer = Renderer::new();
    renderer.load_text(text, "scene.ron").unwrap_or_else(|faults| panic!("{faults}\n{text}"));
    render(&renderer.snapshot().expect("a snapshot"), &Options::default()).picture.hash()
}

/// A tag as the menus have it: `PointLight` is "Point light".
pub(crate) fn words(tag: &str) -> String {
    let letters = tag.char_indices().flat_map(|(at, letter)| {
        let is_new_word = at > 0 && letter.is_uppercase();
        let letter = if is_new_word { letter.to_ascii_lowercase() } else { letter };
        is_new_word.then_some(' ').into_iter().chain([letter])
    });
    letters.collect()
}
