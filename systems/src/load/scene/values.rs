//! Numbers, vectors, colours, choices and placements as a scene writes them.

use super::{
    node::{Field, Form, Node},
    source::{did_you_mean, excerpt, listed},
};
use glam::{DVec2, DVec3};
use smallvec::SmallVec;
use snell_components::{
    color::{Encoding, Rgb},
    describe::{Range, Spec},
    transform::Step,
};

/// The largest size of a number: bounds of shapes are kept in single precision.
pub(crate) const LARGEST: f64 = f32::MAX as f64;

/// The names of the steps of a placement.
const STEPS: [&str; 6] = ["Translate", "Scale", "RotateX", "RotateY", "RotateZ", "Rotate"];

/// A fault at a byte of the text.
pub(super) type Complaint = (usize, String);

/// Faults of the names of `fields`: those that are not known or given twice, and at `here` those that are missing.
///
/// Required names come with their meaning.
pub(super) fn check_names(
    text: &str,
    here: usize,
    fields: &[Field],
    known: &[&str],
    required: &[(&str, &str)],
) -> Vec<Complaint> {
    let (mut seen, mut misspelt): (Vec<&str>, Vec<&str>) = (vec![], vec![]);
    let mut faults = vec![];
    for field in fields {
        let name = field.name(text);
        let fault = if !known.contains(&name) {
            misspelt.push(name);
            let near = did_you_mean(name, known.iter().copied());
            let names = listed(known.iter().copied(), "and");
            let all = match (known, near.is_empty()) {
                ([], _) => "; there are none".into(),
                ([_], true) => format!("; the only field is {names}"),
                ([_], false) => format!(" The only field is {names}"),
                (_, true) => format!("; fields are {names}"),
                (_, false) => format!(" Fields are {names}"),
            };
            format!("unknown field {}{near}{all}", excerpt(name))
        } else if seen.contains(&name) {
            format!("field `{name}` is given twice")
        } else {
            seen.push(name);
            continue;
        };
        faults.push((field.name.start, fault));
    }
    for (name, about) in required {
        // A field whose name is misspelt is not missing as well.
        let is_near = |given: &&str| !did_you_mean(given, [*name]).is_empty();
        if !seen.contains(name) && !misspelt.iter().any(is_near) {
            faults.push((here, format!("missing field `{name}` ({about})")));
        }
    }
    faults
}

/// Reads values from a text; each reader gives nothing and notes why where the value is not sound.
pub(super) struct Values<'a> {
    pub(super) text: &'a str,
    /// What colours `"#rrggbb"` mean.
    pub(super) encoding: Encoding,
    pub(super) faults: Vec<Complaint>,
}

impl<'a> Values<'a> {
    /// Notes that a value is not what was expected.
    pub(super) fn unexpected(&mut self, node: &Node, expected: &str) {
        let message = format!("expected {expected}, found {}", excerpt(node.text(self.text)));
        self.faults.push((node.span.start, message));
    }

    pub(super) fn number(&mut self, node: &Node, range: Range) -> Option<f64> {
        // Words, too, may be numbers: `inf` and `NaN`.
        let number = match node.form {
            Form::Number | Form::Word => ron::from_str::<f64>(node.text(self.text)).ok(),
            _ => None,
        };
        match number {
            Some(x) if x.is_nan() || x.abs() > LARGEST => {
                self.unexpected(node, "a finite number, at most 3.4e38 in size")
            }
            Some(x) if range.contains(x) => return Some(x),
            _ => self.unexpected(node, &format!("a number{}", limits(range))),
        }
        None
    }

    pub(super) fn integer(&mut self, node: &Node, range: Range) -> Option<u32> {
        let number = ron::from_str::<u32>(node.text(self.text)).ok().filter(|x| range.contains(f64::from(*x)));
        if number.is_none() {
            let range = Range { min: range.min.max(0.0), max: range.max.min(f64::from(u32::MAX)), ..range };
            self.unexpected(node, &format!("a whole number{}", limits(range)));
        }
        number
    }

    pub(super) fn boolean(&mut self, node: &Node) -> Option<bool> {
        match node.tag(self.text) {
            Some("true") => return Some(true),
            Some("false") => return Some(false),
            _ => self.unexpected(node, "`true` or `false`"),
        }
        None
    }

    pub(super) fn string(&mut self, node: &Node, expected: &str) -> Option<String> {
        let string = node.string(self.text);
        if string.is_none() {
            self.unexpected(node, expected);
        }
        string
    }

    /// Exactly `N` numbers.
    fn numbers<const N: usize>(&mut self, node: &Node, range: Range, expected: &str) -> Option<[f64; N]> {
        let Some(items) = node.items().filter(|items| items.len() == N) else {
            self.unexpected(node, expected);
            return None;
        };
        let mut numbers = [Some(0.0); N];
        for (number, item) in numbers.iter_mut().zip(items) {
            *number = self.number(item, range);
        }
        // All are read before the first that failed ends it, so that every fault is told.
        numbers.iter().all(Option::is_some).then(|| numbers.map(Option::unwrap_or_default))
    }

    pub(super) fn vector(&mut self, node: &Node, spec: Spec) -> Option<DVec3> {
        let expected = format!("three numbers `(x, y, z)`{}", each(spec.range));
        let vector = DVec3::from_array(self.numbers(node, spec.range, &expected)?);
        // A vector so short that it cannot be normalised has no direction either.
        if spec.nonzero && vector.try_normalize().is_none() {
            self.unexpected(node, "a vector with a direction");
            return None;
        }
        Some(vector)
    }

    pub(super) fn vector2(&mut self, node: &Node, spec: Spec) -> Option<DVec2> {
        let expected = format!("two numbers `(u, v)`{}", each(spec.range));
        self.numbers(node, spec.range, &expected).map(DVec2::from_array)
    }

    /// A list of what `item` reads.
    pub(super) fn list<T>(
        &mut self,
        node: &Node,
        expected: &str,
        mut item: impl FnMut(&mut Self, &Node) -> Option<T>,
    ) -> Option<Vec<T>> {
        let Form::List(items) = &node.form else {
            self.unexpected(node, expected);
            return None;
        };
        // All are read before the first that failed ends it, so that every fault is told.
        let read: Vec<_> = items.iter().map(|node| item(self, node)).collect();
        read.into_iter().collect()
    }

    pub(super) fn color(&mut self, node: &Node, range: Range) -> Option<Rgb> {
        match &node.form {
            Form::Number | Form::Word => self.number(node, range).map(Rgb::splat),
            Form::Text => {
                let color = node.string(self.text).and_then(|text| color_from_hex(&text, self.encoding));
                if color.is_none() {
                    self.unexpected(node, "an sRGB colour \"#rrggbb\" or \"#rgb\"");
                }
                color
            }
            _ => {
                let expected = format!("a colour: one number, three numbers or \"#rrggbb\"{}", each(range));
                self.numbers(node, range, &expected).map(Rgb::from_array)
            }
        }
    }

    /// The position of a word among those allowed.
    pub(super) fn choice(&mut self, node: &Node, words: &[&str]) -> Option<usize> {
        let word = node.tag(self.text).filter(|_| matches!(node.form, Form::Word));
        let position = word.and_then(|word| words.iter().position(|known| *known == word));
        if position.is_none() {
            let near = word.map_or(String::new(), |word| did_you_mean(word, words.iter().copied()));
            let found = excerpt(node.text(self.text));
            let expected = listed(words.iter().copied(), "or");
            self.faults.push((node.span.start, format!("expected {expected}, found {found}{near}")));
        }
        position
    }

    pub(super) fn steps(&mut self, node: &Node) -> Option<SmallVec<[Step; 4]>> {
        self.list(node, "a list of steps `[Translate((x, y, z)), …]`", Self::step).map(SmallVec::from_vec)
    }

    fn step(&mut self, node: &Node) -> Option<Step> {
        let any = Spec::any("");
        let Some(tag) = node.tag(self.text) else {
            self.unexpected(node, "a step, as `Translate((x, y, z))`");
            return None;
        };
        if !STEPS.contains(&tag) {
            let near = did_you_mean(tag, STEPS);
            let steps = if near.is_empty() { format!("; steps: {}", listed(STEPS, "and")) } else { near };
            self.faults.push((node.span.start, format!("unknown step `{tag}`{steps}")));
            return None;
        }
        if tag == "Rotate" {
            return self.turn(node);
        }
        let Some(value) = argument(node) else {
            let value = if tag.starts_with("Rotate") { "degrees" } else { "(x, y, z)" };
            self.unexpected(node, &format!("`{tag}({value})`"));
            return None;
        };
        match tag {
            "Translate" => self.vector(value, any).map(Step::Translate),
            "Scale" if matches!(value.form, Form::Number | Form::Word) => {
                self.number(value, any.range).map(|by| Step::Scale(DVec3::splat(by)))
            }
            "Scale" => self.vector(value, any).map(Step::Scale),
            "RotateX" => self.number(value, any.range).map(Step::RotateX),
            "RotateY" => self.number(value, any.range).map(Step::RotateY),
            _ => self.number(value, any.range).map(Step::RotateZ),
        }
    }

    /// A turn about any axis.
    fn turn(&mut self, node: &Node) -> Option<Step> {
        let inner = match &node.form {
            Form::Tagged(_, inner) => Some(&inner.form),
            _ => None,
        };
        let Some(Form::Fields(fields)) = inner else {
            self.unexpected(node, "`Rotate(axis: (x, y, z), degrees: …)`");
            return None;
        };
        const REQUIRED: [(&str, &str); 2] = [("axis", "direction of the axis"), ("degrees", "angle")];
        self.faults.extend(check_names(self.text, node.span.start, fields, &["axis", "degrees"], &REQUIRED));
        let find = |name: &str| fields.iter().find(|field| field.name(self.text) == name).map(|field| &field.value);
        let (axis, degrees) = (find("axis"), find("degrees"));
        let any = Spec::any("");
        let axis = axis.and_then(|value| self.vector(value, any.nonzero()));
        let degrees = degrees.and_then(|value| self.number(value, any.range));
        Some(Step::Rotate { axis: axis?, degrees: degrees? })
    }
}

/// The one value of `Tag(value)`; `Tag(x, y, z)` means `Tag((x, y, z))`.
pub(super) fn argument(node: &Node) -> Option<&Node> {
    let Form::Tagged(_, inner) = &node.form else { return None };
    match &inner.form {
        Form::Tuple(items) => match items.as_slice() {
            [] => None,
            [one] => Some(one),
            _ => Some(inner),
        },
        _ => None,
    }
}

/// The limits of a number, to follow the word "number".
fn limits(range: Range) -> String {
    let Range { min, max, min_inclusive } = range;
    match (min > f64::MIN, max < f64::MAX) {
        (false, false) => String::new(),
        (false, true) => format!(" up to {max}"),
        (true, false) if min_inclusive => format!(" of at least {min}"),
        (true, false) => format!(" above {min}"),
        (true, true) if min_inclusive => format!(" from {min} to {max}"),
        (true, true) => format!(" above {min} and up to {max}"),
    }
}

/// The limits of several numbers, to end a sentence with.
fn each(range: Range) -> String {
    let limits = limits(range);
    if limits.is_empty() { limits } else { format!(", each{limits}") }
}

/// The light of a colour `#rrggbb` or `#rgb`.
fn color_from_hex(text: &str, encoding: Encoding) -> Option<Rgb> {
    let digits: Vec<u32> = text.strip_prefix('#')?.chars().map(|c| c.to_digit(16)).collect::<Option<_>>()?;
    let bytes = match digits[..] {
        [r, g, b] => [r * 17, g * 17, b * 17],
        [r1, r0, g1, g0, b1, b0] => [r1 * 16 + r0, g1 * 16 + g0, b1 * 16 + b0],
        _ => return None,
    };
    Some(Rgb::from_array(bytes.map(|byte| encoding.decode(f64::from(byte) / 255.0))))
}
