//! A sign of life for the user who waits.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::{
    io::{IsTerminal, stderr},
    sync::mpsc::{RecvTimeoutError, Sender, channel},
    thread::{self, JoinHandle},
    time::Duration,
};

/// A bar on a terminal that shows itself once the work takes over a second, and goes away with this value.
pub(super) struct Progress {
    bar: ProgressBar,
    /// Shows the bar unless the sender goes away first.
    shower: Option<(Sender<()>, JoinHandle<()>)>,
}

const PATIENCE: Duration = Duration::from_secs(1);
const TICK: Duration = Duration::from_millis(100);

impl Progress {
    /// Progress that starts now; hidden for good if `quiet`, or if nobody watches.
    pub(super) fn new(quiet: bool) -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        let shower = (!quiet && stderr().is_terminal()).then(|| {
            let (sender, receiver) = channel();
            let bar = bar.clone();
            let show = move || {
                if receiver.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                    bar.set_draw_target(ProgressDrawTarget::stderr());
                    bar.enable_steady_tick(TICK);
                }
            };
            (sender, thread::spawn(show))
        });
        Self { bar, shower }
    }

    /// Begins a stage whose end cannot be foreseen.
    pub(super) fn begin(&self, stage: &'static str) {
        self.restyle(stage, "{spinner} {msg} {elapsed}");
    }

    /// Begins a stage of so many pixels.
    pub(super) fn begin_pixels(&self, stage: &'static str, total: u64) {
        self.bar.set_length(total);
        self.restyle(stage, "{msg} {wide_bar} {percent} %, {eta} left");
    }

    /// Pixels that are done.
    pub(super) fn set(&self, done: u64) {
        self.bar.set_position(done);
    }

    /// Does something that writes to the terminal.
    pub(super) fn aside<R>(&self, write: impl FnOnce() -> R) -> R {
        self.bar.suspend(write)
    }

    fn restyle(&self, stage: &'static str, template: &str) {
        self.bar.reset();
        self.bar.set_message(stage);
        self.bar.set_style(ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((sender, shower)) = self.shower.take() {
            drop(sender);
            // It does nothing that could fail, and the bar is cleared all the same.
            let _ = shower.join();
        }
        self.bar.finish_and_clear();
    }
}
