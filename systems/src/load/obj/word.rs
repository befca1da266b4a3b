//! The words of a line, and the numbers they stand for.

use super::lines::Line;
use std::num::IntErrorKind;

/// A word and where it starts in its line.
#[derive(Clone, Copy)]
pub(super) struct Word<'a> {
    pub(super) text: &'a [u8],
    pub(super) offset: usize,
}

fn is_space(byte: u8) -> bool {
    byte.is_ascii_whitespace() || byte == 0x0B
}

/// The words of a line up to its comment. `#` starts a comment only at the start of a word: `1.#INF` is no number and
/// must not pass for `1.`.
pub(super) fn words<'a>(line: &Line<'a>) -> impl Iterator<Item = Word<'a>> + use<'a> {
    let text = line.text;
    let mut next = 0;
    std::iter::from_fn(move || {
        let offset = next + text[next..].iter().position(|&b| !is_space(b))?;
        let len = text[offset..].iter().position(|&b| is_space(b)).unwrap_or(text.len() - offset);
        next = offset + len;
        Some(Word { text: &text[offset..next], offset })
    })
    .take_while(|word| word.text[0] != b'#')
}

/// What follows the first word of a line, as one name: names may hold spaces and `#`.
pub(super) fn name(line: &Line<'_>, keyword: Word<'_>) -> String {
    let rest = &line.text[keyword.offset + keyword.text.len()..];
    String::from_utf8_lossy(rest).trim().to_owned()
}

/// The number a word stands for.
pub(super) fn number(word: &[u8]) -> Result<f32, String> {
    let parsed = std::str::from_utf8(word).ok().and_then(|text| text.parse::<f32>().ok());
    match parsed {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) if word.iter().any(u8::is_ascii_digit) => {
            Err(format!("{} is beyond the range of single precision", quoted(word)))
        }
        Some(_) => Err(format!("{} is not finite", quoted(word))),
        None if word.contains(&b',') => Err(format!("{} is not a number; decimals take a point", quoted(word))),
        None => Err(format!("{} is not a number", quoted(word))),
    }
}

/// The whole number a word stands for; saturated where it is beyond 64 bits.
pub(super) fn integer(word: &[u8]) -> Option<i64> {
    match std::str::from_utf8(word).ok()?.parse::<i64>() {
        Ok(value) => Some(value),
        Err(error) => match error.kind() {
            IntErrorKind::PosOverflow => Some(i64::MAX),
            IntErrorKind::NegOverflow => Some(i64::MIN),
            _ => None,
        },
    }
}

/// Text of a file as a message shows it: short, and without control characters.
pub(super) fn quoted(text: &[u8]) -> String {
    const LONGEST: usize = 40;
    let text = String::from_utf8_lossy(&text[..text.len().min(4 * LONGEST + 4)]);
    let shown = text.chars().take(LONGEST).map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c });
    let rest = if text.chars().count() > LONGEST { "…" } else { "" };
    format!("`{}{rest}`", shown.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_finite_or_refused() {
        for (text, value) in [("1", 1.0), ("-.5", -0.5), ("+2.", 2.0), ("1E+2", 100.0), ("1e-310", 0.0)] {
            assert_eq!(number(text.as_bytes()), Ok(value));
        }
        for (text, message) in [
            ("nan", "`nan` is not finite"),
            ("-inf", "`-inf` is not finite"),
            ("1e39", "`1e39` is beyond the range of single precision"),
            ("0,5", "`0,5` is not a number; decimals take a point"),
            ("1.#INF", "`1.#INF` is not a number"),
            ("0x10", "`0x10` is not a number"),
        ] {
            assert_eq!(number(text.as_bytes()), Err(message.to_owned()));
        }
    }

    #[test]
    fn whole_numbers_beyond_64_bits_are_out_of_every_range() {
        assert_eq!(integer(b"-9223372036854775809"), Some(i64::MIN));
        assert_eq!(integer(b"99999999999999999999"), Some(i64::MAX));
        assert_eq!((integer(b"1.0"), integer(b""), integer(b"-")), (None, None, None));
    }

    #[test]
    fn quotes_are_short_and_clean() {
        assert_eq!(quoted(b"a\x1b[1m\xff"), "`a\u{fffd}[1m\u{fffd}`");
        assert_eq!(quoted(&[b'y'; 2000]).chars().count(), 43);
    }
}
