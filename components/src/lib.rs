//! The data of a scene: what exists, before anything happens to it.
//!
//! Every module holds plain components and the arithmetic that belongs to them; nothing here reads files, schedules
//! work or knows what other components exist. A new shape needs only this crate:
//!
//! ```
//! use snell_components::{describe::{Describe, FieldVisitor, Spec}, shape::Sphere};
//!
//! let mut ball = Sphere { radius: 2.0 };
//! // One description serves scene files, editors and bindings alike.
//! struct Names(Vec<&'static str>);
//! # use snell_components::describe::Value;
//! impl FieldVisitor for Names {
//!     fn field(&mut self, name: &'static str, _: Value<'_>, _: Spec) { self.0.push(name) }
//! }
//! let mut names = Names(vec![]);
//! ball.describe(&mut names);
//! assert_eq!(names.0, ["radius"]);
//! ```
//!
//! | module | holds |
//! |---|---|
//! | [`math`] | the only door to functions beyond `+ − × ÷ √` |
//! | [`space`], [`packet`], [`transform`] | rays, rays that travel together, bounds, placement |
//! | [`color`] | linear RGB and the sRGB transfer curve |
//! | [`name`], [`hidden`], [`describe`], [`asset`], [`written`] | what a thing is called, how its fields are read and written, files it refers to, where it stands in a file |
//! | [`lanes`] | several numbers at once, at the level the machine has |
//! | [`bvh`] | the bounding-volume tree, over bounds alone |
//! | [`method`], [`sphere_tree`], [`real`] | the methods Snell is measured against, and the choice between them |
//! | [`primitive`], [`surfaces`] | the contract every shape meets, and what rays that travel together meet; [`shape`] holds the built-in ones |
//! | [`figure`] | shapes made of many triangles or spheres by a rule; [`random`] their numbers |
//! | [`material`], [`texture`], [`light`], [`camera`], [`settings`] | what the rays meet and how the picture is taken |

// What `derive(Describe)` makes names things as a crate that uses Snell does.
extern crate self as snell;
mod components {
    pub(crate) use crate::describe;
}

pub mod math;

pub mod space;

pub mod packet;

pub mod transform;

pub mod color;

pub mod name;

pub mod written;

pub mod asset;

pub mod describe;

#[expect(unsafe_code, reason = "intrinsics and an uninitialised stack")]
pub mod lanes;

#[expect(unsafe_code, reason = "advice to the system about memory")]
mod pages;

pub mod bvh;

pub mod sphere_tree;

pub mod method;

pub mod real;

pub mod primitive;

pub mod surfaces;

pub mod shape;

pub mod random;

pub mod figure;

pub mod texture;

pub mod material;

pub mod hidden;

pub mod light;

pub mod camera;

pub mod settings;
