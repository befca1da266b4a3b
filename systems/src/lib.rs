//! What happens to a scene, in order.
//!
//! scene text → [`load`] → `World` → [`transform`] → [`accelerate`] → [`extract`] → [`snapshot::Snapshot`] → [`render`]
//! → [`image`] → file. [`save`] is the way back from a `World` to scene text, by way of [`scene`]; [`compare`] tells how far
//! two pictures are apart; [`pipeline`] holds the order, [`build`] makes scenes in code, [`registry`] the open set of components.

#![forbid(unsafe_code)]

pub mod pipeline;

pub mod build;

pub mod registry;

pub mod load;

pub mod scene;

pub mod save;

pub mod transform;

pub mod accelerate;

pub mod extract;

pub mod snapshot;

pub mod render;

pub mod why;

pub mod image;

pub mod compare;

pub mod conformance;
