//! MTL files: the check of their statements, and what the parser makes of them.
//!
//! The parser sees numbered materials, so that any name will do; colours of three numbers; and `d` for transparency
//! however it was written.

use super::feed::{Check, Feed};
use super::lines::Line;
use super::log::Log;
use super::word::{Word, integer, name, number, quoted, words};
use crate::load::fault::{Fault, Position};
use crate::load::file;
use std::path::{Path, PathBuf};

/// Largest library read: many times what any needs, as a short line of it may take much memory.
const MOST_BYTES: u64 = 16 << 20;

/// One material of a library.
pub(super) struct Entry {
    pub(super) name: String,
    pub(super) at: Position,
    pub(super) parsed: tobj::Material,
}

/// The materials of one file.
pub(super) struct Library {
    pub(super) entries: Vec<Entry>,
    pub(super) log: Log,
}

impl Library {
    /// The path of a material's texture, if it has one.
    pub(super) fn texture(&self, of: &Entry) -> Option<PathBuf> {
        let folder = self.log.file().parent().unwrap_or(Path::new(""));
        of.parsed.diffuse_texture.as_ref().map(|texture| file::resolve(folder, texture))
    }
}

/// Reads a library; one with faults has no entries.
///
/// # Errors
/// The file cannot be read, or the parser failed on what had passed the check.
pub(super) fn read(path: &Path) -> Result<Library, Fault> {
    let reader = file::open_text(path, MOST_BYTES)?;
    let mut scan = Scan { log: Log::new(path), names: vec![], has_dissolve: false };
    let parsed = Feed::parse(reader, &mut scan, tobj::load_mtl_buf);
    let materials = parsed.map_err(|message| Fault::of_file(path, message))?.map(|(materials, _)| materials);
    let Scan { log, names, .. } = scan;
    let materials = match materials {
        Some(materials) if materials.len() != names.len() => {
            let message = format!("cannot be parsed: {} materials of {}", materials.len(), names.len());
            return Err(Fault::of_file(path, message));
        }
        materials => materials.unwrap_or_default(),
    };
    let entry = |((name, at), parsed)| Entry { name, at, parsed };
    Ok(Library { entries: names.into_iter().zip(materials).map(entry).collect(), log })
}

struct Scan {
    log: Log,
    names: Vec<(String, Position)>,
    /// Whether the current material has a `d`.
    has_dissolve: bool,
}

impl Check for Scan {
    fn line(&mut self, line: &Line<'_>, out: &mut Vec<u8>) {
        if !line.text.is_ascii() && std::str::from_utf8(line.text).is_err() {
            self.log.notice(Some(line.position(0)), "a line with bytes that are not UTF-8, each read as `\u{fffd}`");
        }
        let Some(keyword) = words(line).next() else { return };
        let at = line.position(keyword.offset);
        if keyword.text == b"newmtl" {
            out.extend_from_slice(format!("newmtl {}\n", self.names.len()).as_bytes());
            self.names.push((name(line, keyword), at));
            self.has_dissolve = false;
            return;
        }
        if self.names.is_empty() {
            return self.log.notice(Some(at), "a statement before the first `newmtl` passed over");
        }
        let checked = match keyword.text {
            b"Ka" | b"Kd" | b"Ks" => self.color(line, keyword, out),
            b"Ns" | b"Ni" | b"d" | b"Tr" => self.scalar(line, keyword, out),
            b"illum" => illumination(line, keyword, out),
            b"map_Kd" => {
                self.texture(line, keyword, out);
                Ok(())
            }
            other => {
                let text = format!("{} passed over: {}", quoted(other), reason(other));
                self.log.notice(Some(at), &text);
                Ok(())
            }
        };
        if let Err((at, message)) = checked {
            self.log.fault(at, message);
        }
    }

    fn finish(&mut self) {}

    fn report(&mut self) -> &mut Log {
        &mut self.log
    }
}

/// What is wrong with a statement, and where.
type Wrong = (Position, String);

impl Scan {
    fn color(&mut self, line: &Line<'_>, keyword: Word<'_>, out: &mut Vec<u8>) -> Result<(), Wrong> {
        let first = words(line).nth(1);
        if let Some(form) = first.filter(|word| [&b"spectral"[..], b"xyz"].contains(&word.text)) {
            let text = format!("a colour as `{}` passed over", String::from_utf8_lossy(form.text));
            self.log.notice(Some(line.position(form.offset)), &text);
            return Ok(());
        }
        let numbers = numbers(line, 1)?;
        let (r, g, b) = match *numbers.as_slice() {
            [r, g, b] => (r, g, b),
            // By the format's definition the others equal the first.
            [grey] => (grey, grey, grey),
            _ => {
                let message = format!("a colour has 3 numbers, or 1 for a grey, this has {}", numbers.len());
                return Err((line.position(keyword.offset), message));
            }
        };
        out.extend_from_slice(keyword.text);
        out.extend_from_slice(format!(" {r} {g} {b}\n").as_bytes());
        Ok(())
    }

    fn scalar(&mut self, line: &Line<'_>, keyword: Word<'_>, out: &mut Vec<u8>) -> Result<(), Wrong> {
        let halo = words(line).nth(1).filter(|word| word.text == b"-halo");
        if let Some(halo) = halo {
            self.log.notice(Some(line.position(halo.offset)), "the option `-halo` passed over");
        }
        let numbers = numbers(line, 1 + usize::from(halo.is_some()))?;
        let Some(value) = numbers.first() else {
            let message = format!("{} has 1 number, this has none", quoted(keyword.text));
            return Err((line.position(keyword.offset), message));
        };
        if numbers.len() > 1 {
            let text = format!("{} has 1 number: those after it passed over", quoted(keyword.text));
            self.log.notice(Some(line.position(keyword.offset)), &text);
        }
        match keyword.text {
            // Some exporters write `Tr` the wrong way round: where `d` is present it is the one to trust.
            b"Tr" if self.has_dissolve => {}
            b"Tr" => out.extend_from_slice(format!("d {}\n", 1.0 - value).as_bytes()),
            keyword => {
                self.has_dissolve |= keyword == b"d";
                out.extend_from_slice(keyword);
                out.extend_from_slice(format!(" {value}\n").as_bytes());
            }
        }
        Ok(())
    }

    fn texture(&mut self, line: &Line<'_>, keyword: Word<'_>, out: &mut Vec<u8>) {
        let mut rest = words(line).skip(1).peekable();
        while let Some(option) = rest.next_if(|word| most_arguments(word.text) > 0) {
            let text = format!("the texture option {} passed over", quoted(option.text));
            self.log.notice(Some(line.position(option.offset)), &text);
            // The first argument is always there, the others only if they are numbers.
            rest.next();
            for _ in 1..most_arguments(option.text) {
                let _ = rest.next_if(|word| number(word.text).is_ok());
            }
        }
        match rest.next() {
            Some(first) => {
                let path = String::from_utf8_lossy(&line.text[first.offset..]);
                out.extend_from_slice(format!("map_Kd {}\n", path.trim()).as_bytes());
            }
            None => self.log.notice(Some(line.position(keyword.offset)), "a texture without a file passed over"),
        }
    }
}

fn numbers(line: &Line<'_>, skip: usize) -> Result<Vec<f32>, Wrong> {
    let read = |word: Word<'_>| number(word.text).map_err(|message| (line.position(word.offset), message));
    words(line).skip(skip).map(read).collect()
}

fn illumination(line: &Line<'_>, keyword: Word<'_>, out: &mut Vec<u8>) -> Result<(), Wrong> {
    let word = words(line).nth(1);
    let model = word.and_then(|word| integer(word.text)).filter(|&model| model >= 0);
    let Some(model) = model else {
        let at = line.position(word.unwrap_or(keyword).offset);
        return Err((at, "`illum` has the number of a model of illumination, 0 to 10".into()));
    };
    out.extend_from_slice(format!("illum {}\n", model.min(i64::from(u8::MAX))).as_bytes());
    Ok(())
}

/// How many arguments a texture option has at most; 0 for what is no option.
fn most_arguments(word: &[u8]) -> usize {
    match word {
        b"-blendu" | b"-blendv" | b"-cc" | b"-clamp" | b"-bm" | b"-boost" | b"-texres" | b"-imfchan" | b"-type" => 1,
        b"-mm" => 2,
        b"-o" | b"-s" | b"-t" => 3,
        _ => 0,
    }
}

/// Why a statement is passed over.
fn reason(keyword: &[u8]) -> &'static str {
    const MAPS: [&[u8]; 6] = [b"map_", b"bump", b"disp", b"decal", b"refl", b"norm"];
    match keyword {
        _ if MAPS.iter().any(|map| keyword.starts_with(map)) => "of the textures only `map_Kd` is read",
        b"Ke" | b"Tf" | b"sharpness" | b"Km" | b"Pr" | b"Pm" | b"Ps" | b"Pc" | b"Pcr" | b"aniso" | b"anisor" => {
            "a property without a counterpart"
        }
        _ => "unknown statement",
    }
}
