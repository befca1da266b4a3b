//! What was found in one file: its faults, and what was repaired or passed over, with counts.

use crate::load::fault::{Fault, Notice, Position};
use std::path::{Path, PathBuf};

/// Faults shown of one file; the rest are counted.
const MOST_FAULTS: usize = 20;

/// Different notices kept of one file; the rest are counted together.
const MOST_NOTICES: usize = 50;

/// Collects the faults and notices of one file.
pub(super) struct Log {
    file: PathBuf,
    faults: Vec<(Position, String)>,
    fault_count: usize,
    notices: Vec<Tally>,
    further_notices: usize,
}

/// One kind of notice: how often, and where first.
struct Tally {
    text: String,
    count: usize,
    first: Option<Position>,
}

impl Log {
    pub(super) fn new(file: &Path) -> Self {
        Self { file: file.into(), faults: vec![], fault_count: 0, notices: vec![], further_notices: 0 }
    }

    pub(super) fn file(&self) -> &Path {
        &self.file
    }

    pub(super) fn fault(&mut self, at: Position, message: impl Into<String>) {
        self.fault_count += 1;
        self.faults.push((at, message.into()));
        // Faults found late may stand early in the text: sort before cutting, but not at every fault.
        if self.faults.len() == 4 * MOST_FAULTS {
            self.keep_first();
        }
    }

    pub(super) fn has_faults(&self) -> bool {
        self.fault_count > 0
    }

    /// Counts one more of what `text` says.
    pub(super) fn notice(&mut self, at: Option<Position>, text: &str) {
        if let Some(tally) = self.notices.iter_mut().find(|tally| tally.text == text) {
            tally.count += 1;
        } else if self.has_room() {
            self.notices.push(Tally { text: text.to_owned(), count: 1, first: at });
        } else {
            self.further_notices += 1;
        }
    }

    /// Whether another kind of notice would be kept with its text.
    pub(super) fn has_room(&self) -> bool {
        self.notices.len() < MOST_NOTICES
    }

    fn keep_first(&mut self) {
        self.faults.sort_by_key(|(at, _)| *at);
        self.faults.truncate(MOST_FAULTS);
    }

    /// The faults in the order of the text, with a last line for those beyond what is shown; the notices likewise.
    pub(super) fn into_parts(mut self) -> (Vec<Fault>, Vec<Notice>) {
        self.keep_first();
        let more = self.fault_count - self.faults.len();
        let at = |at: Position, message| Fault::at(&self.file, at.line, at.column, message);
        let mut faults: Vec<_> = self.faults.into_iter().map(|(position, message)| at(position, message)).collect();
        if more > 0 {
            faults.push(Fault::of_file(&self.file, format!("and {more} more faults")));
        }
        self.notices.sort_by_key(|tally| tally.first);
        let notice = |tally: Tally| {
            let times = if tally.count > 1 { format!(" ({} times, first here)", tally.count) } else { String::new() };
            Notice(Fault { file: self.file.clone(), position: tally.first, message: tally.text + &times })
        };
        let mut notices: Vec<_> = self.notices.into_iter().map(notice).collect();
        if self.further_notices > 0 {
            let message = format!("and {} more notices of other kinds", self.further_notices);
            notices.push(Notice(Fault::of_file(&self.file, message)));
        }
        (faults, notices)
    }
}
