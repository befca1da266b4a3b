//! A text file as logical lines, each byte of which knows its place in the file.

use crate::load::fault::Position;
use std::io::{self, BufRead};

/// A logical line: physical lines joined where they end in a backslash, without their line ends.
pub(super) struct Line<'a> {
    pub(super) text: &'a [u8],
    pieces: &'a [Piece],
}

/// Where a physical line begins in the logical one.
#[derive(Clone, Copy)]
struct Piece {
    start: usize,
    line: usize,
}

impl Line<'_> {
    /// The place in the file of a byte of the text.
    pub(super) fn position(&self, offset: usize) -> Position {
        let piece = self.pieces.iter().rfind(|piece| piece.start <= offset).copied();
        let Piece { start, line } = piece.unwrap_or(Piece { start: 0, line: 1 });
        // Every byte but those that continue a character in UTF-8 starts one.
        let starts = |byte: &&u8| **byte & 0xC0 != 0x80;
        let before = self.text.get(start..offset).unwrap_or_default();
        Position { line, column: 1 + before.iter().filter(starts).count() }
    }
}

/// The logical lines of a reader. Lines end in LF, CR LF or CR; comments are not continued.
pub(super) struct Lines<R> {
    reader: R,
    /// What was read last: one physical line, or several where they end in CR alone.
    raw: Vec<u8>,
    /// How much of `raw` was handed out.
    used: usize,
    /// Count of physical lines handed out.
    count: usize,
    joined: Vec<u8>,
    pieces: Vec<Piece>,
}

impl<R: BufRead> Lines<R> {
    pub(super) fn new(reader: R) -> Self {
        Self { reader, raw: vec![], used: 0, count: 0, joined: vec![], pieces: vec![] }
    }

    /// The next line; `None` at the end of the file.
    pub(super) fn next(&mut self) -> io::Result<Option<Line<'_>>> {
        self.joined.clear();
        self.pieces.clear();
        loop {
            let Some((start, end)) = self.physical()? else {
                let text = (!self.pieces.is_empty()).then_some(&*self.joined);
                return Ok(text.map(|text| Line { text, pieces: &self.pieces }));
            };
            self.pieces.push(Piece { start: self.joined.len(), line: self.count });
            let text = &self.raw[start..end];
            let continued = text.strip_suffix(b"\\").filter(|_| !(self.joined.is_empty() && is_comment(text)));
            match continued {
                Some(text) => {
                    self.joined.extend_from_slice(text);
                    self.joined.push(b' ');
                }
                None if self.joined.is_empty() => {
                    return Ok(Some(Line { text: &self.raw[start..end], pieces: &self.pieces }));
                }
                None => {
                    self.joined.extend_from_slice(text);
                    return Ok(Some(Line { text: &self.joined, pieces: &self.pieces }));
                }
            }
        }
    }

    /// The range in `raw` of the next physical line, without its end.
    fn physical(&mut self) -> io::Result<Option<(usize, usize)>> {
        if self.used == self.raw.len() {
            self.raw.clear();
            self.used = 0;
            if self.reader.read_until(b'\n', &mut self.raw)? == 0 {
                return Ok(None);
            }
        }
        self.count += 1;
        let rest = &self.raw[self.used..];
        let len = rest.iter().position(|&b| b == b'\r' || b == b'\n').unwrap_or(rest.len());
        let end = match &rest[len..] {
            [b'\r', b'\n', ..] => len + 2,
            [] => len,
            _ => len + 1,
        };
        let start = self.used;
        self.used += end;
        Ok(Some((start, start + len)))
    }
}

fn is_comment(text: &[u8]) -> bool {
    text.trim_ascii_start().starts_with(b"#")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &str) -> Vec<(String, usize)> {
        let mut lines = Lines::new(text.as_bytes());
        let mut found = vec![];
        while let Some(line) = lines.next().expect("text in memory") {
            found.push((String::from_utf8_lossy(line.text).into_owned(), line.position(0).line));
        }
        found
    }

    #[test]
    fn lines_end_in_every_known_way() {
        let expected = ["a", "b", "", "c", "d"].map(String::from);
        let found = all("a\nb\r\n\rc\rd");
        assert_eq!(found.iter().map(|(_, line)| *line).collect::<Vec<_>>(), [1, 2, 3, 4, 5]);
        assert_eq!(found.into_iter().map(|(text, _)| text).collect::<Vec<_>>(), expected);
        assert!(all("").is_empty());
        assert_eq!(all("\n").len(), 1);
    }

    #[test]
    fn continued_lines_keep_the_places_of_their_pieces() {
        let mut lines = Lines::new("f 1 \\\r\n2 \\\né 3\nend\\".as_bytes());
        let line = lines.next().expect("text in memory").expect("a line");
        assert_eq!(line.text, "f 1  2  é 3".as_bytes());
        let at = line.text.len() - 1;
        assert_eq!(line.position(2), Position { line: 1, column: 3 });
        assert_eq!(line.position(5), Position { line: 2, column: 1 });
        assert_eq!(line.position(at), Position { line: 3, column: 3 });
        assert_eq!(lines.next().expect("text in memory").expect("a line").text, b"end ");
        assert!(lines.next().expect("text in memory").is_none());
    }

    #[test]
    fn a_comment_is_not_continued() {
        assert_eq!(all("# C:\\\nv").len(), 2);
        assert_eq!(all("f 1 # C:\\\nv").len(), 1);
    }
}
