//! Brackets, the values in them, and the comments that belong to each.

use super::tokens::{Kind, Token};

/// A comment in lines of its own.
#[derive(Clone, Debug)]
pub(super) struct Remark<'t> {
    pub text: &'t str,
    /// Whether an empty line stands before it.
    pub apart: bool,
}

/// A value, with its name or key if it has one.
#[derive(Clone, Debug, Default)]
pub(super) struct Item<'t> {
    /// Comments above it.
    pub above: Vec<Remark<'t>>,
    /// Whether an empty line stands before the value itself.
    pub apart: bool,
    pub pieces: Vec<Piece<'t>>,
    /// Comments behind it in its line.
    pub behind: Vec<&'t str>,
}

#[derive(Clone, Debug)]
pub(super) enum Piece<'t> {
    Atom(&'t str),
    Colon,
    Group(Group<'t>),
    /// A comment of one line that another token follows.
    Comment(&'t str),
}

/// Brackets.
#[derive(Clone, Debug)]
pub(super) struct Group<'t> {
    pub open: &'t str,
    pub close: &'t str,
    pub items: Vec<Item<'t>>,
    /// Comments behind the last value.
    pub end: Vec<Remark<'t>>,
    /// Whether a line ends behind the opening bracket.
    pub is_open: bool,
}

/// The whole text as a group without brackets; attributes are values of it.
pub(super) fn root<'t>(tokens: &[Token<'t>]) -> Option<Group<'t>> {
    let mut stack = vec![Level::new("", true)];
    for (number, token) in tokens.iter().enumerate() {
        let next = tokens.get(number + 1);
        match token.kind {
            Kind::Open => {
                let is_open = next.is_some_and(|next| next.lines > 0);
                stack.last_mut()?.begin(token);
                stack.push(Level::new(token.text, is_open));
            }
            Kind::Close => {
                let level = stack.pop()?;
                stack.last_mut()?.item.pieces.push(Piece::Group(level.close(token.text)));
            }
            Kind::Comma => stack.last_mut()?.end_item(),
            Kind::Colon => stack.last_mut()?.item.pieces.push(Piece::Colon),
            Kind::Atom => {
                let level = stack.last_mut()?;
                level.begin(token);
                level.item.pieces.push(Piece::Atom(token.text));
            }
            Kind::Attribute => {
                let level = stack.last_mut()?;
                level.begin(token);
                level.item.pieces.push(Piece::Atom(token.text));
                level.end_item();
            }
            Kind::Comment => stack.last_mut()?.comment(token, next),
        }
    }
    let root = stack.pop()?;
    stack.is_empty().then(|| root.close(""))
}

/// A group that is not closed yet.
struct Level<'t> {
    group: Group<'t>,
    item: Item<'t>,
}

impl<'t> Level<'t> {
    fn new(open: &'t str, is_open: bool) -> Self {
        let group = Group { open, close: "", items: vec![], end: vec![], is_open };
        Self { group, item: Item::default() }
    }

    /// Notes what stands before the first token of a value.
    fn begin(&mut self, token: &Token<'t>) {
        if self.item.pieces.is_empty() {
            self.item.apart = token.lines > 1;
        }
        // A comment that the value goes on behind cannot stand behind it.
        let moved = self.item.behind.drain(..).map(|text| Remark { text, apart: false });
        self.item.above.extend(moved);
    }

    fn end_item(&mut self) {
        if !self.item.pieces.is_empty() {
            self.group.items.push(std::mem::take(&mut self.item));
        }
    }

    fn comment(&mut self, token: &Token<'t>, next: Option<&Token<'t>>) {
        let fills_line = token.is_line_comment() || token.text.contains('\n');
        let goes_on = next.is_some_and(|next| next.lines == 0 && !matches!(next.kind, Kind::Comma | Kind::Close));
        let same_line = token.lines == 0;
        if !same_line && next.is_none_or(|next| next.kind == Kind::Close) {
            // The value before it is complete, though no comma says so.
            self.end_item();
        }
        if !self.item.pieces.is_empty() {
            if !fills_line && goes_on {
                self.item.pieces.push(Piece::Comment(token.text));
            } else {
                self.item.behind.push(token.text);
            }
        } else if !fills_line && goes_on && next.is_some_and(|next| next.kind != Kind::Comment) {
            self.item.apart |= token.lines > 1;
            self.item.pieces.push(Piece::Comment(token.text));
        } else if let Some(last) = self.group.items.last_mut().filter(|_| same_line && self.item.above.is_empty()) {
            last.behind.push(token.text);
        } else {
            self.item.above.push(Remark { text: token.text, apart: token.lines > 1 });
        }
    }

    fn close(mut self, close: &'t str) -> Group<'t> {
        self.end_item();
        self.group.end = std::mem::take(&mut self.item.above);
        self.group.close = close;
        self.group
    }
}
