//! Components: their fields are read through their own descriptions, whatever their type.

use super::{
    node::{Field, Form, Node},
    source::{Place, Report, Source, beside},
    values::{Values, argument, check_names},
};
use crate::load::assets::Assets;
use glam::DAffine3;
use snell_components::{
    describe::{Fault, FieldVisitor, Spec, Value},
    transform::Transform,
};
use std::path::Path;

/// What stands in a component's parentheses.
#[derive(Clone, Copy, Debug)]
pub(super) enum Given<'s> {
    /// Nothing.
    Nothing,
    /// Fields by name.
    Named(&'s [Field]),
    /// The value of the only field, or of the first, if no other must be given.
    Value(&'s Node),
}

impl<'s> Given<'s> {
    /// What is given with a tag.
    pub(super) fn of(node: &'s Node) -> Self {
        match &node.form {
            Form::Tagged(_, inner) => match &inner.form {
                Form::Fields(fields) => Self::Named(fields),
                _ => argument(node).map_or(Self::Nothing, Self::Value),
            },
            _ => Self::Nothing,
        }
    }
}

/// A component as written.
#[derive(Clone, Copy)]
pub(super) struct Written<'s> {
    pub(super) source: &'s Source,
    /// Where it starts.
    pub(super) place: Place,
    pub(super) given: Given<'s>,
}

/// What was read.
pub(super) struct Filled<T> {
    /// The component, or what puts it on its entity.
    pub(super) value: T,
    /// The matrix of the steps it holds.
    pub(super) placement: Option<DAffine3>,
    /// The number of the model it holds.
    pub(super) model: Option<usize>,
}

/// Fills what `describe` shows; `subject` says in messages whose it is. Nothing if something is wrong, which is
/// reported.
pub(super) fn fill<T>(
    written: Written<'_>,
    subject: &str,
    assets: &mut Assets,
    report: &mut Report,
    describe: impl FnOnce(&mut dyn FieldVisitor) -> (T, Result<(), Fault>),
) -> Option<Filled<T>> {
    let values = Values { text: &written.source.text, encoding: assets.encoding, faults: vec![] };
    let mut reader = Reader {
        written,
        values,
        assets,
        described: vec![],
        required: 0,
        first_required: false,
        missing: vec![],
        placement: None,
        model: None,
    };
    let (value, checked) = describe(&mut reader);
    reader.check_given();
    if let Err(fault) = checked
        && reader.values.faults.is_empty()
    {
        let offset = reader.find(fault.field).map_or(written.place.offset, |node| node.span.start);
        reader.values.faults.push((offset, format!(".{}: expected {}", fault.field, fault.expected)));
    }
    let Reader { values, placement, model, .. } = reader;
    let sound = values.faults.is_empty();
    for (offset, message) in values.faults {
        report.add(Place { offset, ..written.place }, format!("{subject}{message}"));
    }
    sound.then_some(Filled { value, placement, model })
}

/// Fills the fields of one component.
struct Reader<'a, 's> {
    written: Written<'s>,
    values: Values<'s>,
    assets: &'a mut Assets,
    /// The fields seen so far.
    described: Vec<&'static str>,
    /// How many of them must be given.
    required: usize,
    /// Whether the first is one of those.
    first_required: bool,
    /// Fields that must be given and are not, with their meanings.
    missing: Vec<(&'static str, &'static str)>,
    placement: Option<DAffine3>,
    model: Option<usize>,
}

impl<'s> Reader<'_, 's> {
    /// The value of a field.
    fn find(&self, name: &str) -> Option<&'s Node> {
        match self.written.given {
            Given::Nothing => None,
            Given::Named(fields) => {
                let field = fields.iter().find(|field| field.name(self.values.text) == name);
                field.map(|field| &field.value)
            }
            Given::Value(node) => (self.described.first() == Some(&name)).then_some(node),
        }
    }

    /// Whether the first field must be given and no other, so that it may stand alone without its name.
    fn first_is_enough(&self) -> bool {
        self.required == 1 && self.first_required
    }

    /// Checks what was given against the fields that there are.
    fn check_given(&mut self) {
        let here = self.written.place.offset;
        let fields = match self.written.given {
            Given::Value(_) if self.described.len() != 1 && !self.first_is_enough() => {
                // What the value was taken for does not matter any more.
                let message = match self.described.first() {
                    Some(first) => format!(": expected its fields by name, as `{first}: …`"),
                    None => ": expected no fields".into(),
                };
                self.values.faults = vec![(here, message)];
                return;
            }
            Given::Named(fields) => fields,
            Given::Nothing | Given::Value(_) => &[],
        };
        let faults = check_names(self.values.text, here, fields, &self.described, &self.missing);
        self.values.faults.extend(faults.into_iter().map(|(offset, message)| (offset, format!(": {message}"))));
    }

    /// Reads `value` from what is written.
    fn read(&mut self, node: &'s Node, value: Value<'_>, spec: Spec) {
        let values = &mut self.values;
        match value {
            Value::Number(place) => set(place, values.number(node, spec.range)),
            Value::Integer(place) => set(place, values.integer(node, spec.range)),
            Value::Bool(place) => set(place, values.boolean(node)),
            Value::Vector(place) => set(place, values.vector(node, spec)),
            Value::Color(place) => set(place, values.color(node, spec.range)),
            Value::Choice(place) => {
                if let Some(position) = values.choice(node, place.words()) {
                    place.choose(position);
                }
            }
            Value::OptionalNumber(place) => {
                *place = optional(node, values.text).and_then(|node| values.number(node, spec.range));
            }
            Value::OptionalVector(place) => {
                *place = optional(node, values.text).and_then(|node| values.vector(node, spec));
            }
            Value::Vectors(place) => {
                set(place, values.list(node, "a list of vectors `[(x, y, z), …]`", |v, item| v.vector(item, spec)));
            }
            Value::Vectors2(place) => {
                set(place, values.list(node, "a list of pairs `[(u, v), …]`", |v, item| v.vector2(item, spec)));
            }
            Value::Steps(place) => {
                if let Some(steps) = values.steps(node) {
                    self.placement = Some(Transform(steps.clone()).matrix());
                    *place = steps;
                }
            }
            Value::Model(place) => {
                let number = self.file(node, |assets, file, path| assets.model(file, path));
                self.model = number.as_ref().and_then(|(_, number)| *number);
                if let Some((path, _)) = number {
                    place.path = path;
                }
                place.data = self.model.and_then(|number| self.assets.model_at(number)).map(|(_, m)| m.mesh.clone());
            }
            Value::Image(place) => {
                if let Some((path, image)) = self.file(node, |assets, file, _| assets.image(file)) {
                    place.path = path;
                    place.data = image;
                }
            }
        }
    }

    /// The path in quotes, as seen from the scene's folder, and what `open` makes of the file.
    fn file<T>(
        &mut self,
        node: &Node,
        open: impl FnOnce(&mut Assets, &Path, &str) -> Result<T, String>,
    ) -> Option<(String, T)> {
        let written = self.values.string(node, "a path in quotes")?;
        let source = self.written.source;
        let path = beside(&source.folder, &written);
        let file = source.path.parent().unwrap_or(Path::new("")).join(&written);
        match open(self.assets, &file, &path) {
            Ok(contents) => Some((path, contents)),
            Err(why) => {
                self.values.faults.push((node.span.start, format!("cannot read `{}`: {why}", file.display())));
                None
            }
        }
    }
}

impl FieldVisitor for Reader<'_, '_> {
    fn field(&mut self, name: &'static str, value: Value<'_>, spec: Spec) {
        self.first_required |= spec.required && self.described.is_empty();
        self.required += usize::from(spec.required);
        self.described.push(name);
        match self.find(name) {
            Some(node) => {
                let before = self.values.faults.len();
                self.read(node, value, spec);
                for (_, message) in self.values.faults.iter_mut().skip(before) {
                    message.insert_str(0, &format!(".{name}: "));
                }
            }
            None if spec.required => self.missing.push((name, spec.about)),
            None => {}
        }
    }
}

/// Writes a value that could be read.
fn set<T>(place: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *place = value;
    }
}

/// The value of a field that may be `None`, bare or in `Some`.
fn optional<'n>(node: &'n Node, text: &str) -> Option<&'n Node> {
    match node.tag(text) {
        Some("None") => None,
        Some("Some") => Some(argument(node).unwrap_or(node)),
        _ => Some(node),
    }
}
