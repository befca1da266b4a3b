//! Cases run in turn, and what comes out of them.

use crate::clock::{Spent, median};
use serde::Serialize;
use snell::components::primitive::Cost;

/// What one run of a case did.
pub(crate) struct Done {
    pub(crate) spent: Spent,
    /// How many of the case's items.
    pub(crate) items: u64,
    pub(crate) cost: Cost,
}

/// Something to measure.
pub(crate) struct Case<'a> {
    pub(crate) bench: &'static str,
    pub(crate) subject: String,
    /// What is counted: `triangles`, `rays`, `bytes`.
    pub(crate) item: &'static str,
    pub(crate) threads: usize,
    pub(crate) run: Box<dyn FnMut() -> Done + 'a>,
}

/// What was measured.
#[derive(Clone, Serialize)]
pub(crate) struct Row {
    pub(crate) bench: &'static str,
    pub(crate) subject: String,
    pub(crate) item: &'static str,
    pub(crate) threads: usize,
    pub(crate) items: u64,
    /// Medians.
    pub(crate) cpu_seconds: f64,
    pub(crate) wall_seconds: f64,
    /// The least of all rounds: what the machine can do undisturbed.
    pub(crate) least_cpu_seconds: f64,
    /// Counts that do not depend on the machine.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) nodes_per_item: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) tests_per_item: Option<f64>,
}

/// Runs all cases in turn, round after round; the first round warms up and is not counted.
pub(crate) fn interleave(mut cases: Vec<Case<'_>>, rounds: usize) -> Vec<Row> {
    let mut done: Vec<Vec<Done>> = cases.iter().map(|_| vec![]).collect();
    for round in 0..=rounds {
        for (case, done) in cases.iter_mut().zip(&mut done) {
            let one = (case.run)();
            if round > 0 {
                done.push(one);
            }
        }
    }
    cases.iter().zip(&done).map(|(case, done)| row(case, done)).collect()
}

fn row(case: &Case<'_>, done: &[Done]) -> Row {
    let (items, cost) = done.first().map_or((0, Cost::default()), |one| (one.items, one.cost));
    let per_item = |count: u64| (count > 0).then(|| count as f64 / items as f64);
    Row {
        bench: case.bench,
        subject: case.subject.clone(),
        item: case.item,
        threads: case.threads,
        items,
        cpu_seconds: median(done.iter().map(|one| one.spent.cpu)),
        wall_seconds: median(done.iter().map(|one| one.spent.wall)),
        least_cpu_seconds: done.iter().map(|one| one.spent.cpu).fold(f64::INFINITY, f64::min),
        nodes_per_item: per_item(cost.nodes),
        tests_per_item: per_item(cost.primitives),
    }
}

/// Prints rows as a table.
pub(crate) fn show(rows: &[Row]) {
    println!(
        "{:8} {:28} {:>7} {:>11} {:9} {:>9} {:>9} {:>11} {:>11} {:>10} {:>10}",
        "bench", "subject", "threads", "items", "", "CPU s", "wall s", "M/CPU s", "best", "nodes/item", "tests/item"
    );
    for row in rows {
        let count = |per_item: Option<f64>| per_item.map_or(String::new(), |count| format!("{count:.2}"));
        println!(
            "{:8} {:28} {:>7} {:>11} {:9} {:>9.4} {:>9.4} {:>11.2} {:>11.2} {:>10} {:>10}",
            row.bench,
            row.subject,
            row.threads,
            row.items,
            row.item,
            row.cpu_seconds,
            row.wall_seconds,
            row.items as f64 / row.cpu_seconds / 1e6,
            row.items as f64 / row.least_cpu_seconds / 1e6,
            count(row.nodes_per_item),
            count(row.tests_per_item),
        );
    }
}
