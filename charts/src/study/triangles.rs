//! Time against the number of triangles: sparse and in order, sparse and strewn, and crowded.

use super::{Found, Hindrance};
use crate::{
    chart::{Axis, Chart, Guide, Point, Series},
    clock::{UNIT, thread_seconds},
    fit::{line, median},
    measure::Effort,
    table::Table,
};
use snell_components::{
    camera::Camera,
    color::Rgb,
    figure::{Arrangement, TriangleField},
    light::PointLight,
    material::{Diffuse, Mirror},
    math,
    name::Name,
    settings::Settings,
};
use snell_systems::{
    pipeline::Renderer,
    render::{Counts, Options, render},
    snapshot::Snapshot,
};
use std::sync::Arc;

/// How the triangles of a field lie.
#[derive(Clone, Copy)]
pub(super) enum Lie {
    /// One in each cell of a grid, half as large.
    Ordered,
    /// As large, anywhere.
    Strewn,
    /// Anywhere, and ten cells large: the case where every hierarchy suffers.
    Crowded,
}

impl Lie {
    fn about(self) -> &'static str {
        match self {
            Self::Ordered => "sparse, in a grid",
            Self::Strewn => "sparse, strewn",
            Self::Crowded => "crowded: ten cells large",
        }
    }
}

/// A cube of triangles that fills most of the picture, with a lamp, shadows and one mirroring.
pub(super) fn field(count: u32, lie: Lie, width: u32) -> Result<Arc<Snapshot>, Hindrance> {
    let mut renderer = Renderer::new();
    *renderer.settings() =
        Settings { width, height: width * 3 / 4, depth: 1, background: Rgb::splat(0.2), ..Settings::default() };
    let edge = math::pow(f64::from(count), 1.0 / 3.0);
    let world = &mut renderer.world;
    let position = glam::DVec3::new(0.9, 0.7, 1.6);
    world.spawn((
        Name::new("eye"),
        Camera { position, target: Some(glam::DVec3::ZERO), field_of_view: 42.0, ..Camera::default() },
    ));
    world.spawn((Name::new("lamp"), PointLight { position: glam::DVec3::new(2.0, 3.0, 2.0), ..PointLight::default() }));
    let (size, arrangement) = match lie {
        Lie::Ordered => (0.5, Arrangement::Grid),
        Lie::Strewn => (0.5, Arrangement::Random),
        Lie::Crowded => (10.0, Arrangement::Random),
    };
    let cell = 1.0 / edge;
    let field = TriangleField { count, spacing: cell, size: size * cell, arrangement, seed: 1 };
    world.spawn((Name::new("field"), field, Diffuse(Rgb::splat(0.8)), Mirror(Rgb::splat(0.2))));
    Ok(renderer.snapshot()?)
}

/// Processor seconds of runs, and the counts.
pub(super) fn timed(snapshot: &Snapshot, options: &Options<'_>) -> (f64, Counts) {
    let options = Options { threads: None, ..options.clone() };
    let start = thread_seconds();
    let frame = render(snapshot, &options);
    (thread_seconds() - start, frame.counts)
}

/// Does something in a pool of one thread, so that the time of that thread is the time of the work.
pub(super) fn in_one_thread<R: Send>(work: impl FnOnce() -> R + Send) -> Result<R, Hindrance> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.map(|pool| pool.install(work)).map_err(|why| Hindrance::Scene(why.to_string()))
}

pub(super) fn study(effort: Effort) -> Result<Found, Hindrance> {
    let most: u32 = if effort.quick { 20_000 } else { 1_000_000 };
    let mut counts = vec![1000u32];
    while let Some(next) = counts.last().map(|n| n * 3).filter(|n| *n <= most) {
        counts.push(next);
    }
    counts.push(most);
    let lies = [Lie::Ordered, Lie::Strewn, Lie::Crowded];
    let mut table = Table::new(&[
        "triangles",
        "arrangement",
        UNIT,
        "rays",
        "nodes per ray",
        "tests per ray",
        "microseconds per ray",
    ]);
    let mut series = lies.map(|lie| Series { label: lie.about().into(), joined: true, ..Series::default() });
    let mut work = series.clone();
    for &count in &counts {
        for ((lie, times), work) in lies.iter().zip(&mut series).zip(&mut work) {
            let snapshot = field(count, *lie, effort.width)?;
            let runs =
                in_one_thread(|| (0..effort.runs).map(|_| timed(&snapshot, &Options::default())).collect::<Vec<_>>())?;
            let seconds = median(&runs.iter().map(|run| run.0).collect::<Vec<_>>());
            let counts = runs.first().map(|run| run.1).unwrap_or_default();
            let rays = counts.rays().max(1) as f64;
            let micros = 1e6 * seconds / rays;
            let per_ray = |count: u64| count as f64 / rays;
            table.rows.push(vec![
                u64::from(count).into(),
                lie.about().into(),
                seconds.into(),
                counts.rays().into(),
                per_ray(counts.nodes).into(),
                per_ray(counts.primitives).into(),
                micros.into(),
            ]);
            times.points.push(Point { x: f64::from(count), y: micros, ..Point::default() });
            work.points.push(Point {
                x: f64::from(count),
                y: per_ray(counts.nodes + counts.primitives),
                ..Point::default()
            });
        }
    }
    let fitted =
        |series: &Series| line(&series.points.iter().map(|point| (math::log2(point.x), point.y)).collect::<Vec<_>>());
    let [ordered, _, crowded] = &series;
    let fit = fitted(ordered);
    let guides = fit.iter().map(|fit| {
        let at = |n: u32| (f64::from(n), (fit.a + fit.b * math::log2(f64::from(n))).max(0.0));
        let label = format!("{:.3} + {:.4}·log2 n (R² = {:.3}), fitted to the grid", fit.a, fit.b, fit.r_squared);
        Guide { label, ends: [at(counts[0]), at(most)] }
    });
    let guides: Vec<Guide> = guides.collect();
    let last = |series: &Series| series.points.last().map_or(0.0, |point| point.y);
    let says = vec![
        match fit {
            Some(fit) => format!(
                "In a grid the time of a ray grows by {:.4} microseconds with each doubling of the triangles: a straight line in log n \
                 explains {:.1} % of it.",
                fit.b,
                100.0 * fit.r_squared
            ),
            None => String::new(),
        },
        format!(
            "Crowded triangles cost {} as much as ordered ones at {most}, since a ray meets {:.0} nodes and triangles in place of {:.0}.",
            super::times(last(crowded), last(ordered)),
            last(&work[2]),
            last(&work[0]),
        ),
    ];
    let chart = |file: &str, title: &str, y: Axis, series: &[Series], guides: Vec<Guide>| Chart {
        file: file.into(),
        title: title.into(),
        x: Axis::log("triangles"),
        y,
        series: series.to_vec(),
        guides,
        smaller_is_better: false,
    };
    Ok(Found {
        name: "triangles".into(),
        title: "Time against the number of triangles".into(),
        says,
        charts: vec![
            chart(
                "triangles-time",
                "Time of a ray against triangles (lower is better)",
                // Where what grows as log n is straight.
                Axis::linear(format!("microseconds ({UNIT}) per ray")),
                &series,
                guides,
            ),
            chart(
                "triangles-work",
                "Work of a ray against triangles (lower is better)",
                Axis::log("nodes visited and triangles tested per ray"),
                &work,
                vec![],
            ),
        ],
        table,
        pictures: vec![],
        about: None,
    })
}
