//! Seconds on the wall and of the processor, and what to make of several of them.

use cpu_time::ProcessTime;
use std::time::Instant;

/// What some work took.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spent {
    /// Seconds on the wall.
    pub(crate) wall: f64,
    /// Seconds of processor time, of all threads together.
    pub(crate) cpu: f64,
}

/// What some work gives, and what it took.
pub(crate) fn spent<R>(work: impl FnOnce() -> R) -> (R, Spent) {
    let (wall, cpu) = (Instant::now(), ProcessTime::now());
    let result = work();
    (result, Spent { wall: wall.elapsed().as_secs_f64(), cpu: cpu.elapsed().as_secs_f64() })
}

/// The middle value; of an even count the upper one of the two.
pub(crate) fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
