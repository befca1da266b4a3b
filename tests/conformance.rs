//! The built-in shapes keep the contract of shapes.

mod support {
    #[expect(dead_code, reason = "one mesh of it is wanted")]
    pub(crate) mod gallery;
    pub(crate) mod random;
    #[expect(dead_code, reason = "the gallery's")]
    pub(crate) mod scene;
}

use snell::{
    conformance::{Form, check},
    prelude::*,
};
use std::sync::Arc;
use support::gallery::bumpy;

#[test]
fn spheres_do() {
    check(&[Sphere { radius: 1.0 }, Sphere { radius: 0.001 }, Sphere { radius: 300.0 }], Form::Closed).assert();
}

#[test]
fn boxes_do() {
    let sizes = [DVec3::ONE, DVec3::new(0.01, 1.0, 3.0), DVec3::new(40.0, 0.2, 7.0)];
    check(&sizes.map(|size| Cuboid { size }), Form::Closed).assert();
}

#[test]
fn planes_do() {
    check(&[Plane {}], Form::Open).assert();
}

#[test]
fn triangles_do() {
    let corners = |a, b, c| Triangle { a, b, c, ..Triangle::default() };
    let thin = corners(DVec3::ZERO, DVec3::new(1.0, 0.001, 0.0), DVec3::new(2.0, 0.0, 0.3));
    check(&[corners(DVec3::ZERO, DVec3::X, DVec3::new(0.2, 0.9, 0.4)), thin], Form::Open).assert();
}

#[test]
fn meshes_do() {
    check(&[Mesh::new(Arc::new(bumpy(16, 10, false)))], Form::Closed).assert();
    check(&[Mesh::new(Arc::new(bumpy(12, 9, true))).smooth()], Form::Closed).assert();
}
