//! The whole editor without a window, driven by the names that screen readers see.

mod build;
mod crash;
mod driver;
mod files;
mod look;
mod outside_shape;
mod panels;
mod pointer;
#[expect(dead_code, unreachable_pub, reason = "a program as the editor writes it")]
#[rustfmt::skip]
mod program;
mod raster;
mod shown;

#[path = "../../../tests/outside/src/torus.rs"]
#[expect(unreachable_pub, reason = "as it stands in a crate of its own")]
mod torus;
