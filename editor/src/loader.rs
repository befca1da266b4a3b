//! Files are read, and the trees over models built, in the background, so that the window goes on.

use snell::{
    Faults, Notice, Renderer,
    components::{
        asset::Asset,
        describe::{FieldVisitor, Spec, Value},
    },
    systems::{
        registry::{AnyComponent, Registry},
        scene::Scene,
    },
};
use std::{
    panic::{AssertUnwindSafe, catch_unwind},
    path::{Path, PathBuf},
    sync::{
        Arc,
        mpsc::{self, Receiver, TryRecvError},
    },
    thread,
};

/// Makes a renderer that knows all kinds of shapes, lights and textures.
pub type Factory = Arc<dyn Fn() -> Renderer + Send + Sync>;

/// A scene that was read.
pub struct Loaded {
    /// The world that holds it, its trees built.
    pub renderer: Renderer,
    /// The same by value.
    pub scene: Scene,
    /// What was repaired or passed over.
    pub notices: Vec<Notice>,
}

/// Something that is being read.
pub struct Loading {
    /// What is read, to be told meanwhile.
    pub what: String,
    receiver: Receiver<Result<Loaded, Vec<String>>>,
}

impl Loading {
    /// The scene, once it is there, or all that is wrong with it.
    #[must_use]
    pub fn poll(&self) -> Option<Result<Loaded, Vec<String>>> {
        match self.receiver.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(vec![format!("{}: reading failed", self.what)])),
        }
    }
}

/// Reads a scene file.
#[must_use]
pub fn file(factory: &Factory, path: &Path, done: impl FnOnce() + Send + 'static) -> Loading {
    let path = path.to_path_buf();
    start(factory, path.display().to_string(), move |renderer| renderer.load(&path), done)
}

/// Reads a scene from memory, with paths as seen from the folder of `path`.
#[must_use]
pub fn text(
    factory: &Factory,
    what: String,
    text: String,
    path: PathBuf,
    done: impl FnOnce() + Send + 'static,
) -> Loading {
    start(factory, what, move |renderer| renderer.load_text(&text, path), done)
}

fn start(
    factory: &Factory,
    what: String,
    load: impl FnOnce(&mut Renderer) -> Result<Vec<Notice>, Faults> + Send + 'static,
    done: impl FnOnce() + Send + 'static,
) -> Loading {
    let (sender, receiver) = mpsc::channel();
    let factory = factory.clone();
    let work = move || {
        let loaded = catch_unwind(AssertUnwindSafe(|| loaded(factory(), load)));
        // Nobody waits if the window is closed meanwhile.
        let _ = sender.send(loaded.unwrap_or_else(|_| Err(vec!["reading failed unexpectedly".into()])));
        done();
    };
    // If the thread cannot be started the sender is gone, and that is told.
    let _ = thread::Builder::new().name("load".into()).spawn(work);
    Loading { what, receiver }
}

fn loaded(
    mut renderer: Renderer,
    load: impl FnOnce(&mut Renderer) -> Result<Vec<Notice>, Faults>,
) -> Result<Loaded, Vec<String>> {
    let told = |faults: Faults| faults.0.iter().map(ToString::to_string).collect::<Vec<_>>();
    let notices = load(&mut renderer).map_err(told)?;
    // Builds the trees; what keeps the scene from being drawn is told where it is drawn.
    let _ = renderer.snapshot();
    let scene = Scene::of(&renderer.world);
    Ok(Loaded { renderer, scene, notices })
}

/// Makes the paths of all files that a scene names absolute; they are as seen from a folder.
pub fn make_absolute(scene: &mut Scene, folder: &Path) {
    let folder = std::path::absolute(folder).unwrap_or(folder.into());
    let moved = |path: &Path| folder.join(path);
    move_paths(scene, &moved);
}

/// Makes the paths of all files that a scene names as seen from a folder, where that can be.
pub fn make_relative(scene: &mut Scene, folder: &Path) {
    let moved = |path: &Path| crate::files::relative(path, folder);
    move_paths(scene, &moved);
}

fn move_paths(scene: &mut Scene, moved: &dyn Fn(&Path) -> PathBuf) {
    for (_, thing) in &mut scene.things {
        let names_files = thing.components.values().any(|component| names_file(component.as_ref()));
        if names_files {
            let mut mover = Mover(moved);
            Arc::make_mut(thing).components.values_mut().for_each(|component| component.visit(&mut mover));
        }
    }
}

/// Whether a component names a file.
#[must_use]
pub fn names_file(component: &dyn AnyComponent) -> bool {
    struct Finder(bool);
    impl FieldVisitor for Finder {
        fn field(&mut self, _: &'static str, value: Value<'_>, _: Spec) {
            self.0 |= matches!(value, Value::Model(_) | Value::Image(_));
        }
    }
    let mut finder = Finder(false);
    component.copy().visit(&mut finder);
    finder.0
}

struct Mover<'a>(&'a dyn Fn(&Path) -> PathBuf);

impl Mover<'_> {
    fn rebase<T>(&self, asset: &mut Asset<T>) {
        if !asset.path.is_empty() {
            asset.path = (self.0)(Path::new(&asset.path)).to_string_lossy().into_owned();
        }
    }
}

impl FieldVisitor for Mover<'_> {
    fn field(&mut self, _: &'static str, value: Value<'_>, _: Spec) {
        match value {
            Value::Model(asset) => self.rebase(asset),
            Value::Image(asset) => self.rebase(asset),
            _ => {}
        }
    }
}

/// The names that the registry knows of one kind, in order.
#[must_use]
pub fn tags(registry: &Registry, kind: snell::systems::registry::Kind) -> Vec<&'static str> {
    registry.entries().filter(|(_, entry)| entry.kind == kind).map(|(tag, _)| tag).collect()
}
