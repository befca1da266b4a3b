//! The whole editor without a window, driven by the names that screen readers see.

mod build;
mod driver;
mod files;
mod outside_shape;

#[path = "../../../tests/outside/src/torus.rs"]
#[expect(unreachable_pub, reason = "as it stands in a crate of its own")]
mod torus;
