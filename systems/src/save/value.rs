//! Values as a scene writes them.

use crate::{load::LARGEST, registry::AnyComponent};
use core::fmt::Display;
use glam::DVec3;
use snell_components::{
    color::{Encoding, Rgb},
    describe::{FieldVisitor, Spec, Value},
    transform::Step,
};
use std::sync::Arc;

/// A field as a scene writes it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The field.
    pub name: &'static str,
    /// Its value; or why no scene can say it.
    pub text: Result<String, String>,
    /// Whether a scene must give the field.
    pub required: bool,
    /// Where the contents of a file lie, so that two readings of one file differ.
    contents: usize,
}

/// Whether two components hold the same, to the last bit.
#[must_use]
pub fn same(a: &dyn AnyComponent, b: &dyn AnyComponent) -> bool {
    a.tag() == b.tag() && fields(a, Encoding::Srgb) == fields(b, Encoding::Srgb)
}

/// All fields of a component, in a scene in which the numbers of colours mean what `encoding` says.
#[must_use]
pub fn fields(component: &dyn AnyComponent, encoding: Encoding) -> Vec<Written> {
    let mut writer = Writer { fields: vec![], encoding };
    component.copy().visit(&mut writer);
    writer.fields
}

/// Writes fields as it sees them.
pub(super) struct Writer {
    pub(super) fields: Vec<Written>,
    pub(super) encoding: Encoding,
}

impl FieldVisitor for Writer {
    fn field(&mut self, name: &'static str, value: Value<'_>, spec: Spec) {
        let mut contents = 0;
        let text = match value {
            Value::Number(x) => number(*x),
            Value::OptionalNumber(x) => x.map_or(Ok("None".into()), number),
            Value::Integer(x) => Ok(x.to_string()),
            Value::Bool(x) => Ok(x.to_string()),
            Value::Vector(v) => vector(*v),
            Value::OptionalVector(v) => v.map_or(Ok("None".into()), vector),
            Value::Vectors(all) => list(all.iter().map(|v| vector(*v))),
            Value::Vectors2(all) => list(all.iter().map(|v| tuple(&v.to_array()))),
            Value::Color(color) => self::color(*color, self.encoding),
            Value::Choice(choice) => Ok(choice.words()[choice.position()].into()),
            Value::Steps(steps) => list(steps.iter().map(|step| self::step(*step))),
            Value::Model(asset) => {
                contents = asset.data.as_ref().map_or(0, |data| Arc::as_ptr(data).addr());
                path(&asset.path)
            }
            Value::Image(asset) => {
                contents = asset.data.as_ref().map_or(0, |data| Arc::as_ptr(data).addr());
                path(&asset.path)
            }
        };
        self.fields.push(Written { name, text, required: spec.required, contents });
    }
}

/// The shortest decimal that reads back to the same bits.
fn number(x: f64) -> Result<String, String> {
    if x.is_finite() && x.abs() <= LARGEST {
        // Whole numbers need no point.
        return Ok(if x.abs() < 1e15 { x.to_string() } else { format!("{x:?}") }).map(shorter(x));
    }
    Err(format!("{x} is not a number that a scene can hold"))
}

/// Takes the form with an exponent where it is much shorter.
fn shorter(x: f64) -> impl FnOnce(String) -> String {
    move |plain| {
        let exponent = format!("{x:e}");
        if plain.len() > exponent.len() + 4 { exponent } else { plain }
    }
}

fn tuple(numbers: &[f64]) -> Result<String, String> {
    let numbers: Vec<_> = numbers.iter().map(|x| number(*x)).collect::<Result<_, _>>()?;
    Ok(format!("({})", numbers.join(", ")))
}

fn vector(v: DVec3) -> Result<String, String> {
    tuple(&v.to_array())
}

fn list(items: impl Iterator<Item = Result<String, String>>) -> Result<String, String> {
    Ok(format!("[{}]", items.collect::<Result<Vec<_>, _>>()?.join(", ")))
}

/// A colour as a scene writes it: see [`scene_text`](super::scene_text). A colour that no scene can hold gives a text that
/// none reads.
#[must_use]
pub fn color_text(color: Rgb, encoding: Encoding) -> String {
    self::color(color, encoding).unwrap_or_else(|_| format!("{color:?}"))
}

/// One number for grey, `"#rrggbb"` where that means these very bits, and three numbers otherwise.
fn color(color: Rgb, encoding: Encoding) -> Result<String, String> {
    let channels = color.to_array();
    if channels.iter().all(|channel| channel.to_bits() == channels[0].to_bits()) {
        return number(channels[0]);
    }
    let bytes = channels.map(|channel| (encoding.encode(channel) * 255.0 + 0.5) as u8);
    let decoded = bytes.map(|byte| encoding.decode(f64::from(byte) / 255.0).to_bits());
    if decoded == channels.map(f64::to_bits) && !bytes.iter().all(|byte| [0, 255].contains(byte)) {
        let [r, g, b] = bytes;
        return Ok(format!("\"#{r:02x}{g:02x}{b:02x}\""));
    }
    tuple(&channels)
}

fn step(step: Step) -> Result<String, String> {
    let call = |name: &str, argument: &dyn Display| format!("{name}({argument})");
    Ok(match step {
        Step::Translate(by) => call("Translate", &vector(by)?),
        Step::Scale(by) if by.to_array().iter().all(|x| x.to_bits() == by.x.to_bits()) => call("Scale", &number(by.x)?),
        Step::Scale(by) => call("Scale", &vector(by)?),
        Step::RotateX(degrees) => call("RotateX", &number(degrees)?),
        Step::RotateY(degrees) => call("RotateY", &number(degrees)?),
        Step::RotateZ(degrees) => call("RotateZ", &number(degrees)?),
        Step::Rotate { axis, degrees } => {
            format!("Rotate(axis: {}, degrees: {})", vector(axis)?, number(degrees)?)
        }
    })
}

fn path(path: &str) -> Result<String, String> {
    if path.is_empty() {
        return Err("it was made in memory and has no file to be named".into());
    }
    quoted(path)
}

/// A text in quotes.
pub(super) fn quoted(text: &str) -> Result<String, String> {
    ron::to_string(text).map_err(|why| why.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_read_back_to_the_same_bits() {
        for (x, text) in [
            (1.0, "1"),
            (-0.0, "-0"),
            (0.1, "0.1"),
            (1e-7, "1e-7"),
            (3e38, "3e38"),
            (1_000_000.0, "1000000"),
            (-2.5e-300, "-2.5e-300"),
            (f64::MIN_POSITIVE * f64::EPSILON, "5e-324"),
            (1.0 / 3.0, "0.3333333333333333"),
        ] {
            assert_eq!(number(x).as_deref(), Ok(text));
            assert_eq!(ron::from_str::<f64>(text).map(f64::to_bits), Ok(x.to_bits()), "{text}");
        }
        assert!(number(f64::NAN).is_err() && number(f64::INFINITY).is_err() && number(1e39).is_err());
    }

    #[test]
    fn colours_take_their_shortest_exact_form() {
        let srgb = |byte: u8| Encoding::Srgb.decode(f64::from(byte) / 255.0);
        let color = |rgb| color(rgb, Encoding::Srgb);
        assert_eq!(color(Rgb::splat(0.5)).as_deref(), Ok("0.5"));
        assert_eq!(color(Rgb::new(1.0, 0.0, 0.0)).as_deref(), Ok("(1, 0, 0)"));
        assert_eq!(color(Rgb::new(srgb(192), srgb(64), srgb(32))).as_deref(), Ok("\"#c04020\""));
        assert_eq!(color(Rgb::new(0.5, 0.25, 0.125)).as_deref(), Ok("(0.5, 0.25, 0.125)"));
        let raw = Rgb::new(192.0, 64.0, 32.0) / 255.0;
        assert_eq!(super::color(raw, Encoding::Raw).as_deref(), Ok("\"#c04020\""));
    }
}
