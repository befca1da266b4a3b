//! The layout.

use super::tree::{Group, Item, Piece, Remark};

/// Longest line, where it can be helped.
const WIDTH: usize = 120;
const INDENT: usize = 4;

/// The whole text.
pub(super) fn root(group: &Group<'_>) -> String {
    let mut printer = Printer::default();
    for (number, item) in group.items.iter().enumerate() {
        printer.remarks(&item.above, number == 0);
        printer.start(item.apart && (number > 0 || !item.above.is_empty()));
        printer.item(item, 0);
        printer.behind(&item.behind);
    }
    printer.remarks(&group.end, group.items.is_empty());
    let mut text = printer.text.trim_start_matches('\n').to_owned();
    text.push('\n');
    text
}

/// An item in one line; none if a comment or an open bracket keeps it from that.
fn flat(item: &Item<'_>) -> Option<String> {
    if !item.above.is_empty() || !item.behind.is_empty() {
        return None;
    }
    flat_pieces(&item.pieces)
}

fn flat_pieces(pieces: &[Piece<'_>]) -> Option<String> {
    let mut text = String::new();
    for (number, piece) in pieces.iter().enumerate() {
        match piece {
            Piece::Group(group) => text.push_str(&flat_group(group)?),
            other => text.push_str(&plain(other, number)),
        }
        space_behind(&mut text, pieces, number);
    }
    Some(text)
}

fn flat_group(group: &Group<'_>) -> Option<String> {
    if !group.end.is_empty() || (group.is_open && !group.items.is_empty()) {
        return None;
    }
    let items: Vec<_> = group.items.iter().map(flat).collect::<Option<_>>()?;
    Some(format!("{}{}{}", group.open, items.join(", "), group.close))
}

/// A piece that is no group.
fn plain<'t>(piece: &Piece<'t>, number: usize) -> String {
    match piece {
        Piece::Atom(text) => (*text).into(),
        Piece::Colon => ":".into(),
        Piece::Comment(text) if number == 0 => (*text).into(),
        Piece::Comment(text) => format!(" {text}"),
        Piece::Group(_) => String::new(),
    }
}

/// The space between a piece and the next one.
fn space_behind(text: &mut String, pieces: &[Piece<'_>], number: usize) {
    let spaced = matches!(pieces[number], Piece::Colon | Piece::Comment(_));
    if spaced && pieces.get(number + 1).is_some_and(|next| !matches!(next, Piece::Comment(_) | Piece::Colon)) {
        text.push(' ');
    }
}

#[derive(Default)]
struct Printer {
    text: String,
    indent: usize,
}

impl Printer {
    /// Begins a line.
    fn start(&mut self, apart: bool) {
        self.text.push_str(if apart { "\n\n" } else { "\n" });
        self.text.extend(std::iter::repeat_n(' ', self.indent));
    }

    /// Comments in lines of their own; `first` says that nothing stands before them.
    fn remarks(&mut self, remarks: &[Remark<'_>], first: bool) {
        for (number, remark) in remarks.iter().enumerate() {
            self.start(remark.apart && !(first && number == 0));
            let lines: Vec<_> = remark.text.lines().map(str::trim_end).collect();
            self.text.push_str(&lines.join("\n"));
        }
    }

    /// Comments behind a value.
    fn behind(&mut self, comments: &[&str]) {
        for (number, comment) in comments.iter().enumerate() {
            let lines: Vec<_> = comment.lines().map(str::trim_end).collect();
            // Nothing can follow a comment that fills its line.
            if number > 0 && comments[number - 1].starts_with("//") {
                self.start(false);
            } else {
                self.text.push(' ');
            }
            self.text.push_str(&lines.join("\n"));
        }
    }

    /// Columns taken in the line at hand.
    fn column(&self) -> usize {
        self.text.rsplit('\n').next().map_or(0, |line| line.chars().count())
    }

    /// A value, behind which `after` more columns are needed.
    fn item(&mut self, item: &Item<'_>, after: usize) {
        if let Some(text) = flat_pieces(&item.pieces)
            && self.column() + text.chars().count() + after <= WIDTH
        {
            self.text.push_str(&text);
            return;
        }
        // The last brackets are opened: those before them are keys.
        let last = item.pieces.iter().rposition(|piece| matches!(piece, Piece::Group(_)));
        for (number, piece) in item.pieces.iter().enumerate() {
            match piece {
                Piece::Group(group) => match flat_group(group).filter(|_| Some(number) != last) {
                    Some(text) => self.text.push_str(&text),
                    None => self.group(group),
                },
                other => self.text.push_str(&plain(other, number)),
            }
            space_behind(&mut self.text, &item.pieces, number);
        }
    }

    /// Brackets with a line for every value.
    fn group(&mut self, group: &Group<'_>) {
        self.text.push_str(group.open);
        if group.items.is_empty() && group.end.is_empty() {
            self.text.push_str(group.close);
            return;
        }
        self.indent += INDENT;
        for (number, item) in group.items.iter().enumerate() {
            self.remarks(&item.above, number == 0);
            self.start(item.apart && (number > 0 || !item.above.is_empty()));
            self.item(item, 1);
            self.text.push(',');
            self.behind(&item.behind);
        }
        self.remarks(&group.end, group.items.is_empty());
        self.indent -= INDENT;
        self.start(false);
        self.text.push_str(group.close);
    }
}
