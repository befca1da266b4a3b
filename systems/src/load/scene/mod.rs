//! Reads scenes: RON text with named entities, each a list of components.
//!
//! In order: the texts of all files ([`mod@include`]), what each says ([`node`], [`document`]), the components of every
//! entity ([`entity`], [`component`], [`values`]; images [`ahead`] of them), what entities take from each other ([`links`]); and only if nothing at
//! all is wrong, the entities in the world ([`spawn`]).

mod source;

mod node;

mod ahead;

mod document;

mod include;

mod values;

mod component;

mod entity;

mod links;

mod spawn;

use super::{
    assets::{Assets, UsedFiles},
    fault::{Faults, Notice},
};
use crate::registry::Registry;
use bevy_ecs::prelude::*;
pub(crate) use document::RESERVED as MODEL_MARK;
pub(crate) use values::LARGEST;

use component::{Given, Written};
use include::Layout;
use node::Form;
use snell_components::{color::Encoding, describe::Describe, settings::Settings};
use source::{Place, Report, Source, excerpt};
use std::{collections::BTreeMap, path::Path};

/// Reads a scene file, and all files it names, into the world: its entities, and its [`Settings`].
///
/// The components that may be named are those in the world's [`Registry`].
///
/// # Errors
/// All that is wrong with the files, in the order of the text; the world is then as it was.
pub fn read_scene(world: &mut World, path: &Path) -> Result<Vec<Notice>, Faults> {
    let mut report = Report::default();
    let sources = include::read_files(path, &mut report)?;
    read(world, &sources, report)
}

/// Reads a scene from memory; `path` stands for its file in messages and where the scene names other files.
///
/// # Errors
/// All that is wrong with the text and the files it names, in the order of the text; the world is then as it was.
pub fn read_scene_text(world: &mut World, text: &str, path: &Path) -> Result<Vec<Notice>, Faults> {
    let mut report = Report::default();
    let sources = include::read_all(path, text.into(), &mut report);
    read(world, &sources, report)
}

/// Checks that a text is RON, whatever it says.
///
/// # Errors
/// The first place where it is not.
pub(super) fn check_syntax(text: &str, path: &Path) -> Result<(), Faults> {
    let Err((offset, message)) = node::parse(text) else { return Ok(()) };
    let mut report = Report::default();
    report.add(Place { file: 0, offset }, message);
    Err(report.into_faults(&[Source::new(path.into(), String::new(), text.into())]))
}

fn read(world: &mut World, sources: &[Source], mut report: Report) -> Result<Vec<Notice>, Faults> {
    let empty = Registry::default();
    let registry = world.get_resource().unwrap_or(&empty);
    let mut assets = Assets::default();
    let settings = read_settings(sources, &mut assets, &mut report);
    let layout = Layout::new(sources, &mut report);
    ahead::decode_images(registry, &layout, sources, &mut assets);
    let mut reader = entity::Reader {
        registry,
        layout: &layout,
        sources,
        assets: &mut assets,
        report: &mut report,
        unknown: BTreeMap::new(),
    };
    let stated: Vec<_> = layout.entities.iter().map(|entity| reader.entity(entity)).collect();
    let wholes = links::complete(&layout, &stated, &mut report);
    if !report.is_empty() || !assets.faults.is_empty() {
        let mut faults = report.into_faults(sources);
        faults.0.append(&mut assets.faults);
        return Err(faults);
    }
    let ready = spawn::prepare(sources, layout, &stated, wholes);
    spawn::spawn(world, ready, &assets);
    world.insert_resource(settings);
    let scenes = sources.iter().map(|source| source.path.clone());
    world.insert_resource(UsedFiles(scenes.chain(assets.files()).collect()));
    Ok(assets.notices)
}

/// The settings of the scene; those of included files are a fault.
fn read_settings(sources: &[Source], assets: &mut Assets, report: &mut Report) -> Settings {
    let mut settings = Settings::default();
    for (file, source) in sources.iter().enumerate() {
        let Some(node) = &source.document.settings else { continue };
        let place = Place { file, offset: node.span.start };
        let given = match &node.form {
            _ if file > 0 => {
                report.add(place, "settings: an included file has none: they belong to the scene");
                continue;
            }
            Form::Fields(fields) => Given::Named(fields),
            Form::Tuple(items) if items.is_empty() => Given::Nothing,
            _ => {
                let found = excerpt(node.text(&source.text));
                report.add(place, format!("settings: expected `(width: …, height: …)`, found {found}"));
                continue;
            }
        };
        let written = Written { source, place, given };
        assets.encoding = encoding(source, given);
        let filled = component::fill(written, "settings", assets, report, |fields| {
            let mut settings = Settings::default();
            settings.describe(fields);
            let checked = settings.check();
            (settings, checked)
        });
        settings = filled.map_or(settings, |filled| filled.value);
    }
    settings
}

/// What colours mean, the background among the settings included, so it is looked up before anything is read; a fault in
/// it is told with those of the other settings.
fn encoding(source: &Source, given: Given<'_>) -> Encoding {
    let Given::Named(fields) = given else { return Encoding::default() };
    let field = fields.iter().find(|field| field.name(&source.text) == "encoding");
    match field.and_then(|field| field.value.tag(&source.text)) {
        Some("Raw") => Encoding::Raw,
        _ => Encoding::Srgb,
    }
}

#[cfg(test)]
mod tests;
