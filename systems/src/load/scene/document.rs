//! What a scene file says, apart from the meaning of its components.

use super::{
    node::{self, Field, Form, Node},
    source::{Place, Report, did_you_mean, excerpt},
    values::check_names,
};

/// The version of the format that is read.
const VERSION: u32 = 1;

/// A mark in names that only the loader sets, for the materials of models.
pub(crate) const RESERVED: char = '#';

/// A scene file, part by part.
#[derive(Debug, Default)]
pub(super) struct Document {
    pub(super) settings: Option<Node>,
    pub(super) includes: Vec<Include>,
    pub(super) entities: Vec<Definition>,
}

/// A file whose entities are to be part of the scene.
#[derive(Debug)]
pub(super) struct Include {
    /// Where it is written.
    pub(super) at: usize,
    /// Path from the file that includes it.
    pub(super) path: String,
    /// What its names begin with here.
    pub(super) prefix: String,
    /// Steps that place it.
    pub(super) transform: Option<Node>,
    /// The file's number, once it was read.
    pub(super) file: Option<usize>,
}

/// An entity as written.
#[derive(Debug)]
pub(super) struct Definition {
    pub(super) name: String,
    /// Where the name is written.
    pub(super) at: usize,
    pub(super) components: Vec<Node>,
}

/// Reads the text of the file with a number; what is not sound is reported and left out.
pub(super) fn read(text: &str, file: usize, report: &mut Report) -> Document {
    match node::parse(text) {
        Ok(root) => Reader { text, file, report }.document(root),
        Err((offset, message)) => {
            report.add(Place { file, offset }, message);
            Document::default()
        }
    }
}

struct Reader<'a> {
    text: &'a str,
    file: usize,
    report: &'a mut Report,
}

impl Reader<'_> {
    fn fault(&mut self, offset: usize, message: impl Into<String>) {
        self.report.add(Place { file: self.file, offset }, message);
    }

    /// A fault of a value that is not what was expected.
    fn unexpected(&mut self, subject: &str, expected: &str, found: &Node) {
        let found_text = excerpt(found.text(self.text));
        self.fault(found.span.start, format!("{subject}: expected {expected}, found {found_text}"));
    }

    fn check_names(&mut self, subject: &str, here: usize, fields: &[Field], known: &[&str], required: &[(&str, &str)]) {
        for (offset, message) in check_names(self.text, here, fields, known, required) {
            self.fault(offset, format!("{subject}: {message}"));
        }
    }

    fn document(mut self, root: Node) -> Document {
        const SHAPE: &str = "`Scene(version: 1, …)`";
        let mut document = Document::default();
        let start = root.span.start;
        if let Some(tag) = root.tag(self.text).filter(|tag| *tag != "Scene") {
            self.fault(start, format!("expected {SHAPE}, found `{tag}`{}", did_you_mean(tag, ["Scene"])));
            return document;
        }
        let fields = match root.form {
            Form::Fields(fields) => fields,
            Form::Tagged(_, inner) if matches!(inner.form, Form::Fields(_)) => match inner.form {
                Form::Fields(fields) => fields,
                _ => vec![],
            },
            _ => {
                let found = excerpt(root.text(self.text));
                self.fault(start, format!("expected {SHAPE}, found {found}"));
                return document;
            }
        };
        match fields.iter().find(|field| field.name(self.text) == "version") {
            None => self.fault(start, format!("Scene: missing field `version`: write `version: {VERSION}`")),
            Some(field) if !self.is_version(&field.value) => return document,
            Some(_) => {}
        }
        self.check_names("Scene", start, &fields, &["version", "settings", "include", "entities"], &[]);
        for field in fields {
            match field.name(self.text) {
                "settings" => document.settings = Some(field.value),
                "include" => document.includes = self.includes(field.value),
                "entities" => document.entities = self.entities(field.value),
                _ => {}
            }
        }
        document
    }

    /// Whether this is the version that can be read; of a file of another version nothing else is said.
    fn is_version(&mut self, node: &Node) -> bool {
        let text = node.text(self.text);
        match ron::from_str::<u32>(text) {
            Ok(VERSION) => return true,
            Ok(newer) if newer > VERSION => self.fault(
                node.span.start,
                format!("version: this scene is of version {newer}; this program reads version {VERSION}: update it"),
            ),
            _ => self.unexpected("version", &format!("`{VERSION}`"), node),
        }
        false
    }

    fn includes(&mut self, node: Node) -> Vec<Include> {
        match node.form {
            Form::List(items) => items.into_iter().filter_map(|item| self.include(item)).collect(),
            _ => {
                self.unexpected("include", "a list of files `[\"…\"]`", &node);
                vec![]
            }
        }
    }

    fn include(&mut self, node: Node) -> Option<Include> {
        let at = node.span.start;
        let mut include = Include { at, path: String::new(), prefix: String::new(), transform: None, file: None };
        if let Some(path) = node.string(self.text) {
            include.path = path;
            return Some(include);
        }
        let Form::Fields(fields) = node.form else {
            self.unexpected("include", "a path in quotes or `(path: \"…\", prefix: \"…\", transform: […])`", &node);
            return None;
        };
        self.check_names("include", at, &fields, &["path", "prefix", "transform"], &[("path", "the file")]);
        let mut path = None;
        for field in fields {
            match field.name(self.text) {
                "path" => path = Some(self.string("include.path", &field.value)),
                "prefix" => include.prefix = self.prefix(&field.value),
                "transform" => include.transform = Some(field.value),
                _ => {}
            }
        }
        if let (Some(transform), true) = (&include.transform, include.prefix.is_empty()) {
            let message = "include.transform: a file that is placed needs a `prefix` too, which names its placement";
            self.fault(transform.span.start, message);
            return None;
        }
        include.path = path??;
        Some(include)
    }

    fn string(&mut self, subject: &str, node: &Node) -> Option<String> {
        let string = node.string(self.text);
        if string.is_none() {
            self.unexpected(subject, "a text in quotes", node);
        }
        string
    }

    fn prefix(&mut self, node: &Node) -> String {
        let prefix = self.string("include.prefix", node).unwrap_or_default();
        self.check_reserved(&prefix, node);
        prefix
    }

    fn check_reserved(&mut self, name: &str, node: &Node) {
        if name.contains(RESERVED) {
            let message = format!("{name:?}: `{RESERVED}` is kept for the names of models' materials");
            self.fault(node.span.start, message);
        }
    }

    fn entities(&mut self, node: Node) -> Vec<Definition> {
        match node.form {
            Form::Map(pairs) => pairs.into_iter().filter_map(|(name, value)| self.entity(&name, value)).collect(),
            _ => {
                self.unexpected("entities", "entities by name `{\"name\": [ … ]}`", &node);
                vec![]
            }
        }
    }

    fn entity(&mut self, key: &Node, value: Node) -> Option<Definition> {
        let Some(name) = key.string(self.text) else {
            self.unexpected("entities", "a name in quotes", key);
            return None;
        };
        if name.is_empty() {
            self.fault(key.span.start, "entities: a name needs at least one character");
        }
        self.check_reserved(&name, key);
        let at = key.span.start;
        let components = match value.form {
            Form::List(components) => components,
            _ => {
                self.unexpected(&format!("{name:?}"), "a list of components `[ … ]`", &value);
                vec![]
            }
        };
        Some(Definition { name, at, components })
    }
}
