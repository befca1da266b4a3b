//! Whether the error that is promised is kept, and what it saves.

use super::{Found, Hindrance, Scene, scene};
use crate::{
    chart::{Axis, Chart, Guide, Point, Series},
    measure::{self, Effort},
    table::Table,
};
use bevy_ecs::prelude::*;
use snell_components::settings::{Antialias, Settings};
use snell_systems::{
    compare::Difference,
    render::{Options, Picture, render},
};

/// In 255ths.
const ERRORS: [u32; 5] = [1, 2, 4, 8, 16];

/// The share of pixels whose error is told: two standard errors.
const CONFIDENCE: f64 = 0.95;

pub(super) fn study(scene: &mut Scene, effort: Effort) -> Result<Found, Hindrance> {
    let reference = measure::picture(&*scene.with(effort, |world| {
        scene::converge_lights(world, 24);
        let settings = &mut *world.resource_mut::<Settings>();
        (settings.antialias, settings.grid) = (Antialias::Grid, if effort.quick { 16 } else { 48 });
        scene::cut_nothing_visible(settings);
    })?);
    let mut table = Table::new(&[
        "error promised",
        "rays per pixel",
        "rays per pixel, nothing cut",
        "rays per pixel, 16 by 16",
        "largest error by cuts, in 255ths",
        "bound proved, in 255ths",
        "error of 95 % of pixels, in 255ths",
        "pixels within the error, %",
        "pixels not resolved, %",
    ]);
    // As exact as one can be without looking where it matters.
    let grid = scene.candidate(effort, "", "", |settings| {
        (settings.antialias, settings.grid, settings.error) = (Antialias::Grid, 16, 0.0);
        settings.cutoff = 0.0;
    })?;
    let grid = render(&grid.snapshot, &Options::default()).counts.rays();
    let (mut cuts, mut bounds, mut found) = (vec![], vec![], vec![]);
    let errors = if effort.quick { &ERRORS[2..4] } else { &ERRORS[..] };
    for &in_255ths in errors {
        let error = f64::from(in_255ths) / 255.0;
        let with_error = scene.with(effort, |world| {
            let settings = &mut *world.resource_mut::<Settings>();
            (settings.antialias, settings.subdivisions, settings.error) = (Antialias::Adaptive, 6, error);
        })?;
        let kept = render(&with_error, &Options::default());
        // The same rays through pixels and samples of lights in both, so that what differs is what was cut.
        let mut fixed = (*with_error).clone();
        (fixed.settings.antialias, fixed.settings.grid) = (Antialias::Four, 2);
        let cut = render(&fixed, &Options::default());
        fixed.ceiling = None;
        let full = render(&fixed, &Options::default());
        let by_cuts = Difference::between(&full.picture, &cut.picture).map_or(0.0, |difference| difference.max);
        let bound = cut.counts.cut_bound.max(kept.counts.cut_bound);
        let mut off = errors_of(&reference, &kept.picture);
        let within = off.iter().filter(|off| **off <= error).count() as f64 / off.len().max(1) as f64;
        off.sort_by(f64::total_cmp);
        let most = off
            .get(((off.len() as f64 * CONFIDENCE) as usize).min(off.len().saturating_sub(1)))
            .copied()
            .unwrap_or_default();
        let pixels = off.len().max(1) as f64;
        // What the halved pixels would take if nothing were cut, by the share that was cut elsewhere.
        let uncut = kept.counts.rays() as f64 * full.counts.rays() as f64 / cut.counts.rays().max(1) as f64;
        table.rows.push(vec![
            format!("{in_255ths}/255").as_str().into(),
            (kept.counts.rays() as f64 / pixels).into(),
            (uncut / pixels).into(),
            (grid as f64 / pixels).into(),
            (255.0 * by_cuts).into(),
            (255.0 * bound).into(),
            (255.0 * most).into(),
            (100.0 * within).into(),
            (100.0 * kept.counts.unresolved as f64 / pixels).into(),
        ]);
        let point = |y: f64| Point { x: f64::from(in_255ths), y: 255.0 * y, ..Point::default() };
        cuts.push(point(by_cuts));
        bounds.push(point(bound));
        found.push(point(most));
    }
    let kept = found.iter().all(|point| point.y <= point.x);
    let proved = cuts.iter().zip(&bounds).all(|(cut, bound)| cut.y <= bound.y + 1e-3 && bound.y <= 0.5 * bound.x);
    let series = |label: &str, points: Vec<Point>| Series { label: label.into(), points, joined: true };
    let ends = |share: f64| [(f64::from(errors[0]), share * f64::from(errors[0])), (16.0, share * 16.0)];
    Ok(Found {
        name: "error".into(),
        title: format!("{}: whether the error is kept", scene.name),
        says: vec![
            format!(
                "Cutting rays {} within the bound that is proved, in every pixel.",
                if proved { "stays" } else { "does NOT stay" }
            ),
            format!(
                "95 % of the pixels {} within the error that was promised, as compared with a picture of {} rays to a pixel.",
                if kept { "are" } else { "are not always" },
                if effort.quick { 256 } else { 2304 }
            ),
        ],
        charts: vec![Chart {
            file: "error".into(),
            title: format!("{}: error found against error promised (below the line is kept)", scene.name),
            x: Axis::log("error promised, in 255ths of linear light"),
            y: Axis::log("error found, in 255ths of linear light"),
            series: vec![
                series("error that 95 % of the pixels keep, all in all", found),
                series("bound proved for what is cut", bounds),
                series("largest error of a pixel by what is cut", cuts),
            ],
            guides: vec![
                Guide { label: "what is promised".into(), ends: ends(1.0) },
                Guide { label: "half of it, for what is cut".into(), ends: ends(0.5) },
            ],
            smaller_is_better: false,
        }],
        table,
        pictures: vec![],
        about: None,
    })
}

/// The largest error of a channel, pixel by pixel.
fn errors_of(reference: &Picture, picture: &Picture) -> Vec<f64> {
    let largest =
        |(a, b): (&[f32; 3], &[f32; 3])| a.iter().zip(b).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max);
    reference.pixels.iter().zip(&picture.pixels).map(largest).collect()
}
