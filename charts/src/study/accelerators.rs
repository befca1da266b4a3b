//! No tree, the tree of spheres of 2004 and the tree of boxes, side by side.

use super::{
    Found, Hindrance,
    triangles::{Lie, field, in_one_thread, timed},
};
use crate::{
    chart::{Axis, Chart, Point, Series},
    clock::UNIT,
    fit::{median, power},
    measure::Effort,
    table::Table,
};
use snell_components::method::{Accelerator, Methods};
use snell_systems::render::Options;

const ALL: [(&str, Accelerator); 3] = [
    ("no tree", Accelerator::BruteForce),
    ("tree of spheres, 2004", Accelerator::SphereTree),
    ("tree of boxes", Accelerator::Tree),
];

/// No tree is not waited for beyond this many triangles.
const PATIENCE: u32 = 5000;

pub(super) fn study(effort: Effort) -> Result<Found, Hindrance> {
    let width = (effort.width / 3).max(40);
    let most = if effort.quick { 4000 } else { 256_000 };
    let counts: Vec<u32> = (0..10).map(|n| 16 * 4u32.pow(n)).filter(|n| *n <= most).collect();
    let mut table = Table::new(&[
        "triangles",
        "accelerator",
        UNIT,
        "microseconds per ray",
        "nodes per ray",
        "tests per ray",
        "same picture",
    ]);
    let mut times = ALL.map(|(label, _)| Series { label: label.into(), joined: true, ..Series::default() });
    let mut work = times.clone();
    let mut all_same = true;
    let most = counts.last().copied().unwrap_or_default();
    for &count in &counts {
        let snapshot = field(count, Lie::Strewn, width)?;
        let expected = snell_systems::render::render(&snapshot, &Options::default()).picture.hash();
        for (((label, accelerator), times), work) in ALL.iter().zip(&mut times).zip(&mut work) {
            if *accelerator == Accelerator::BruteForce && count > PATIENCE {
                continue;
            }
            let options =
                Options { methods: Methods { accelerator: *accelerator, ..Methods::default() }, ..Options::default() };
            let same = snell_systems::render::render(&snapshot, &options).picture.hash() == expected;
            all_same &= same;
            let runs = in_one_thread(|| (0..effort.runs).map(|_| timed(&snapshot, &options)).collect::<Vec<_>>())?;
            let seconds = median(&runs.iter().map(|run| run.0).collect::<Vec<_>>());
            let counts = runs.first().map(|run| run.1).unwrap_or_default();
            let rays = counts.rays().max(1) as f64;
            let micros = 1e6 * seconds / rays;
            let [nodes, tests] = [counts.nodes, counts.primitives].map(|n| n as f64 / rays);
            let same = if same { "yes" } else { "no" };
            table.rows.push(vec![
                u64::from(count).into(),
                (*label).into(),
                seconds.into(),
                micros.into(),
                nodes.into(),
                tests.into(),
                same.into(),
            ]);
            times.points.push(Point { x: f64::from(count), y: micros, ..Point::default() });
            work.points.push(Point { x: f64::from(count), y: nodes + tests, ..Point::default() });
        }
    }
    let [_, spheres, boxes] = &times;
    let last = |series: &Series| series.points.last().map_or(0.0, |point| point.y);
    let growth = |series: &Series| {
        power(&series.points.iter().map(|p| (p.x, p.y)).collect::<Vec<_>>()).map_or(0.0, |line| line.b)
    };
    let chart = |file: &str, title: &str, y: String, series: &[Series]| Chart {
        file: file.into(),
        title: title.into(),
        x: Axis::log("triangles, strewn sparsely"),
        y: Axis::log(y),
        series: series.to_vec(),
        ..Chart::default()
    };
    Ok(Found {
        name: "accelerators".into(),
        title: "Accelerators side by side".into(),
        says: vec![
            format!(
                "At {most} triangles the tree of spheres takes {} the time of the tree of boxes; without a tree time grows with the power {:.2} of their number.",
                super::times(last(spheres), last(boxes)),
                growth(&times[0]),
            ),
            format!("The pictures are {} to the last bit.", if all_same { "the same" } else { "NOT the same" }),
        ],
        charts: vec![
            chart(
                "accelerators-time",
                "Time of a ray by accelerator (lower is better)",
                format!("microseconds ({UNIT}) per ray"),
                &times,
            ),
            chart(
                "accelerators-work",
                "Work of a ray by accelerator (lower is better)",
                "nodes visited and triangles tested per ray".into(),
                &work,
            ),
        ],
        table,
        pictures: vec![],
        about: None,
    })
}
