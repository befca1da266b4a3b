//! The picture of a run: failure rates of every method over scale and offset, as SVG.

use crate::suite::{Outcome, Row};
use core::fmt::Write;
use std::collections::BTreeMap;

const CELL: (usize, usize) = (74, 30);
const LEFT: usize = 110;
const GAP: usize = 64;

/// A field for each case and method that was tried over scales and offsets: offsets across, scales down.
#[must_use]
pub fn svg(outcome: &Outcome) -> String {
    let mut fields: BTreeMap<(&str, &str, &str), Vec<&Row>> = BTreeMap::new();
    for row in outcome.rows.iter().filter(|row| row.at.is_some()) {
        fields.entry((&row.id, &row.case, &row.method)).or_default().push(row);
    }
    let mut body = String::new();
    let mut y = 50;
    for ((id, case, method), rows) in &fields {
        let mut scales: Vec<f64> = rows.iter().filter_map(|row| row.at).map(|at| at.0).collect();
        scales.sort_by(f64::total_cmp);
        scales.dedup();
        // Writing to a string cannot fail.
        let _ = writeln!(body, r#"<text x="10" y="{y}" class="t">{id} {case}: {}</text>"#, escaped(method));
        y += 10;
        for scale in scales {
            let _ = writeln!(body, r#"<text x="10" y="{}">size {scale:e}</text>"#, y + 20);
            for (column, row) in rows.iter().filter(|row| row.at.is_some_and(|at| at.0 == scale)).enumerate() {
                let x = LEFT + column * CELL.0;
                let (fill, ink) = colors(row.rate());
                let _ = writeln!(
                    body,
                    r#"<rect x="{x}" y="{y}" width="{}" height="{}" fill="{fill}"/><text x="{}" y="{}" class="c" fill="{ink}">{}</text>"#,
                    CELL.0 - 2,
                    CELL.1 - 2,
                    x + CELL.0 / 2 - 1,
                    y + 13,
                    rate(row),
                );
                let offset = row.at.map_or(0.0, |at| at.1);
                let _ = writeln!(
                    body,
                    r#"<text x="{}" y="{}" class="s" fill="{ink}">at {offset:.0e}</text>"#,
                    x + CELL.0 / 2 - 1,
                    y + 24,
                );
            }
            y += CELL.1;
        }
        y += GAP - 24;
    }
    format!(
        r##"<svg xmlns="http://www.w3.org/2000/svg" width="520" height="{y}" font-family="sans-serif" font-size="11">
<style>.t{{font-size:13px;font-weight:bold}}.c{{text-anchor:middle}}.s{{text-anchor:middle;font-size:8px}}</style>
<rect width="100%" height="100%" fill="#fff"/>
<text x="10" y="24" font-size="15">Share of tries that fail, by size of the thing and distance from the origin</text>
{body}</svg>
"##
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

fn rate(row: &Row) -> String {
    let rate = row.rate();
    if row.failures == 0 {
        "0".into()
    } else if rate >= 0.001 {
        format!("{:.1} %", 100.0 * rate)
    } else {
        format!("{rate:.0e}")
    }
}

/// White-green for none, then darker by powers of ten; with the colour of the text on it.
fn colors(rate: f64) -> (&'static str, &'static str) {
    match rate {
        0.0 => ("#e3f4e6", "#123"),
        r if r < 1e-4 => ("#fdecc8", "#123"),
        r if r < 1e-2 => ("#f9c784", "#123"),
        r if r < 0.2 => ("#ee8a4a", "#123"),
        r if r < 0.6 => ("#cf4a2c", "#fff"),
        _ => ("#7d1a1a", "#fff"),
    }
}
