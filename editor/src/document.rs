//! The scene being edited: its things, its file, and every edit as a step that can be undone.
//!
//! An edit replaces whole things; a step keeps each thing as it was and as it became. Things are shared, so a step costs no
//! more than what it changed, and undoing gives back the very values.

use snell::{
    components::{name::Name, settings::Settings},
    systems::{
        registry::Registry,
        save::Unsayable,
        scene::{Scene, Thing, is_of_model},
    },
};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
    sync::Arc,
};

/// Steps kept for undoing.
const MOST_STEPS: usize = 10_000;

/// What an edit makes of the scene.
#[derive(Clone, Default)]
pub struct Edit {
    /// What it does, for the undo menu: "Move ball".
    pub label: String,
    /// Things that are new, other or gone.
    pub things: BTreeMap<Name, Option<Arc<Thing>>>,
    /// Things that get another name, old and new; done before `things`, which speak of new names.
    pub renames: Vec<(Name, Name)>,
    /// Other settings.
    pub settings: Option<Settings>,
    /// Edits of one gesture, as a drag, are one step; nothing for an edit by itself.
    pub gesture: Option<u64>,
}

impl Edit {
    /// An edit of one thing.
    #[must_use]
    pub fn of(label: impl Into<String>, name: &Name, thing: Thing) -> Self {
        Self::new(label).put(name, thing)
    }

    /// An edit that does nothing yet.
    #[must_use]
    pub fn new(label: impl Into<String>) -> Self {
        Self { label: label.into(), ..Self::default() }
    }

    /// The edit with a thing that is new or other.
    #[must_use]
    pub fn put(mut self, name: &Name, thing: Thing) -> Self {
        self.things.insert(name.clone(), Some(Arc::new(thing)));
        self
    }

    /// The edit with a thing that is gone.
    #[must_use]
    pub fn take(mut self, name: &Name) -> Self {
        self.things.insert(name.clone(), None);
        self
    }

    /// The edit as part of a gesture.
    #[must_use]
    pub fn during(mut self, gesture: Option<u64>) -> Self {
        self.gesture = gesture;
        self
    }
}

/// Something in two states.
#[derive(Clone)]
struct Change<T> {
    before: T,
    after: T,
}

/// An edit that was done.
#[derive(Clone)]
struct Step {
    label: String,
    things: BTreeMap<Name, Change<Option<Arc<Thing>>>>,
    order: Option<Change<Arc<[Name]>>>,
    settings: Option<Change<Settings>>,
    gesture: Option<u64>,
    /// Names the step by the state of the document that follows it.
    state: u64,
}

/// What changed since it was last asked.
#[derive(Clone, Default)]
pub struct Changes {
    /// Things that are new, other or gone.
    pub things: BTreeMap<Name, Option<Arc<Thing>>>,
    /// Other settings.
    pub settings: Option<Settings>,
}

impl Changes {
    /// Whether nothing changed.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.things.is_empty() && self.settings.is_none()
    }

    /// Later changes on top of these.
    pub fn extend(&mut self, later: Self) {
        self.things.extend(later.things);
        self.settings = later.settings.or(self.settings.take());
    }
}

/// A scene that is edited.
pub struct Document {
    registry: Registry,
    settings: Settings,
    things: BTreeMap<Name, Arc<Thing>>,
    order: Arc<[Name]>,
    undo: Vec<Step>,
    redo: Vec<Step>,
    /// Counts up with every step, so that no two states share a number.
    last_state: u64,
    /// The state without any step.
    first_state: u64,
    saved_state: u64,
    file: Option<PathBuf>,
    pending: Changes,
}

impl Document {
    /// A document with a scene, as its file says it.
    #[must_use]
    pub fn new(registry: Registry, scene: Scene, file: Option<PathBuf>) -> Self {
        Self {
            registry,
            settings: scene.settings,
            order: scene.things.iter().map(|(name, _)| name.clone()).collect(),
            things: scene.things.into_iter().collect(),
            undo: vec![],
            redo: vec![],
            last_state: 0,
            first_state: 0,
            saved_state: 0,
            file,
            pending: Changes::default(),
        }
    }

    /// What can stand on a thing.
    #[must_use]
    pub fn registry(&self) -> &Registry {
        &self.registry
    }

    /// How the picture is taken.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// All things in the order of the file.
    pub fn things(&self) -> impl Iterator<Item = (&Name, &Arc<Thing>)> {
        self.order.iter().filter_map(|name| self.things.get_key_value(name))
    }

    /// The thing of a name.
    #[must_use]
    pub fn get(&self, name: &Name) -> Option<&Arc<Thing>> {
        self.things.get(name)
    }

    /// The scene by value; things are shared, so this is cheap.
    #[must_use]
    pub fn scene(&self) -> Scene {
        let things = self.things().map(|(name, thing)| (name.clone(), thing.clone())).collect();
        Scene { settings: self.settings.clone(), things }
    }

    /// The text of the scene's file.
    ///
    /// # Errors
    /// All that no scene file can say.
    pub fn text(&self) -> Result<String, Unsayable> {
        self.scene().to_text(&self.registry)
    }

    /// The scene's file, if it has one.
    #[must_use]
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    /// Notes that the scene, as it is now, is in a file.
    pub fn set_saved(&mut self, file: PathBuf) {
        self.file = Some(file);
        self.saved_state = self.state();
        self.end_gesture();
    }

    /// Notes that the scene, though just opened, is not what is in its file.
    pub fn set_unsaved(&mut self, file: Option<PathBuf>) {
        self.file = file;
        self.saved_state = u64::MAX;
    }

    /// Notes that nobody wants the scene saved as it is.
    pub fn forget_changes(&mut self) {
        self.saved_state = self.state();
    }

    /// Whether there is anything to save.
    #[must_use]
    pub fn is_changed(&self) -> bool {
        self.saved_state != self.state()
    }

    /// A number for the scene as it is: equal numbers mean equal scenes.
    #[must_use]
    pub fn state(&self) -> u64 {
        self.undo.last().map_or(self.first_state, |step| step.state)
    }

    /// A name that no thing has, from one that is wished for.
    #[must_use]
    pub fn free_name(&self, wish: &str) -> Name {
        let (stem, number) = match wish.trim_end_matches(|c: char| c.is_ascii_digit()) {
            stem if stem.len() < wish.len() && stem.ends_with(' ') => (stem.trim_end(), 2),
            _ => (wish, 2),
        };
        let plain = Name::new(stem);
        let numbered = (number..).map(|number| Name::new(format!("{stem} {number}")));
        [plain]
            .into_iter()
            .chain(numbered)
            .find(|name| !self.things.contains_key(name))
            .unwrap_or_else(|| Name::new(wish))
    }

    /// Why a thing cannot have a name; nothing if it can.
    #[must_use]
    pub fn name_fault(&self, name: &str) -> Option<String> {
        if name.is_empty() {
            Some("a name needs at least one character".into())
        } else if is_of_model(&Name::new(name)) {
            Some("`#` is kept for the names of models' materials".into())
        } else if self.things.contains_key(&Name::new(name)) {
            Some(format!("“{name}” is taken"))
        } else {
            None
        }
    }

    /// Does an edit. Nothing happens, and no step is made, if it changes nothing.
    pub fn apply(&mut self, edit: Edit) {
        let mut step = Step {
            label: edit.label,
            things: BTreeMap::new(),
            order: None,
            settings: None,
            gesture: edit.gesture,
            state: self.last_state + 1,
        };
        let mut order = self.order.to_vec();
        let mut wanted: BTreeMap<Name, Option<Arc<Thing>>> = BTreeMap::new();
        for (old, new) in &edit.renames {
            let Some(thing) = self.things.get(old).cloned() else { continue };
            order.iter_mut().filter(|name| *name == old).for_each(|name| *name = new.clone());
            wanted.insert(old.clone(), None);
            wanted.insert(new.clone(), Some(thing));
            for (name, thing) in self.things.iter().filter(|(name, _)| *name != old) {
                let refers = |to: &Option<Name>| to.as_ref() == Some(old);
                if refers(&thing.made_of) || refers(&thing.parent) {
                    let mut thing = wanted.get(name).cloned().flatten().unwrap_or_else(|| thing.clone());
                    let changed = Arc::make_mut(&mut thing);
                    for link in [&mut changed.made_of, &mut changed.parent] {
                        if link.as_ref() == Some(old) {
                            *link = Some(new.clone());
                        }
                    }
                    wanted.insert(name.clone(), Some(thing));
                }
            }
        }
        wanted.extend(edit.things);
        for (name, after) in wanted {
            let before = self.things.get(&name).cloned();
            let same = match (&before, &after) {
                (Some(a), Some(b)) => a == b,
                (a, b) => a.is_none() && b.is_none(),
            };
            if !same {
                step.things.insert(name, Change { before, after });
            }
        }
        // Scenes of very many things are searched only where some come or go.
        if step.things.values().any(|change| change.before.is_none() || change.after.is_none()) {
            order.retain(|name| step.things.get(name).is_none_or(|change| change.after.is_some()));
            let known: BTreeSet<&Name> = order.iter().collect();
            let new = step.things.iter().filter(|(name, change)| change.after.is_some() && !known.contains(name));
            let new: Vec<Name> = new.map(|(name, _)| name.clone()).collect();
            order.extend(new);
        }
        if order[..] != self.order[..] {
            step.order = Some(Change { before: self.order.clone(), after: order.into() });
        }
        if let Some(after) = edit.settings.filter(|after| *after != self.settings) {
            step.settings = Some(Change { before: self.settings.clone(), after });
        }
        if step.things.is_empty() && step.settings.is_none() && step.order.is_none() {
            return;
        }
        self.last_state += 1;
        self.redo.clear();
        self.set(&step, true);
        match self.undo.last_mut() {
            Some(top) if top.gesture.is_some() && top.gesture == step.gesture => top.merge(step),
            _ => self.undo.push(step),
        }
        if self.undo.len() > MOST_STEPS {
            self.first_state = self.undo.remove(0).state;
        }
    }

    /// Ends the gesture: the next edit is a step of its own.
    pub fn end_gesture(&mut self) {
        if let Some(top) = self.undo.last_mut() {
            top.gesture = None;
        }
    }

    /// What undoing would take back.
    #[must_use]
    pub fn undo_label(&self) -> Option<&str> {
        self.undo.last().map(|step| step.label.as_str())
    }

    /// What redoing would do again.
    #[must_use]
    pub fn redo_label(&self) -> Option<&str> {
        self.redo.last().map(|step| step.label.as_str())
    }

    /// Takes back the last step.
    pub fn undo(&mut self) {
        if let Some(mut step) = self.undo.pop() {
            step.gesture = None;
            self.set(&step, false);
            self.redo.push(step);
        }
    }

    /// Does again what was taken back.
    pub fn redo(&mut self) {
        if let Some(step) = self.redo.pop() {
            self.set(&step, true);
            self.undo.push(step);
        }
    }

    /// What changed since this was last called.
    pub fn take_changes(&mut self) -> Changes {
        std::mem::take(&mut self.pending)
    }

    /// The scene as it is before (`false`) or after (`true`) a step.
    fn set(&mut self, step: &Step, after: bool) {
        for (name, change) in &step.things {
            let thing = if after { &change.after } else { &change.before };
            match thing {
                Some(thing) => self.things.insert(name.clone(), thing.clone()),
                None => self.things.remove(name),
            };
            self.pending.things.insert(name.clone(), thing.clone());
        }
        if let Some(order) = &step.order {
            self.order = if after { order.after.clone() } else { order.before.clone() };
        }
        if let Some(settings) = &step.settings {
            self.settings = if after { settings.after.clone() } else { settings.before.clone() };
            self.pending.settings = Some(self.settings.clone());
        }
    }
}

impl Step {
    /// This step and a later one as one.
    fn merge(&mut self, later: Self) {
        for (name, change) in later.things {
            match self.things.get_mut(&name) {
                Some(known) => known.after = change.after,
                None => drop(self.things.insert(name, change)),
            }
        }
        merge(&mut self.order, later.order);
        merge(&mut self.settings, later.settings);
        self.state = later.state;
    }
}

fn merge<T>(mine: &mut Option<Change<T>>, later: Option<Change<T>>) {
    match (mine, later) {
        (Some(mine), Some(later)) => mine.after = later.after,
        (mine @ None, later) => *mine = later,
        (Some(_), None) => {}
    }
}
