//! Time that a thread spent working.

/// Processor time of this thread in seconds; it does not grow while others have the processor.
#[must_use]
pub fn thread_seconds() -> f64 {
    cpu_time::ThreadTime::now().as_duration().as_secs_f64()
}

/// What [`thread_seconds`] counts, for axes.
pub const UNIT: &str = "CPU seconds";
