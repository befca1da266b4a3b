//! All settings side by side, with advice.

use super::{Error, Found, Hindrance, Scene, antialias, rays_against_error, time_against_error};
use crate::{
    advice,
    measure::{self, Effort, Measured, measure},
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
    let mut default = scene.candidate(effort, "defaults", "defaults", |settings| {
        (settings.antialias, settings.cutoff, settings.error) = (plain.antialias, plain.cutoff, plain.error);
    })?;
    default.default = true;
    candidates.push(default);
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
    let beats = |m: &&Measured| {
        let fewer = m.counts.rays() < default.counts.rays();
        let better = m.difference.rmse < default.difference.rmse;
        m.counts.rays() <= default.counts.rays() && m.difference.rmse <= default.difference.rmse && (fewer || better)
    };
    match measured.iter().filter(beats).min_by(|a, b| a.difference.rmse.total_cmp(&b.difference.rmse)) {
        None => "The default settings lie on the Pareto front of rays and error: nothing tried here has a smaller error with as few rays.".into(),
        Some(better) => format!(
            "The default settings are beaten by {} ({} against {}): their finer cut-off, 0.001, is for what one ray to a pixel \
             cannot show.",
            better.label,
            measure::in_short(better),
            measure::in_short(default)
        ),
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
