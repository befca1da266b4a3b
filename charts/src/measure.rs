//! What a setting costs and how far its picture is from a reference.

use crate::{
    clock::thread_seconds,
    fit::median,
    table::{Cell, Table, short},
};
use snell_systems::{
    compare::Difference,
    render::{Counts, Options, Picture, render},
    snapshot::Snapshot,
};
use std::sync::Arc;

/// A way to render that is to be measured.
#[derive(Clone)]
pub struct Candidate {
    /// Which kind of setting it changes.
    pub group: String,
    /// What it is.
    pub label: String,
    /// Whether it is what users get who change nothing.
    pub default: bool,
    /// The scene with the settings.
    pub snapshot: Arc<Snapshot>,
    /// How it is rendered.
    pub options: Options<'static>,
}

/// What was measured of a candidate.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Which kind of setting it changes.
    pub group: String,
    /// What it is.
    pub label: String,
    /// Whether it is what users get who change nothing.
    pub default: bool,
    /// Processor time of one thread, the median over the runs.
    pub seconds: f64,
    /// The fastest and the slowest run.
    pub spread: (f64, f64),
    /// What was done.
    pub counts: Counts,
    /// How far the picture is from the reference.
    pub difference: Difference,
    /// The picture.
    pub picture: Picture,
}

/// How often things are measured.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Runs of each candidate, in turn.
    pub runs: u32,
    /// Width of pictures in pixels; the height follows from the scene.
    pub width: u32,
    /// Whether fewer settings are tried.
    pub quick: bool,
}

impl Effort {
    /// For charts that count.
    pub const FULL: Self = Self { runs: 5, width: 200, quick: false };
    /// For a look.
    pub const QUICK: Self = Self { runs: 1, width: 80, quick: true };
}

/// A picture to compare with.
#[must_use]
pub fn picture(snapshot: &Snapshot) -> Picture {
    render(snapshot, &Options::default()).picture
}

/// Measures candidates, each run of all before the next run of any, so that a change of the machine's speed meets all
/// alike. Everything runs in one thread.
#[must_use]
pub fn measure(candidates: &[Candidate], reference: &Picture, effort: Effort) -> Vec<Measured> {
    let mut seconds = vec![vec![]; candidates.len()];
    let mut frames = vec![None; candidates.len()];
    let mut all = || {
        for _ in 0..effort.runs.max(1) {
            for ((candidate, seconds), frame) in candidates.iter().zip(&mut seconds).zip(&mut frames) {
                let start = thread_seconds();
                let drawn = render(&candidate.snapshot, &candidate.options);
                seconds.push(thread_seconds() - start);
                *frame = Some(drawn);
            }
        }
    };
    match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(pool) => pool.install(all),
        Err(_) => all(),
    }
    let measured = |((candidate, seconds), frame): ((&Candidate, &Vec<f64>), _)| {
        let frame: snell_systems::render::Frame = frame?;
        let least = seconds.iter().copied().fold(f64::INFINITY, f64::min);
        let most = seconds.iter().copied().fold(0.0, f64::max);
        Some(Measured {
            group: candidate.group.clone(),
            label: candidate.label.clone(),
            default: candidate.default,
            seconds: median(seconds),
            spread: (least, most),
            counts: frame.counts,
            difference: Difference::between(reference, &frame.picture)?,
            picture: frame.picture,
        })
    };
    candidates.iter().zip(&seconds).zip(frames).filter_map(measured).collect()
}

/// All that was measured, a row each.
#[must_use]
pub fn table(measured: &[Measured]) -> Table {
    let mut table = Table::new(&[
        "kind",
        "setting",
        crate::clock::UNIT,
        "fastest",
        "slowest",
        "rays",
        "rays per pixel",
        "nodes per ray",
        "tests per ray",
        "RMSE",
        "FLIP",
        "largest error",
        "share beyond 1/255",
    ]);
    for m in measured {
        let rays = m.counts.rays();
        let per_ray = |count: u64| count as f64 / rays.max(1) as f64;
        let Difference { rmse, flip, max, beyond } = m.difference;
        let label = if m.default { format!("{} (default)", m.label) } else { m.label.clone() };
        let mut row: Vec<Cell> = vec![m.group.as_str().into(), label.as_str().into()];
        row.extend([m.seconds, m.spread.0, m.spread.1].map(Cell::from));
        row.push(rays.into());
        let per_pixel = rays as f64 / m.picture.pixels.len().max(1) as f64;
        row.extend(
            [per_pixel, per_ray(m.counts.nodes), per_ray(m.counts.primitives), rmse, flip, max, beyond].map(Cell::from),
        );
        table.rows.push(row);
    }
    table
}

/// "0.12 s, RMSE 0.003".
#[must_use]
pub fn in_short(m: &Measured) -> String {
    format!("{} s, RMSE {}", short(m.seconds), short(m.difference.rmse))
}
