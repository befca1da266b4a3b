//! Every edit is on disk a moment later, so that a crash costs at most the last one.
//!
//! A thread of its own writes the whole scene beside its file as `.<name>.autosave`, or for a scene without a file into
//! the user's data folder; the file is whole or absent. It goes when the scene is saved or closed.

use crate::files;
use snell::systems::{image::write_atomically, registry::Registry, scene::Scene};
use std::{
    fs,
    path::{Path, PathBuf},
    sync::mpsc::{self, Receiver, Sender},
    thread::{self, JoinHandle},
};

enum Message {
    Keep(PathBuf, Box<Scene>),
    Drop(PathBuf),
    /// Answered once all before it is done.
    Flush(Sender<()>),
}

/// The thread that writes.
pub struct Autosave {
    sender: Option<Sender<Message>>,
    thread: Option<JoinHandle<()>>,
}

impl Autosave {
    /// Starts the thread.
    #[must_use]
    pub fn new(registry: Registry) -> Self {
        let (sender, receiver) = mpsc::channel();
        let thread = thread::Builder::new().name("autosave".into()).spawn(move || run(&receiver, &registry)).ok();
        Self { sender: Some(sender), thread }
    }

    /// Keeps a scene as it is now; only the latest of several in a row is written.
    pub fn keep(&self, place: PathBuf, scene: Scene) {
        self.send(Message::Keep(place, Box::new(scene)));
    }

    /// Takes away what was kept.
    pub fn discard(&self, place: PathBuf) {
        self.send(Message::Drop(place));
    }

    /// Waits until all is done.
    pub fn flush(&self) {
        let (sender, receiver) = mpsc::channel();
        self.send(Message::Flush(sender));
        let _ = receiver.recv();
    }

    fn send(&self, message: Message) {
        if let Some(sender) = &self.sender {
            // Nobody listens only if the thread could not be started.
            let _ = sender.send(message);
        }
    }
}

impl Drop for Autosave {
    fn drop(&mut self) {
        self.sender = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

fn run(receiver: &Receiver<Message>, registry: &Registry) {
    while let Ok(first) = receiver.recv() {
        let mut messages = vec![first];
        messages.extend(receiver.try_iter());
        let last = messages.iter().rposition(|message| matches!(message, Message::Keep(..)));
        for (number, message) in messages.into_iter().enumerate() {
            match message {
                Message::Keep(place, scene) if Some(number) == last => {
                    // What no file can say would be lost with everything else otherwise.
                    let (text, _) = scene.to_text_in_part(registry);
                    if let Some(folder) = place.parent()
                        && fs::create_dir_all(folder).is_ok()
                    {
                        // A folder that cannot be written leaves the scene without a net, as editors without one are.
                        let _ = write_atomically(&place, text.as_bytes());
                    }
                }
                Message::Keep(..) => {}
                Message::Drop(place) => drop(fs::remove_file(place)),
                Message::Flush(done) => drop(done.send(())),
            }
        }
    }
}

/// Where the scene of a file is kept until it is saved; for a scene without a file, in the user's data folder.
#[must_use]
pub fn place(file: Option<&Path>, data: &Path) -> PathBuf {
    match file.and_then(|file| Some((file.parent()?, file.file_name()?.to_str()?))) {
        Some((folder, name)) => folder.join(format!(".{name}.autosave")),
        None => data.join(files::UNTITLED),
    }
}
