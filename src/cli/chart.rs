//! `snell chart`: speed against accuracy, for scenes.

use super::{Console, Failure, args::ChartArguments, draw::of_scene, machine};
use crate::Renderer;
use snell_charts::{
    measure::Effort,
    page,
    study::{ALL, Found, Hindrance, Kind, Scene, Study, side_by_side},
};
use std::{fs, path::Path};

/// Measures, draws and tells.
pub(super) fn chart(mut renderer: Renderer, args: &ChartArguments, console: &mut Console<'_>) -> Result<(), Failure> {
    let chosen: Vec<&Study> = ALL.iter().filter(|study| args.chooses(study)).collect();
    if let Some(study) = chosen.iter().find(|study| matches!(study.kind, Kind::OfScene(_)) && args.scenes.is_empty()) {
        return Err(Failure::Usage(format!("the study `{}` needs a scene", study.name)));
    }
    let mut effort = if args.quick { Effort::QUICK } else { Effort::FULL };
    effort.width = args.width.unwrap_or(effort.width);
    effort.runs = args.runs.unwrap_or(effort.runs);
    let title = match &args.scenes[..] {
        [] => "Speed against accuracy".into(),
        scenes => {
            format!("Speed against accuracy: {}", scenes.iter().map(|file| name(file)).collect::<Vec<_>>().join(", "))
        }
    };
    let folder = args.output.clone().unwrap_or_else(|| match args.scenes.first() {
        Some(scene) => format!("{}-charts", name(scene)).into(),
        None => "snell-charts".into(),
    });
    let cannot_write = |why: std::io::Error| Failure::Work(format!("{}: {why}", folder.display()));
    // Before the work, not after it.
    fs::create_dir_all(&folder).map_err(cannot_write)?;

    let mut found: Vec<Found> = vec![];
    for study in chosen.iter().filter(|study| matches!(study.kind, Kind::Ready(_))) {
        if let Kind::Ready(run) = study.kind {
            found.extend(told(study, run(effort), None, true, console)?);
        }
    }
    for file in &args.scenes {
        let faults = |faults: crate::Faults| Failure::Scene(faults.0.iter().map(ToString::to_string).collect());
        renderer.load(file).map_err(faults)?.iter().for_each(|notice| console.warn(notice));
        let mut scene = Scene::new(name(file), renderer);
        for study in &chosen {
            let Kind::OfScene(run) = study.kind else { continue };
            // One that was asked for by name, of one scene, must be possible.
            let must = !args.study.is_empty() && args.scenes.len() == 1;
            let mut done = told(study, run(&mut scene, effort), Some(file), must, console)?;
            if let Some(found) = done.as_mut().filter(|_| args.scenes.len() > 1) {
                found.belongs_to(&scene.name);
            }
            found.extend(done);
        }
        renderer = scene.cleared();
    }
    found.extend(side_by_side(&found));
    let about = format!(
        "Snell {}, {}; pictures {} pixels wide, medians of {} interleaved runs.",
        env!("CARGO_PKG_VERSION"),
        machine::about(),
        effort.width,
        effort.runs,
    );
    let page = page::write(&folder, &title, &about, &found).map_err(cannot_write)?;
    console.say(format!("charts, tables and a page that shows them: {}", page.display()));
    Ok(())
}

/// Tells what a study found, or why it was left out.
fn told(
    study: &Study,
    outcome: Result<Found, Hindrance>,
    scene: Option<&Path>,
    must: bool,
    console: &mut Console<'_>,
) -> Result<Option<Found>, Failure> {
    let of = scene.map_or_else(String::new, |scene| format!(", {}", name(scene)));
    console.note(format!("{}{of}: {}", study.name, study.about));
    match outcome {
        Ok(found) => {
            found
                .says
                .iter()
                .filter(|sentence| !sentence.is_empty())
                .for_each(|sentence| console.say(format!("  {sentence}")));
            Ok(Some(found))
        }
        Err(Hindrance::Nothing(why)) if !must => {
            console.note(format!("  left out: {why}"));
            Ok(None)
        }
        Err(why) => {
            let what = format!("study `{}`: {why}", study.name);
            Err(Failure::Scene(vec![scene.map_or(what.clone(), |scene| of_scene(scene, &what))]))
        }
    }
}

fn name(scene: &Path) -> String {
    scene.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy().into_owned())
}

impl ChartArguments {
    /// Whether a study is to be done: those that are named; without names those of the scenes, or, without a scene, the
    /// ready ones.
    fn chooses(&self, study: &Study) -> bool {
        if self.study.is_empty() {
            matches!(study.kind, Kind::OfScene(_)) != self.scenes.is_empty()
        } else {
            self.study.iter().any(|name| name == study.name)
        }
    }
}
