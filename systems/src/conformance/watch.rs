//! A shape that does not come to an end is told, with what it was asked last.

use super::Report;
use core::time::Duration;
use snell_components::space::Ray;
use std::{
    panic,
    sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc},
    thread,
};

/// How long a shape may take over one answer. It takes millionths of a second; only what never ends takes this long.
pub(super) const PATIENCE: Duration = Duration::from_secs(60);

/// Knows what a shape was asked last.
#[derive(Clone, Default)]
pub(super) struct Watch(Arc<Mutex<Asked>>);

#[derive(Default)]
struct Asked {
    /// How many questions there were.
    number: u64,
    shape: String,
    /// None if it was asked without one.
    ray: Option<Ray>,
}

impl Watch {
    /// To be told before a shape is asked anything.
    pub(super) fn asks(&self, shape: &str, ray: Option<&Ray>) {
        let mut asked = self.last();
        asked.number += 1;
        asked.ray = ray.copied();
        if asked.shape != shape {
            shape.clone_into(&mut asked.shape);
        }
    }

    fn last(&self) -> MutexGuard<'_, Asked> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What checks find; or, if they make no step for as long as `patience`, that the shape does not come to an end.
///
/// The checks then go on in a thread of their own for as long as the program runs: nothing can stop them.
pub(super) fn watched(patience: Duration, checks: impl FnOnce(&Watch) -> Report + Send + 'static) -> Report {
    let watch = Watch::default();
    let (done, result) = mpsc::channel();
    let worker = thread::spawn({
        let watch = watch.clone();
        // Nobody listens any more if it took too long.
        move || drop(done.send(checks(&watch)))
    });
    let mut seen = 0;
    loop {
        match result.recv_timeout(patience) {
            Ok(report) => return report,
            Err(mpsc::RecvTimeoutError::Disconnected) => match worker.join() {
                Err(why) => panic::resume_unwind(why),
                Ok(()) => return Report::default(),
            },
            Err(mpsc::RecvTimeoutError::Timeout) => {
                let asked = watch.last();
                if asked.number == seen {
                    let what = asked.ray.map_or("it".into(), |ray| format!("{ray:?}: its `hit` or `surface`"));
                    let mut report = Report::default();
                    report.add("ends", &asked.shape, format!("{what} took more than {patience:?}"));
                    return report;
                }
                seen = asked.number;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    const MOMENT: Duration = Duration::from_millis(20);

    #[test]
    fn an_answer_that_never_comes_is_told_with_the_question() {
        let (forever, never) = mpsc::channel::<()>();
        let report = watched(MOMENT, move |watch| {
            watch.asks("Knot, far away", Some(&Ray { origin: DVec3::X, direction: DVec3::Y }));
            let _ = never.recv();
            Report::default()
        });
        assert!(report.has("ends"), "{report}");
        let told = report.to_string();
        assert!(told.contains("Knot, far away") && told.contains("origin: DVec3(1.0, 0.0, 0.0)"), "{told}");
        drop(forever);
    }

    #[test]
    fn many_questions_may_take_long() {
        let report = watched(200 * MOMENT, |watch| {
            for _ in 0..20 {
                watch.asks("Ball", None);
                thread::sleep(MOMENT);
            }
            let mut report = Report::default();
            report.add("bounds", "Ball", "found");
            report
        });
        assert!(report.has("bounds") && report.failures.len() == 1, "{report}");
    }

    #[test]
    #[should_panic(expected = "by the shape itself")]
    fn a_panic_stays_one() {
        let _ = watched(200 * MOMENT, |_| panic!("by the shape itself"));
    }
}
