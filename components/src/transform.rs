//! Placement: steps as the scene writes them, and the matrix that the transform system makes of them.

use crate::{
    describe::{Describe, Fault, FieldVisitor, Spec, Value},
    math,
};
use bevy_ecs::prelude::*;
use core::fmt;
use glam::{DAffine3, DMat3, DVec3};
use smallvec::SmallVec;

/// One step of a placement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// Move by a vector.
    Translate(DVec3),
    /// Scale about the origin by one factor per axis; a negative one mirrors.
    Scale(DVec3),
    /// Turn about Ox by degrees, counter-clockwise seen from +x.
    RotateX(f64),
    /// Turn about Oy by degrees, counter-clockwise seen from +y.
    RotateY(f64),
    /// Turn about Oz by degrees, counter-clockwise seen from +z.
    RotateZ(f64),
    /// Turn about any axis through the origin, counter-clockwise seen against the axis.
    Rotate {
        /// Direction of the axis; any length but zero.
        axis: DVec3,
        /// Angle in degrees.
        degrees: f64,
    },
}

impl Step {
    /// The step as a matrix.
    #[must_use]
    pub fn matrix(self) -> DAffine3 {
        match self {
            Self::Translate(by) => DAffine3::from_translation(by),
            Self::Scale(by) => DAffine3::from_scale(by),
            Self::RotateX(degrees) => rotation(DVec3::X, degrees),
            Self::RotateY(degrees) => rotation(DVec3::Y, degrees),
            Self::RotateZ(degrees) => rotation(DVec3::Z, degrees),
            Self::Rotate { axis, degrees } => rotation(axis.normalize_or_zero(), degrees),
        }
    }
}

/// As a scene file has it.
impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Translate(DVec3 { x, y, z }) => write!(f, "Translate(({x:?}, {y:?}, {z:?}))"),
            Self::Scale(DVec3 { x, y, z }) => write!(f, "Scale(({x:?}, {y:?}, {z:?}))"),
            Self::RotateX(degrees) => write!(f, "RotateX({degrees:?})"),
            Self::RotateY(degrees) => write!(f, "RotateY({degrees:?})"),
            Self::RotateZ(degrees) => write!(f, "RotateZ({degrees:?})"),
            Self::Rotate { axis: DVec3 { x, y, z }, degrees } => {
                write!(f, "Rotate(axis: ({x:?}, {y:?}, {z:?}), degrees: {degrees:?})")
            }
        }
    }
}

/// Rodrigues' rotation about a unit axis.
fn rotation(axis: DVec3, degrees: f64) -> DAffine3 {
    let (sin, cos) = math::sin_cos_degrees(degrees);
    let turned = |v: DVec3| v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos));
    DAffine3::from_mat3(DMat3::from_cols(turned(DVec3::X), turned(DVec3::Y), turned(DVec3::Z)))
}

/// Placement in the parent's space (the world's, where there is no parent): steps applied in order, the first first.
///
/// The steps are kept, not their product, so a thousand edits leave a rotation as exact as one.
#[derive(Component, Clone, Debug, Default, PartialEq)]
pub struct Transform(pub SmallVec<[Step; 4]>);

impl Transform {
    /// What is expected of a placement, to follow the word "expected".
    pub(crate) const MUST_BE_UNDONE: &'static str =
        "a placement that can be undone: this one is singular or not finite";

    /// A placement from steps.
    #[must_use]
    pub fn new(steps: impl IntoIterator<Item = Step>) -> Self {
        Self(steps.into_iter().collect())
    }

    /// Moved by a vector.
    #[must_use]
    pub fn at(position: DVec3) -> Self {
        Self::new([Step::Translate(position)])
    }

    /// The product of the steps.
    #[must_use]
    pub fn matrix(&self) -> DAffine3 {
        self.0.iter().fold(DAffine3::IDENTITY, |so_far, step| step.matrix() * so_far)
    }
}

impl Describe for Transform {
    const TAG: &'static str = "Transform";

    fn describe(&mut self, fields: &mut dyn FieldVisitor) {
        let about = "steps, applied in the written order";
        fields.field("steps", Value::Steps(&mut self.0), Spec::any(about).required());
    }

    fn check(&self) -> Result<(), Fault> {
        if is_invertible(&self.matrix()) { Ok(()) } else { Err(Fault::new("steps", Self::MUST_BE_UNDONE)) }
    }
}

/// Whether a matrix and its inverse are finite.
#[must_use]
pub fn is_invertible(matrix: &DAffine3) -> bool {
    matrix.is_finite() && matrix.matrix3.determinant() != 0.0 && matrix.inverse().is_finite()
}

/// Placement in the scene, and in the world unless the settings place the scene as a whole: maps object space to there.
///
/// Written by the transform system alone, from [`Transform`] and the parents' placements.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq)]
pub struct GlobalTransform(pub DAffine3);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_apply_in_the_written_order() {
        let scale_then_move = Transform::new([Step::Scale(DVec3::splat(2.0)), Step::Translate(DVec3::X)]);
        assert_eq!(scale_then_move.matrix().transform_point3(DVec3::X), DVec3::new(3.0, 0.0, 0.0));
        let turn = Transform::new([Step::RotateZ(90.0), Step::RotateX(90.0)]);
        assert_eq!(turn.matrix().transform_point3(DVec3::X), DVec3::Z);
    }

    #[test]
    fn turning_about_an_axis_agrees_with_the_axis_forms() {
        for degrees in [0.0, 33.0, 90.0, -120.0] {
            let about_y = Step::Rotate { axis: DVec3::Y * 7.0, degrees }.matrix();
            assert_eq!(about_y, Step::RotateY(degrees).matrix());
        }
    }

    #[test]
    fn singular_steps_are_a_fault() {
        assert!(Transform::new([Step::Scale(DVec3::new(1.0, 0.0, 1.0))]).check().is_err());
        assert!(Transform::new([Step::Scale(DVec3::new(-1.0, 1.0, 1.0))]).check().is_ok());
    }
}
