//! Load: scene text and the files it names become entities, or a list of everything that is wrong with them.

pub mod fault;

pub mod image;

pub mod obj;

mod assets;

mod scene;

pub use scene::{read_scene, read_scene_text};
