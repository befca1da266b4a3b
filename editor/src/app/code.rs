//! A scene as a Rust program that builds it.

use snell::{
    Renderer,
    components::{
        color::Rgb,
        describe::{Describe, FieldVisitor, Spec, Value},
        name::Name,
        settings::Settings,
        transform::Step,
    },
    prelude::DVec3,
    systems::{
        registry::{AnyComponent, Kind, Registry},
        save::fields,
        scene::{Scene, Thing, is_of_model},
    },
};
use std::collections::{BTreeMap, BTreeSet};

/// Components that are tuples.
const TUPLES: &[&str] =
    &["Absorption", "Ambient", "Color", "Diffuse", "MediumRank", "Mirror", "Transform", "Transmission"];

/// Types of words, by field.
const WORDS: &[(&str, &str)] = &[
    ("antialias", "Antialias"),
    ("arrangement", "Arrangement"),
    ("emission", "Emission"),
    ("encoding", "snell::components::color::Encoding"),
    ("fall_off", "FallOff"),
    ("shading", "Shading"),
];

/// A program that builds a scene and renders it. Things that a program can only take from files are read from scene text.
pub(super) fn rust(scene: &Scene, registry: &Registry) -> String {
    let things: Vec<_> = scene.things.iter().filter(|(name, _)| !is_of_model(name)).collect();
    let body = built(scene, &things).unwrap_or_else(|| read(scene, registry));
    let (uses, with) = outside(&things, registry);
    format!(
        "{uses}use snell::{{components::name::Name, prelude::*, systems::image}};\n\n\
         /// The scene.\npub fn scene() -> Result<Renderer, Box<dyn std::error::Error>> {{\n    \
         let mut renderer = Renderer::new(){with};\n{body}    Ok(renderer)\n}}\n\n\
         fn main() -> Result<(), Box<dyn std::error::Error>> {{\n    \
         let snapshot = scene()?.snapshot()?;\n    let frame = render(&snapshot, &Options::default());\n    \
         let metadata = image::Metadata::of(&frame, &snapshot.settings, \"scene\".as_ref());\n    \
         image::write(\"scene.png\".as_ref(), image::Format::Png8, &frame.picture, &metadata)?;\n    Ok(())\n}}\n"
    )
}

/// What a program must say of shapes, lights and textures that are not Snell's: where they come from, and that it has them.
fn outside(things: &[&(Name, std::sync::Arc<Thing>)], registry: &Registry) -> (String, String) {
    let renderer = Renderer::new();
    let known = renderer.world.resource::<Registry>();
    let tags: BTreeSet<&str> = things.iter().flat_map(|(_, thing)| thing.components.keys().copied()).collect();
    let (mut uses, mut with) = (String::new(), String::new());
    for tag in tags.into_iter().filter(|tag| known.get(tag).is_none()) {
        let verb = match registry.get(tag).map(|entry| entry.kind) {
            Some(Kind::Shape) => "with_primitive",
            Some(Kind::Light) => "with_light",
            Some(Kind::Texture) => "with_texture",
            _ => continue,
        };
        uses += &format!("// `{tag}` is not Snell's: bring it in here with `use`.\n");
        with += &format!(".{verb}::<{tag}>()");
    }
    (uses, with)
}

/// The scene read from its text.
fn read(scene: &Scene, registry: &Registry) -> String {
    match scene.to_text(registry) {
        Ok(text) => format!("    let text = r##\"{text}\"##;\n    renderer.load_text(text, \"scene.ron\")?;\n"),
        Err(why) => why.0.iter().map(|line| format!("    // {line}\n")).collect(),
    }
}

/// The scene built thing by thing; none if that cannot be said.
fn built(scene: &Scene, things: &[&(Name, std::sync::Arc<Thing>)]) -> Option<String> {
    let mut code = String::new();
    let default = fields(&AsComponent(Settings::default()), scene.settings.encoding);
    let now = fields(&AsComponent(scene.settings.clone()), scene.settings.encoding);
    let other: Vec<&str> = now.iter().zip(&default).filter(|(a, b)| a != b).map(|(field, _)| field.name).collect();
    if !other.is_empty() {
        let written = Expressions::of(&mut scene.settings.clone())?;
        let lines = written.iter().filter(|(name, _)| other.contains(name));
        let lines: String = lines.map(|(name, text)| format!("        {name}: {text},\n")).collect();
        code += &format!("    *renderer.settings() = Settings {{\n{lines}        ..Settings::default()\n    }};\n");
    }
    code += "    let world = &mut renderer.world;\n";
    let mut variables: BTreeMap<&Name, String> = BTreeMap::new();
    for (number, (name, _)) in things.iter().enumerate() {
        variables.insert(name, format!("{}_{number}", variable(name.as_str())));
    }
    let is_needed = |name: &Name| {
        things.iter().any(|(_, thing)| thing.made_of.as_ref() == Some(name) || thing.parent.as_ref() == Some(name))
    };
    // Those that others refer to come first.
    let mut left: Vec<_> = things.to_vec();
    let mut known: Vec<&Name> = vec![];
    while !left.is_empty() {
        let is_ready = |thing: &Thing| {
            [&thing.made_of, &thing.parent].iter().all(|link| link.as_ref().is_none_or(|to| known.contains(&to)))
        };
        let at = left.iter().position(|(_, thing)| is_ready(thing))?;
        let (name, thing) = left.remove(at);
        let mut parts = vec![format!("Name::new({:?})", name.as_str())];
        for component in thing.components.values() {
            parts.push(expression(component.as_ref())?);
        }
        let link = |tag: &str, to: &Option<Name>| Some(format!("{tag}({})", variables.get(to.as_ref()?)?));
        parts.extend(link("MadeOf", &thing.made_of));
        parts.extend(link("ChildOf", &thing.parent));
        let binding = if is_needed(name) { format!("let {} = ", variables.get(name)?) } else { String::new() };
        let end = if binding.is_empty() { ");" } else { ").id();" };
        let line = format!("    {binding}world.spawn(({})", parts.join(", "));
        if line.chars().count() < 110 {
            code += &format!("{line}{end}\n");
        } else {
            let parts: String = parts.iter().map(|part| format!("        {part},\n")).collect();
            code += &format!("    {binding}world.spawn((\n{parts}    ){end}\n");
        }
        known.push(name);
    }
    Some(code)
}

/// Settings as if they were a component: they have the same description.
#[derive(Clone)]
struct AsComponent(Settings);

impl AnyComponent for AsComponent {
    fn tag(&self) -> &'static str {
        Settings::TAG
    }

    fn visit(&mut self, fields: &mut dyn FieldVisitor) {
        self.0.describe(fields);
    }

    fn validate(&self) -> Result<(), snell::components::describe::Fault> {
        self.0.check()
    }

    fn copy(&self) -> Box<dyn AnyComponent> {
        Box::new(self.clone())
    }

    fn insert(self: Box<Self>, _: &mut snell::prelude::EntityWorldMut<'_>) {}

    fn as_any(&self) -> &dyn std::any::Any {
        &self.0
    }
}

/// A name for a variable.
fn variable(name: &str) -> String {
    let plain: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' }).collect();
    let plain = plain.trim_matches('_');
    if plain.starts_with(|c: char| c.is_ascii_alphabetic()) { plain.into() } else { format!("thing_{plain}") }
}

/// A component as an expression; none if it names files or words whose type is not known.
fn expression(component: &dyn AnyComponent) -> Option<String> {
    let tag = component.tag();
    let kind = if tag == "Box" { "Cuboid" } else { tag };
    let all = Expressions::of_any(component)?;
    if TUPLES.contains(&tag) {
        return Some(format!("{kind}({})", all.first()?.1));
    }
    let fields: Vec<_> = all.iter().map(|(name, text)| format!("{name}: {text}")).collect();
    Some(format!("{kind} {{ {} }}", fields.join(", ")))
}

/// Fields as expressions.
struct Expressions(Option<Vec<(&'static str, String)>>);

impl Expressions {
    fn of(described: &mut impl Describe) -> Option<Vec<(&'static str, String)>> {
        let mut this = Self(Some(vec![]));
        described.describe(&mut this);
        this.0
    }

    fn of_any(component: &dyn AnyComponent) -> Option<Vec<(&'static str, String)>> {
        let mut this = Self(Some(vec![]));
        component.copy().visit(&mut this);
        this.0
    }
}

impl FieldVisitor for Expressions {
    fn field(&mut self, name: &'static str, value: Value<'_>, _: Spec) {
        let text = match value {
            Value::Number(x) => Some(format!("{x:?}")),
            Value::OptionalNumber(x) => Some(format!("{x:?}")),
            Value::Integer(x) => Some(x.to_string()),
            Value::Bool(x) => Some(x.to_string()),
            Value::Vector(v) => Some(vector(*v)),
            Value::OptionalVector(v) => Some(v.map_or("None".into(), |v| format!("Some({})", vector(v)))),
            Value::Vectors(all) => Some(list("vec!", all.iter().map(|v| vector(*v)))),
            Value::Vectors2(all) => Some(list("vec!", all.iter().map(|v| format!("DVec2::new({:?}, {:?})", v.x, v.y)))),
            Value::Color(color) => Some(rgb(*color)),
            Value::Choice(choice) => {
                let kind = WORDS.iter().find(|(field, _)| *field == name).map(|(_, kind)| kind);
                kind.map(|kind| format!("{kind}::{}", choice.words()[choice.position()]))
            }
            Value::Steps(steps) if name == "transform" => {
                Some(format!("Transform::new({})", list("", steps.iter().map(|at| step(*at)))))
            }
            Value::Steps(steps) => {
                Some(format!("{}.into_iter().collect()", list("", steps.iter().map(|at| step(*at)))))
            }
            Value::Model(_) | Value::Image(_) => None,
        };
        match (text, &mut self.0) {
            (Some(text), Some(all)) => all.push((name, text)),
            _ => self.0 = None,
        }
    }
}

fn list(open: &str, items: impl Iterator<Item = String>) -> String {
    format!("{open}[{}]", items.collect::<Vec<_>>().join(", "))
}

fn vector(v: DVec3) -> String {
    format!("DVec3::new({:?}, {:?}, {:?})", v.x, v.y, v.z)
}

fn rgb(color: Rgb) -> String {
    if color.x == color.y && color.y == color.z {
        return format!("Rgb::splat({:?})", color.x);
    }
    format!("Rgb::new({:?}, {:?}, {:?})", color.x, color.y, color.z)
}

fn step(step: Step) -> String {
    match step {
        Step::Translate(by) => format!("Step::Translate({})", vector(by)),
        Step::Scale(by) => format!("Step::Scale({})", vector(by)),
        Step::RotateX(degrees) => format!("Step::RotateX({degrees:?})"),
        Step::RotateY(degrees) => format!("Step::RotateY({degrees:?})"),
        Step::RotateZ(degrees) => format!("Step::RotateZ({degrees:?})"),
        Step::Rotate { axis, degrees } => format!("Step::Rotate {{ axis: {}, degrees: {degrees:?} }}", vector(axis)),
    }
}
