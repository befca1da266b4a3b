//! The text of a scene file.

use super::{
    Unsayable,
    value::{Writer, Written, fields, quoted},
};
use crate::{
    registry::{AnyComponent, Kind, Registry},
    scene::{Scene, Thing, is_of_model},
};
use snell_components::{color::Encoding, describe::Describe, name::Name, settings::Settings};
use std::collections::BTreeSet;

/// Longest line that holds an entity whole.
const WIDTH: usize = 120;

/// The text of a scene.
///
/// # Errors
/// All that no scene file can say.
pub fn scene_text(scene: &Scene, registry: &Registry) -> Result<String, Unsayable> {
    let (text, faults) = scene_text_in_part(scene, registry);
    if faults.0.is_empty() { Ok(text) } else { Err(faults) }
}

/// The text of a scene without what no scene file can say, and all of that.
#[must_use]
pub fn scene_text_in_part(scene: &Scene, registry: &Registry) -> (String, Unsayable) {
    let mut faults = Unsayable::default();
    let mut text = String::from("Scene(\n    version: 1,\n");
    let settings = written_settings(&scene.settings, &mut faults);
    if !settings.is_empty() {
        text += &wrapped("    settings: (", &settings, "),\n", "        ");
    }
    text += "    entities: {\n";
    let mut seen = BTreeSet::new();
    for (name, thing) in scene.things.iter().filter(|(name, _)| !is_of_model(name)) {
        if name.as_str().is_empty() || !seen.insert(name) {
            faults.0.push(format!("{:?}: names have at least one character and each stands once", name.as_str()));
            continue;
        }
        let key = quoted(name.as_str()).unwrap_or_default();
        let components = components(name, thing, (registry, scene.settings.encoding), &mut faults);
        text += &wrapped(&format!("        {key}: ["), &components, "],\n", "            ");
    }
    text += "    },\n)\n";
    (text, faults)
}

/// Items on one line, or if that is too long on a line each.
fn wrapped(open: &str, items: &[String], close: &str, indent: &str) -> String {
    let line = format!("{open}{}{close}", items.join(", "));
    if line.trim_end().chars().count() <= WIDTH {
        return line;
    }
    let outer = indent.strip_suffix("    ").unwrap_or_default();
    let items: String = items.iter().map(|item| format!("{indent}{item},\n")).collect();
    format!("{open}\n{items}{outer}{close}")
}

/// The fields of the settings that do not have their default.
fn written_settings(settings: &Settings, faults: &mut Unsayable) -> Vec<String> {
    let encoding = settings.encoding;
    let all = |mut settings: Settings| {
        let mut writer = Writer { fields: vec![], encoding };
        settings.describe(&mut writer);
        writer.fields
    };
    let (written, default) = (all(settings.clone()), all(Settings::default()));
    named(&written, &default, "settings", faults)
}

/// The fields that are to be given, by name.
fn named(written: &[Written], default: &[Written], subject: &str, faults: &mut Unsayable) -> Vec<String> {
    let mut stated = vec![];
    for (field, default) in written.iter().zip(default) {
        match &field.text {
            Ok(_) if field == default && !field.required => {}
            Ok(text) => stated.push(format!("{}: {text}", field.name)),
            Err(why) => faults.0.push(format!("{subject}.{}: {why}", field.name)),
        }
    }
    stated
}

/// What stands in the list of an entity.
fn components(
    name: &Name,
    thing: &Thing,
    (registry, encoding): (&Registry, Encoding),
    faults: &mut Unsayable,
) -> Vec<String> {
    let mut parts: Vec<(Kind, &dyn AnyComponent, _)> = vec![];
    for (tag, component) in &thing.components {
        match registry.get(tag) {
            Some(entry) => parts.push((entry.kind, component.as_ref(), entry)),
            None => faults.0.push(format!("{:?}: {tag} is not known here", name.as_str())),
        }
    }
    parts.sort_by_key(|(kind, component, _)| (*kind, component.tag()));
    let mut texts: Vec<_> = parts
        .into_iter()
        .filter_map(|(_, component, entry)| {
            let subject = format!("{:?}: {}", name.as_str(), component.tag());
            let default = fields((entry.new)().as_ref(), encoding);
            component_text(component.tag(), &fields(component, encoding), &default, &subject, faults)
        })
        .collect();
    let mut relation = |tag: &str, to: &Option<Name>| match to {
        Some(to) if is_of_model(to) => {
            faults.0.push(format!("{:?}: {tag}: {:?} comes with a model's file", name.as_str(), to.as_str()));
        }
        Some(to) => texts.push(format!("{tag}({})", quoted(to.as_str()).unwrap_or_default())),
        None => {}
    };
    relation("MadeOf", &thing.made_of);
    relation("Parent", &thing.parent);
    if let Some(slot) = thing.slots.iter().find(|slot| !is_of_model(slot)) {
        let (name, slot) = (name.as_str(), slot.as_str());
        faults.0.push(format!("{name:?}: {slot:?} is one of its materials by slot, and not of its model's file"));
    }
    texts
}

/// A component: its tag and those fields that are to be given; nothing if one of these cannot be said.
fn component_text(
    tag: &str,
    written: &[Written],
    default: &[Written],
    subject: &str,
    faults: &mut Unsayable,
) -> Option<String> {
    let stated = named(written, default, subject, faults);
    if written.iter().any(|field| field.required && field.text.is_err()) {
        return None;
    }
    Some(match written {
        [Written { text: Ok(only), required: true, .. }] => format!("{tag}({only})"),
        _ if stated.is_empty() => tag.into(),
        _ => format!("{tag}({})", stated.join(", ")),
    })
}
