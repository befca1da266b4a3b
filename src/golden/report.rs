//! What failures leave: pictures, and one page that shows them all.

use super::html;
use crate::{
    Picture,
    systems::{
        compare,
        image::{self, Format, Metadata},
    },
};
use serde::{Deserialize, Serialize};
use std::{
    fs, io,
    path::{Path, PathBuf},
    sync::Mutex,
};

/// One failure.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Entry {
    pub name: String,
    /// What is different.
    pub what: String,
    /// How like it should have been.
    pub level: String,
    /// Mean FLIP error.
    pub flip: f64,
    /// Pixels that differ.
    pub bits: usize,
    /// The command to bless.
    pub bless: String,
    /// The golden file.
    pub expected: PathBuf,
    /// The first pixel whose levels differ.
    pub first: Option<First>,
    /// The command that explains it.
    pub explain: Option<String>,
    /// How that pixel comes about now.
    pub why: Option<String>,
}

/// A pixel of the pictures, and its levels as expected and drawn.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct First {
    pub x: u32,
    pub y: u32,
    pub levels: [[u8; 3]; 2],
}

/// Tests of one program run at the same time.
static WRITING: Mutex<()> = Mutex::new(());

const PAGE: &str = "report.html";

/// Where a failure leaves its parts.
fn part(reports: &Path, name: &str, part: &str) -> PathBuf {
    reports.join(format!("{name}.{part}"))
}

/// Leaves the pictures of a failure, and the page of all of them, whose path is returned.
pub(super) fn add(
    reports: &Path,
    entry: &Entry,
    expected: Option<&Picture>,
    actual: &Picture,
) -> Result<PathBuf, String> {
    let _one = WRITING.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let name = &entry.name;
    if let Some(folder) = part(reports, name, "json").parent() {
        fs::create_dir_all(folder).map_err(|why| format!("{}: {why}", folder.display()))?;
    }
    // The candidate is what blessing would write.
    super::write(&part(reports, name, "actual.png"), actual)?;
    let draw = |kind: &str, picture: &Picture| {
        let file = part(reports, name, kind);
        image::write(&file, Format::Png8, picture, &Metadata::default()).map_err(|why| why.to_string())
    };
    if let Some(expected) = expected {
        draw("expected.png", expected)?;
        draw(
            "difference.png",
            &compare::shown(expected, &image::as_read(actual, Format::Png8, crate::components::color::Encoding::Srgb)),
        )?;
    }
    let json = serde_json::to_vec_pretty(entry).map_err(|why| why.to_string())?;
    image::write_atomically(&part(reports, name, "json"), &json).map_err(|why| why.to_string())?;
    write_page(reports)
}

/// Takes away what an earlier failure left.
pub(super) fn remove(reports: &Path, name: &str) {
    if !part(reports, name, "json").exists() {
        return;
    }
    let _one = WRITING.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    take(reports, name);
    let _ = write_page(reports);
}

/// Takes away what is left of golden pictures in a folder that nobody names any more.
pub(super) fn forget(reports: &Path, folder: &Path, is_named: impl Fn(&str) -> bool) -> io::Result<()> {
    let _one = WRITING.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let entries = entries(reports)?;
    let forgotten = |entry: &&Entry| entry.expected.starts_with(folder) && !is_named(&entry.name);
    for entry in entries.iter().filter(forgotten) {
        take(reports, &entry.name);
    }
    let _ = write_page(reports);
    Ok(())
}

fn take(reports: &Path, name: &str) {
    for kind in ["json", "actual.png", "expected.png", "difference.png"] {
        // That it is not there is as good.
        let _ = fs::remove_file(part(reports, name, kind));
    }
}

fn entries(reports: &Path) -> io::Result<Vec<Entry>> {
    let files = super::files(reports, "json")?;
    Ok(files.iter().filter_map(|file| serde_json::from_slice(&fs::read(file).ok()?).ok()).collect())
}

/// Writes the page of all failures, worst first; without failures there is none.
fn write_page(reports: &Path) -> Result<PathBuf, String> {
    let mut entries = entries(reports).map_err(|why| why.to_string())?;
    entries.sort_by(|a, b| b.flip.total_cmp(&a.flip).then(b.bits.cmp(&a.bits)).then(a.name.cmp(&b.name)));
    let page = reports.join(PAGE);
    if entries.is_empty() {
        let _ = fs::remove_file(&page);
        return Ok(page);
    }
    let picture = |entry: &Entry, kind: &str| fs::read(part(reports, &entry.name, kind)).ok();
    let html = html::page(&entries, &picture);
    image::write_atomically(&page, html.as_bytes()).map_err(|why| why.to_string())?;
    Ok(page)
}
