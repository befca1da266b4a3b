//! Stage 0: scene text, and the files it names, become entities, or a list of everything that is wrong with them.

mod fault;

mod file;

pub mod image;

pub mod obj;

mod assets;

mod scene;

mod format;

pub use assets::UsedFiles;
pub use fault::{Fault, Faults, Notice, Position, nearest};
pub use format::format_scene;
pub(crate) use scene::{LARGEST, MODEL_MARK};
pub use scene::{read_scene, read_scene_text};
