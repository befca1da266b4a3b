//! What an editor of scenes stands on, without a window.
//!
//! | module | holds |
//! |---|---|
//! | [`document`] | the scene, its file, every edit as a step that can be undone |
//! | [`worker`], [`screen`] | the thread that draws, from coarse to exact, and what it has drawn |
//! | [`loader`] | files are read in the background |
//! | [`autosave`], [`files`] | what outlives a crash, and where an editor keeps its own files |
//! | [`placement`], [`view`] | moving, turning and scaling things; moving the camera |

pub mod autosave;

pub mod document;

pub mod files;

pub mod loader;

pub mod placement;

pub mod screen;

pub mod view;

pub mod worker;
