//! How triangles and spheres are tested, and in which numbers.

use super::{Error, Found, Hindrance, Scene, time_against_error};
use crate::{
    measure::{self, Effort, measure},
    table::short,
};
use snell_components::method::{Methods, Precision, SphereTest, TriangleTest};
use snell_systems::render::Options;

pub(super) fn study(scene: &mut Scene, effort: Effort) -> Result<Found, Hindrance> {
    let plain = Methods::default();
    let single = Methods { precision: Precision::F32, ..plain };
    let all = [
        ("triangles: sheared edges; spheres: foot of the perpendicular", plain),
        ("triangles: Möller–Trumbore", Methods { triangle: TriangleTest::MollerTrumbore, ..plain }),
        ("triangles: frame of the ray, 2004", Methods { triangle: TriangleTest::RayFrame, ..plain }),
        ("spheres: naive quadratic", Methods { sphere: SphereTest::Naive, ..plain }),
    ];
    let reference = scene.with(effort, |_| {})?;
    let mut candidates = vec![];
    for (label, methods) in all {
        for (numbers, precision) in [("in f64", Precision::F64), ("in f32", single.precision)] {
            let mut candidate = scene.candidate(effort, label, numbers, |_| {})?;
            candidate.options = Options { methods: Methods { precision, ..methods }, ..Options::default() };
            candidate.default = candidate.options.methods == plain;
            candidates.push(candidate);
        }
    }
    let measured = measure(&candidates, &measure::picture(&reference), effort);
    let title = format!("{}: tests of triangles and spheres", scene.name);
    let mut says = vec![];
    let own = |numbers: &str| measured.iter().find(|m| m.group.starts_with("triangles: sheared") && m.label == numbers);
    if let (Some(double), Some(single)) = (own("in f64"), own("in f32")) {
        says.push(format!(
            "In single precision the default tests take {:.2} times the time of double precision and are off by RMSE {}.",
            single.seconds / double.seconds.max(1e-9),
            short(single.difference.rmse)
        ));
    }
    let alike = measured.iter().filter(|m| m.difference.max == 0.0).count();
    says.push(format!("{alike} of {} ways give the default's picture to the last bit.", measured.len()));
    Ok(Found {
        name: "methods".into(),
        title: format!("{title}, speed against accuracy"),
        says,
        charts: vec![time_against_error(
            "methods-time",
            &format!("{title}, time against difference"),
            &measured,
            Error::Rmse,
        )],
        table: measure::table(&measured),
        pictures: vec![],
        about: None,
    })
}
