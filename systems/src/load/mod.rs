//! Stage 0: scene text, and the files it names, become entities, or a list of everything that is wrong with them.

mod fault;

mod file;

pub mod image;

pub mod obj;

pub use fault::{Fault, Faults, Notice, Position, nearest};

use bevy_ecs::world::World;
use std::path::Path;

/// stub
pub fn read_scene(_world: &mut World, _path: &Path) -> Result<Vec<Notice>, Faults> {
    Ok(vec![])
}
/// stub
pub fn read_scene_text(_world: &mut World, _text: &str, _path: &Path) -> Result<Vec<Notice>, Faults> {
    Ok(vec![])
}
