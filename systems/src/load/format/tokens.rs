//! The tokens of RON text, comments among them.

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Open,
    Close,
    Comma,
    Colon,
    /// A name, number, text or character.
    Atom,
    /// `#![…]`.
    Attribute,
    Comment,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Token<'t> {
    pub kind: Kind,
    pub text: &'t str,
    /// How many lines ended since the token before.
    pub lines: usize,
}

impl Token<'_> {
    /// Whether the token ends with its line.
    pub(super) fn is_line_comment(&self) -> bool {
        self.kind == Kind::Comment && self.text.starts_with("//")
    }
}

/// All tokens of a text that is known to be RON; none if something in it cannot be made out.
pub(super) fn tokens(text: &str) -> Option<Vec<Token<'_>>> {
    let mut found = vec![];
    let (mut rest, mut lines) = (text, 0);
    while let Some(c) = rest.chars().next() {
        if is_space(c) {
            lines += usize::from(c == '\n');
            rest = &rest[c.len_utf8()..];
            continue;
        }
        let (kind, len) = match c {
            '(' | '[' | '{' => (Kind::Open, 1),
            ')' | ']' | '}' => (Kind::Close, 1),
            ',' => (Kind::Comma, 1),
            ':' => (Kind::Colon, 1),
            '#' if rest.starts_with("#!") || rest.starts_with("# ") => (Kind::Attribute, rest.find(']')? + 1),
            '/' => (Kind::Comment, comment(rest)?),
            _ => (Kind::Atom, atom(rest)?),
        };
        let (token, after) = rest.split_at_checked(len)?;
        found.push(Token { kind, text: token.trim_end(), lines });
        (rest, lines) = (after, 0);
    }
    Some(found)
}

fn is_space(c: char) -> bool {
    c.is_whitespace() || matches!(c, '\u{200E}' | '\u{200F}')
}

/// The length of a comment; blocks may hold others.
fn comment(text: &str) -> Option<usize> {
    if text.starts_with("//") {
        return Some(text.find('\n').unwrap_or(text.len()));
    }
    let mut at = text.strip_prefix("/*").map(|_| 2)?;
    let mut depth = 1;
    while depth > 0 {
        let rest = text.get(at..)?;
        let next = rest.find(['/', '*'])?;
        let rest = &rest[next..];
        let step = match rest.get(..2)? {
            "/*" => 1,
            "*/" => -1,
            _ => 0,
        };
        depth += step;
        at += next + if step == 0 { 1 } else { 2 };
    }
    Some(at)
}

/// The length of a name, number, text or character.
fn atom(text: &str) -> Option<usize> {
    let marked = text.strip_prefix('b').unwrap_or(text);
    let prefix = text.len() - marked.len();
    if let Some(raw) = marked.strip_prefix('r') {
        let hashes = raw.len() - raw.trim_start_matches('#').len();
        if let Some(inner) = raw.get(hashes..)?.strip_prefix('"') {
            let end = format!("\"{}", "#".repeat(hashes));
            return Some(prefix + 1 + hashes + 1 + inner.find(&end)? + end.len());
        }
    }
    let quote = marked.chars().next().filter(|c| matches!(c, '"' | '\''));
    if let Some(quote) = quote {
        let mut escaped = false;
        for (at, c) in marked.char_indices().skip(1) {
            if c == quote && !escaped {
                return Some(prefix + at + 1);
            }
            escaped = c == '\\' && !escaped;
        }
        return None;
    }
    let ends = |c: char| is_space(c) || matches!(c, '(' | ')' | '[' | ']' | '{' | '}' | ',' | ':' | '/' | '"' | '\'');
    Some(text.find(ends).unwrap_or(text.len())).filter(|len| *len > 0)
}
