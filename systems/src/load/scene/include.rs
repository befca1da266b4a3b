//! Scene files and the files they include: each is read once, and its entities stand in the scene once for every time
//! that it is included.

use super::{
    document::{self, RESERVED},
    node::Node,
    source::{Place, Report, Source, beside, excerpt},
};
use crate::load::{
    assets::{find, reason},
    fault::{Fault, Faults},
};
use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

/// How often files may be included in all. Ten files that include each other twice make a thousand inclusions.
const MOST_INCLUSIONS: usize = 10_000;

/// What the name of an included file's placement ends with.
const PLACEMENT: &str = "(include)";

/// Reads a scene file and all that it includes, in the order in which they are met.
///
/// # Errors
/// The scene file itself cannot be read.
pub(super) fn read_files(path: &Path, report: &mut Report) -> Result<Vec<Source>, Faults> {
    let bytes = fs::read(path).map_err(|error| Faults(vec![Fault::of_file(path, reason(&error))]))?;
    Ok(read_all(path, bytes, report))
}

/// Reads a scene from memory, and all that it includes, in the order in which they are met.
pub(super) fn read_all(path: &Path, bytes: Vec<u8>, report: &mut Report) -> Vec<Source> {
    let base = path.parent().unwrap_or(Path::new("")).to_path_buf();
    let mut number_by_file: BTreeMap<PathBuf, usize> = BTreeMap::new();
    // A scene from memory need not exist as a file.
    number_by_file.insert(path.canonicalize().unwrap_or(path.into()), 0);
    let mut sources = vec![open(path.into(), String::new(), bytes, 0, report)];
    let mut at = 0;
    while let Some(source) = sources.get_mut(at) {
        let folder = source.folder.clone();
        let mut includes = std::mem::take(&mut source.document.includes);
        for include in &mut includes {
            let from_scene = beside(&folder, &include.path);
            let file = base.join(&from_scene);
            let number = find(&file).and_then(|found| {
                if let Some(number) = number_by_file.get(&found) {
                    return Ok(*number);
                }
                let bytes = fs::read(&file).map_err(|error| reason(&error))?;
                let number = sources.len();
                sources.push(open(file.clone(), folder_of(&from_scene), bytes, number, report));
                number_by_file.insert(found, number);
                Ok(number)
            });
            match number {
                Ok(number) => include.file = Some(number),
                Err(why) => {
                    let message = format!("include: cannot read `{}`: {why}", file.display());
                    report.add(Place { file: at, offset: include.at }, message);
                }
            }
        }
        if let Some(source) = sources.get_mut(at) {
            source.document.includes = includes;
        }
        at += 1;
    }
    sources
}

/// The folder part of a path.
fn folder_of(path: &str) -> String {
    Path::new(path).parent().and_then(Path::to_str).unwrap_or_default().into()
}

/// Reads one file's text.
fn open(path: PathBuf, folder: String, bytes: Vec<u8>, file: usize, report: &mut Report) -> Source {
    let (mut text, fault) = match String::from_utf8(bytes) {
        Ok(text) => (text, None),
        Err(error) => {
            let (end, bytes) = (error.utf8_error().valid_up_to(), error.into_bytes());
            let message = format!("expected UTF-8 text, found the byte {:#04x}", bytes.get(end).unwrap_or(&0));
            (String::from_utf8_lossy(bytes.get(..end).unwrap_or_default()).into_owned(), Some(message))
        }
    };
    if let Some(rest) = text.strip_prefix('\u{FEFF}') {
        text = rest.into();
    }
    let mut source = Source::new(path, folder, text);
    match fault {
        Some(message) => report.add(Place { file, offset: source.text.len() }, message),
        None => source.document = document::read(&source.text, file, report),
    }
    source
}

/// One inclusion of a file; the first is the scene itself.
pub(super) struct Scope {
    file: usize,
    /// What the names of its entities begin with.
    prefix: String,
    /// The inclusion that holds this one.
    outer: Option<usize>,
    /// The entity that places its entities.
    pub(super) placement: Option<usize>,
}

/// An entity to be.
pub(super) struct Named<'s> {
    /// Its name in the scene.
    pub(super) name: String,
    /// Its name in its file, for messages: the same in every inclusion.
    pub(super) written: &'s str,
    pub(super) place: Place,
    /// The inclusion in which its references are looked up.
    pub(super) scope: usize,
    pub(super) content: Content<'s>,
}

/// What an entity is made from.
#[derive(Clone, Copy)]
pub(super) enum Content<'s> {
    Components(&'s [Node]),
    /// The steps that place an included file.
    Steps(&'s Node),
}

/// All entities of a scene and where their names are known.
pub(super) struct Layout<'s> {
    pub(super) scopes: Vec<Scope>,
    pub(super) entities: Vec<Named<'s>>,
    by_name: BTreeMap<String, usize>,
}

impl<'s> Layout<'s> {
    /// Lays out what the files say; double names and circles of files are reported.
    pub(super) fn new(sources: &'s [Source], report: &mut Report) -> Self {
        let scene = Scope { file: 0, prefix: String::new(), outer: None, placement: None };
        let mut layout = Self { scopes: vec![scene], entities: vec![], by_name: BTreeMap::new() };
        let mut scope = 0;
        while scope < layout.scopes.len() {
            layout.add_scope(scope, sources, report);
            scope += 1;
        }
        layout
    }

    /// Adds the entities of an inclusion, and the inclusions in it.
    fn add_scope(&mut self, scope: usize, sources: &'s [Source], report: &mut Report) {
        let Scope { file, ref prefix, placement, .. } = self.scopes[scope];
        let prefix = prefix.clone();
        let Some(source) = sources.get(file) else { return };
        for definition in &source.document.entities {
            self.add(
                sources,
                report,
                Named {
                    name: format!("{prefix}{}", definition.name),
                    written: &definition.name,
                    place: Place { file, offset: definition.at },
                    scope,
                    content: Content::Components(&definition.components),
                },
            );
        }
        for include in &source.document.includes {
            let place = Place { file, offset: include.at };
            let Some(target) = include.file else { continue };
            if let Some(circle) = self.circle(scope, target, sources) {
                report.add(place, format!("include: files include each other in a circle: {circle}"));
                continue;
            }
            if self.scopes.len() > MOST_INCLUSIONS {
                report.add(place, format!("include: more than {MOST_INCLUSIONS} inclusions in one scene"));
                return;
            }
            let prefix = format!("{prefix}{}", include.prefix);
            let mut placement = placement;
            if let Some(steps) = &include.transform {
                let name = format!("{prefix}{PLACEMENT}");
                let content = Content::Steps(steps);
                let entity = Named { name, written: &include.path, place, scope, content };
                placement = self.add(sources, report, entity).or(placement);
            }
            self.scopes.push(Scope { file: target, prefix, outer: Some(scope), placement });
        }
    }

    /// Adds an entity and gives its number, unless its name is taken.
    fn add(&mut self, sources: &[Source], report: &mut Report, entity: Named<'s>) -> Option<usize> {
        let first = self.by_name.get(&entity.name).and_then(|number| self.entities.get(*number));
        let Some(first) = first else {
            let number = self.entities.len();
            self.by_name.insert(entity.name.clone(), number);
            self.entities.push(entity);
            return Some(number);
        };
        let source = sources.get(first.place.file)?;
        let (name, line) = (&entity.name, source.line(first.place.offset));
        if first.place == entity.place {
            let message = format!("{name:?}: this file is included twice under one prefix, so the name is taken twice");
            report.add(entity.place, message);
        } else if first.place.file == entity.place.file {
            report.add(entity.place, format!("{name:?}: the name is taken: it is first given in line {line}"));
        } else {
            let path = source.path.display();
            report.add(entity.place, format!("{name:?}: the name is taken: it is first given in {path}:{line}"));
        }
        None
    }

    /// The files from `target` to itself, if it is among those that hold the scope.
    fn circle(&self, scope: usize, target: usize, sources: &[Source]) -> Option<String> {
        let holders = std::iter::successors(Some(scope), |scope| self.scopes.get(*scope)?.outer);
        let files: Vec<_> = holders.filter_map(|scope| Some(self.scopes.get(scope)?.file)).collect();
        let start = files.iter().position(|file| *file == target)?;
        let circle = files.iter().take(start + 1).rev().chain([&target]);
        let names = circle.filter_map(|file| Some(excerpt(&sources.get(*file)?.path.display().to_string())));
        Some(names.collect::<Vec<_>>().join(" → "))
    }

    /// The number of the entity that a name means in a scope: its own, or else one of the nearest scope around it.
    pub(super) fn resolve(&self, scope: usize, name: &str) -> Option<usize> {
        let holders = std::iter::successors(Some(scope), |scope| self.scopes.get(*scope)?.outer);
        let mut prefixes = holders.filter_map(|scope| Some(&self.scopes.get(scope)?.prefix));
        prefixes.find_map(|prefix| self.by_name.get(&format!("{prefix}{name}")).copied())
    }

    /// The names that can be meant in a scope, as they are written there.
    pub(super) fn names(&self, scope: usize) -> impl Iterator<Item = &str> {
        let prefix = self.scopes.get(scope).map_or("", |scope| &scope.prefix);
        let names = self.entities.iter().map(|entity| entity.name.as_str());
        names.map(move |name| name.strip_prefix(prefix).unwrap_or(name)).filter(|name| !name.contains(RESERVED))
    }
}
