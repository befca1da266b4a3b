//! Filters of textures, against many rays to a pixel.

use super::{Error, Found, Hindrance, Scene, time_against_error};
use crate::{
    measure::{self, Effort, measure},
    table::short,
};
use bevy_ecs::prelude::*;
use snell_components::{
    settings::{Antialias, Settings},
    texture::{Checker, Filter, ImageTexture},
};

const FILTERS: &[(&str, Filter)] = &[
    ("nearest texel", Filter::Nearest),
    ("bilinear", Filter::Bilinear),
    ("trilinear", Filter::Trilinear),
    ("anisotropic", Filter::Anisotropic),
];

pub(super) fn study(scene: &mut Scene, effort: Effort) -> Result<Found, Hindrance> {
    if !scene.has_textures() {
        return Err(Hindrance::Nothing("nothing has a texture".into()));
    }
    let reference = measure::picture(&*scene.converged(effort)?);
    let mut candidates = vec![];
    for (rays, antialias) in
        [("one ray to a pixel", Antialias::Off), ("four rays", Antialias::Four), ("4 by 4 rays", Antialias::Grid)]
    {
        for (label, filter) in FILTERS {
            let mut candidate = scene.candidate(effort, rays, *label, |_| {})?;
            candidate.snapshot = scene.with(effort, |world| {
                for mut texture in world.query::<&mut ImageTexture>().iter_mut(world) {
                    texture.filter = *filter;
                }
                let filtered = matches!(filter, Filter::Trilinear | Filter::Anisotropic);
                for mut texture in world.query::<&mut Checker>().iter_mut(world) {
                    texture.filtered = filtered;
                }
                let settings = &mut *world.resource_mut::<Settings>();
                (settings.antialias, settings.grid, settings.error) = (antialias, 4, 0.0);
            })?;
            candidates.push(candidate);
        }
    }
    let measured = measure(&candidates, &reference, effort);
    let title = format!("{}: filters of textures", scene.name);
    let one = |label: &str| measured.iter().find(|m| m.label == label);
    let says = match (one("nearest texel"), one("anisotropic")) {
        (Some(nearest), Some(filtered)) => vec![
            format!(
                "With one ray to a pixel the nearest texel has RMSE {}, the anisotropic filter {}, for {:.2} times the time.",
                short(nearest.difference.rmse),
                short(filtered.difference.rmse),
                filtered.seconds / nearest.seconds.max(1e-9),
            ),
            "What is left is the edges of objects, which no filter of textures smooths: more rays do.".into(),
        ],
        _ => vec![],
    };
    Ok(Found {
        name: "textures".into(),
        title: format!("{title}, speed against accuracy"),
        says,
        charts: vec![time_against_error(
            "textures-time",
            &format!("{title}, time against error"),
            &measured,
            Error::Rmse,
        )],
        table: measure::table(&measured),
        pictures: vec![],
        about: None,
    })
}
