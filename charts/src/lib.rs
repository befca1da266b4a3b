//! Speed against accuracy: measured for a scene, drawn as charts, and put to use where a render has an error or a time.
//!
//! A [`study`] measures a few settings against a reference and says what it found: [`chart`]s, a [`table`] and sentences.
//! [`page`] puts studies together. [`deadline`] renders as well as a time allows.

pub mod advice;
pub mod canvas;
pub mod chart;
pub mod clock;
pub mod deadline;
pub mod fit;
pub mod measure;
pub mod page;
pub mod study;
pub mod table;
