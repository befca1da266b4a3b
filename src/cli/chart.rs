//! `snell chart`: speed against accuracy, for a scene.

use super::{Console, Failure, args::ChartArguments, draw::of_scene, machine};
use crate::Renderer;
use snell_charts::{
    measure::Effort,
    page,
    study::{ALL, Found, Hindrance, Kind, Scene, Study},
};
use std::path::Path;

/// Measures, draws and tells.
pub(super) fn chart(mut renderer: Renderer, args: &ChartArguments, console: &mut Console<'_>) -> Result<(), Failure> {
    let chosen: Vec<&Study> = ALL.iter().filter(|study| args.chooses(study)).collect();
    let mut effort = if args.quick { Effort::QUICK } else { Effort::FULL };
    effort.width = args.width.unwrap_or(effort.width);
    effort.runs = args.runs.unwrap_or(effort.runs);

    let mut scene = None;
    if let Some(file) = &args.scene {
        let faults = |faults: crate::Faults| Failure::Scene(faults.0.iter().map(ToString::to_string).collect());
        renderer.load(file).map_err(faults)?.iter().for_each(|notice| console.warn(notice));
        scene = Some(Scene::new(name(file), renderer));
    }
    let folder = args
        .output
        .clone()
        .unwrap_or_else(|| format!("{}-charts", args.scene.as_deref().map_or("snell".into(), name)).into());
    std::fs::create_dir_all(&folder).map_err(|why| Failure::Work(format!("{}: {why}", folder.display())))?;

    let mut found: Vec<Found> = vec![];
    for study in chosen {
        console.note(format!("{}: {}", study.name, study.about));
        let outcome = match (study.kind, &mut scene) {
            (Kind::Ready(run), _) => run(effort),
            (Kind::OfScene(run), Some(scene)) => run(scene, effort),
            (Kind::OfScene(_), None) => {
                return Err(Failure::Usage(format!("the study `{}` needs a scene", study.name)));
            }
        };
        match outcome {
            Ok(study) => {
                study
                    .says
                    .iter()
                    .filter(|sentence| !sentence.is_empty())
                    .for_each(|sentence| console.say(format!("  {sentence}")));
                found.push(study);
            }
            // All studies were tried, so one that has nothing to measure is no fault.
            Err(Hindrance::Nothing(why)) if args.study.is_empty() => console.note(format!("  left out: {why}")),
            Err(why) => {
                let what = format!("study `{}`: {why}", study.name);
                return Err(Failure::Scene(vec![
                    args.scene.as_ref().map_or(what.clone(), |scene| of_scene(scene, &what)),
                ]));
            }
        }
    }
    let about = format!(
        "Snell {}, {}; pictures {} pixels wide, medians of {} interleaved runs.",
        env!("CARGO_PKG_VERSION"),
        machine::about(),
        effort.width,
        effort.runs,
    );
    let title = match &args.scene {
        Some(scene) => format!("Speed against accuracy: {}", name(scene)),
        None => "Speed against accuracy".into(),
    };
    let page = page::write(&folder, &title, &about, &found)
        .map_err(|why| Failure::Work(format!("{}: {why}", folder.display())))?;
    console.say(format!("charts, tables and a page that shows them: {}", page.display()));
    Ok(())
}

fn name(scene: &Path) -> String {
    scene.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy().into_owned())
}

impl ChartArguments {
    /// Whether a study is to be done: those that are named; without names those of the scene, or, without a scene, the
    /// ready ones.
    fn chooses(&self, study: &Study) -> bool {
        if self.study.is_empty() {
            matches!(study.kind, Kind::OfScene(_)) == self.scene.is_some()
        } else {
            self.study.iter().any(|name| name == study.name)
        }
    }
}
