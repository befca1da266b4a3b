//! The table of a run as text: Markdown and JSON.

use crate::suite::{Expected, Outcome, Row, cases};
use core::fmt::Write;

/// The table as Markdown: what each case is about, and a row for every method and cell.
#[must_use]
pub fn markdown(outcome: &Outcome) -> String {
    let mut text = String::new();
    let rows = |id: &str| outcome.rows.iter().filter(move |row| row.id == id).collect::<Vec<_>>();
    for case in cases() {
        let rows = rows(case.id);
        if rows.is_empty() {
            continue;
        }
        // Writing to a string cannot fail.
        let _ = writeln!(text, "### {} {}\n\n{}.\n", case.id, case.name, case.about);
        text.push_str("| method | cell | tries | failures | rate | 95 % bound | worst error | expected |\n");
        text.push_str("|---|---|---:|---:|---:|---:|---:|---|\n");
        for row in rows {
            let _ = writeln!(
                text,
                "| {} | {} | {} | {} | {} | {:.1e} | {} | {} |",
                row.method,
                row.cell,
                row.tries,
                row.failures,
                percent(row),
                row.bound(),
                row.worst.map_or_else(String::new, |worst| format!("{worst:.2e}")),
                expected(row),
            );
        }
        text.push('\n');
    }
    text
}

/// The rows as JSON, with all digits.
///
/// # Errors
/// Never for rows of a run: their numbers are finite.
pub fn json(outcome: &Outcome) -> Result<String, serde_json::Error> {
    serde_json::to_string_pretty(outcome)
}

fn percent(row: &Row) -> String {
    if row.failures == 0 { "0".into() } else { format!("{:.3} %", 100.0 * row.rate()) }
}

fn expected(row: &Row) -> &'static str {
    match (row.expected, row.holds()) {
        (Expected::Sound, true) => "none, holds",
        (Expected::Sound, false) => "none, **broken**",
        (Expected::Failing, true) => "fails, as known",
        (Expected::Failing, false) => "fails, **not seen**",
        (Expected::Shown, _) => "",
    }
}
