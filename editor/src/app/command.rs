//! All that can be asked of the editor, from menus, buttons and keys alike.

use super::{camera::Motion, dialog::Dialog, gizmo::Tool};
use crate::document::Edit;
use egui::{Context, Key, KeyboardShortcut, Modifiers};
use snell::components::name::Name;
use std::path::PathBuf;

/// A wish, done at the end of the frame in which it was made.
pub(super) enum Command {
    /// Shows scenes to begin with.
    New,
    /// Begins with a ready scene.
    Start(&'static str),
    /// Asks for a scene to open.
    AskOpen,
    Open(PathBuf),
    /// Opens what was kept of an unsaved scene.
    Recover(Option<PathBuf>),
    /// Opens a file though something was kept in its place.
    OpenSaved(Option<PathBuf>),
    Save,
    AskSaveAs,
    SaveAs(PathBuf),
    AskSavePicture,
    SavePicture(PathBuf),
    /// Ends, after asking what is to become of changes.
    Quit,
    /// Goes on with what was asked before, the changes saved or not wanted.
    Proceed {
        save: bool,
    },
    Undo,
    Redo,
    Apply(Edit),
    /// As [`Command::Apply`], as part of the gesture that is going on.
    Gesture(Edit),
    /// Takes back the gesture that is going on.
    Abandon,
    Select(Option<Name>),
    /// Selects the thing that is so many after the selected one in the list.
    Page(isize),
    /// Adds a thing with a component of a tag.
    Add(&'static str),
    AddMaterial(usize),
    AddCamera,
    AddGroup,
    /// Asks for a model to add.
    AskModel,
    /// Takes a file that was dropped or chosen: a scene, a model, an image.
    Take(PathBuf),
    Duplicate,
    ToggleHidden(Name),
    /// Hides or shows the selected thing.
    Hide,
    Delete,
    AskRename,
    Rename(Name, String),
    /// Asks for a file of a field of the selected thing's component.
    AskFile {
        tag: &'static str,
        field: &'static str,
    },
    /// Takes a file for it.
    SetFile {
        tag: &'static str,
        field: &'static str,
        file: PathBuf,
    },
    Render,
    Stop,
    ToggleRender,
    Frame,
    Move(Motion),
    Tool(Tool),
    CopyCode,
    Show(Dialog),
    Close,
}

/// A command with a key.
pub(super) struct Shortcut {
    /// What it is called.
    pub(super) label: &'static str,
    key: Key,
    modifiers: Modifiers,
    make: fn() -> Command,
}

impl Shortcut {
    /// How the key is written.
    pub(super) fn text(&self, ctx: &Context) -> String {
        ctx.format_shortcut(&KeyboardShortcut::new(self.modifiers, self.key))
    }

    /// The command.
    pub(super) fn command(&self) -> Command {
        (self.make)()
    }
}

const fn shortcut(label: &'static str, modifiers: Modifiers, key: Key, make: fn() -> Command) -> Shortcut {
    Shortcut { label, key, modifiers, make }
}

const CTRL: Modifiers = Modifiers::COMMAND;
const CTRL_SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

/// Commands with keys, those with more modifiers first.
pub(super) const SHORTCUTS: &[Shortcut] = &[
    shortcut("New…", CTRL, Key::N, || Command::New),
    shortcut("Open…", CTRL, Key::O, || Command::AskOpen),
    shortcut("Save as…", CTRL_SHIFT, Key::S, || Command::AskSaveAs),
    shortcut("Save", CTRL, Key::S, || Command::Save),
    shortcut("Save picture…", CTRL, Key::P, || Command::AskSavePicture),
    shortcut("Quit", CTRL, Key::Q, || Command::Quit),
    shortcut("Redo", CTRL_SHIFT, Key::Z, || Command::Redo),
    shortcut("Redo", CTRL, Key::Y, || Command::Redo),
    shortcut("Undo", CTRL, Key::Z, || Command::Undo),
    shortcut("Duplicate", CTRL, Key::D, || Command::Duplicate),
    shortcut("Hide", Modifiers::NONE, Key::H, || Command::Hide),
    shortcut("Delete", Modifiers::NONE, Key::Delete, || Command::Delete),
    shortcut("Rename…", Modifiers::NONE, Key::F2, || Command::AskRename),
    shortcut("Previous thing", Modifiers::NONE, Key::PageUp, || Command::Page(-1)),
    shortcut("Next thing", Modifiers::NONE, Key::PageDown, || Command::Page(1)),
    shortcut("Show selected", Modifiers::NONE, Key::F, || Command::Frame),
    shortcut("Render", Modifiers::NONE, Key::F5, || Command::ToggleRender),
    shortcut("Move", Modifiers::NONE, Key::G, || Command::Tool(Tool::Move)),
    shortcut("Turn", Modifiers::NONE, Key::R, || Command::Tool(Tool::Turn)),
    shortcut("Scale", Modifiers::NONE, Key::T, || Command::Tool(Tool::Scale)),
];

/// The shortcut of a label.
pub(super) fn find(label: &str) -> Option<&'static Shortcut> {
    SHORTCUTS.iter().find(|shortcut| shortcut.label == label)
}

/// Commands whose keys were pressed. Keys without modifiers are left to text that is being typed.
pub(super) fn pressed(ctx: &Context) -> Vec<Command> {
    let is_typing = ctx.text_edit_focused();
    let mut commands = vec![];
    for shortcut in SHORTCUTS {
        if is_typing && (shortcut.modifiers == Modifiers::NONE || matches!(shortcut.key, Key::Z | Key::Y)) {
            continue;
        }
        let keys = KeyboardShortcut::new(shortcut.modifiers, shortcut.key);
        if ctx.input_mut(|input| input.consume_shortcut(&keys)) {
            commands.push(shortcut.command());
        }
    }
    commands
}
