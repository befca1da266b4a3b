//! Time against threads.

use super::{Found, Hindrance, Scene};
use crate::{
    chart::{Axis, Chart, Guide, Point, Series},
    fit::median,
    measure::Effort,
    table::{Table, short},
};
use snell_systems::render::{Options, render};
use std::time::Instant;

pub(super) fn study(scene: &mut Scene, effort: Effort) -> Result<Found, Hindrance> {
    let snapshot = scene.with(effort, |_| {})?;
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    // Twice the cores, to show that more threads than cores cost nothing.
    let counts: Vec<usize> = (1..=(2 * cores).max(4)).filter(|n| *n <= 8 || n.is_power_of_two()).collect();
    let mut seconds = vec![vec![]; counts.len()];
    let mut hashes = vec![];
    for _ in 0..effort.runs.max(1) {
        for (threads, seconds) in counts.iter().zip(&mut seconds) {
            let options = Options { threads: Some(*threads), ..Options::default() };
            let start = Instant::now();
            let frame = render(&snapshot, &options);
            seconds.push(start.elapsed().as_secs_f64());
            hashes.push(frame.picture.hash());
        }
    }
    hashes.dedup();
    let medians: Vec<f64> = seconds.iter().map(|seconds| median(seconds)).collect();
    let one = medians.first().copied().unwrap_or_default();
    let mut table = Table::new(&["threads", "seconds", "fastest", "slowest", "times as fast as one", "efficiency"]);
    let mut points = vec![];
    for ((threads, seconds), middle) in counts.iter().zip(&seconds).zip(&medians) {
        let least = seconds.iter().copied().fold(f64::INFINITY, f64::min);
        let most = seconds.iter().copied().fold(0.0, f64::max);
        let gain = one / middle;
        table.rows.push(vec![
            (*threads as u64).into(),
            (*middle).into(),
            least.into(),
            most.into(),
            gain.into(),
            (gain / *threads as f64).into(),
        ]);
        points.push(Point { x: *threads as f64, y: gain, label: format!("{} s", short(*middle)), ..Point::default() });
    }
    let most = counts.last().copied().unwrap_or(1) as f64;
    let best = points.iter().map(|point| point.y).fold(0.0, f64::max);
    let same = if hashes.len() == 1 { "the same to the last bit" } else { "NOT the same" };
    Ok(Found {
        name: "threads".into(),
        title: format!("{}: threads", scene.name),
        says: vec![
            format!("Of {cores} cores, more threads make the picture up to {best:.2} times as fast as one does."),
            format!("The picture is {same} for every number of threads."),
        ],
        charts: vec![Chart {
            file: "threads".into(),
            title: format!("{}: how much faster more threads are (higher is better)", scene.name),
            x: Axis::linear("threads"),
            y: Axis::linear("times as fast as one thread, by the clock on the wall"),
            series: vec![Series {
                label: format!("measured on {cores} cores; median seconds at the points"),
                points,
                joined: true,
            }],
            guides: vec![Guide {
                label: "as many times as threads".into(),
                ends: [(0.0, 0.0), (most.min(1.2 * cores as f64), most.min(1.2 * cores as f64))],
            }],
            smaller_is_better: false,
        }],
        table,
        pictures: vec![],
        about: None,
    })
}
