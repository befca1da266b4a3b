//! The scene files that were read, and the faults found in them.

use super::document::Document;
use crate::load::fault::{Fault, Faults, nearest};
use std::{
    cell::Cell,
    collections::BTreeSet,
    ops::RangeInclusive,
    path::{Path, PathBuf},
};

/// One scene file.
#[derive(Debug)]
pub(super) struct Source {
    /// The path to show and to read.
    pub(super) path: PathBuf,
    /// The file's folder as seen from the scene's; empty if they are the same.
    pub(super) folder: String,
    /// The text without byte order mark; up to the first bad byte if it is not UTF-8.
    pub(super) text: String,
    /// What the text says.
    pub(super) document: Document,
    /// Offsets at which lines start.
    lines: Vec<usize>,
}

impl Source {
    /// A file whose document is still to be read.
    pub(super) fn new(path: PathBuf, folder: String, text: String) -> Self {
        let starts = text.match_indices('\n').map(|(at, _)| at + 1);
        let lines = std::iter::once(0).chain(starts).collect();
        Self { path, folder, text, document: Document::default(), lines }
    }

    /// The line, from 1, of a byte.
    pub(super) fn line(&self, offset: usize) -> usize {
        self.lines.partition_point(|start| *start <= offset)
    }
}

/// A byte of a scene file, by the file's number in the order of reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Place {
    pub(super) file: usize,
    pub(super) offset: usize,
}

/// Faults in scene files, in the order of the text, each once however often its file is included.
#[derive(Debug, Default)]
pub(super) struct Report(BTreeSet<(Place, String)>);

impl Report {
    /// Notes a fault.
    pub(super) fn add(&mut self, place: Place, message: impl Into<String>) {
        self.0.insert((place, message.into()));
    }

    /// Whether nothing is wrong.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The faults with lines and columns.
    pub(super) fn into_faults(self, sources: &[Source]) -> Faults {
        // Columns are counted on from the last fault, so that a file in one long line takes no longer than others.
        let last = Cell::new((Place { file: usize::MAX, offset: 0 }, 0, 1));
        let faults = self.0.into_iter().filter_map(|(place, message)| {
            let source = sources.get(place.file)?;
            let line = source.line(place.offset);
            let (before, before_line, before_column) = last.get();
            let (from, column) = if (before.file, before_line) == (place.file, line) {
                (before.offset, before_column)
            } else {
                (source.lines.get(line - 1).copied().unwrap_or_default(), 1)
            };
            let column = column + source.text.get(from..place.offset).map_or(0, |text| text.chars().count());
            last.set((place, line, column));
            Some(Fault::at(&source.path, line, column, message))
        });
        Faults(faults.collect())
    }
}

/// Lengths of names for which near ones are looked for: every letter is near every other.
const LENGTHS: RangeInclusive<usize> = 2..=100;

/// The nearest of the known names as a question to end a message with; empty if none is near.
pub(super) fn did_you_mean<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    if !LENGTHS.contains(&name.len()) {
        return String::new();
    }
    let known = known.into_iter().filter(|candidate| LENGTHS.contains(&candidate.len()));
    nearest(name, known).map_or(String::new(), |near| format!("; did you mean `{near}`?"))
}

/// Names in a row: `a`, `b` and `c`.
pub(super) fn listed<'a>(names: impl IntoIterator<Item = &'a str>, last: &str) -> String {
    let names: Vec<_> = names.into_iter().map(|name| format!("`{name}`")).collect();
    match names.split_last() {
        Some((end, start)) if !start.is_empty() => format!("{} {last} {end}", start.join(", ")),
        _ => names.concat(),
    }
}

/// A piece of text short enough for a message.
pub(super) fn excerpt(text: &str) -> String {
    const WIDTH: usize = 40;
    // No more is looked at than could be shown, however long the value is.
    let mut words = String::new();
    for word in text.split_whitespace() {
        if !words.is_empty() {
            words.push(' ');
        }
        words.extend(word.chars().take(WIDTH + 1));
        if words.chars().nth(WIDTH).is_some() {
            let shortened: String = words.chars().take(WIDTH - 1).collect();
            return format!("`{}…`", shortened.trim_end());
        }
    }
    format!("`{words}`")
}

/// A path that a file in `folder` writes, as seen from the scene's folder.
pub(super) fn beside(folder: &str, written: &str) -> String {
    if folder.is_empty() || Path::new(written).is_absolute() { written.into() } else { format!("{folder}/{written}") }
}
