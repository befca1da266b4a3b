//! Shuffles the entities in the text of a scene.

use super::random::Random;

/// The scene with the entries of its `entities` in another order, by `seed`; nothing if it has no such map.
pub(crate) fn shuffled(scene: &str, seed: u64) -> Option<String> {
    let (start, end, commas) = entities(scene)?;
    let mut entries = vec![];
    let mut from = start;
    for to in commas.into_iter().chain([end]) {
        entries.push(&scene[from..to]);
        from = to + 1;
    }
    // After a last comma.
    entries.pop_if(|entry| entry.trim().is_empty());
    let mut random = Random::new(seed);
    for i in (1..entries.len()).rev() {
        entries.swap(i, random.below(i + 1));
    }
    // On a line of its own no comma ends up in a comment.
    Some(format!("{}{}\n{}", &scene[..start], entries.join("\n,"), &scene[end..]))
}

/// Where the entries of `entities` start and end, and the commas between them.
fn entities(scene: &str) -> Option<(usize, usize, Vec<usize>)> {
    let code = code(scene);
    let field = code.find("entities")?;
    let start = field + code[field..].find('{')? + 1;
    let (mut depth, mut commas) = (0, vec![]);
    for (at, byte) in code.bytes().enumerate().skip(start) {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b'}' if depth == 0 => return Some((start, at, commas)),
            b')' | b']' | b'}' => depth -= 1,
            b',' if depth == 0 => commas.push(at),
            _ => {}
        }
    }
    None
}

/// The scene with every byte of its strings and comments blank.
fn code(scene: &str) -> String {
    let mut code = String::new();
    let mut rest = scene;
    while let Some(first) = rest.chars().next() {
        let blank = match rest.as_bytes() {
            [b'"', ..] => string(rest),
            [b'/', b'/', ..] => rest.find('\n').unwrap_or(rest.len()),
            [b'/', b'*', ..] => rest.find("*/").map_or(rest.len(), |end| end + 2),
            _ => 0,
        };
        if blank == 0 {
            code.push(first);
            rest = &rest[first.len_utf8()..];
        } else {
            code.extend(std::iter::repeat_n(' ', blank));
            rest = &rest[blank..];
        }
    }
    code
}

/// Length of the string that `text` starts with.
fn string(text: &str) -> usize {
    let mut escaped = false;
    let end = text[1..].find(|c| {
        let closes = c == '"' && !escaped;
        escaped = c == '\\' && !escaped;
        closes
    });
    end.map_or(text.len(), |end| end + 2)
}
