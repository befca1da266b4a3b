//! Scenes → scene text: the way back of [`load`](crate::load).
//!
//! What is written reads back to the same scene, to the last bit of every number; fields that have their default are left
//! out. The materials of a model are not written: they come with the model's file.

mod text;
mod value;

pub use text::{scene_text, scene_text_in_part};
pub use value::{Written, color_text, fields, same};

use core::fmt;

/// All that no scene file can say, one line each.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Unsayable(pub Vec<String>);

impl fmt::Display for Unsayable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.join("\n"))
    }
}

impl core::error::Error for Unsayable {}
