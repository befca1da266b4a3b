//! Rays in a pixel: one, four, grids and halving, against many.

use super::{Error, Found, Hindrance, Scene, rays_against_error, time_against_error, times};
use crate::{
    measure::{self, Candidate, Effort, Measured, measure},
    table::short,
};
use snell_components::settings::Antialias;

pub(super) fn study(scene: &mut Scene, effort: Effort) -> Result<Found, Hindrance> {
    let reference = measure::picture(&*scene.converged(effort)?);
    let measured = measure(&candidates(scene, effort)?, &reference, effort);
    let title = |what: &str| format!("{}: rays in a pixel, {what}", scene.name);
    Ok(Found {
        name: "antialias".into(),
        title: title("speed against accuracy"),
        says: says(&measured),
        charts: vec![
            time_against_error("antialias-time", &title("time against error"), &measured, Error::Rmse),
            rays_against_error("antialias-rays", &title("rays against error"), &measured, Error::Rmse),
        ],
        table: measure::table(&measured),
        pictures: vec![],
        about: None,
    })
}

/// Every way of placing rays, at what the scene says otherwise.
pub(super) fn candidates(scene: &mut Scene, effort: Effort) -> Result<Vec<Candidate>, Hindrance> {
    let mut all = vec![];
    for (label, antialias) in [("off", Antialias::Off), ("four", Antialias::Four)] {
        all.push(scene.candidate(effort, "grids", label, |settings| {
            (settings.antialias, settings.error) = (antialias, 0.0);
        })?);
    }
    let grids: &[u32] = if effort.quick { &[4] } else { &[3, 4, 6, 8] };
    for &grid in grids {
        all.push(scene.candidate(effort, "grids", format!("grid:{grid}"), |settings| {
            (settings.antialias, settings.grid, settings.error) = (Antialias::Grid, grid, 0.0);
        })?);
    }
    let halvings: &[(u32, f64)] = if effort.quick {
        &[(2, 0.05)]
    } else {
        &[(1, 0.05), (2, 0.2), (2, 0.05), (2, 0.01), (3, 0.05), (4, 0.05), (4, 0.01)]
    };
    for &(subdivisions, contrast) in halvings {
        let label = format!("adaptive:{subdivisions}:{contrast}");
        all.push(scene.candidate(effort, "halved where corners differ by a contrast", label, |settings| {
            (settings.antialias, settings.error) = (Antialias::Adaptive, 0.0);
            (settings.subdivisions, settings.contrast) = (subdivisions, contrast);
        })?);
    }
    let errors: &[u32] = if effort.quick { &[8] } else { &[32, 16, 8, 4, 2] };
    for &error in errors {
        all.push(within_error(scene, effort, error)?);
    }
    Ok(all)
}

/// Halved, cut and sampled as far as an error in 255ths asks for.
pub(super) fn within_error(scene: &mut Scene, effort: Effort, error: u32) -> Result<Candidate, Hindrance> {
    scene.candidate(effort, "--error: halved, cut and sampled as it asks", format!("error {error}/255"), |settings| {
        (settings.antialias, settings.subdivisions) = (Antialias::Adaptive, 6);
        settings.error = f64::from(error) / 255.0;
    })
}

fn says(measured: &[Measured]) -> Vec<String> {
    let find = |label: &str| measured.iter().find(|m| m.label == label);
    let mut says = vec![];
    if let (Some(grid), Some(halved)) = (find("grid:4"), find("adaptive:2:0.05")) {
        says.push(format!(
            "Halving twice where corners differ comes to RMSE {} with {:.1} rays of all kinds in a pixel, where a grid of 4 by 4, \
             with {:.1}, comes to {}.",
            short(halved.difference.rmse),
            per_pixel(halved),
            per_pixel(grid),
            short(grid.difference.rmse),
        ));
    }
    let best = measured.iter().min_by(|a, b| a.difference.rmse.total_cmp(&b.difference.rmse));
    if let (Some(best), Some(four)) = (best, find("four")) {
        says.push(format!(
            "The most exact is {} with RMSE {}, at {} the time of four rays to a pixel, which have {}.",
            best.label,
            short(best.difference.rmse),
            times(best.seconds, four.seconds),
            short(four.difference.rmse),
        ));
    }
    says
}

fn per_pixel(m: &Measured) -> f64 {
    m.counts.rays() as f64 / m.picture.pixels.len().max(1) as f64
}
