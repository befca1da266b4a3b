//! Moving, turning and scaling things, as steps of their placements.
//!
//! Steps go in at the end, in the parent's space, and run together with the last ones where they can, so that a placement
//! that is dragged about stays short and exact.

use smallvec::SmallVec;
use snell::{
    components::transform::{Step, Transform},
    prelude::DVec3,
};

/// The placement moved by a vector in the parent's space.
#[must_use]
pub fn moved(placement: &Transform, by: DVec3) -> Transform {
    let mut steps = placement.0.clone();
    push_move(&mut steps, by);
    Transform(steps)
}

/// The placement turned by degrees about an axis through a point in the parent's space.
#[must_use]
pub fn turned(placement: &Transform, pivot: DVec3, axis: DVec3, degrees: f64) -> Transform {
    about(placement, pivot, |steps| {
        let step = match axis.to_array() {
            [x, 0.0, 0.0] => Step::RotateX(degrees * x.signum()),
            [0.0, y, 0.0] => Step::RotateY(degrees * y.signum()),
            [0.0, 0.0, z] => Step::RotateZ(degrees * z.signum()),
            _ => Step::Rotate { axis, degrees },
        };
        match (steps.last_mut(), step) {
            (Some(Step::RotateX(so_far)), Step::RotateX(more))
            | (Some(Step::RotateY(so_far)), Step::RotateY(more))
            | (Some(Step::RotateZ(so_far)), Step::RotateZ(more)) => {
                *so_far += more;
                if *so_far == 0.0 {
                    steps.pop();
                }
            }
            _ if degrees != 0.0 => steps.push(step),
            _ => {}
        }
    })
}

/// The placement scaled about a point in the parent's space.
#[must_use]
pub fn scaled(placement: &Transform, pivot: DVec3, by: DVec3) -> Transform {
    about(placement, pivot, |steps| match steps.last_mut() {
        Some(Step::Scale(so_far)) => {
            *so_far *= by;
            if *so_far == DVec3::ONE {
                steps.pop();
            }
        }
        _ if by != DVec3::ONE => steps.push(Step::Scale(by)),
        _ => {}
    })
}

/// Does something with the pivot at the origin.
fn about(placement: &Transform, pivot: DVec3, change: impl FnOnce(&mut SmallVec<[Step; 4]>)) -> Transform {
    let mut steps = placement.0.clone();
    push_move(&mut steps, -pivot);
    change(&mut steps);
    push_move(&mut steps, pivot);
    Transform(steps)
}

/// Adds a move, to the last step if that is one.
fn push_move(steps: &mut SmallVec<[Step; 4]>, by: DVec3) {
    match steps.last_mut() {
        Some(Step::Translate(so_far)) => {
            *so_far += by;
            if *so_far == DVec3::ZERO {
                steps.pop();
            }
        }
        _ if by != DVec3::ZERO => steps.push(Step::Translate(by)),
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thing_turned_about_its_place_stays_there_in_three_steps() {
        let pivot = DVec3::new(1.0, 2.0, 3.0);
        let mut placement = Transform::at(pivot);
        for _ in 0..90 {
            placement = turned(&placement, pivot, DVec3::Y, 1.0);
        }
        assert_eq!(placement, Transform::new([Step::RotateY(90.0), Step::Translate(pivot)]));
        assert_eq!(placement.matrix().transform_point3(DVec3::ZERO), pivot);
        let back = turned(&placement, pivot, DVec3::NEG_Y, 90.0);
        assert_eq!(back, Transform::at(pivot));
    }

    #[test]
    fn turning_and_scaling_keep_the_pivot_and_do_what_they_say() {
        let start =
            Transform::new([Step::Scale(DVec3::new(1.0, 2.0, 1.0)), Step::RotateX(30.0), Step::Translate(DVec3::X)]);
        let pivot = DVec3::new(0.5, -1.0, 2.0);
        let point = DVec3::new(0.3, 0.4, 0.5);
        let before = start.matrix().transform_point3(point) - pivot;
        let scaled = scaled(&start, pivot, DVec3::splat(2.0)).matrix().transform_point3(point) - pivot;
        assert!((scaled - before * 2.0).length() < 1e-12);
        let turned = turned(&start, pivot, DVec3::new(0.0, 0.0, 1.0), 180.0).matrix().transform_point3(point) - pivot;
        assert!((turned - DVec3::new(-before.x, -before.y, before.z)).length() < 1e-12);
        let moved = moved(&start, DVec3::Y).matrix().transform_point3(point) - pivot;
        assert!((moved - before - DVec3::Y).length() < 1e-12);
    }
}
