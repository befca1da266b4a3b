//! Pictures are written in the background: to pack a large one takes seconds.

use crate::session::Told;
use snell::{
    Frame,
    components::settings::Settings,
    systems::image::{self, Format, Metadata},
};
use std::{
    path::{Path, PathBuf},
    sync::Arc,
    thread::{self, JoinHandle},
};

/// A picture that is being written.
pub struct Writing {
    file: PathBuf,
    thread: Option<JoinHandle<Told>>,
}

impl Writing {
    /// Begins to write a picture, complete or as far as it was drawn, made with `settings` from a scene's file.
    #[must_use]
    pub fn new(
        file: PathBuf,
        frame: Arc<Frame>,
        settings: Settings,
        scene: PathBuf,
        done: impl FnOnce() + Send + 'static,
    ) -> Self {
        let to = file.clone();
        let work = move || {
            let metadata = Metadata::of(&frame, &settings, &scene);
            let written = Format::of(&to).and_then(|format| image::write(&to, format, &frame.picture, &metadata));
            done();
            match written {
                Ok(()) if frame.is_complete() => Told::done(format!("Saved {}", to.display())),
                Ok(()) => Told::done(format!("Saved the part that was drawn: {}", to.display())),
                Err(why) => Told::fault(why.to_string(), vec![]),
            }
        };
        Self { file, thread: thread::Builder::new().name("picture".into()).spawn(work).ok() }
    }

    /// The file that is written.
    #[must_use]
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// Whether it came to an end.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// How it went; waits until then.
    #[must_use]
    pub fn wait(self) -> Told {
        let told = self.thread.and_then(|thread| thread.join().ok());
        told.unwrap_or_else(|| Told::fault(format!("{} was not saved", self.file.display()), vec![]))
    }
}
