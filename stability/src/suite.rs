//! Cases and what comes of them.

use crate::random::Random;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// How much is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// A hundred thousand tries a cell: seconds in all.
    Fast,
    /// Ten million tries a cell: minutes to an hour.
    Deep,
}

/// One way of failing.
pub struct Case {
    /// Its number in the catalogue, `F01` to `F81`.
    pub id: &'static str,
    /// What fails.
    pub name: &'static str,
    /// What counts as a failure, and what the oracle is.
    pub about: &'static str,
    pub(crate) run: fn(&mut Bench),
}

/// What is to come of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Expected {
    /// No failure.
    Sound,
    /// Some failures: the method is known to fail, and the check to see it.
    Failing,
    /// Whatever it is.
    Shown,
}

/// What one method did in one cell of a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Number in the catalogue.
    pub id: String,
    /// What fails.
    pub case: String,
    /// Which method.
    pub method: String,
    /// Where: scale, offset, distance; empty if there is one cell.
    pub cell: String,
    /// Size of the things and how far they are from the origin, where the case is about that.
    pub at: Option<(f64, f64)>,
    /// How often it was tried.
    pub tries: u64,
    /// How often it failed.
    pub failures: u64,
    /// Largest error, in units that the case tells; none where failing has no size.
    pub worst: Option<f64>,
    /// What is to come of it.
    pub expected: Expected,
}

impl Row {
    /// Whether what was expected came.
    #[must_use]
    pub fn holds(&self) -> bool {
        match self.expected {
            Expected::Sound => self.failures == 0 && self.tries > 0,
            Expected::Failing => self.failures > 0,
            Expected::Shown => true,
        }
    }

    /// Share of tries that failed.
    #[must_use]
    pub fn rate(&self) -> f64 {
        self.failures as f64 / self.tries.max(1) as f64
    }

    /// Upper 95 % bound of the true rate: exact for no failure (1 − 0.05^(1/n) ≈ 3/n), else Wilson's, one-sided.
    #[must_use]
    pub fn bound(&self) -> f64 {
        let n = self.tries.max(1) as f64;
        if self.failures == 0 {
            return (2.995_732_273_553_991 / n).min(1.0);
        }
        const Z: f64 = 1.644_853_626_951_472_2;
        let (p, z2) = (self.rate(), Z * Z);
        ((p + z2 / (2.0 * n) + Z * (p * (1.0 - p) / n + z2 / (4.0 * n * n)).sqrt()) / (1.0 + z2 / n)).min(1.0)
    }
}

/// All rows of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Every row, in the order of cases.
    pub rows: Vec<Row>,
}

impl Outcome {
    /// Rows of which something else came than expected.
    pub fn broken(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| !row.holds())
    }
}

/// All cases, in the order of the catalogue.
#[must_use]
pub fn cases() -> Vec<Case> {
    crate::cases::all()
}

impl Case {
    /// Runs the case.
    #[must_use]
    pub fn run(&self, size: Size) -> Vec<Row> {
        let mut bench = Bench { case: (self.id, self.name), size, rows: vec![] };
        (self.run)(&mut bench);
        bench.rows
    }
}

/// Where a case runs: how much is tried, and what came of it.
pub(crate) struct Bench {
    case: (&'static str, &'static str),
    pub(crate) size: Size,
    rows: Vec<Row>,
}

/// What one try showed.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Trial {
    /// It does not count.
    Skip,
    /// It is right, with this error.
    Pass(f64),
    /// It is wrong, by this error.
    Fail(f64),
}

impl Trial {
    /// Right or wrong, without a size.
    pub(crate) fn of(right: bool) -> Self {
        if right { Self::Pass(0.0) } else { Self::Fail(f64::NAN) }
    }

    /// Right if the error is within a bar.
    pub(crate) fn within(error: f64, bar: f64) -> Self {
        if error <= bar { Self::Pass(error) } else { Self::Fail(error) }
    }
}

/// Sums over tries.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    pub(crate) tries: u64,
    pub(crate) failures: u64,
    pub(crate) worst: f64,
}

impl Tally {
    pub(crate) fn add(&mut self, trial: Trial) {
        let error = match trial {
            Trial::Skip => return,
            Trial::Pass(error) => error,
            Trial::Fail(error) => {
                self.failures += 1;
                error
            }
        };
        self.tries += 1;
        if error > self.worst {
            self.worst = error;
        }
    }

    fn join(self, other: Self) -> Self {
        let worst = if other.worst > self.worst { other.worst } else { self.worst };
        Self { tries: self.tries + other.tries, failures: self.failures + other.failures, worst }
    }
}

/// Tries in a chunk: the unit of parallel work, each with a stream of its own.
const CHUNK: u64 = 4096;

/// Of so many tries at least one counts.
const MOST_SKIPPED: u64 = 64;

impl Bench {
    /// Tries of a cell in full.
    pub(crate) fn full(&self) -> u64 {
        match self.size {
            Size::Fast => 100_000,
            Size::Deep => 10_000_000,
        }
    }

    /// Tries of a cell for a method that is there to be seen failing: enough to see how often.
    pub(crate) fn others(&self) -> u64 {
        match self.size {
            Size::Fast => 100_000,
            Size::Deep => 1_000_000,
        }
    }

    /// Tries something many times, in parallel, the same every time. What does not count is made up for by further tries.
    pub(crate) fn tally(&self, seed: u64, tries: u64, one: impl Fn(&mut Random) -> Trial + Sync) -> Tally {
        let chunk = |n: u64| {
            let mut random = Random::of_chunk(seed, n);
            let mut tally = Tally::default();
            let wanted = CHUNK.min(tries - n * CHUNK);
            for _ in 0..wanted * MOST_SKIPPED {
                if tally.tries == wanted {
                    break;
                }
                tally.add(one(&mut random));
            }
            tally
        };
        (0..tries.div_ceil(CHUNK)).into_par_iter().map(chunk).reduce(Tally::default, Tally::join)
    }

    fn row(&mut self, method: &str, cell: String, at: Option<(f64, f64)>, tally: Tally, expected: Expected) {
        let (id, case) = self.case;
        self.rows.push(Row {
            id: id.into(),
            case: case.into(),
            method: method.into(),
            cell,
            at,
            tries: tally.tries,
            failures: tally.failures,
            worst: (tally.worst > 0.0).then_some(tally.worst),
            expected,
        });
    }

    /// Adds a row.
    pub(crate) fn add(&mut self, expected: Expected, method: &str, cell: impl Into<String>, tally: Tally) {
        self.row(method, cell.into(), None, tally, expected);
    }

    /// Adds a row of a cell of scale and offset.
    pub(crate) fn add_at(&mut self, expected: Expected, method: &str, scale: f64, offset: f64, tally: Tally) {
        self.row(method, format!("scale {scale:e}, offset {offset:e}"), Some((scale, offset)), tally, expected);
    }
}
