//! The check of an OBJ file's statements: every number, count and index, with its place.
//!
//! What passes on to the parser are the statements `v` (three numbers), `vt` (two), `vn` and `f`, the last with absolute
//! indices and corners that either all or none have a texture coordinate, and likewise a normal. What the parser is not
//! shown is kept here: materials, and which faces have which attribute.

use super::feed::Check;
use super::lines::Line;
use super::log::Log;
use super::word::{Word, integer, name, number, quoted, words};
use crate::load::fault::Position;
use std::collections::BTreeMap;
use std::path::Path;

/// What the indices of a corner refer to, in the order they are written.
const REFERRED: [&str; 3] = ["vertex", "texture coordinate", "normal"];

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

/// What a file holds beside what the parser keeps.
pub(super) struct Scan {
    pub(super) log: Log,
    /// Vertices, texture coordinates and normals.
    pub(super) counts: [usize; 3],
    pub(super) faces: usize,
    /// Corners of all faces.
    pub(super) corners: usize,
    pub(super) runs: Vec<Run>,
    /// Materials in order of their first use.
    pub(super) names: Vec<(String, Position)>,
    /// What the `mtllib` statements say.
    pub(super) libraries: Vec<(String, Position)>,
    ahead: Vec<Ahead>,
    material: Current,
    slots: BTreeMap<String, u16>,
    face: Vec<[Option<usize>; 3]>,
}

impl Scan {
    pub(super) fn new(file: &Path) -> Self {
        Self {
            log: Log::new(file),
            counts: [0; 3],
            faces: 0,
            corners: 0,
            runs: vec![],
            names: vec![],
            libraries: vec![],
            ahead: vec![],
            material: Current::None,
            slots: BTreeMap::new(),
            face: vec![],
        }
    }

    /// Checks a statement of numbers and passes those on that the parser reads, absent ones as zero.
    fn numbers(&mut self, line: &Line<'_>, keyword: Word<'_>, kind: Numbers, out: &mut Vec<u8>) {
        self.counts[kind.counted] += 1;
        let mut count = 0;
        out.extend_from_slice(kind.keyword);
        for word in words(line).skip(1) {
            if let Err(message) = number(word.text) {
                return self.log.fault(line.position(word.offset), message);
            }
            if count < kind.kept {
                out.push(b' ');
                out.extend_from_slice(word.text);
            }
            count += 1;
        }
        if !kind.allowed.contains(&count) {
            let message = format!("{}, this has {count}", kind.rule);
            return self.log.fault(line.position(keyword.offset), message);
        }
        for _ in count..kind.kept {
            out.extend_from_slice(b" 0");
        }
        out.push(b'\n');
        if kind.counted == 0 && count > 3 {
            let what = if count == 4 { "weight, which only curves use," } else { "colour" };
            self.log.notice(Some(line.position(keyword.offset)), &format!("a vertex with a {what} is read without"));
        }
    }

    fn face(&mut self, line: &Line<'_>, keyword: Word<'_>, out: &mut Vec<u8>) {
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
            let count = self.face.iter().filter(|corner| corner[kind].is_some()).count();
            if count > 0 && count < corners {
                let text = format!("a face with a {} at only some of its corners: it is left without", REFERRED[kind]);
                self.log.notice(Some(line.position(keyword.offset)), &text);
            }
            count == corners
        });
        out.push(b'f');
        for &[vertex, uv, normal] in &self.face {
            let (uv, normal) = (uv.filter(|_| uvs), normal.filter(|_| normals));
            out.push(b' ');
            push_number(out, vertex.unwrap_or_default());
            if uv.is_some() || normal.is_some() {
                out.push(b'/');
            }
            if let Some(uv) = uv {
                push_number(out, uv);
            }
            if let Some(normal) = normal {
                out.push(b'/');
                push_number(out, normal);
            }
        }
        out.push(b'\n');
        self.count_face(Has { uvs, normals });
    }

    /// The absolute indices of a corner; a fault and nothing if one is wrong.
    fn corner(&mut self, line: &Line<'_>, word: Word<'_>) -> Option<[Option<usize>; 3]> {
        let mut corner = [None; 3];
        let mut offset = word.offset;
        for (kind, part) in word.text.split(|&b| b == b'/').enumerate() {
            let index = match (integer(part), corner.get(kind)) {
                (_, None) => Err(format!("{} has more than 3 indices", quoted(word.text))),
                (None, _) if part.is_empty() && kind > 0 => Ok(None),
                (None, _) => Err(format!("{} is not the index of a {}", quoted(part), REFERRED[kind])),
                (Some(index), _) => self.absolute(line, offset, kind, index).map(Some),
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

    /// An index counted from 1. Those that point ahead are noted down for the end of the file.
    fn absolute(&mut self, line: &Line<'_>, offset: usize, kind: usize, index: i64) -> Result<usize, String> {
        let count = self.counts[kind];
        let what = REFERRED[kind];
        let magnitude = usize::try_from(index.unsigned_abs()).unwrap_or(usize::MAX);
        match index {
            0 => Err(format!("there is no {what} 0: they count from 1")),
            1.. => {
                if magnitude > count {
                    self.ahead.push(Ahead { at: line.position(offset), kind, index: magnitude });
                }
                Ok(magnitude)
            }
            _ if magnitude <= count => Ok(count - magnitude + 1),
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
        self.corners += self.face.len();
    }
}

/// How a statement of numbers is written.
struct Numbers {
    keyword: &'static [u8],
    /// Position in [`Scan::counts`].
    counted: usize,
    allowed: &'static [usize],
    /// How many of them the parser reads.
    kept: usize,
    rule: &'static str,
}

const VERTEX: Numbers = Numbers {
    keyword: b"v",
    counted: 0,
    allowed: &[3, 4, 6, 7],
    kept: 3,
    rule: "a vertex has 3 numbers, 4 with a weight, 6 or 7 with a colour",
};
const UV: Numbers = Numbers {
    keyword: b"vt",
    counted: 1,
    allowed: &[1, 2, 3],
    kept: 2,
    rule: "a texture coordinate has 1 to 3 numbers",
};
const NORMAL: Numbers = Numbers { keyword: b"vn", counted: 2, allowed: &[3], kept: 3, rule: "a normal has 3 numbers" };

impl Check for Scan {
    fn line(&mut self, line: &Line<'_>, out: &mut Vec<u8>) {
        if !line.text.is_ascii() && std::str::from_utf8(line.text).is_err() {
            self.log.notice(Some(line.position(0)), "a line with bytes that are not UTF-8, each read as `\u{fffd}`");
        }
        let Some(keyword) = words(line).next() else { return };
        let at = || line.position(keyword.offset);
        match keyword.text {
            b"v" => self.numbers(line, keyword, VERTEX, out),
            b"vt" => self.numbers(line, keyword, UV, out),
            b"vn" => self.numbers(line, keyword, NORMAL, out),
            b"f" => self.face(line, keyword, out),
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
        for Ahead { at, kind, index } in self.ahead.drain(..) {
            let (count, what) = (self.counts[kind], REFERRED[kind]);
            if kind > 0 && count == 0 {
                // Exporters leave out what was not asked for, but not always the references to it.
                self.log.notice(Some(at), &format!("the file has no {what}s: a corner's index of one is passed over"));
            } else if index > count {
                self.log.fault(at, format!("there is no {what} {index}: the file has {count}"));
            }
        }
    }

    fn report(&mut self) -> &mut Log {
        &mut self.log
    }
}

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

/// Appends a number in decimal digits.
fn push_number(out: &mut Vec<u8>, number: usize) {
    let mut digits = [0; 20];
    let mut start = digits.len();
    let mut rest = number;
    loop {
        start -= 1;
        digits[start] = b'0' + (rest % 10) as u8;
        rest /= 10;
        if rest == 0 {
            break;
        }
    }
    out.extend_from_slice(&digits[start..]);
}
