//! An editor of scenes: a window in which one can build, light, look and render.
//!
//! | module | holds |
//! |---|---|
//! | [`document`] | the scene, its file, every edit as a step that can be undone |
//! | [`worker`], [`screen`] | the thread that draws, from coarse to exact, and what it has drawn |
//! | [`loader`], [`picture`] | files are read, and pictures written, in the background |
//! | [`autosave`], [`files`] | what outlives a crash, and where an editor keeps its own files |
//! | [`placement`], [`view`] | moving, turning and scaling things; moving the camera |
//! | [`session`] | the open scene and all of the above at work for it |
//! | [`app`], [`window`] | what is seen, with egui; the window on the screen |

pub mod app;

pub mod autosave;

pub mod document;

pub mod files;

pub mod loader;

pub mod picture;

pub mod placement;

pub mod screen;

pub mod session;

pub mod view;

pub mod window;

pub mod worker;
