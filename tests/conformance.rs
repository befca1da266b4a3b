//! The built-in shapes, lights and patterns keep their contracts.

mod support {
    #[expect(dead_code, reason = "one mesh of it is wanted")]
    pub(crate) mod gallery;
    pub(crate) mod random;
    #[expect(dead_code, reason = "the gallery's")]
    pub(crate) mod scene;
}

use snell::{
    conformance::{Form, check, check_light, check_texture},
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

#[test]
fn cones_do() {
    let cones = [(1.0, 0.0, 2.0), (0.05, 0.0, 3.0), (0.3, 2.0, 0.5), (0.0, 1.0, 1.0), (5.0, 4.9, 0.1)];
    check(&cones.map(|(radius, top, height)| Cone { radius, top, height }), Form::Closed).assert();
}

#[test]
fn cylinders_do() {
    let cylinders = [(1.0, 2.0), (0.01, 3.0), (4.0, 0.02)];
    check(&cylinders.map(|(radius, height)| Cylinder { radius, height }), Form::Closed).assert();
}

#[test]
fn figures_of_triangles_do() {
    let profile = [(0.0, 0.0), (0.8, 0.1), (0.4, 0.9), (0.6, 1.5), (0.0, 1.7)];
    let vase = Lathe { profile: profile.map(DVec2::from).to_vec(), segments: 20, ..Lathe::default() };
    check(&[vase.clone(), Lathe { shading: Shading::Smooth, ..vase.clone() }], Form::Closed).assert();
    let ring = [(1.0, 0.0), (1.3, 0.2), (1.0, 0.4), (1.0, 0.0)];
    check(&[Lathe { profile: ring.map(DVec2::from).to_vec(), ..vase }], Form::Closed).assert();
    check(&[HeightField { size: DVec3::new(4.0, 1.0, 3.0), cells: 24, ..HeightField::default() }], Form::Open).assert();
    let arrangements = [Arrangement::Grid, Arrangement::Random];
    let fields = arrangements.map(|arrangement| TriangleField { count: 200, arrangement, ..TriangleField::default() });
    check(&fields, Form::Open).assert();
}

#[test]
fn sphere_flakes_do() {
    check(&[0, 2].map(|depth| SphereFlake { radius: 1.5, depth }), Form::Open).assert();
}

#[test]
fn lights_do() {
    let intensity = Rgb::new(2.0, 0.5, 0.0);
    check_light(&[PointLight::at([1.0, 2.0, 3.0]), PointLight { intensity, ..PointLight::default() }]).assert();
    check_light(&[DirectionalLight::along([1.0, -2.0, 0.5])]).assert();
    let cone = ConeLight { position: DVec3::Y, angle: 50.0, intensity, ..ConeLight::default() };
    check_light(&[cone.clone(), ConeLight { fall_off: FallOff::Linear, ..cone }]).assert();
    let disk = DiskLight { position: DVec3::Y, radius: 3.0, intensity, ..DiskLight::default() };
    check_light(&[disk.clone(), DiskLight { emission: Emission::Radiant, ..disk }]).assert();
}

#[test]
fn patterns_do() {
    let checker = Checker { odd: Rgb::new(0.2, 0.0, 3.0), frequency: 2.5, ..Checker::default() };
    check_texture(&[checker.clone(), Checker { filtered: true, ..checker }]).assert();
    let texels = (0..48u8).map(|n| [n, 5 * n, 255 - n]).collect();
    let image = ImageTexture::from(Image::from_bytes(8, 6, texels).expect("an image"));
    let wraps = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp, Wrap::Once];
    let filters = [Filter::Nearest, Filter::Bilinear, Filter::Trilinear, Filter::Anisotropic];
    let all = wraps.into_iter().flat_map(|wrap| filters.map(|filter| ImageTexture { wrap, filter, ..image.clone() }));
    check_texture(&all.collect::<Vec<_>>()).assert();
}
