//! Reading files: what is wrong with one is said with its place, and nothing is lost in silence.

pub mod fault;
mod file;
pub mod image;
pub mod obj;
