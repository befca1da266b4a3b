//! The camera's screen in the world.

use super::SceneError;
use crate::snapshot::View;
use glam::DAffine3;
use snell_components::{
    camera::{Camera, screen_axes},
    transform::is_invertible,
};

/// The view of a camera placed by `world_from_object`.
///
/// # Errors
/// A placement that has no inverse, or a camera that looks nowhere.
pub(super) fn view(camera: &Camera, world_from_object: &DAffine3) -> Result<View, SceneError> {
    if !is_invertible(world_from_object) {
        return Err(SceneError::camera("its placement is singular or not finite"));
    }
    let camera = camera.moved();
    let eye = world_from_object.transform_point3(camera.position);
    let forward = world_from_object.transform_vector3(camera.view()).try_normalize();
    let Some(forward) = forward else {
        return Err(SceneError::camera("it looks nowhere: its direction has no length"));
    };
    let (right, up) = screen_axes(forward, world_from_object.transform_vector3(camera.up), camera.roll);
    Ok(View { eye, right, up, forward: forward * camera.distance() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn looks_along_minus_z_with_x_to_the_right() {
        let view = view(&Camera { field_of_view: 90.0, ..Camera::default() }, &DAffine3::IDENTITY).expect("a view");
        assert_eq!((view.right, view.up), (DVec3::X, DVec3::Y));
        let corner = view.ray(0.0, 0.0, 200, 100).direction;
        assert!((corner / -corner.z - DVec3::new(-2.0, 1.0, -1.0)).length() < 1e-15);
        assert_eq!(view.ray(100.0, 50.0, 200, 100).direction, DVec3::NEG_Z);
    }

    #[test]
    fn looking_straight_down_is_fine() {
        let down = Camera { direction: Some(DVec3::NEG_Y), ..Camera::default() };
        let view = view(&down, &DAffine3::IDENTITY).expect("a view");
        assert!(view.right.is_finite() && (view.right.length() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_quarter_roll_clockwise_puts_the_right_hand_side_below() {
        let rolled = Camera { roll: 90.0, ..Camera::default() };
        let view = view(&rolled, &DAffine3::IDENTITY).expect("a view");
        assert!((view.right - DVec3::NEG_Y).length() < 1e-15 && (view.up - DVec3::X).length() < 1e-15);
    }
}
