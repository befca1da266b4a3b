//! Fields: extreme values, and reading from text.

use super::{Report, watch::Watch};
use crate::{
    load::{self, Faults},
    registry::{Kind, Registry},
};
use bevy_ecs::prelude::*;
use glam::{DAffine3, DVec3};
use snell_components::{
    describe::{Describe, FieldVisitor, Spec, Value},
    primitive::{Cost, Extent, Primitive},
    settings::Settings,
    space::Ray,
};
use std::panic::{AssertUnwindSafe, catch_unwind};

pub(super) fn check<P: Primitive + Clone>(shape: &P, name: &str, watch: &Watch, report: &mut Report) {
    check_extremes(shape, name, watch, report);
    check_text(shape, Kind::Shape, name, report);
}

/// Writes a component as a scene file has it and reads it again, sound and with faults.
pub(super) fn check_text<C: Describe + Component>(component: &C, kind: Kind, name: &str, report: &mut Report) {
    let fields = fields_of(component.clone());
    if fields.iter().any(|field| field.text.is_none()) {
        // Models and images lie in files; nothing in memory names them.
        return;
    }
    let written = |fields: &[Field]| {
        let fields = fields.iter().filter_map(|field| Some(format!("{}: {}", field.name, field.text.as_ref()?)));
        format!("{}({})", C::TAG, fields.collect::<Vec<_>>().join(", "))
    };
    let mut compare = |fields: &[Field], read: Result<Option<C>, Faults>| match read {
        Err(faults) => report.add("text", name, format!("`{}` is not read: {faults}", written(fields))),
        Ok(None) => report.add("text", name, "the component is not on its entity"),
        Ok(Some(read)) => {
            let again = fields_of(read);
            if let Some((a, b)) = fields.iter().zip(&again).find(|(a, b)| a.text != b.text) {
                let (field, a, b) = (a.name, a.text.as_deref(), b.text.as_deref());
                report.add("text", name, format!("`{field}` was written as {a:?} and read as {b:?}"));
            }
        }
    };
    compare(&fields, read(&written(&fields), kind));
    // Other numbers than those at hand: a field that is not read may have its value by chance.
    let others: Vec<_> = fields.iter().map(Field::with_another_number).collect();
    let read_others = read(&written(&others), kind);
    // They may not go together.
    if read_others.is_ok() {
        compare(&others, read_others);
    }
    check_faults::<C>(&fields, kind, name, report);
}

/// One field of a component.
#[derive(Clone)]
struct Field {
    name: &'static str,
    /// The value as in a scene file; none for files, and for what was left out.
    text: Option<String>,
    spec: Spec,
    /// Whether it is a single number.
    is_number: bool,
}

impl Field {
    /// The field with three quarters of its number, if it is one that may be so small.
    fn with_another_number(&self) -> Self {
        let number = self.text.as_deref().filter(|_| self.is_number).and_then(|text| text.parse::<f64>().ok());
        let other = number.map(|number| 0.75 * number).filter(|other| self.spec.range.contains(*other));
        Self { text: other.map(|other| format!("{other:?}")).or(self.text.clone()), ..self.clone() }
    }
}

fn fields_of<D: Describe>(mut shape: D) -> Vec<Field> {
    struct Fields(Vec<Field>);
    impl FieldVisitor for Fields {
        fn field(&mut self, name: &'static str, value: Value<'_>, spec: Spec) {
            let is_number = matches!(value, Value::Number(_));
            self.0.push(Field { name, text: text(&value), spec, is_number });
        }
    }
    let mut fields = Fields(vec![]);
    shape.describe(&mut fields);
    fields.0
}

/// A value as in a scene file.
fn text(value: &Value<'_>) -> Option<String> {
    let vector = |v: &DVec3| format!("({:?}, {:?}, {:?})", v.x, v.y, v.z);
    Some(match value {
        Value::Number(x) => format!("{x:?}"),
        Value::OptionalNumber(x) => x.map_or("None".into(), |x| format!("{x:?}")),
        Value::Integer(n) => n.to_string(),
        Value::Bool(yes) => yes.to_string(),
        Value::Vector(v) | Value::Color(v) => vector(v),
        Value::OptionalVector(v) => v.as_ref().map_or("None".into(), vector),
        Value::Vectors(all) => format!("[{}]", all.iter().map(vector).collect::<Vec<_>>().join(", ")),
        Value::Vectors2(all) => {
            let pairs = all.iter().map(|v| format!("({:?}, {:?})", v.x, v.y));
            format!("[{}]", pairs.collect::<Vec<_>>().join(", "))
        }
        Value::Choice(choice) => choice.words().get(choice.position()).copied().unwrap_or_default().into(),
        Value::Steps(_) | Value::Model(_) | Value::Image(_) => return None,
    })
}

/// Reads a component from a scene.
fn read<C: Describe + Component>(component: &str, kind: Kind) -> Result<Option<C>, Faults> {
    let mut world = World::new();
    let mut registry = Registry::default();
    registry.register::<C>(kind);
    world.insert_resource(registry);
    world.insert_resource(Settings::default());
    let scene = format!("Scene(version: 1, entities: {{\n\"it\": [{component}]}})");
    load::read_scene_text(&mut world, &scene, "conformance.ron".as_ref())?;
    Ok(world.query::<&C>().iter(&world).next().cloned())
}

/// Misspells, leaves out and spoils fields.
fn check_faults<C: Describe + Component>(fields: &[Field], kind: Kind, name: &str, report: &mut Report) {
    let component = |change: &dyn Fn(&Field) -> Option<(String, String)>| {
        let fields = fields.iter().filter_map(change).map(|(name, text)| format!("{name}: {text}"));
        format!("{}({})", C::TAG, fields.collect::<Vec<_>>().join(", "))
    };
    let kept = |field: &Field| Some((field.name.to_owned(), field.text.clone()?));
    let mut expect = |component: &str, words: &[&str]| {
        let what = match read::<C>(component, kind) {
            Ok(_) => format!("`{component}` is read without a fault"),
            Err(faults) => {
                let told = faults.to_string();
                let known = told.starts_with("conformance.ron:2:") && words.iter().all(|word| told.contains(word));
                if known {
                    return;
                }
                format!("`{component}`: the fault should name its place, and {words:?}, but says: {told}")
            }
        };
        report.add("faults", name, what);
    };
    for field in fields {
        let is = |other: &Field| other.name == field.name;
        let misspelt = format!("{}x", field.name);
        expect(
            &component(&|other| {
                Some((if is(other) { misspelt.clone() } else { other.name.into() }, other.text.clone()?))
            }),
            &[&misspelt],
        );
        expect(
            &component(&|other| if is(other) { Some((field.name.into(), "'?'".into())) } else { kept(other) }),
            &[field.name, "expected"],
        );
        if field.spec.required {
            expect(&component(&|other| if is(other) { None } else { kept(other) }), &["missing", field.name]);
        }
        if field.is_number {
            let wrong = |text: &str| {
                component(&|other| if is(other) { Some((field.name.into(), text.into())) } else { kept(other) })
            };
            expect(&wrong("NaN"), &[field.name]);
            expect(&wrong("inf"), &[field.name]);
            if field.spec.range.min > f64::MIN {
                let below =
                    if field.spec.range.min_inclusive { field.spec.range.min - 1.0 } else { field.spec.range.min };
                expect(&wrong(&format!("{below:?}")), &[field.name]);
            }
        }
    }
    expect(
        &component(&|field| Some((field.name.into(), field.text.clone()?))).replacen('(', "(no_such_field: 1, ", 1),
        &["no_such_field"],
    );
}

/// Packs and hits shapes whose numbers are as small and as large as their ranges allow.
fn check_extremes<P: Primitive + Clone>(shape: &P, name: &str, watch: &Watch, report: &mut Report) {
    let numbers = fields_of(shape.clone()).into_iter().filter(|field| field.is_number);
    for field in numbers {
        let range = field.spec.range;
        let values = [range.min, range.min.next_up(), 1e-300, 1e-150, 1e-9, 1e9, 1e150, 1e300, range.max];
        for value in values.into_iter().filter(|value| range.contains(*value)) {
            let mut shape = shape.clone();
            shape.describe(&mut Setter { name: field.name, value });
            if shape.check().is_err() {
                continue;
            }
            let at = format!("{name}, `{}: {value:e}`", field.name);
            let tried = catch_unwind(AssertUnwindSafe(|| try_extreme(&shape, &at, watch)));
            let what = match tried {
                Ok(None) => continue,
                Ok(Some(what)) => what,
                Err(_) => "panics".into(),
            };
            report.add("extremes", name, format!("with `{}: {value:e}` it {what}", field.name));
        }
    }
}

/// What is wrong with a shape, if anything.
fn try_extreme<P: Primitive>(shape: &P, name: &str, watch: &Watch) -> Option<String> {
    watch.asks(name, None);
    // A reason why there is nothing to hit is as good as something to hit.
    let (extent, packed) = shape.pack(&DAffine3::IDENTITY).ok()?;
    let target = match extent {
        Extent::Unbounded => DVec3::ZERO,
        Extent::Bounded(bounds) if bounds.min.is_finite() && bounds.max.is_finite() => 0.5 * (bounds.min + bounds.max),
        // The renderer leaves it out.
        Extent::Bounded(_) => return None,
    };
    for direction in [DVec3::X, DVec3::NEG_Y, DVec3::Z, DVec3::new(0.6, -0.64, 0.48)] {
        for origin in [target - direction * 5.0, target] {
            let ray = Ray { origin, direction };
            watch.asks(name, Some(&ray));
            let Some(hit) = P::hit(&packed, &ray, f64::INFINITY, &mut Cost::default()) else { continue };
            if !(hit.t > 0.0 && hit.t.is_finite()) {
                return Some(format!("is hit at {}", hit.t));
            }
            P::surface(&packed, &ray, hit);
        }
    }
    None
}

/// Writes a number into a field.
struct Setter {
    name: &'static str,
    value: f64,
}

impl FieldVisitor for Setter {
    fn field(&mut self, name: &'static str, value: Value<'_>, _: Spec) {
        if let Value::Number(place) = value
            && name == self.name
        {
            *place = self.value;
        }
    }
}
