//! Time against the area on the screen, and against the number of pixels.

use super::{
    Found, Hindrance,
    triangles::{Lie, field, in_one_thread, timed},
};
use crate::{
    chart::{Axis, Chart, Guide, Point, Series},
    clock::UNIT,
    fit::{line, median},
    measure::Effort,
    table::Table,
};
use snell_systems::{
    render::{Options, render},
    snapshot::Snapshot,
};

pub(super) fn study(effort: Effort) -> Result<Found, Hindrance> {
    let (count, width) = if effort.quick { (5000, 2 * effort.width) } else { (40_000, 2 * effort.width) };
    let snapshot = field(count, Lie::Ordered, width)?;
    let mut table = Table::new(&["pixels that show the field", "share of the picture", UNIT, "rays"]);
    let mut points = vec![];
    for step in 0..10 {
        // Farther away the field is smaller.
        let farther = 1.0 + 0.35 * f64::from(step);
        let mut moved: Snapshot = (*snapshot).clone();
        moved.view.eye *= farther;
        let runs = in_one_thread(|| (0..effort.runs).map(|_| timed(&moved, &Options::default())).collect::<Vec<_>>())?;
        let seconds = median(&runs.iter().map(|run| run.0).collect::<Vec<_>>());
        let covered = covered(&moved);
        let share = covered as f64 / f64::from(moved.settings.width * moved.settings.height);
        let rays = runs.first().map(|run| run.1.rays()).unwrap_or_default();
        table.rows.push(vec![covered.into(), share.into(), seconds.into(), rays.into()]);
        points.push((covered as f64, seconds));
    }
    let fit = line(&points);
    let most = points.iter().map(|point| point.0).fold(0.0, f64::max);
    let guides = fit.iter().map(|fit| Guide {
        label: format!("line by least squares (R² = {:.4})", fit.r_squared),
        ends: [(0.0, fit.a.max(0.0)), (most, fit.a + fit.b * most)],
    });
    let guides = guides.collect();
    let says = match fit {
        Some(fit) => vec![
            format!(
                "Time grows in a straight line with the area on the screen, which explains {:.2} % of it.",
                100.0 * fit.r_squared
            ),
            format!(
                "A pixel that shows the field of {count} triangles takes {:.2} microseconds, one that shows nothing {:.2}.",
                1e6 * (fit.b + fit.a / f64::from(width * width * 3 / 4)),
                1e6 * fit.a / f64::from(width * width * 3 / 4)
            ),
        ],
        None => vec![],
    };
    let point = |(x, y): &(f64, f64)| Point { x: *x, y: *y, ..Point::default() };
    Ok(Found {
        name: "area".into(),
        title: "Time against the area on the screen".into(),
        says,
        charts: vec![Chart {
            file: "area".into(),
            title: format!("Time against the area of {count} triangles on the screen (lower is better)"),
            x: Axis::linear("pixels that show the field"),
            y: Axis::linear(format!("{UNIT} for the picture, one thread")),
            series: vec![Series {
                label: format!("the camera moves away, {width} by {} pixels", width * 3 / 4),
                points: points.iter().map(point).collect(),
                joined: false,
            }],
            guides,
            smaller_is_better: false,
        }],
        table,
        pictures: vec![],
        about: None,
    })
}

/// Pixels that show something else than the background.
fn covered(snapshot: &Snapshot) -> u64 {
    let background = snapshot.settings.background.as_vec3().to_array();
    let picture = render(snapshot, &Options::default()).picture;
    picture.pixels.iter().filter(|pixel| **pixel != background).count() as u64
}
