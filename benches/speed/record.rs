//! Measurements as a file: with the machine and the commit, or they could not be compared with any other.

use crate::{growth::Fit, measure::Row};
use serde::Serialize;
use std::{fs, io, path::Path, process::Command};

#[derive(Serialize)]
struct Record<'a> {
    commit: String,
    processor: String,
    cores: usize,
    compiler: String,
    rounds: usize,
    rows: &'a [Row],
    fits: &'a [Fit],
}

/// Writes measurements with what is known of where they were made.
pub(crate) fn write(path: &Path, rounds: usize, rows: &[Row], fits: &[Fit]) -> io::Result<()> {
    let record = Record {
        commit: told("git", &["describe", "--always", "--dirty", "--abbrev=9"]),
        processor: processor(),
        cores: std::thread::available_parallelism().map_or(0, usize::from),
        compiler: told("rustc", &["--version"]),
        rounds,
        rows,
        fits,
    };
    fs::write(path, serde_json::to_string_pretty(&record)? + "\n")
}

/// The first line that a program says; nothing where it cannot be run.
fn told(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output().map(|output| output.stdout).unwrap_or_default();
    String::from_utf8_lossy(&output).lines().next().unwrap_or_default().to_owned()
}

fn processor() -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info.lines().find(|line| line.starts_with("model name")).and_then(|line| line.split(": ").nth(1));
    name.unwrap_or(std::env::consts::ARCH).to_owned()
}
