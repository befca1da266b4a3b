//! All settings side by side, with advice.

use super::{Error, Found, Hindrance, Scene, antialias, rays_against_error, time_against_error};
use crate::{
    advice,
    measure::{self, Effort, Measured, measure},
    table::{Cell, Table},
};
use bevy_ecs::prelude::*;
use snell_components::{
    light::DiskLight,
    settings::{Antialias, Settings},
};

pub(super) fn study(scene: &mut Scene, effort: Effort) -> Result<Found, Hindrance> {
    let reference = measure::picture(&*scene.converged(effort)?);
    let mut candidates = antialias::candidates(scene, effort)?;
    candidates.push(scene.candidate(effort, "as the scene says", "the scene", |_| {})?);
    // The scene's own light, depth and background belong to it; the rest is what it gets that says nothing.
    let plain = Settings::default();
    let mut as_default = |label: &str, change: fn(&mut Settings)| {
        scene.candidate(effort, "defaults, and one of them changed", label, |settings| {
            (settings.antialias, settings.cutoff, settings.error) = (plain.antialias, plain.cutoff, plain.error);
            change(settings);
        })
    };
    let mut default = as_default("defaults", |_| {})?;
    default.default = true;
    candidates.push(default);
    candidates.push(as_default("cut-off 1/255", |settings| settings.cutoff = 1.0 / 255.0)?);
    candidates.push(as_default("cut-off 0.02", |settings| settings.cutoff = 0.02)?);
    candidates.push(as_default("half the depth", |settings| settings.depth /= 2)?);
    if !effort.quick {
        for depth in [1, 2, 4] {
            candidates.push(scene.candidate(
                effort,
                "four rays, less depth",
                format!("depth {depth}"),
                |settings| {
                    (settings.antialias, settings.error) = (Antialias::Four, 0.0);
                    settings.depth = depth.min(settings.depth);
                },
            )?);
        }
        for cutoff in [0.1, 0.02, 0.0001] {
            candidates.push(scene.candidate(
                effort,
                "four rays, other cut-off",
                format!("cut-off {cutoff}"),
                |settings| {
                    (settings.antialias, settings.cutoff, settings.error) = (Antialias::Four, cutoff, 0.0);
                },
            )?);
        }
        if scene.has_soft_lights() {
            for error in [0.1, 0.003] {
                let label = format!("light error {error}");
                let mut candidate = scene.candidate(effort, "four rays, other samples of lights", label, |_| {})?;
                candidate.snapshot = scene.with(effort, |world| {
                    for mut light in world.query::<&mut DiskLight>().iter_mut(world) {
                        light.error = error;
                    }
                    let settings = &mut *world.resource_mut::<Settings>();
                    (settings.antialias, settings.error) = (Antialias::Four, 0.0);
                })?;
                candidates.push(candidate);
            }
        }
    }
    let measured = measure(&candidates, &reference, effort);
    let title = |what: &str| format!("{}: settings, {what}", scene.name);
    let mut says = vec![on_the_front(&measured)];
    says.extend(advice::sentences(&measured));
    Ok(Found {
        name: "settings".into(),
        title: title("speed against accuracy"),
        says,
        charts: vec![
            time_against_error("settings-rmse", &title("time against error"), &measured, Error::Rmse),
            time_against_error("settings-flip", &title("time against how different it looks"), &measured, Error::Flip),
            rays_against_error("settings-rays", &title("rays against error"), &measured, Error::Rmse),
        ],
        table: measure::table(&measured),
        pictures: pictures(&measured, reference),
        about: None,
    })
}

/// Whether the defaults are beaten, by counts of rays, which no noise disturbs, and error.
fn on_the_front(measured: &[Measured]) -> String {
    let Some(default) = measured.iter().find(|m| m.default) else { return String::new() };
    let points: Vec<_> = measured.iter().map(|m| (m.counts.rays() as f64, m.difference.rmse)).collect();
    match better(&points, (default.counts.rays() as f64, default.difference.rmse)) {
        None => "The default settings lie on the Pareto front of rays and error: nothing tried here has a smaller error with as few rays.".into(),
        Some(at) => format!(
            "The default settings are beaten by {} ({} and {:.1} rays per pixel against {} and {:.1}): {WHY}",
            measured[at].label,
            measure::in_short(&measured[at]),
            per_pixel(&measured[at]),
            measure::in_short(default),
            per_pixel(default),
        ),
    }
}

const WHY: &str =
    "the default cut-off, 0.001, follows rays that one ray to a pixel is too coarse to show, and that show with more.";

fn per_pixel(m: &Measured) -> f64 {
    m.counts.rays() as f64 / m.picture.pixels.len().max(1) as f64
}

/// Which of some points of rays and error beats one, with the least error, if any does.
fn better(points: &[(f64, f64)], one: (f64, f64)) -> Option<usize> {
    let beats = |(_, p): &(usize, &(f64, f64))| p.0 <= one.0 && p.1 <= one.1 && **p != one;
    points.iter().enumerate().filter(beats).min_by(|a, b| a.1.1.total_cmp(&b.1.1)).map(|(at, _)| at)
}

/// Whether the defaults are on the front, scene by scene.
pub(super) fn defaults_of_all(studies: &[&Found]) -> Found {
    let mut table = Table::new(&[
        "scene",
        "rays per pixel with the defaults",
        "RMSE",
        "what beats them",
        "its rays per pixel",
        "its RMSE",
        "more of error with the defaults, %",
    ]);
    let mut beaten = 0;
    for study in studies {
        let column = |name: &str| study.table.columns.iter().position(|column| column == name);
        let (Some(rays), Some(rmse)) = (column("rays per pixel"), column("RMSE")) else { continue };
        let number = |cell: &Cell| if let Cell::Number(number) = cell { *number } else { f64::NAN };
        let label = |row: &[Cell]| row[1].to_string();
        let points: Vec<_> = study.table.rows.iter().map(|row| (number(&row[rays]), number(&row[rmse]))).collect();
        let Some(default) = study.table.rows.iter().position(|row| label(row).ends_with("(default)")) else { continue };
        let one = points[default];
        let mut row: Vec<Cell> = vec![study.about.as_deref().unwrap_or_default().into(), one.0.into(), one.1.into()];
        match better(&points, one) {
            None => row.extend(["nothing", "", "", ""].map(Cell::from)),
            Some(at) => {
                beaten += 1;
                row.push(label(&study.table.rows[at]).as_str().into());
                row.extend([points[at].0, points[at].1, 100.0 * (one.1 / points[at].1 - 1.0)].map(Cell::from));
            }
        }
        table.rows.push(row);
    }
    let on = table.rows.len() - beaten;
    Found {
        name: "defaults".into(),
        title: "All scenes: whether the default settings lie on the Pareto front".into(),
        says: vec![
            format!("They do in {on} of {} scenes, by rays and RMSE.", table.rows.len()),
            format!("In the others {WHY}"),
        ],
        table,
        ..Found::default()
    }
}

/// The reference, the defaults, and the best.
fn pictures(
    measured: &[Measured],
    reference: snell_systems::render::Picture,
) -> Vec<(String, snell_systems::render::Picture)> {
    let mut pictures = vec![("the reference".to_string(), reference)];
    let best = measured.iter().min_by(|a, b| a.difference.rmse.total_cmp(&b.difference.rmse));
    for m in measured.iter().find(|m| m.default).into_iter().chain(best) {
        pictures.push((format!("{}: {}", m.label, measure::in_short(m)), m.picture.clone()));
    }
    pictures
}
