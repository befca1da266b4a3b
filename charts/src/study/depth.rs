//! Depth of reflections, and rules for cutting rays.

use super::{Error, Found, Hindrance, Scene, rays_against_error, scene, time_against_error};
use crate::{
    measure::{self, Effort, Measured, measure},
    table::short,
};
use snell_components::settings::Settings;
use snell_systems::compare::Difference;

/// More rays to a pixel than this are not waited for.
const MOST_RAYS: f64 = 3000.0;

/// A name and what it does.
type Rule = (&'static str, fn(&mut Settings));

const RULES: &[Rule] = &[
    ("nothing cut", |settings| (settings.cutoff, settings.error) = (0.0, 0.0)),
    ("weight below 0.001 (the default)", |settings| (settings.cutoff, settings.error) = (0.001, 0.0)),
    ("weight below 1/255", |settings| (settings.cutoff, settings.error) = (1.0 / 255.0, 0.0)),
    ("weight below 0.05", |settings| (settings.cutoff, settings.error) = (0.05, 0.0)),
    ("proved: at most 0.5/255", |settings| settings.error = 1.0 / 255.0),
    ("proved: at most 2/255", |settings| settings.error = 4.0 / 255.0),
];

pub(super) fn study(scene: &mut Scene, effort: Effort) -> Result<Found, Hindrance> {
    let deepest = if effort.quick { 16 } else { 32 };
    // What lights give is the same in all, so that only the trees of rays differ.
    let light_samples = 16;
    let mut with = |depth: u32, rule: fn(&mut Settings)| {
        scene.with(effort, |world| {
            scene::converge_lights(world, light_samples);
            let settings = &mut *world.resource_mut::<Settings>();
            settings.antialias = snell_components::settings::Antialias::Off;
            settings.depth = depth;
            rule(settings);
        })
    };
    let reference = with(deepest, scene::cut_nothing_visible)?;
    if !reference.materials.any_transparent && !reference.materials.all.iter().any(|m| m.effects.iter().any(goes_on)) {
        return Err(Hindrance::Nothing("nothing mirrors or lets light through".into()));
    }
    let reference = measure::picture(&reference);
    let depths: &[u32] = if effort.quick { &[1, 4, 8] } else { &[0, 1, 2, 3, 4, 6, 8, 12, 16, 24] };
    let mut measured: Vec<Measured> = vec![];
    for &(name, rule) in RULES {
        for &depth in depths {
            let candidate = measure::Candidate {
                group: name.into(),
                label: format!("depth {depth}"),
                default: depth == 8 && name.ends_with("(the default)"),
                snapshot: with(depth, rule)?,
                options: snell_systems::render::Options::default(),
            };
            let found = measure(&[candidate], &reference, effort);
            let rays = found.first().map_or(0.0, |m| m.counts.rays() as f64 / reference.pixels.len().max(1) as f64);
            measured.extend(found);
            if rays > MOST_RAYS {
                break;
            }
        }
    }
    let title = format!("{}: depth and cut-off", scene.name);
    Ok(Found {
        name: "depth".into(),
        title: format!("{title}, speed against accuracy"),
        says: says(&measured),
        charts: vec![
            rays_against_error("depth-rays", &format!("{title}, rays against error"), &measured, Error::Rmse),
            time_against_error("depth-time", &format!("{title}, time against error"), &measured, Error::Rmse),
        ],
        table: measure::table(&measured),
        pictures: vec![],
        about: None,
    })
}

fn goes_on(effect: &snell_systems::snapshot::Effect) -> bool {
    matches!(effect, snell_systems::snapshot::Effect::Mirror(_))
}

fn says(measured: &[Measured]) -> Vec<String> {
    let deepest = |rule: &str| measured.iter().rfind(|m| m.group == rule);
    let mut says = vec![];
    let at = |rule: &str, depth: &str| measured.iter().find(|m| m.group == rule && m.label == depth);
    let full = deepest("nothing cut");
    if let Some((full, cut)) = full.and_then(|full| Some((full, at("proved: at most 0.5/255", &full.label)?))) {
        let off = Difference::between(&full.picture, &cut.picture).map_or(0.0, |difference| difference.max);
        says.push(format!(
            "Cutting what provably shows less than 0.5/255 leaves {:.1} of {:.1} rays in a pixel at {}; no channel of a pixel \
             changes by more than {:.2}/255.",
            cut.counts.rays() as f64 / cut.picture.pixels.len().max(1) as f64,
            full.counts.rays() as f64 / full.picture.pixels.len().max(1) as f64,
            full.label,
            255.0 * off,
        ));
    }
    if let Some(default) = measured.iter().find(|m| m.default) {
        says.push(format!(
            "The default, depth 8 and a least weight of 0.001, is off by RMSE {} from depth without end.",
            short(default.difference.rmse)
        ));
    }
    says
}
