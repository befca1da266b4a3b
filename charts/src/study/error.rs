//! Whether the error that is promised is kept, and what it saves.
//!
//! The picture keeps the size that the scene gives it, since what a pixel holds depends on it; blocks of pixels spread over
//! it stand for the whole, so that the reference can be waited for.

use super::{Found, Hindrance, Scene, scene};
use crate::{
    chart::{Axis, Chart, Guide, Point, Series},
    measure::Effort,
    table::{Cell, Table, short},
};
use bevy_ecs::prelude::*;
use rayon::prelude::*;
use snell_components::settings::{Antialias, Settings};
use snell_systems::{
    render::{Counts, Options, Region, render},
    snapshot::Snapshot,
};

/// In 255ths.
const ERRORS: [u32; 5] = [1, 2, 4, 8, 16];

const ERRORS_OF_A_LOOK: [u32; 2] = [1, 4];

/// The share of pixels that is to keep the error: two standard errors.
const CONFIDENCE: f64 = 0.95;

/// Column: the share of pixels that keep the error.
const WITHIN: &str = "pixels within it, %";

/// Column: rays over those of the smallest grid that is as good.
const OF_GRID: &str = "rays of those, %";

/// Rays across a pixel of the pictures that the promise is compared with in cost.
const GRIDS: [u32; 10] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32];

pub(super) fn study(scene: &mut Scene, effort: Effort) -> Result<Found, Hindrance> {
    let Settings { width, height, .. } = scene.settings();
    let finest = if effort.quick { 32 } else { 48 };
    let reference = scene.at_its_size(|world| {
        scene::converge_lights(world, 16);
        let settings = &mut *world.resource_mut::<Settings>();
        (settings.antialias, settings.grid) = (Antialias::Grid, finest);
        scene::cut_nothing_visible(settings);
    })?;
    let reference = Sampled::of(&reference, &blocks(width, height, effort));
    let grids: &[u32] = if effort.quick { &GRIDS[..7] } else { &GRIDS };
    let mut full = vec![];
    for &grid in grids {
        let snapshot = scene.at_its_size(|world| {
            let settings = &mut *world.resource_mut::<Settings>();
            (settings.antialias, settings.grid) = (Antialias::Grid, grid);
            (settings.cutoff, settings.error) = (0.0, 0.0);
        })?;
        full.push((grid, Sampled::of(&snapshot, &blocks(width, height, effort))));
    }
    let mut table = Table::new(&[
        "error promised",
        WITHIN,
        "error of 95 % of pixels, in 255ths",
        "pixels not resolved, %",
        "rays per pixel",
        "smallest grid without cuts as good",
        "its rays per pixel",
        OF_GRID,
        "bound proved for cuts, in 255ths",
        "largest error by cuts, in 255ths",
        "rays left by cuts, %",
    ]);
    let (mut cuts, mut bounds, mut found) = (vec![], vec![], vec![]);
    let (mut kept_everywhere, mut proved, mut shares) = (true, true, vec![]);
    let errors = if effort.quick { &ERRORS_OF_A_LOOK[..] } else { &ERRORS[..] };
    for &in_255ths in errors {
        let error = f64::from(in_255ths) / 255.0;
        let with_error = scene.at_its_size(|world| {
            let settings = &mut *world.resource_mut::<Settings>();
            (settings.antialias, settings.subdivisions, settings.error) = (Antialias::Adaptive, 6, error);
        })?;
        let kept = Sampled::of(&with_error, &blocks(width, height, effort));
        // The same rays through pixels and samples of lights in both, so that what differs is what was cut.
        let mut fixed = (*with_error).clone();
        (fixed.settings.antialias, fixed.settings.grid) = (Antialias::Four, 2);
        let cut = Sampled::of(&fixed, &blocks(width, height, effort));
        fixed.ceiling = None;
        let uncut = Sampled::of(&fixed, &blocks(width, height, effort));
        let by_cuts = cut.errors(&uncut).into_iter().fold(0.0, f64::max);
        let bound = cut.counts.cut_bound.max(kept.counts.cut_bound);
        let mut off = kept.errors(&reference);
        off.sort_by(f64::total_cmp);
        let most = off.get(((off.len() as f64 * CONFIDENCE) as usize).min(off.len() - 1)).copied().unwrap_or_default();
        let within = kept.share_within(error, &reference);
        // A grid that leaves as many pixels within the error, at what rays it may take.
        let as_good = full.iter().find(|(_, grid)| grid.share_within(error, &reference) >= within);
        let (grid, rays) = match (as_good, full.last()) {
            (Some((n, grid)), _) => (format!("{n} by {n}"), grid.rays_per_pixel()),
            (None, Some((n, grid))) => (format!("none to {n} by {n}"), grid.rays_per_pixel()),
            (None, None) => (String::new(), f64::NAN),
        };
        let share = kept.rays_per_pixel() / rays;
        shares.push(share);
        kept_everywhere &= within >= CONFIDENCE;
        proved &= by_cuts <= bound + 1e-6 && bound <= 0.5 * error;
        table.rows.push(vec![
            format!("{in_255ths}/255").as_str().into(),
            (100.0 * within).into(),
            (255.0 * most).into(),
            (100.0 * kept.counts.unresolved as f64 / off.len() as f64).into(),
            kept.rays_per_pixel().into(),
            grid.as_str().into(),
            rays.into(),
            (100.0 * share).into(),
            (255.0 * bound).into(),
            (255.0 * by_cuts).into(),
            (100.0 * cut.counts.rays() as f64 / uncut.counts.rays().max(1) as f64).into(),
        ]);
        let point = |y: f64| Point { x: f64::from(in_255ths), y: 255.0 * y, ..Point::default() };
        cuts.push(point(by_cuts));
        bounds.push(point(bound));
        found.push(point(most));
    }
    let series = |label: &str, points: Vec<Point>| Series { label: label.into(), points, joined: true };
    let ends = [errors[0], errors[errors.len() - 1]].map(|error| (f64::from(error), f64::from(error)));
    let least = shares.iter().copied().fold(f64::INFINITY, f64::min);
    let most = shares.iter().copied().fold(0.0, f64::max);
    Ok(Found {
        name: "error".into(),
        title: format!("{}: whether the error is kept", scene.name),
        says: vec![
            format!(
                "Cutting rays {} within the bound that is proved, in every pixel.",
                if proved { "stays" } else { "does NOT stay" }
            ),
            format!(
                "95 % of the pixels {} within the error that was promised, as compared with {} rays to a pixel, for {} to {} % of \
                 the rays of a grid without cuts that is as good.",
                if kept_everywhere { "are" } else { "are NOT always" },
                finest * finest,
                short(100.0 * least),
                short(100.0 * most),
            ),
        ],
        charts: vec![Chart {
            file: "error".into(),
            title: format!("{}: error found against error promised (below the line is kept)", scene.name),
            x: Axis::log("error promised, in 255ths of linear light"),
            y: Axis::log("error found, in 255ths of linear light (lower is better)"),
            series: vec![
                series("error that 95 % of the pixels keep, all in all", found),
                series("bound proved for what is cut", bounds),
                series("largest error of a pixel by what is cut", cuts),
            ],
            guides: vec![Guide { label: "what is promised".into(), ends }],
            smaller_is_better: false,
        }],
        table,
        pictures: vec![],
        about: None,
    })
}

/// Edge of a block of pixels: so large that pixels share most corners, as they do in a whole picture.
const BLOCK: u32 = 8;

/// Blocks of pixels that are spread over a picture; the whole picture if it is as small.
fn blocks(width: u32, height: u32, effort: Effort) -> Vec<Region> {
    let (across, down) = if effort.quick { (4, 3) } else { (5, 4) };
    if width <= across * BLOCK || height <= down * BLOCK {
        return vec![Region::whole(width, height)];
    }
    let middle = |i: u32, of: u32, len: u32| (len - BLOCK) * (2 * i + 1) / (2 * of);
    let block = |i: u32| Region {
        x: middle(i % across, across, width),
        y: middle(i / across, down, height),
        width: BLOCK,
        height: BLOCK,
    };
    (0..across * down).map(block).collect()
}

/// Pixels of blocks.
struct Sampled {
    pixels: Vec<[f32; 3]>,
    counts: Counts,
}

impl Sampled {
    fn of(snapshot: &Snapshot, blocks: &[Region]) -> Self {
        let draw = |block: &Region| render(snapshot, &Options { region: Some(*block), ..Options::default() });
        let frames: Vec<_> = blocks.par_iter().with_max_len(1).map(draw).collect();
        let mut sampled = Self { pixels: vec![], counts: Counts::default() };
        for frame in frames {
            sampled.pixels.extend(frame.picture.pixels);
            sampled.counts += frame.counts;
        }
        sampled
    }

    fn rays_per_pixel(&self) -> f64 {
        self.counts.rays() as f64 / self.pixels.len() as f64
    }

    /// The largest error of a channel, pixel by pixel.
    fn errors(&self, reference: &Self) -> Vec<f64> {
        let largest =
            |(a, b): (&[f32; 3], &[f32; 3])| a.iter().zip(b).map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max);
        reference.pixels.iter().zip(&self.pixels).map(largest).collect()
    }

    fn share_within(&self, error: f64, reference: &Self) -> f64 {
        let off = self.errors(reference);
        off.iter().filter(|off| **off <= error).count() as f64 / off.len() as f64
    }
}
/// The tables of several scenes in one.
pub(super) fn kept_in_all(studies: &[&Found]) -> Found {
    let mut table = Table { columns: vec!["scene".into()], rows: vec![] };
    table.columns.extend(studies.iter().take(1).flat_map(|study| study.table.columns.iter().cloned()));
    let (mut not_kept, mut dearer) = (vec![], vec![]);
    for study in studies {
        let scene = study.about.as_deref().unwrap_or_default();
        for row in &study.table.rows {
            let is = |column: &str, wanted: fn(f64) -> bool| {
                let at = study.table.columns.iter().position(|name| name == column);
                at.is_some_and(|at| matches!(row[at], Cell::Number(number) if wanted(number)))
            };
            if is(WITHIN, |share| share < 100.0 * CONFIDENCE) && !not_kept.contains(&scene) {
                not_kept.push(scene);
            }
            if is(OF_GRID, |share| share > 100.0) && !dearer.contains(&scene) {
                dearer.push(scene);
            }
            table.rows.push(core::iter::once(scene.into()).chain(row.iter().cloned()).collect());
        }
    }
    let but = |scenes: &[&str]| if scenes.is_empty() { String::new() } else { format!(" but {}", scenes.join(", ")) };
    Found {
        name: "errors".into(),
        title: "All scenes: whether the error is kept".into(),
        says: vec![
            format!("95 % of the pixels are within the error promised in all scenes{}.", but(&not_kept)),
            format!("It takes fewer rays than the smallest grid that is as good in all{}.", but(&dearer)),
        ],
        table,
        ..Found::default()
    }
}
