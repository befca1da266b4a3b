//! Lays out scene text in one way, whatever way it was written; comments stay.
//!
//! Values that fit stand in one line; a bracket behind which a line ended stays open, with a line for each value in it.
//! At most one empty line in a row stays. Nothing but space and commas is changed, which is checked.

mod print;
mod tokens;
mod tree;

use super::{
    fault::{Fault, Faults},
    scene::check_syntax,
};
use std::path::Path;
use tokens::{Kind, tokens};

/// The text of a scene file, laid out; the same for every layout of it. `path` names it in messages.
///
/// # Errors
/// Text that is not RON.
pub fn format_scene(text: &str, path: &Path) -> Result<String, Faults> {
    let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
    check_syntax(text, path)?;
    let odd = || Faults(vec![Fault::of_file(path, "this notation cannot be laid out")]);
    let laid_out =
        tokens(text).and_then(|tokens| tree::root(&tokens)).map(|root| print::root(&root)).ok_or_else(odd)?;
    // Whatever is wrong with the layout must not harm the scene.
    if same(text, &laid_out) { Ok(laid_out) } else { Err(odd()) }
}

/// Whether two texts hold the same values and comments.
fn same(a: &str, b: &str) -> bool {
    let parts = |text| {
        let tokens = tokens(text)?;
        // Commas mean nothing, and comments may move to the line above.
        let (mut values, mut comments) = (vec![], vec![]);
        for token in &tokens {
            match token.kind {
                Kind::Comma => {}
                Kind::Comment => comments.push(without_ends(token.text)),
                _ => values.push(token.text),
            }
        }
        comments.sort_unstable();
        Some((values, comments))
    };
    parts(a).is_some_and(|a| Some(a) == parts(b))
}

/// A comment without space at the ends of its lines.
fn without_ends(text: &str) -> String {
    text.lines().map(str::trim_end).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests;
