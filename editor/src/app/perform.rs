//! What becomes of every wish, at the end of the frame in which it was made.

use super::{
    add::{self, LOOKS},
    browser::Browser,
    camera,
    command::Command,
    dialog::Dialog,
    gizmo,
    intake::IMAGES,
    starters,
    state::{Editor, Tab},
};
use crate::{document::Edit, session::Told};
use egui::{Context, ViewportCommand};
use snell::components::{camera::Camera, describe::Describe, hidden::Hidden, name::Name};
use std::path::{Path, PathBuf};

impl Editor {
    /// Does all that was wished for in this frame.
    pub(super) fn perform(&mut self, ctx: &Context) {
        for command in std::mem::take(&mut self.commands) {
            self.do_one(ctx, command);
        }
        let focus = ctx.memory(|memory| memory.focused());
        let pointer = ctx.input(|input| input.pointer.any_pressed() || input.pointer.any_released());
        if pointer || focus != self.focus {
            self.focus = focus;
            self.gesture += 1;
        }
        let document = &self.session.document;
        let is_nothing = document.things().next().is_none() && document.file().is_none() && !document.is_changed();
        if self.dialog.is_none() && is_nothing && self.session.reading().is_none() {
            // As after a start with a scene that has faults.
            self.dialog = Some(Dialog::Start);
        }
        if self.dialog.is_none() {
            // What was to come after a question is not to come after another one.
            self.next = None;
        }
        if self.selected.as_ref().is_some_and(|name| self.session.document.get(name).is_none()) {
            self.selected = None;
        }
    }

    fn do_one(&mut self, ctx: &Context, command: Command) {
        match command {
            Command::New => self.dialog = Some(Dialog::Start),
            Command::Start(_) | Command::Open(_) | Command::Recover(_) | Command::Quit
                if self.session.document.is_changed() && self.next.is_none() =>
            {
                self.dialog = Some(Dialog::Unsaved);
                self.next = Some(Box::new(command));
            }
            Command::Start(name) => {
                self.next = None;
                self.dialog = None;
                self.told = None;
                if let Some(starter) = starters::ALL.iter().find(|starter| starter.name == name) {
                    self.session.open_text(starter.name, starter.text);
                }
            }
            Command::Open(file) => {
                self.next = None;
                self.dialog = None;
                self.open(&file);
            }
            Command::Recover(file) => {
                self.next = None;
                self.session.recover(file.as_deref());
            }
            Command::OpenSaved(file) => {
                self.session.forget_kept(file.as_deref());
                match file {
                    Some(file) => self.session.open(&file),
                    None => self.dialog = Some(Dialog::Start),
                }
            }
            Command::Quit => {
                self.may_close = true;
                ctx.send_viewport_cmd(ViewportCommand::Close);
            }
            Command::Proceed { save } => self.proceed(ctx, save),
            Command::Close => {
                self.dialog = None;
                self.next = None;
            }
            Command::Show(dialog) => self.dialog = Some(dialog),
            Command::AskOpen => self.browse("Open a scene", &["ron"], Command::Open),
            Command::Save => {
                if self.session.document.file().is_none() {
                    self.do_one(ctx, Command::AskSaveAs);
                } else if !self.session.document.is_changed() {
                    self.told = Some(Told::done("Nothing to save"));
                } else {
                    self.session.save();
                }
            }
            Command::AskSaveAs => {
                let name = self.session.document.file().and_then(Path::file_name);
                let name = name.map_or_else(|| "scene.ron".into(), |name| name.to_string_lossy().into_owned());
                let browser =
                    Browser::save("Save the scene", &["ron"], self.session.folder(), name, Box::new(Command::SaveAs));
                self.dialog = Some(Dialog::Files(browser));
            }
            Command::SaveAs(file) => {
                self.dialog = None;
                if self.session.save_as(&file)
                    && let Some(next) = self.next.take()
                {
                    self.do_one(ctx, *next);
                }
            }
            Command::AskSavePicture => {
                let name = Path::new(&self.session.title()).with_extension("png").to_string_lossy().into_owned();
                let browser = Browser::save(
                    "Save the picture",
                    &["png", "exr"],
                    self.session.folder(),
                    name,
                    Box::new(Command::SavePicture),
                );
                self.dialog = Some(Dialog::Files(browser));
            }
            Command::SavePicture(file) => {
                self.dialog = None;
                self.save_picture(&file);
            }
            Command::Undo => self.session.undo(),
            Command::Redo => self.session.redo(),
            Command::Apply(edit) => {
                self.session.apply(edit);
            }
            Command::Gesture(edit) => self.session.apply(edit.during(Some(self.gesture))),
            Command::Abandon => {
                self.drag = None;
                self.session.undo();
                self.gesture += 1;
            }
            Command::Select(name) => self.select(name),
            Command::Page(by) => self.page(by),
            Command::Add(tag) => {
                let at = self.looked_at();
                self.added(add::component(&self.session.document, tag, at));
            }
            Command::AddMaterial(number) => self.added(Some(add::material(&self.session.document, &LOOKS[number]))),
            Command::AddCamera => self.added(Some(add::camera(&self.session.document))),
            Command::AddGroup => self.added(Some(add::group(&self.session.document))),
            Command::Duplicate => {
                let copy = self.selected.as_ref().and_then(|name| add::duplicate(&self.session.document, name));
                self.added(copy);
            }
            Command::Hide => {
                if let Some(name) = self.selected.clone() {
                    self.toggle_hidden(&name);
                }
            }
            Command::ToggleHidden(name) => self.toggle_hidden(&name),
            Command::Delete => {
                if let Some(name) = self.selected.take() {
                    self.session.apply(add::delete(&self.session.document, &name));
                }
            }
            Command::AskRename => {
                self.tab = Tab::Thing;
                self.wants_name = true;
            }
            Command::Rename(old, new) => {
                let new = Name::new(new);
                if self.session.document.name_fault(new.as_str()).is_none() {
                    let label = format!("Rename {}", old.as_str());
                    self.session.apply(Edit { renames: vec![(old, new.clone())], ..Edit::new(label) });
                    self.selected = Some(new);
                }
            }
            Command::AskModel => self.browse("Add a model", &["obj"], Command::Take),
            Command::Take(file) => self.take(&file),
            Command::AskFile { tag, field } => {
                let is_model = self.is_model(tag);
                let (title, extensions): (_, &[&str]) =
                    if is_model { ("Choose a model", &["obj"]) } else { ("Choose an image", IMAGES) };
                self.browse(title, extensions, move |file| Command::SetFile { tag, field, file });
            }
            Command::SetFile { tag, field, file } => {
                self.dialog = None;
                self.set_file(tag, field, &file);
            }
            Command::Render => self.session.worker.start(),
            Command::Stop => self.session.worker.stop(),
            Command::ToggleRender => {
                if self.session.worker.is_busy() {
                    self.session.worker.stop();
                } else {
                    self.session.worker.start();
                }
            }
            Command::Frame => self.frame(),
            Command::Move(motion) => {
                if let Some(edit) = camera::moved(&self.session.document, motion) {
                    // Motions that follow each other at once are one step.
                    let is_going_on = self.session.document.undo_label() == Some("Move camera");
                    let gesture = if is_going_on { self.gesture } else { self.gesture + 1 };
                    self.gesture = gesture;
                    self.session.apply(edit.during(Some(gesture)));
                }
            }
            Command::Tool(tool) => self.tool = tool,
            Command::CopyCode => {
                ctx.copy_text(super::code::rust(&self.session.document.scene(), self.session.document.registry()));
                self.told = Some(Told::done("The program is in the clipboard"));
            }
        }
    }

    fn browse(
        &mut self,
        title: &'static str,
        extensions: &'static [&'static str],
        make: impl Fn(PathBuf) -> Command + 'static,
    ) {
        self.dialog = Some(Dialog::Files(Browser::open(title, extensions, self.session.folder(), Box::new(make))));
    }

    /// Opens a file, or asks whether what was kept of it is wanted.
    pub(super) fn open(&mut self, file: &Path) {
        self.told = None;
        if self.session.kept(Some(file)).is_some() {
            self.dialog = Some(Dialog::Recover(Some(file.into())));
        } else {
            self.session.open(file);
        }
    }

    fn proceed(&mut self, ctx: &Context, save: bool) {
        if save && self.session.document.file().is_none() {
            return self.do_one(ctx, Command::AskSaveAs);
        }
        if save && !self.session.save() {
            return;
        }
        if !save {
            self.session.forget_changes();
        }
        self.dialog = None;
        if let Some(next) = self.next.take() {
            self.do_one(ctx, *next);
        }
    }

    pub(super) fn select(&mut self, name: Option<Name>) {
        if name.is_some() {
            self.tab = Tab::Thing;
        }
        self.selected = name;
        self.drag = None;
    }

    /// Selects another thing by its place in the list, which goes around.
    fn page(&mut self, by: isize) {
        let names = self.listed.all();
        let Some(last) = names.len().checked_sub(1) else { return };
        let here = self.selected.as_ref().and_then(|name| names.iter().position(|other| other == name));
        let next = match here {
            Some(here) => (here as isize + by).rem_euclid(names.len() as isize) as usize,
            None if by < 0 => last,
            None => 0,
        };
        self.select(names.get(next).cloned());
    }

    fn added(&mut self, made: Option<(Edit, Name)>) {
        if let Some((edit, name)) = made {
            self.session.apply(edit);
            self.select(Some(name));
        }
    }

    fn toggle_hidden(&mut self, name: &Name) {
        let Some(thing) = self.session.document.get(name) else { return };
        let mut thing = (**thing).clone();
        let verb = if thing.components.remove(Hidden::TAG).is_some() {
            "Show"
        } else {
            thing = thing.with(Hidden {});
            "Hide"
        };
        self.session.apply(Edit::of(format!("{verb} {}", name.as_str()), name, thing));
    }

    /// The camera goes to where it sees the selected thing whole.
    fn frame(&mut self) {
        let Some((name, thing)) = self.selected_thing() else { return };
        if thing.get::<Camera>().is_some() {
            return;
        }
        let snapshot = self.session.worker.view().snapshot.clone();
        let sphere = snapshot.and_then(|snapshot| gizmo::sphere(&snapshot, &name));
        let (center, radius) = sphere.map_or_else(
            || {
                let at = thing.components.values().find_map(|component| add::position(component.as_ref()));
                let world = camera::world_from_object(&self.session.document, &thing);
                (world.transform_point3(at.unwrap_or_default()), 1.0)
            },
            |sphere| (sphere.center, sphere.radius),
        );
        if let Some(edit) = camera::framed(&self.session.document, center, radius) {
            self.session.apply(edit);
        }
    }
}
