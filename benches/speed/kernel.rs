//! Trees over meshes: building them, and tracing rays of each kind.

use crate::{
    clock::spent,
    measure::{Case, Done, Row, interleave},
    rays::{Rays, Search},
    subject::{Subject, build as build_tree, snapshot},
};
use rayon::{ThreadPoolBuildError, ThreadPoolBuilder};
use snell::components::primitive::Cost;

/// Triangles a second.
pub(crate) fn build(subjects: &[Subject], rounds: usize) -> Result<Vec<Row>, ThreadPoolBuildError> {
    let mut cases = vec![];
    for threads in [1, 2] {
        for subject in subjects {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build()?;
            let run = move || {
                let mesh = subject.mesh();
                let ((), spent) = spent(|| pool.install(|| build_tree(&mesh)));
                Done { spent, items: subject.triangles.len() as u64, cost: Cost::default() }
            };
            let run = Box::new(run);
            cases.push(Case { bench: "build", subject: subject.name.clone(), item: "triangles", threads, run });
        }
    }
    Ok(interleave(cases, rounds))
}

/// Rays a second.
pub(crate) fn trace(subjects: &[Subject], rounds: usize) -> Vec<Row> {
    let prepared: Vec<_> = subjects.iter().map(prepare).collect();
    let mut cases = vec![];
    for (subject, (snapshot, sets)) in subjects.iter().zip(&prepared) {
        for (set, threads) in sets.iter().flat_map(|set| [(set, 1), (set, 2)]) {
            let run = Box::new(move || {
                let (met, spent) = spent(|| set.trace(&Search::Surface { geometry: &snapshot.geometry }, threads));
                Done { spent, items: set.rays.len() as u64, cost: met.cost }
            });
            let subject = format!("{}: {}", subject.name, set.kind.name());
            cases.push(Case { bench: "trace", subject, item: "rays", threads, run });
        }
    }
    interleave(cases, rounds)
}

fn prepare(subject: &Subject) -> (std::sync::Arc<snell::Snapshot>, [Rays; 4]) {
    let snapshot = snapshot(subject.mesh());
    let (min, max) = subject.bounds();
    let rays = Rays::about(&snapshot.geometry, min, max);
    (snapshot, rays)
}
