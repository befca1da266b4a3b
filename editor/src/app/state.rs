//! The editor's state, and what becomes of every wish.

use super::{
    add::{self, LOOKS},
    browser::Browser,
    camera,
    command::Command,
    dialog::Dialog,
    gizmo::{self, Drag, Tool},
    starters::{self, Thumbnails},
    viewport::Viewport,
    why::Why,
};
use crate::{
    document::Edit,
    loader::Factory,
    session::{Arrived, Session, Told},
};
use egui::{Context, ViewportCommand};
use snell::{
    Region, Snapshot,
    components::{
        asset::Asset,
        camera::Camera,
        describe::{FieldVisitor, Spec, Value},
        name::Name,
        shape::Mesh,
    },
    prelude::{DVec3, ImageTexture},
    systems::{
        image::{self, Format, Metadata},
        registry::AnyComponent,
        scene::Thing,
    },
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
}

impl Tab {
    pub(super) const ALL: [Self; 3] = [Self::Thing, Self::Render, Self::Why];

    pub(super) fn label(self) -> &'static str {
        match self {
            Self::Thing => "Properties",
            Self::Render => "Picture",
            Self::Why => "Why",
        }
    }

    pub(super) fn tip(self) -> &'static str {
        match self {
            Self::Thing => "All about the selected thing",
            Self::Render => "Render, size, light, save the picture",
            Self::Why => "Where the colour of a point comes from",
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
    pub(super) why: Why,
    pub(super) pending_region: Option<Region>,
    /// The axis and degrees of turning the camera.
    pub(super) turn_about: ([f64; 3], f64),
    /// Whether the name of the selected thing is to be typed.
    pub(super) wants_name: bool,
    /// A fault between the fields of a component: whose, and what.
    fault: Option<(Name, &'static str, String)>,
    commands: Vec<Command>,
    ctx: Context,
    /// Changes with every press, release and change of focus: edits within one number are one step.
    gesture: u64,
    focus: Option<egui::Id>,
    /// What is to be done once changes are saved or not wanted.
    next: Option<Box<Command>>,
    /// Whether the window may be closed.
    may_close: bool,
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
            why: Why::default(),
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
            "Duplicate" | "Delete" | "Rename…" | "Show selected" => self.selected.is_some(),
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
                if !matches!(self.dialog, Some(Dialog::Start | Dialog::Recover(_))) {
                    self.dialog = None;
                }
            }
            Some(Arrived::Thing(name)) => self.select(Some(name)),
            Some(Arrived::Fault) | None => {}
        }
        for told in self.session.take_told() {
            if told.tone == crate::session::Tone::Fault && !told.lines.is_empty() {
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
    fn open(&mut self, file: &Path) {
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

    fn select(&mut self, name: Option<Name>) {
        if name.is_some() {
            self.tab = Tab::Thing;
        }
        self.selected = name;
        self.drag = None;
    }

    fn added(&mut self, made: Option<(Edit, Name)>) {
        if let Some((edit, name)) = made {
            self.session.apply(edit);
            self.select(Some(name));
        }
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

    /// Takes a file from outside: a scene is opened, a model added, an image put on the selected thing.
    fn take(&mut self, file: &Path) {
        self.dialog = None;
        let extension = file.extension().map(|extension| extension.to_string_lossy().to_ascii_lowercase());
        match extension.as_deref() {
            Some("ron") => self.ask(Command::Open(file.into())),
            Some("obj") => {
                let stem = file.file_stem().map_or_else(|| "Model".into(), |stem| stem.to_string_lossy().into_owned());
                let name = self.session.document.free_name(&stem.replace('#', " "));
                let mesh = Mesh { model: asset(file), ..Mesh::default() };
                self.session.bring(format!("Add {}", name.as_str()), &name, Thing::default().with(mesh));
            }
            Some(extension) if IMAGES.contains(&extension) => {
                let Some((name, mut thing)) = self.selected_thing() else {
                    self.told = Some(Told::fault("Select the thing that the image is for, then drop it again", vec![]));
                    return;
                };
                let registry = self.session.document.registry();
                let is_texture = |tag: &str| {
                    registry.get(tag).is_some_and(|entry| entry.kind == snell::systems::registry::Kind::Texture)
                };
                thing.components.retain(|tag, _| !is_texture(tag));
                let texture = ImageTexture { image: asset(file), ..ImageTexture::default() };
                self.session.bring(format!("Image on {}", name.as_str()), &name, thing.with(texture));
            }
            _ => {
                let what = format!("{} is no scene, model or image that can be read", file.display());
                self.told = Some(Told::fault(what, vec![]));
            }
        }
    }

    fn is_model(&self, tag: &str) -> bool {
        struct Finder(bool);
        impl FieldVisitor for Finder {
            fn field(&mut self, _: &'static str, value: Value<'_>, _: Spec) {
                self.0 |= matches!(value, Value::Model(_));
            }
        }
        let mut finder = Finder(false);
        if let Some(mut component) = add::fresh(tag, self.session.document.registry()) {
            component.visit(&mut finder);
        }
        finder.0
    }

    /// Names another file in a field of the selected thing's component, which is added if it is not there.
    fn set_file(&mut self, tag: &'static str, field: &'static str, file: &Path) {
        struct Setter<'a>(&'static str, &'a Path);
        impl FieldVisitor for Setter<'_> {
            fn field(&mut self, name: &'static str, value: Value<'_>, _: Spec) {
                match value {
                    Value::Model(model) if name == self.0 => *model = asset(self.1),
                    Value::Image(image) if name == self.0 => *image = asset(self.1),
                    _ => {}
                }
            }
        }
        let Some((name, mut thing)) = self.selected_thing() else { return };
        let known = thing.components.get(tag).cloned();
        let Some(mut component) = known.or_else(|| add::fresh(tag, self.session.document.registry())) else { return };
        component.visit(&mut Setter(field, file));
        thing.components.insert(component.tag(), component);
        self.session.bring(format!("File of {}", name.as_str()), &name, thing);
    }

    fn save_picture(&mut self, file: &Path) {
        let (frame, snapshot) = {
            let view = self.session.worker.view();
            (view.frame.clone(), view.snapshot.clone())
        };
        let (Some(frame), Some(snapshot)) = (frame, snapshot) else {
            self.told = Some(Told::fault("There is no picture to save", vec![]));
            return;
        };
        let scene = self.session.document.file().map_or_else(|| "untitled".into(), Path::to_path_buf);
        let metadata = Metadata::of(&frame, &snapshot.settings, &scene);
        let written = Format::of(file).and_then(|format| image::write(file, format, &frame.picture, &metadata));
        self.told = Some(match written {
            Ok(()) if frame.is_complete() => Told::done(format!("Saved {}", file.display())),
            Ok(()) => Told::done(format!("Saved the part that was drawn: {}", file.display())),
            Err(why) => Told::fault(why.to_string(), vec![]),
        });
    }
}

/// Images that can be textures.
const IMAGES: &[&str] = &["png", "jpg", "jpeg", "bmp", "tga", "exr"];

fn asset<T>(file: &Path) -> Asset<T> {
    let file = std::path::absolute(file).unwrap_or(file.into());
    Asset { path: file.to_string_lossy().into_owned(), data: None }
}

/// The field of a component that names a file it cannot do without.
fn file_field(component: &dyn AnyComponent) -> Option<&'static str> {
    struct Finder(Option<&'static str>);
    impl FieldVisitor for Finder {
        fn field(&mut self, name: &'static str, value: Value<'_>, spec: Spec) {
            if matches!(value, Value::Model(_) | Value::Image(_)) && spec.required {
                self.0 = Some(name);
            }
        }
    }
    let mut finder = Finder(None);
    component.copy().visit(&mut finder);
    finder.0
}
