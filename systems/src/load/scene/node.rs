//! The values of a RON text and where each is written.
//!
//! The `ron` crate decides what is RON, and reads numbers and strings. It does not tell where a value stands; so once a
//! text is known to be sound, a small scanner walks over it and notes the places.

use ron::error::{Error, SpannedError};
use serde::de::IgnoredAny;
use std::ops::Range;

/// A value and its place, in bytes of the text.
#[derive(Debug)]
pub(super) struct Node {
    pub(super) span: Range<usize>,
    pub(super) form: Form,
}

/// What a value looks like; names stay in the text.
#[derive(Debug)]
pub(super) enum Form {
    /// A number, as far as its first character tells.
    Number,
    /// A text in quotes.
    Text,
    /// A bare word, as `Four` or `true`.
    Word,
    /// A character, bytes, or whatever else no scene holds.
    Other,
    /// `[a, b]`.
    List(Vec<Node>),
    /// `(a, b)`.
    Tuple(Vec<Node>),
    /// `(x: a, y: b)`.
    Fields(Vec<Field>),
    /// `{a: b}`.
    Map(Vec<(Node, Node)>),
    /// `Tag(…)`: where the tag ends, and the parentheses as a [`Form::Tuple`] or [`Form::Fields`].
    Tagged(usize, Box<Node>),
}

/// A named value.
#[derive(Debug)]
pub(super) struct Field {
    pub(super) name: Range<usize>,
    pub(super) value: Node,
}

/// The part of `text` at `span`; empty if there is none, which does not happen for spans of the same text.
pub(super) fn slice<'t>(text: &'t str, span: &Range<usize>) -> &'t str {
    text.get(span.clone()).unwrap_or_default()
}

impl Node {
    /// The value as written.
    pub(super) fn text<'t>(&self, text: &'t str) -> &'t str {
        slice(text, &self.span)
    }

    /// The name before the parentheses, or the bare word.
    pub(super) fn tag<'t>(&self, text: &'t str) -> Option<&'t str> {
        let end = match self.form {
            Form::Word => self.span.end,
            Form::Tagged(end, _) => end,
            _ => return None,
        };
        Some(identifier(slice(text, &(self.span.start..end))))
    }

    /// The text in quotes, with its escapes resolved.
    pub(super) fn string(&self, text: &str) -> Option<String> {
        match self.form {
            Form::Text => ron::from_str(self.text(text)).ok(),
            _ => None,
        }
    }

    /// The values in `[…]` or `(…)`.
    pub(super) fn items(&self) -> Option<&[Self]> {
        match &self.form {
            Form::List(items) | Form::Tuple(items) => Some(items),
            _ => None,
        }
    }
}

impl Field {
    /// The name.
    pub(super) fn name<'t>(&self, text: &'t str) -> &'t str {
        identifier(slice(text, &self.name))
    }
}

/// An identifier without the mark of RON's raw ones.
fn identifier(word: &str) -> &str {
    word.strip_prefix("r#").unwrap_or(word)
}

/// The value that a whole text holds.
///
/// # Errors
/// The place, in bytes, and what is wrong there.
pub(super) fn parse(text: &str) -> Result<Node, (usize, String)> {
    // `ron` limits the depth of nesting, so the scanner may recurse.
    ron::from_str::<IgnoredAny>(text).map_err(|error| explain(text, &error))?;
    let mut scanner = Scanner { text, at: 0 };
    scanner.skip_attributes();
    scanner.value().ok_or((scanner.at, "this notation has no place in a scene".into()))
}

/// A syntax error in plain words.
fn explain(text: &str, error: &SpannedError) -> (usize, String) {
    let start = offset(text, error.span.start.line, error.span.start.col);
    let end = offset(text, error.span.end.line, error.span.end.col);
    let next = text.get(end..).unwrap_or_default().trim_start().chars().next();
    let found = next.map_or(String::new(), |c| format!(", found `{c}`"));
    match (&error.code, next) {
        _ if text.trim().is_empty() => (0, "expected `Scene(version: 1, …)`, found an empty file".into()),
        (Error::Eof, _) | (Error::ExpectedComma | Error::ExpectedMapColon, None) => {
            (end, "the file ends before the scene does: a bracket is not closed".into())
        }
        (Error::ExpectedComma, _) => (end, format!("expected a comma or a closing bracket{found}")),
        (Error::ExpectedMapColon, _) => (end, format!("expected a colon{found}")),
        (Error::ExceededRecursionLimit, _) => (start, "values are nested too deep".into()),
        (Error::TrailingCharacters, _) => {
            (start, "expected the end of the file: the scene is complete before this".into())
        }
        (Error::UnexpectedChar(c), _) => (start, format!("expected a value, found `{c}`")),
        (Error::UnclosedBlockComment, _) => (start, "this comment is not closed: `*/` is missing".into()),
        (Error::ExpectedStringEnd, _) => (start, "this text is not closed: `\"` is missing".into()),
        (other, _) => {
            let message = other.to_string();
            let mut letters = message.chars();
            let first = letters.next().map(|c| c.to_lowercase().to_string()).unwrap_or_default();
            (start, format!("{first}{}", letters.as_str()))
        }
    }
}

/// The byte at a line and column, both from 1.
fn offset(text: &str, line: usize, column: usize) -> usize {
    let before: usize = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
    let rest = text.get(before..).unwrap_or_default();
    before + rest.char_indices().nth(column.saturating_sub(1)).map_or(rest.len(), |(at, _)| at)
}

/// Walks over RON that is known to be sound. What it cannot make out gives `None`, never a wrong value.
struct Scanner<'t> {
    text: &'t str,
    at: usize,
}

impl Scanner<'_> {
    fn rest(&self) -> &str {
        self.text.get(self.at..).unwrap_or_default()
    }

    /// Passes over `token` if it comes next.
    fn eat(&mut self, token: &str) -> bool {
        let found = self.rest().starts_with(token);
        self.at += if found { token.len() } else { 0 };
        found
    }

    /// Passes over everything before the first character that ends it; to the end of the text if none does.
    fn skip_until(&mut self, ends: impl Fn(char) -> bool) {
        self.at += self.rest().find(ends).unwrap_or(self.rest().len());
    }

    /// Passes over white space and comments.
    fn skip_space(&mut self) {
        loop {
            self.skip_until(|c| !(c.is_whitespace() || matches!(c, '\u{200E}' | '\u{200F}')));
            if self.eat("//") {
                self.skip_until(|c| c == '\n');
            } else if self.eat("/*") {
                self.skip_comment();
            } else {
                return;
            }
        }
    }

    /// Passes over the rest of a block comment; they nest.
    fn skip_comment(&mut self) {
        let mut depth = 1;
        while depth > 0 && !self.rest().is_empty() {
            self.skip_until(|c| matches!(c, '/' | '*'));
            if self.eat("/*") {
                depth += 1;
            } else if self.eat("*/") {
                depth -= 1;
            } else if !self.eat("/") {
                self.eat("*");
            }
        }
    }

    /// Passes over `#![…]` before the value: what it enables is always allowed.
    fn skip_attributes(&mut self) {
        self.skip_space();
        while self.eat("#") {
            while !self.rest().is_empty() && !self.eat("]") {
                if self.string().is_none() {
                    let step = self.rest().chars().next().map_or(0, char::len_utf8);
                    self.at += step;
                }
            }
            self.skip_space();
        }
    }

    /// The value that comes next.
    fn value(&mut self) -> Option<Node> {
        self.skip_space();
        let start = self.at;
        let form = if self.eat("[") {
            Form::List(self.sequence("]", Self::value)?)
        } else if self.eat("{") {
            Form::Map(self.sequence("}", Self::pair)?)
        } else if self.rest().starts_with('(') {
            self.parentheses()?
        } else if let Some(form) = self.string() {
            form
        } else {
            self.word()?
        };
        Some(Node { span: start..self.at, form })
    }

    /// Items with commas between them, up to `close`.
    fn sequence<T>(&mut self, close: &str, item: impl Fn(&mut Self) -> Option<T>) -> Option<Vec<T>> {
        let mut items = vec![];
        loop {
            self.skip_space();
            if self.eat(close) {
                return Some(items);
            }
            items.push(item(self)?);
            self.skip_space();
            if !self.eat(",") && !self.rest().starts_with(close) {
                return None;
            }
        }
    }

    fn pair(&mut self) -> Option<(Node, Node)> {
        let key = self.value()?;
        self.skip_space();
        if self.eat(":") { Some((key, self.value()?)) } else { None }
    }

    fn field(&mut self) -> Option<Field> {
        let (name, value) = self.pair()?;
        matches!(name.form, Form::Word).then_some(Field { name: name.span, value })
    }

    /// `(…)` with or without names.
    fn parentheses(&mut self) -> Option<Form> {
        self.eat("(");
        let inside = self.at;
        // Names are told by the colon behind the first word.
        self.skip_space();
        self.skip_until(is_delimiter);
        self.skip_space();
        let named = self.rest().starts_with(':');
        self.at = inside;
        Some(if named {
            Form::Fields(self.sequence(")", Self::field)?)
        } else {
            Form::Tuple(self.sequence(")", Self::value)?)
        })
    }

    /// A number, or a word with or without parentheses.
    fn word(&mut self) -> Option<Form> {
        let start = self.at;
        if self.rest().starts_with("r#") {
            self.at += 2;
        }
        self.skip_until(is_delimiter);
        let end = self.at;
        let first = self.text.get(start..end)?.chars().next()?;
        if first.is_ascii_digit() || matches!(first, '+' | '-' | '.') {
            return Some(Form::Number);
        }
        self.skip_space();
        if !self.rest().starts_with('(') {
            self.at = end;
            return Some(Form::Word);
        }
        let open = self.at;
        let form = self.parentheses()?;
        Some(Form::Tagged(end, Box::new(Node { span: open..self.at, form })))
    }

    /// A text, bytes or a character; nothing is passed over if there is none.
    fn string(&mut self) -> Option<Form> {
        let start = self.at;
        let bytes = self.eat("b");
        let raw = self.eat("r");
        let hashes = if raw { self.rest().len() - self.rest().trim_start_matches('#').len() } else { 0 };
        self.at += hashes;
        let quote = if self.eat("\"") {
            '"'
        } else if !raw && self.eat("'") {
            '\''
        } else {
            self.at = start;
            return None;
        };
        if raw {
            let close = format!("\"{}", "#".repeat(hashes));
            self.at += self.rest().find(&close)? + close.len();
        } else {
            let mut escaped = false;
            let closing = |(_, c): &(usize, char)| {
                let closes = !escaped && *c == quote;
                escaped = !escaped && *c == '\\';
                closes
            };
            let (close, _) = self.rest().char_indices().find(closing)?;
            self.at += close + 1;
        }
        Some(if bytes || quote == '\'' { Form::Other } else { Form::Text })
    }
}

/// Whether a character ends a word or number.
fn is_delimiter(c: char) -> bool {
    c.is_whitespace()
        || matches!(c, '(' | ')' | '[' | ']' | '{' | '}' | ',' | ':' | '/' | '"' | '\'' | '\u{200E}' | '\u{200F}')
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tree in a short notation, with the text of every leaf.
    fn shown(text: &str, node: &Node) -> String {
        let all = |nodes: &[Node]| nodes.iter().map(|node| shown(text, node)).collect::<Vec<_>>().join(" ");
        match &node.form {
            Form::Number | Form::Text | Form::Word | Form::Other => node.text(text).into(),
            Form::List(items) => format!("[{}]", all(items)),
            Form::Tuple(items) => format!("({})", all(items)),
            Form::Map(pairs) => {
                let pairs = pairs.iter().map(|(key, value)| format!("{}={}", shown(text, key), shown(text, value)));
                format!("{{{}}}", pairs.collect::<Vec<_>>().join(" "))
            }
            Form::Fields(fields) => {
                let fields = fields.iter().map(|field| format!("{}={}", field.name(text), shown(text, &field.value)));
                format!("({})", fields.collect::<Vec<_>>().join(" "))
            }
            Form::Tagged(_, inner) => format!("{}{}", node.tag(text).unwrap_or_default(), shown(text, inner)),
        }
    }

    #[test]
    fn every_notation_is_scanned_to_its_end() {
        for (text, expected) in [
            ("  Sphere ( radius /* of /* it */ */ : 1.5e-3 , ) // end", "Sphere(radius=1.5e-3)"),
            ("#![enable(implicit_some)]\n#![enable(unwrap_newtypes)] (a: 1)", "(a=1)"),
            (
                r##"[A, B(), C(1), (), [], {}, r#"a"b"#, "\"]", 'c', '\'', '"', b"x", b'a']"##,
                r##"[A B() C(1) () [] {} r#"a"b"# "\"]" 'c' '\'' '"' b"x" b'a']"##,
            ),
            ("{\"a\": [T, T(x: 2)], \"b\": -.5}", "{\"a\"=[T T(x=2)] \"b\"=-.5}"),
            ("(r#type: r#x(1, 2), y: inf, z: 1..=2)", "(type=x(1 2) y=inf z=1..=2)"),
            ("(a//)\n:1)", "(a=1)"),
            ("(rot: 1, b: br, r: b)", "(rot=1 b=br r=b)"),
        ] {
            let node = parse(text).unwrap_or_else(|fault| panic!("{text}: {fault:?}"));
            assert_eq!(shown(text, &node), expected);
        }
    }

    #[test]
    fn deep_nesting_is_an_error() {
        for open in ["[", "(", "a(", "{1:", "(a:", "Some("] {
            assert!(parse(&open.repeat(200_000)).is_err());
        }
    }
}
