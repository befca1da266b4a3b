//! Samples of lights with an area, against many.

use super::{Error, Found, Hindrance, Scene, scene, time_against_error};
use crate::{
    chart::{Axis, Chart, Guide, Point, Series},
    fit,
    measure::{self, Effort, Measured, measure},
    table::short,
};
use bevy_ecs::prelude::*;
use snell_components::{light::DiskLight, settings::Settings};

pub(super) fn study(scene: &mut Scene, effort: Effort) -> Result<Found, Hindrance> {
    if !scene.has_soft_lights() {
        return Err(Hindrance::Nothing("no light has an area".into()));
    }
    let fixed = "fixed number of samples";
    let adaptive = "as many as the light's error asks for";
    let reference = measure::picture(
        &*scene.with(effort, |world| scene::converge_lights(world, if effort.quick { 2048 } else { 8192 }))?,
    );
    let mut candidates = vec![];
    let mut samples = 4;
    while samples <= if effort.quick { 64 } else { 1024 } {
        let mut candidate = scene.candidate(effort, fixed, samples.to_string(), |_| {})?;
        candidate.snapshot = scene.with(effort, |world| {
            scene::converge_lights(world, samples);
            world.resource_mut::<Settings>().error = 0.0;
        })?;
        candidates.push(candidate);
        samples *= 2;
    }
    for error in [0.1, 0.03, 0.01, 0.003] {
        let mut candidate = scene.candidate(effort, adaptive, format!("error {error}"), |_| {})?;
        candidate.default = error == DiskLight::default().error;
        candidate.snapshot = scene.with(effort, |world| {
            for mut light in world.query::<&mut DiskLight>().iter_mut(world) {
                (light.error, light.samples) = (error, 4096);
            }
            world.resource_mut::<Settings>().error = 0.0;
        })?;
        candidates.push(candidate);
    }
    let measured = measure(&candidates, &reference, effort);
    let of_group = |group: &str| measured.iter().filter(|m| m.group == group).cloned().collect::<Vec<Measured>>();
    let fixed = of_group(fixed);
    let points: Vec<(f64, f64)> =
        fixed.iter().filter_map(|m| Some((m.label.parse::<f64>().ok()?, m.difference.rmse))).collect();
    let slope = fit::power(&points).map_or(0.0, |line| line.b);
    let title = format!("{}: samples of lights", scene.name);
    Ok(Found {
        name: "lights".into(),
        title: format!("{title}, speed against accuracy"),
        says: vec![
            format!(
                "With a fixed number of samples the error falls with the power {slope:.2} of it; −0.5 is what random samples \
                 give, −0.75 what stratified ones give at edges, −1 where all is smooth."
            ),
            adaptive_says(&of_group(adaptive), &fixed),
        ],
        charts: vec![
            convergence(format!("{title} against error"), &points),
            time_against_error("lights-time", &format!("{title}, time against error"), &measured, Error::Rmse),
        ],
        table: measure::table(&measured),
        pictures: vec![],
        about: None,
    })
}

/// How much the choice of places by error saves.
fn adaptive_says(adaptive: &[Measured], fixed: &[Measured]) -> String {
    let Some(m) = adaptive.iter().find(|m| m.default) else { return String::new() };
    let as_good = fixed.iter().find(|fixed| fixed.difference.rmse <= m.difference.rmse);
    let told = format!("A light that stops at an error of 0.01 has RMSE {}", short(m.difference.rmse));
    match as_good {
        Some(fixed) => format!(
            "{told} with {} million rays; a fixed number needs {} samples everywhere, {} million rays, to be as good.",
            short(m.counts.rays() as f64 / 1e6),
            fixed.label,
            short(fixed.counts.rays() as f64 / 1e6)
        ),
        None => format!("{told}, which no fixed number tried here reaches."),
    }
}

/// Samples against error, with the slopes of theory.
fn convergence(title: String, points: &[(f64, f64)]) -> Chart {
    let guide = |label: &str, exponent: f64| {
        let (first, last) = (*points.first()?, *points.last()?);
        // Through the first point, a little above the others.
        let start = first.1 * 1.3;
        let end = start * snell_components::math::pow(last.0 / first.0, exponent);
        Some(Guide { label: label.into(), ends: [(first.0, start), (last.0, end)] })
    };
    let guides = [guide("slope −1/2: random samples", -0.5), guide("slope −3/4: stratified samples, at edges", -0.75)];
    let point = |(x, y): &(f64, f64)| Point { x: *x, y: *y, ..Point::default() };
    Chart {
        file: "lights-samples".into(),
        title,
        x: Axis::log("samples of each light at each point"),
        y: Axis::log(Error::Rmse.label()),
        series: vec![Series {
            label: "Owen-scrambled Sobol points".into(),
            points: points.iter().map(point).collect(),
            joined: true,
        }],
        guides: guides.into_iter().flatten().collect(),
        smaller_is_better: false,
    }
}
