//! The stability suite in its fast form: what must hold holds, and what is known to fail is seen to fail.

use snell_stability::{Expected, Outcome, Size, cases, report};
use std::collections::BTreeSet;

#[test]
fn no_case_fails_here_and_every_usual_method_is_seen_to_fail() {
    let cases = cases();
    let outcome = Outcome { rows: cases.iter().flat_map(|case| case.run(Size::Fast)).collect() };
    let broken: Vec<String> = outcome
        .broken()
        .map(|row| format!("{} {}, {}, {}: {} of {}", row.id, row.case, row.method, row.cell, row.failures, row.tries))
        .collect();
    assert!(broken.is_empty(), "{}", broken.join("\n"));

    for case in &cases {
        let of = |expected| outcome.rows.iter().any(|row| row.id == case.id && row.expected == expected);
        assert!(of(Expected::Sound), "{}: nothing is promised", case.id);
    }
    let text = report::markdown(&outcome);
    assert!(cases.iter().all(|case| text.contains(&format!("### {} {}", case.id, case.name))));
    let read: Outcome = serde_json::from_str(&report::json(&outcome).expect("text")).expect("rows");
    assert_eq!(read.rows.len(), outcome.rows.len());
}

/// `docs/accuracy.md` accounts for every number of the catalogue, and its words for the suite are true.
#[test]
fn every_number_of_the_catalogue_is_accounted_for() {
    let page = include_str!("../docs/accuracy.md");
    let in_suite: BTreeSet<&str> = cases().iter().map(|case| case.id).collect();
    let ranges = [1..=14, 20..=27, 30..=40, 50..=59, 60..=67, 70..=81];
    for number in ranges.into_iter().flatten() {
        let id = format!("F{number:02}");
        let row = page.lines().find(|line| line.starts_with(&format!("| {id} |")));
        let row = row.unwrap_or_else(|| panic!("{id} is not in docs/accuracy.md"));
        assert_eq!(row.contains("| suite"), in_suite.contains(id.as_str()), "{row}");
        // What is shown elsewhere names a file and a test in it.
        for place in row.split('`').filter(|text| text.starts_with("tests/")) {
            let (file, test) = place.split_once(": ").unwrap_or_else(|| panic!("{place}: no test is named"));
            let source = std::fs::read_to_string(file).unwrap_or_else(|why| panic!("{file}: {why}"));
            assert!(source.contains(&format!("fn {test}(")), "{place} is not there");
        }
    }
}
