//! The editor's state, and what it takes in at the begin of a frame.

use super::{
    add, camera,
    chart::Chart,
    command::Command,
    dialog::Dialog,
    gizmo::{Drag, Tool},
    intake::file_field,
    starters::{self, Thumbnails},
    things::Listed,
    viewport::Viewport,
    why::Why,
};
use crate::{
    document::Edit,
    loader::Factory,
    session::{Arrived, Session, Told, Tone},
};
use egui::{Context, ViewportCommand};
use snell::{
    Region, Snapshot,
    components::name::Name,
    prelude::DVec3,
    systems::{registry::AnyComponent, scene::Thing},
};
use std::path::{Path, PathBuf};

/// What the panel at the right shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Tab {
    /// The selected thing.
    #[default]
    Thing,
    /// The render and the settings of the scene.
    Render,
    /// How a pixel comes about.
    Why,
    /// Speed against accuracy.
    Chart,
}

impl Tab {
    pub(super) const ALL: [Self; 4] = [Self::Thing, Self::Render, Self::Why, Self::Chart];

    pub(super) fn label(self) -> &'static str {
        match self {
            Self::Thing => "Properties",
            Self::Render => "Picture",
            Self::Why => "Why",
            Self::Chart => "Chart",
        }
    }

    pub(super) fn tip(self) -> &'static str {
        match self {
            Self::Thing => "All about the selected thing",
            Self::Render => "Render, size, light, save the picture",
            Self::Why => "Where the colour of a point comes from",
            Self::Chart => "Speed against accuracy for this scene",
        }
    }
}

/// The editor.
pub struct Editor {
    pub(super) session: Session,
    pub(super) selected: Option<Name>,
    pub(super) tab: Tab,
    pub(super) tool: Tool,
    pub(super) drag: Option<Drag>,
    pub(super) dialog: Option<Dialog>,
    pub(super) told: Option<Told>,
    pub(super) viewport: Viewport,
    pub(super) thumbnails: Option<Thumbnails>,
    pub(super) listed: Listed,
    pub(super) why: Why,
    pub(super) chart: Chart,
    pub(super) pending_region: Option<Region>,
    /// The axis and degrees of turning the camera.
    pub(super) turn_about: ([f64; 3], f64),
    /// Whether the name of the selected thing is to be typed.
    pub(super) wants_name: bool,
    /// A fault between the fields of a component: whose, and what.
    fault: Option<(Name, &'static str, String)>,
    pub(super) commands: Vec<Command>,
    pub(super) ctx: Context,
    /// Changes with every press, release and change of focus: edits within one number are one step.
    pub(super) gesture: u64,
    pub(super) focus: Option<egui::Id>,
    /// What is to be done once changes are saved or not wanted.
    pub(super) next: Option<Box<Command>>,
    /// Whether the window may be closed.
    pub(super) may_close: bool,
}

impl Editor {
    /// An editor that opens a scene, or shows scenes to begin with; `data` is its own folder.
    #[must_use]
    pub fn new(ctx: &Context, factory: Factory, data: PathBuf, file: Option<&Path>) -> Self {
        super::style::set(ctx);
        let waker = ctx.clone();
        let session = Session::new(factory, data, move || waker.request_repaint());
        let mut this = Self {
            session,
            selected: None,
            tab: Tab::default(),
            tool: Tool::default(),
            drag: None,
            dialog: None,
            told: None,
            viewport: Viewport::default(),
            thumbnails: None,
            listed: Listed::default(),
            why: Why::default(),
            chart: Chart::default(),
            pending_region: None,
            turn_about: ([0.0, 1.0, 0.0], 15.0),
            wants_name: false,
            fault: None,
            commands: vec![],
            ctx: ctx.clone(),
            gesture: 1,
            focus: None,
            next: None,
            may_close: false,
        };
        match file {
            Some(file) => this.open(file),
            None => {
                this.session.open_text(starters::ALL[0].name, starters::ALL[0].text);
                let kept = this.session.kept(None);
                this.dialog = Some(if kept.is_some() { Dialog::Recover(None) } else { Dialog::Start });
            }
        }
        this
    }

    /// The session, for tests and for programs that stand around the editor.
    #[must_use]
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// Waits until all that was asked to be written is on disk; the last thing a program does with an editor.
    pub fn finish(&mut self) {
        self.session.finish();
    }

    /// Whether anything is being read, drawn or written.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        let session = &self.session;
        let thumbnails = self.thumbnails.as_ref().is_some_and(Thumbnails::is_busy);
        session.reading().is_some() || session.writing().is_some() || session.worker.is_busy() || thumbnails
    }

    /// The name of the selected thing.
    #[must_use]
    pub fn selected(&self) -> Option<&Name> {
        self.selected.as_ref()
    }

    /// What the window's title says.
    #[must_use]
    pub fn title(&self) -> String {
        let mark = if self.session.document.is_changed() { "• " } else { "" };
        format!("{mark}{} – Snell", self.session.title())
    }

    /// Wishes something, to be done at the end of the frame.
    pub(super) fn ask(&mut self, command: Command) {
        self.commands.push(command);
    }

    pub(super) fn selected_thing(&self) -> Option<(Name, Thing)> {
        let name = self.selected.clone()?;
        let thing = self.session.document.get(&name)?;
        Some((name, (**thing).clone()))
    }

    /// Whether a command makes sense now.
    pub(super) fn can(&self, label: &str) -> bool {
        match label {
            "Undo" => self.session.document.undo_label().is_some(),
            "Redo" => self.session.document.redo_label().is_some(),
            "Duplicate" | "Hide" | "Delete" | "Rename…" | "Show selected" => self.selected.is_some(),
            "Save picture…" => self.session.worker.view().frame.is_some(),
            _ => true,
        }
    }

    /// How many things cannot be drawn as they are.
    pub(super) fn left_out(&self) -> usize {
        self.session.worker.view().snapshot.as_ref().map_or(0, |snapshot| snapshot.left_out.len())
    }

    /// Whether a click into the picture asks about the pixel.
    pub(super) fn is_asking_why(&self) -> bool {
        self.tab == Tab::Why
    }

    /// Asks how a pixel of the picture comes about.
    pub(super) fn ask_why(&mut self, x: u32, y: u32) {
        let (snapshot, state) = {
            let view = self.session.worker.view();
            (view.snapshot.clone(), view.state)
        };
        let size = |snapshot: &Snapshot| (snapshot.settings.width, snapshot.settings.height);
        if let Some(snapshot) = snapshot.filter(|snapshot| x < size(snapshot).0 && y < size(snapshot).1) {
            let ctx = self.ctx.clone();
            self.why.ask(x, y, state, snapshot, move || ctx.request_repaint());
        }
    }

    /// The fault between the fields of a component, if there is one.
    pub(super) fn field_fault(&self, name: &Name, tag: &str) -> Option<&str> {
        self.fault.as_ref().filter(|(of, its, _)| of == name && *its == tag).map(|(.., fault)| fault.as_str())
    }

    /// Puts a changed component in place of the one a thing has, if its fields fit together.
    pub(super) fn change_component(
        &mut self,
        name: &Name,
        thing: &Thing,
        tag: &'static str,
        new: Box<dyn AnyComponent>,
    ) {
        self.fault = new.validate().err().map(|fault| (name.clone(), tag, format!("Expected {}", fault.expected)));
        if self.fault.is_none() {
            let mut changed = thing.clone();
            changed.components.insert(tag, new);
            let edit = Edit::of(format!("Change {}", name.as_str()), name, changed);
            self.ask(Command::Gesture(edit));
        }
    }

    /// Adds a component to a thing; one that needs a file asks for it first.
    pub(super) fn add_property(&mut self, name: &Name, thing: &Thing, tag: &'static str) {
        let registry = self.session.document.registry();
        let Some(component) = add::fresh(tag, registry) else { return };
        if let Some(field) = file_field(component.as_ref()) {
            return self.ask(Command::AskFile { tag, field });
        }
        let mut changed = thing.clone();
        changed.components.insert(component.tag(), component);
        let label = format!("Add {} to {}", super::names::words(tag).to_lowercase(), name.as_str());
        self.ask(Command::Apply(Edit::of(label, name, changed)));
    }

    /// The point of the world that the camera looks at.
    pub(super) fn looked_at(&self) -> DVec3 {
        let document = &self.session.document;
        let target = camera::find(document).map(|(_, thing, camera)| {
            let at = camera.moved();
            let target = at.target.unwrap_or_else(|| at.position + at.view().normalize_or(DVec3::NEG_Z) * 5.0);
            camera::world_from_object(document, thing).transform_point3(target)
        });
        target.unwrap_or_default()
    }

    /// Takes what arrived from other threads and from outside the window.
    pub(super) fn receive(&mut self, ctx: &Context) {
        match self.session.poll() {
            Some(Arrived::Scene) => {
                self.selected = None;
                self.fault = None;
                self.listed = Listed::default();
                if !matches!(self.dialog, Some(Dialog::Start | Dialog::Recover(_))) {
                    self.dialog = None;
                }
            }
            Some(Arrived::Thing(name)) => self.select(Some(name)),
            Some(Arrived::Fault) | None => {}
        }
        for told in self.session.take_told() {
            if told.tone == Tone::Fault && !told.lines.is_empty() {
                self.dialog = Some(Dialog::Told(told.clone()));
            }
            self.told = Some(told);
        }
        let dropped: Vec<PathBuf> =
            ctx.input(|input| input.raw.dropped_files.iter().map(|file| file.path().to_path_buf()).collect());
        for file in dropped {
            self.ask(Command::Take(file));
        }
        if ctx.input(|input| input.viewport().close_requested()) && !self.may_close {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.ask(Command::Quit);
        }
        if self.dialog.is_none() {
            self.commands.extend(super::command::pressed(ctx));
            self.commands.extend(camera::pressed(ctx).into_iter().map(Command::Move));
            if self.drag.is_some() && ctx.input_mut(|input| input.consume_key(egui::Modifiers::NONE, egui::Key::Escape))
            {
                self.ask(Command::Abandon);
            }
        }
    }
}
