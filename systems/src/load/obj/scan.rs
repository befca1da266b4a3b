//! The reading of an OBJ file's statements: every number, count and index is checked, with its place, and kept.

use super::lines::{Line, Lines};
use super::log::Log;
use super::word::{Word, integer, name, number, quoted, words};
use crate::load::fault::Position;
use std::collections::BTreeMap;
use std::io::{self, BufRead};
use std::path::Path;

/// What the indices of a corner refer to, in the order they are written.
const REFERRED: [&str; 3] = ["vertex", "texture coordinate", "normal"];

/// The index of what a corner does not have.
pub(super) const NONE: u32 = u32::MAX;

/// Faces in a row with the same material and attributes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Run {
    /// Number of the first of the faces.
    pub(super) first: usize,
    /// Position in [`Scan::names`] of the material.
    pub(super) material: Option<u16>,
    /// Whether the corners have texture coordinates and normals.
    pub(super) has: Has,
}

/// Which attributes the corners of a face have.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Has {
    pub(super) uvs: bool,
    pub(super) normals: bool,
}

impl Has {
    /// Neither.
    pub(super) const NONE: Self = Self { uvs: false, normals: false };
}

/// An index that points ahead: it is right only if the file goes on long enough.
struct Ahead {
    at: Position,
    kind: usize,
    index: usize,
}

/// The material of the faces that follow.
enum Current {
    None,
    /// One that faces above have.
    Known(u16),
    /// One that no face has yet.
    New(String, Position),
}

/// What a file holds. What stands beside a fault is not to be used.
pub(super) struct Scan {
    pub(super) log: Log,
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) uvs: Vec<[f32; 2]>,
    pub(super) normals: Vec<[f32; 3]>,
    /// Of the corners of all faces, one after the other, counted from 0.
    pub(super) vertices: Vec<u32>,
    /// Likewise; empty if no corner before has one, else with [`NONE`] where one has none.
    pub(super) corner_uvs: Vec<u32>,
    /// Likewise.
    pub(super) corner_normals: Vec<u32>,
    /// Faces that are no triangles, by number, with their corners.
    pub(super) polygons: Vec<(usize, usize)>,
    pub(super) faces: usize,
    pub(super) runs: Vec<Run>,
    /// Materials in order of their first use.
    pub(super) names: Vec<(String, Position)>,
    /// What the `mtllib` statements say.
    pub(super) libraries: Vec<(String, Position)>,
    ahead: Vec<Ahead>,
    material: Current,
    slots: BTreeMap<String, u16>,
    face: Vec<[u32; 3]>,
}

impl Scan {
    pub(super) fn new(file: &Path) -> Self {
        Self {
            log: Log::new(file),
            positions: vec![],
            uvs: vec![],
            normals: vec![],
            vertices: vec![],
            corner_uvs: vec![],
            corner_normals: vec![],
            polygons: vec![],
            faces: 0,
            runs: vec![],
            names: vec![],
            libraries: vec![],
            ahead: vec![],
            material: Current::None,
            slots: BTreeMap::new(),
            face: vec![],
        }
    }

    /// Reads all statements of a file.
    ///
    /// # Errors
    /// The file cannot be read.
    pub(super) fn read(&mut self, reader: impl BufRead) -> io::Result<()> {
        let mut lines = Lines::new(reader);
        while let Some(line) = lines.next()? {
            self.line(&line);
        }
        self.finish();
        Ok(())
    }

    /// How many vertices, texture coordinates or normals stand above.
    fn count(&self, kind: usize) -> usize {
        [self.positions.len(), self.uvs.len(), self.normals.len()][kind]
    }

    /// The numbers of a statement, absent ones zero; those of a faulty one mean nothing.
    fn numbers<const N: usize>(&mut self, line: &Line<'_>, keyword: Word<'_>, rule: &Numbers) -> [f32; N] {
        let mut numbers = [0.0; N];
        let mut count = 0;
        for word in words(line).skip(1) {
            match number(word.text) {
                Ok(value) if count < N => numbers[count] = value,
                Ok(_) => {}
                Err(message) => {
                    self.log.fault(line.position(word.offset), message);
                    return numbers;
                }
            }
            count += 1;
        }
        if !rule.allowed.contains(&count) {
            self.log.fault(line.position(keyword.offset), format!("{}, this has {count}", rule.text));
        } else if N == 3 && count > 3 {
            let what = if count == 4 { "weight, which only curves use," } else { "colour" };
            self.log.notice(Some(line.position(keyword.offset)), &format!("a vertex with a {what} is read without"));
        }
        numbers
    }

    fn face(&mut self, line: &Line<'_>, keyword: Word<'_>) {
        self.face.clear();
        for word in words(line).skip(1) {
            match self.corner(line, word) {
                Some(corner) => self.face.push(corner),
                None => return,
            }
        }
        let corners = self.face.len();
        if corners < 3 {
            let message = format!("a face needs 3 corners, this has {corners}");
            return self.log.fault(line.position(keyword.offset), message);
        }
        let [uvs, normals] = [1, 2].map(|kind| {
            let count = self.face.iter().filter(|corner| corner[kind] != NONE).count();
            if count > 0 && count < corners {
                let text = format!("a face with a {} at only some of its corners: it is left without", REFERRED[kind]);
                self.log.notice(Some(line.position(keyword.offset)), &text);
            }
            count == corners
        });
        let before = self.vertices.len();
        self.vertices.extend(self.face.iter().map(|corner| corner[0]));
        for (has, kind, list) in [(uvs, 1, &mut self.corner_uvs), (normals, 2, &mut self.corner_normals)] {
            if has {
                list.resize(before, NONE);
                list.extend(self.face.iter().map(|corner| corner[kind]));
            }
        }
        if corners != 3 {
            self.polygons.push((self.faces, corners));
        }
        self.count_face(Has { uvs, normals });
    }

    /// The indices of a corner, counted from 0, [`NONE`] where it has none; a fault and nothing if one is wrong.
    fn corner(&mut self, line: &Line<'_>, word: Word<'_>) -> Option<[u32; 3]> {
        let mut corner = [NONE; 3];
        let mut offset = word.offset;
        for (kind, part) in word.text.split(|&b| b == b'/').enumerate() {
            let index = match (integer(part), corner.get(kind)) {
                (_, None) => Err(format!("{} has more than 3 indices", quoted(word.text))),
                (None, _) if part.is_empty() && kind > 0 => Ok(NONE),
                (None, _) => Err(format!("{} is not the index of a {}", quoted(part), REFERRED[kind])),
                (Some(index), _) => self.absolute(line, offset, kind, index),
            };
            match index {
                Ok(index) => corner[kind] = index,
                Err(message) => {
                    self.log.fault(line.position(offset), message);
                    return None;
                }
            }
            offset += part.len() + 1;
        }
        Some(corner)
    }

    /// An index counted from 0. Those that point ahead are noted down for the end of the file.
    fn absolute(&mut self, line: &Line<'_>, offset: usize, kind: usize, index: i64) -> Result<u32, String> {
        let count = self.count(kind);
        let what = REFERRED[kind];
        let magnitude = usize::try_from(index.unsigned_abs()).unwrap_or(usize::MAX);
        match index {
            0 => Err(format!("there is no {what} 0: they count from 1")),
            1.. => {
                if magnitude > count {
                    self.ahead.push(Ahead { at: line.position(offset), kind, index: magnitude });
                }
                // An index beyond 32 bits is beyond any count: the end of the file will tell.
                Ok(u32::try_from(magnitude - 1).unwrap_or(NONE))
            }
            _ if magnitude <= count => Ok((count - magnitude) as u32),
            _ => Err(format!("there is no {what} {index}: {count} stand above")),
        }
    }

    fn count_face(&mut self, has: Has) {
        let material = match std::mem::replace(&mut self.material, Current::None) {
            Current::None => None,
            Current::Known(slot) => Some(slot),
            Current::New(name, at) => match u16::try_from(self.names.len()) {
                // One slot less than there are numbers: faces without a material may need it.
                Ok(slot) if slot < u16::MAX => {
                    self.slots.insert(name.clone(), slot);
                    self.names.push((name, at));
                    Some(slot)
                }
                _ => {
                    self.log.fault(at, format!("more than {} materials", u16::MAX));
                    None
                }
            },
        };
        self.material = material.map_or(Current::None, Current::Known);
        if self.runs.last().is_none_or(|run| (run.material, run.has) != (material, has)) {
            self.runs.push(Run { first: self.faces, material, has });
        }
        self.faces += 1;
    }

    fn line(&mut self, line: &Line<'_>) {
        if !line.text.is_ascii() && std::str::from_utf8(line.text).is_err() {
            self.log.notice(Some(line.position(0)), "a line with bytes that are not UTF-8, each read as `\u{fffd}`");
        }
        let Some(keyword) = words(line).next() else { return };
        let at = || line.position(keyword.offset);
        match keyword.text {
            b"v" => {
                let position = self.numbers(line, keyword, &VERTEX);
                self.positions.push(position);
            }
            b"vt" => {
                let uv = self.numbers(line, keyword, &UV);
                self.uvs.push(uv);
            }
            b"vn" => {
                let normal = self.numbers(line, keyword, &NORMAL);
                self.normals.push(normal);
            }
            b"f" => self.face(line, keyword),
            b"usemtl" => {
                let name = name(line, keyword);
                let known = self.slots.get(&name).copied();
                self.material = known.map_or_else(|| Current::New(name, at()), Current::Known);
            }
            b"mtllib" => self.libraries.push((name(line, keyword), at())),
            // Names and smoothing of groups: a mesh is one object, smooth where it has normals.
            b"o" | b"g" | b"s" => {}
            other => {
                let text = format!("{} passed over: {}", quoted(other), reason(other));
                self.log.notice(Some(at()), &text);
            }
        }
    }

    fn finish(&mut self) {
        for Ahead { at, kind, index } in std::mem::take(&mut self.ahead) {
            let (count, what) = (self.count(kind), REFERRED[kind]);
            if kind > 0 && count == 0 {
                // Exporters leave out what was not asked for, but not always the references to it.
                self.log.notice(Some(at), &format!("the file has no {what}s: a corner's index of one is passed over"));
            } else if index > count {
                self.log.fault(at, format!("there is no {what} {index}: the file has {count}"));
            }
        }
    }
}

/// How many numbers a statement has.
struct Numbers {
    allowed: &'static [usize],
    text: &'static str,
}

const VERTEX: Numbers =
    Numbers { allowed: &[3, 4, 6, 7], text: "a vertex has 3 numbers, 4 with a weight, 6 or 7 with a colour" };
const UV: Numbers = Numbers { allowed: &[1, 2, 3], text: "a texture coordinate has 1 to 3 numbers" };
const NORMAL: Numbers = Numbers { allowed: &[3], text: "a normal has 3 numbers" };

/// Why a statement is passed over.
fn reason(keyword: &[u8]) -> &'static str {
    match keyword {
        b"p" | b"l" => "points and lines have no surface",
        b"vp" | b"cstype" | b"deg" | b"bmat" | b"step" | b"curv" | b"curv2" | b"surf" | b"parm" | b"trim" | b"hole"
        | b"scrv" | b"sp" | b"end" | b"con" | b"mg" | b"ctech" | b"stech" => "curved surfaces are not read",
        b"bevel" | b"c_interp" | b"d_interp" | b"lod" | b"shadow_obj" | b"trace_obj" | b"maplib" | b"usemap" => {
            "a display attribute"
        }
        _ => "unknown statement",
    }
}
