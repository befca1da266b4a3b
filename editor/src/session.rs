//! The open scene and all that works for it: the document, the thread that draws, autosave, files being read.
//!
//! Within a session the paths of models and images are absolute; in a scene's file they are as seen from its folder.

use crate::{
    autosave::{self, Autosave},
    document::{Document, Edit},
    files,
    loader::{self, Factory, Loaded, Loading},
    picture::Writing,
    worker::{How, Worker},
};
use snell::{
    Frame,
    components::{name::Name, settings::Settings},
    systems::{
        image::write_atomically,
        registry::Registry,
        scene::{Scene, Thing, is_of_model},
    },
};
use std::{
    fs,
    path::{Path, PathBuf},
    sync::Arc,
};

/// How something that is told went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// It was done.
    Done,
    /// It was done, but not all as one might think.
    Warning,
    /// It was not done.
    Fault,
}

/// Something to be told to the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Told {
    /// How it went.
    pub tone: Tone,
    /// What it is about, one line.
    pub title: String,
    /// Details, such as the faults of a file, a line each.
    pub lines: Vec<String>,
}

impl Told {
    /// Something that was done.
    #[must_use]
    pub fn done(title: impl Into<String>) -> Self {
        Self { tone: Tone::Done, title: title.into(), lines: vec![] }
    }

    /// Something that was not done, and why.
    #[must_use]
    pub fn fault(title: impl Into<String>, lines: Vec<String>) -> Self {
        Self { tone: Tone::Fault, title: title.into(), lines }
    }
}

/// What a scene that is being read is for.
enum Purpose {
    /// It takes the place of the open one.
    Open { file: Option<PathBuf>, folder: PathBuf, is_saved: bool },
    /// Its things go into the open one; the thing that is brought, with what it refers to, and the name of the step.
    Bring { label: String, name: Name, thing: Box<Thing>, folder: PathBuf },
}

/// What came of reading.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Arrived {
    /// Another scene is open.
    Scene,
    /// A thing is there or another.
    Thing(Name),
    /// Nothing: the file has faults.
    Fault,
}

/// An open scene.
pub struct Session {
    factory: Factory,
    data: PathBuf,
    /// The scene as it is edited.
    pub document: Document,
    /// The thread that draws.
    pub worker: Worker,
    autosave: Autosave,
    reading: Option<(Loading, Purpose)>,
    writing: Vec<Writing>,
    wake: Arc<dyn Fn() + Send + Sync>,
    how: How,
    told: Vec<Told>,
}

impl Session {
    /// An empty scene. `data` is the editor's own folder; `wake` is called from other threads when there is news.
    #[must_use]
    pub fn new(factory: Factory, data: PathBuf, wake: impl Fn() + Send + Sync + 'static) -> Self {
        let renderer = factory();
        let registry = renderer.world.resource::<Registry>().clone();
        let wake: Arc<dyn Fn() + Send + Sync> = Arc::new(wake);
        let repaint = wake.clone();
        let worker = Worker::new(move || repaint());
        worker.open(renderer, Scene::default(), 0);
        Self {
            document: Document::new(registry.clone(), Scene::default(), None),
            autosave: Autosave::new(registry),
            factory,
            data,
            worker,
            reading: None,
            writing: vec![],
            wake,
            how: How::default(),
            told: vec![],
        }
    }

    /// The editor's own folder.
    #[must_use]
    pub fn data(&self) -> &Path {
        &self.data
    }

    /// Makes renderers that know all that the session's scene may hold.
    #[must_use]
    pub fn factory(&self) -> &Factory {
        &self.factory
    }

    /// How pictures are drawn.
    #[must_use]
    pub fn how(&self) -> How {
        self.how
    }

    /// Draws in another way from now on.
    pub fn set_how(&mut self, how: How) {
        if self.how != how {
            self.how = how;
            self.worker.set_how(how);
        }
    }

    /// The folder from which the scene's files are seen.
    #[must_use]
    pub fn folder(&self) -> PathBuf {
        folder(self.document.file())
    }

    /// The scene's name for a title: that of its file.
    #[must_use]
    pub fn title(&self) -> String {
        let name = self.document.file().and_then(Path::file_name);
        name.map_or_else(|| "Untitled".into(), |name| name.to_string_lossy().into_owned())
    }

    /// What is being read, if anything is.
    #[must_use]
    pub fn reading(&self) -> Option<&str> {
        self.reading.as_ref().map(|(loading, _)| loading.what.as_str())
    }

    /// The picture that is being written, if one is.
    #[must_use]
    pub fn writing(&self) -> Option<&Path> {
        self.writing.first().map(Writing::file)
    }

    /// Writes a picture, which was made with `settings`, to a file.
    pub fn write_picture(&mut self, file: &Path, frame: Arc<Frame>, settings: Settings) {
        let scene = self.document.file().map_or_else(|| "untitled".into(), Path::to_path_buf);
        self.writing.push(Writing::new(file.into(), frame, settings, scene, self.waker()));
    }

    /// What there is to be told since this was last called.
    pub fn take_told(&mut self) -> Vec<Told> {
        std::mem::take(&mut self.told)
    }

    /// Tells something.
    pub fn tell(&mut self, told: Told) {
        self.told.push(told);
    }

    /// Reads a scene file, which then takes the place of the open scene.
    pub fn open(&mut self, file: &Path) {
        let loading = loader::file(&self.factory, file, self.waker());
        let file = std::path::absolute(file).unwrap_or(file.into());
        let purpose = Purpose::Open { folder: folder(Some(&file)), file: Some(file), is_saved: true };
        self.reading = Some((loading, purpose));
    }

    /// Reads a scene without a file from its text.
    pub fn open_text(&mut self, what: &str, text: &str) {
        let folder = folder(None);
        let loading = loader::text(&self.factory, what.into(), text.into(), folder.join(what), self.waker());
        self.reading = Some((loading, Purpose::Open { file: None, folder, is_saved: true }));
    }

    /// What was kept of a scene that was not saved, if anything was; for no file, that of scenes without one.
    #[must_use]
    pub fn kept(&self, file: Option<&Path>) -> Option<PathBuf> {
        Some(autosave::place(file, &self.data)).filter(|place| place.is_file())
    }

    /// Reads what was kept in place of a file.
    pub fn recover(&mut self, file: Option<&Path>) {
        let place = autosave::place(file, &self.data);
        let loading = loader::file(&self.factory, &place, self.waker());
        let purpose = Purpose::Open { file: file.map(Into::into), folder: folder(Some(&place)), is_saved: false };
        self.reading = Some((loading, purpose));
    }

    /// Throws away what was kept in place of a file.
    pub fn forget_kept(&mut self, file: Option<&Path>) {
        self.autosave.discard(autosave::place(file, &self.data));
        self.autosave.flush();
    }

    /// Reads the files that a new or changed thing names and then puts it into the scene as one step.
    pub fn bring(&mut self, label: impl Into<String>, name: &Name, thing: Thing) {
        // What it refers to is not in the scene that is read.
        let alone = Thing { made_of: None, parent: None, slots: vec![], ..thing.clone() };
        let scene = Scene { settings: self.document.settings().clone(), things: vec![(name.clone(), Arc::new(alone))] };
        let folder = self.folder();
        match scene.to_text(self.document.registry()) {
            Ok(text) => {
                let what = format!("{}: files", name.as_str());
                let loading = loader::text(&self.factory, what, text, folder.join("scene"), self.waker());
                let label = label.into();
                let purpose = Purpose::Bring { label, name: name.clone(), thing: Box::new(thing), folder };
                self.reading = Some((loading, purpose));
            }
            Err(why) => self.tell(Told::fault(format!("“{}” cannot be read", name.as_str()), why.0)),
        }
    }

    fn waker(&self) -> impl FnOnce() + Send + 'static {
        let wake = self.wake.clone();
        move || wake()
    }

    /// Takes what has been read meanwhile.
    pub fn poll(&mut self) -> Option<Arrived> {
        while let Some(at) = self.writing.iter().position(Writing::is_done) {
            let told = self.writing.remove(at).wait();
            self.tell(told);
        }
        let result = self.reading.as_ref()?.0.poll()?;
        let (loading, purpose) = self.reading.take()?;
        Some(match (result, purpose) {
            (Ok(loaded), Purpose::Open { file, folder, is_saved }) => {
                self.adopt(loaded, file, &folder, is_saved);
                Arrived::Scene
            }
            (Ok(loaded), Purpose::Bring { label, name, thing, folder }) => {
                self.put(loaded, label, &name, &thing, &folder);
                Arrived::Thing(name)
            }
            (Err(mut lines), purpose) => {
                let title = match purpose {
                    // Of its own folder nothing need be said with every fault.
                    Purpose::Open { file: Some(file), folder, .. } => {
                        let folder = format!("{}{}", folder.display(), std::path::MAIN_SEPARATOR);
                        for line in &mut lines {
                            *line = line.strip_prefix(&folder).unwrap_or(line).to_owned();
                        }
                        format!("{} was not opened", file.file_name().unwrap_or_default().to_string_lossy())
                    }
                    Purpose::Open { .. } => format!("{} was not opened", loading.what),
                    Purpose::Bring { name, .. } => format!("The files of “{}” were not taken", name.as_str()),
                };
                self.tell(Told::fault(title, lines));
                Arrived::Fault
            }
        })
    }

    /// Puts another scene in the place of the open one.
    fn adopt(&mut self, loaded: Loaded, file: Option<PathBuf>, folder: &Path, is_saved: bool) {
        let Loaded { renderer, mut scene, notices } = loaded;
        if !notices.is_empty() {
            let lines = notices.iter().map(ToString::to_string).collect();
            self.tell(Told { tone: Tone::Warning, title: "Some of it was repaired or passed over".into(), lines });
        }
        loader::make_absolute(&mut scene, folder);
        let is_outside = self.document.file() != file.as_deref();
        if is_outside {
            self.discard_kept();
        }
        self.document = Document::new(self.document.registry().clone(), scene.clone(), file.clone());
        if !is_saved {
            self.document.set_unsaved(file.clone());
        }
        if let Some(file) = &file {
            files::remember(&self.data, file);
        }
        self.worker.open(renderer, scene, self.document.state());
    }

    /// Puts a thing whose files were read into the scene.
    fn put(&mut self, loaded: Loaded, label: String, name: &Name, thing: &Thing, folder: &Path) {
        let mut scene = loaded.scene;
        loader::make_absolute(&mut scene, folder);
        let mut edit = Edit::new(label);
        for (found, read) in scene.things {
            let mut read = (*read).clone();
            if found == *name {
                (read.made_of, read.parent) = (thing.made_of.clone(), thing.parent.clone());
            } else if !is_of_model(&found) {
                continue;
            }
            edit = edit.put(&found, read);
        }
        if !loaded.notices.is_empty() {
            let lines = loaded.notices.iter().map(ToString::to_string).collect();
            self.tell(Told { tone: Tone::Warning, title: "Some of it was repaired or passed over".into(), lines });
        }
        self.apply(edit);
    }

    /// Does an edit, draws it and keeps it.
    pub fn apply(&mut self, edit: Edit) {
        self.document.apply(edit);
        self.commit();
    }

    /// Takes back the last step.
    pub fn undo(&mut self) {
        self.document.undo();
        self.commit();
    }

    /// Does again what was taken back.
    pub fn redo(&mut self) {
        self.document.redo();
        self.commit();
    }

    fn commit(&mut self) {
        let changes = self.document.take_changes();
        if changes.is_empty() {
            return;
        }
        self.worker.change(changes, self.document.state());
        let place = autosave::place(self.document.file(), &self.data);
        if self.document.is_changed() {
            self.autosave.keep(place, self.document.scene());
        } else {
            self.autosave.discard(place);
        }
    }

    /// Waits until what autosave was given is on disk.
    pub fn flush(&self) {
        self.autosave.flush();
    }

    /// Waits until all that was asked to be written is on disk.
    pub fn finish(&mut self) {
        self.flush();
        for writing in std::mem::take(&mut self.writing) {
            let told = writing.wait();
            self.tell(told);
        }
    }

    fn discard_kept(&mut self) {
        self.autosave.discard(autosave::place(self.document.file(), &self.data));
    }

    /// Notes that nobody wants the changes since the scene was saved.
    pub fn forget_changes(&mut self) {
        self.document.forget_changes();
        self.discard_kept();
        self.autosave.flush();
    }

    /// The text of the scene as its file in a folder has it.
    ///
    /// # Errors
    /// All that no scene file can say.
    pub fn text(&self, folder: &Path) -> Result<String, Vec<String>> {
        let mut scene = self.document.scene();
        loader::make_relative(&mut scene, folder);
        scene.to_text(self.document.registry()).map_err(|why| why.0)
    }

    /// Saves the scene to its file; whether it has one and it was written. A file that needs no change gets none.
    pub fn save(&mut self) -> bool {
        match self.document.file().map(Path::to_path_buf) {
            Some(_) if !self.document.is_changed() => true,
            Some(file) => self.save_as(&file),
            None => false,
        }
    }

    /// Saves the scene to a file, which is its own from then on; whether that was done.
    pub fn save_as(&mut self, file: &Path) -> bool {
        let file = std::path::absolute(file).unwrap_or(file.into());
        let written = self.text(&folder(Some(&file))).and_then(|text| {
            let spare = keep_comments(&file).map_err(|why| vec![why])?;
            write_atomically(&file, text.as_bytes()).map_err(|why| vec![why.to_string()])?;
            Ok(spare)
        });
        match written {
            Ok(spare) => {
                self.discard_kept();
                self.document.set_saved(file.clone());
                self.discard_kept();
                files::remember(&self.data, &file);
                let name = |file: &Path| file.file_name().unwrap_or_default().to_string_lossy().into_owned();
                self.tell(match spare {
                    Some(spare) => Told {
                        tone: Tone::Warning,
                        title: format!("Saved {}", name(&file)),
                        lines: vec![format!(
                            "It had comments or included files, which are not kept; as it was it is {}",
                            name(&spare)
                        )],
                    },
                    None => Told::done(format!("Saved {}", name(&file))),
                });
                true
            }
            Err(lines) => {
                self.tell(Told::fault("The scene was not saved", lines));
                false
            }
        }
    }
}

/// Copies a scene file that says more than a scene by value can, such as comments, before it is replaced; where to.
fn keep_comments(file: &Path) -> Result<Option<PathBuf>, String> {
    let Ok(text) = fs::read_to_string(file) else { return Ok(None) };
    if !["//", "/*", "include:", "Like("].iter().any(|mark| text.contains(mark)) {
        return Ok(None);
    }
    let mut spare = file.as_os_str().to_os_string();
    spare.push("~");
    let spare = PathBuf::from(spare);
    write_atomically(&spare, text.as_bytes()).map_err(|why| why.to_string())?;
    Ok(Some(spare))
}

/// The folder of a scene file; without a file the one the program was started in.
fn folder(file: Option<&Path>) -> PathBuf {
    let parent = file.and_then(Path::parent).filter(|parent| !parent.as_os_str().is_empty());
    parent.map_or_else(|| std::env::current_dir().unwrap_or_default(), Into::into)
}
