//! docs/sources.md: everything that the three reports describe has a row, and what a row names exists.

use std::{collections::BTreeSet, fs, path::Path};

/// A row of the table.
#[derive(Debug)]
struct Row {
    id: String,
    place: String,
    shown_by: String,
}

fn rows(table: &str) -> Vec<Row> {
    let cells = |line: &str| line.split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    let rows = table.lines().filter(|line| line.starts_with("| ")).map(cells);
    // A bar at either end makes six cells of four columns.
    let row = |cells: Vec<String>| match <[String; 6]>::try_from(cells) {
        Ok([_, id, _, place, shown_by, _]) => Row { id, place, shown_by },
        Err(cells) => panic!("not four columns: {cells:?}"),
    };
    rows.map(row).filter(|row| row.id != "id").collect()
}

/// Every id of the reports.
fn ids() -> BTreeSet<String> {
    let groups = [("G", 9), ("M", 8), ("L", 10), ("V", 6), ("S", 5), ("P", 10), ("E", 9), ("C", 4)];
    groups.iter().flat_map(|(group, last)| (1..=*last).map(move |n| format!("{group}{n}"))).collect()
}

/// Texts between backquotes.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// What is wrong with a table; empty if nothing is.
fn faults(table: &str, root: &Path) -> Vec<String> {
    let mut faults = vec![];
    let rows = rows(table);
    let mut missing = ids();
    for Row { id, place, shown_by } in &rows {
        if !missing.remove(id) {
            faults.push(format!("{id}: unknown, or there twice"));
        }
        if quoted(place).next().is_none() {
            faults.push(format!("{id}: nowhere"));
        }
        for path in quoted(place).filter(|path| !root.join(path).is_file()) {
            faults.push(format!("{id}: no file {path}"));
        }
        let mut shown = 0;
        for name in quoted(shown_by) {
            shown += 1;
            let (path, function) = name.split_once("::").unwrap_or((name, ""));
            match fs::read_to_string(root.join(path)) {
                Err(_) => faults.push(format!("{id}: no file {path}")),
                Ok(_) if path.ends_with(".ron") && function.is_empty() => {}
                Ok(source) if is_test(&source, function) => {}
                Ok(_) => faults.push(format!("{id}: no test {name}")),
            }
        }
        if shown == 0 {
            faults.push(format!("{id}: shown by nothing"));
        }
    }
    faults.extend(missing.into_iter().map(|id| format!("{id}: no row")));
    faults
}

/// Whether a source has a test of that name.
fn is_test(source: &str, name: &str) -> bool {
    let head = format!("fn {name}()");
    let lines: Vec<_> = source.lines().map(str::trim).collect();
    let is =
        |at: usize| lines[at].starts_with(&head) && lines[..at].iter().rev().take(3).any(|line| *line == "#[test]");
    (0..lines.len()).any(is)
}

#[test]
fn every_id_has_a_row_and_what_it_names_exists() {
    let table = fs::read_to_string("docs/sources.md").expect("the table");
    let faults = faults(&table, Path::new("."));
    assert!(faults.is_empty(), "docs/sources.md:\n{}", faults.join("\n"));
}

#[test]
fn planted_faults_are_found() {
    let table = fs::read_to_string("docs/sources.md").expect("the table");
    let found = |from: &str, to: &str| {
        assert!(table.contains(from), "{from}");
        faults(&table.replacen(from, to, 1), Path::new(".")).join("; ")
    };
    assert_eq!(found("| G1 |", "| G77 |"), "G77: unknown, or there twice; G1: no row");
    assert_eq!(found("shape/plane.rs` |", "shape/plain.rs` |"), "G2: no file components/src/shape/plain.rs");
    let test = "tests/media.rs::what_is_left_after_a_body_is_the_exponential_of_the_way";
    assert_eq!(found(test, "tests/media.rs::what_is_left"), "M6: no test tests/media.rs::what_is_left");
    assert_eq!(
        found("scenes/gallery/highlights.ron", "scenes/gallery/none.ron"),
        "M1: no file scenes/gallery/none.ron"
    );
    assert_eq!(found(&format!("`{test}`, `scenes/gallery/absorption.ron`"), ""), "M6: shown by nothing");
}
