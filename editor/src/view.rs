//! Moving the camera: about a point, in its own frame, and to look at something.
//!
//! All in the camera's object space. Position and target move together, so that what is stated stays stated.

use snell::{
    components::{camera::Camera, math, transform::Step},
    prelude::DVec3,
};

/// The camera's own axes: to the right, up, and forward; unit vectors.
#[must_use]
pub fn axes(camera: &Camera) -> [DVec3; 3] {
    let forward = camera.view().normalize_or(DVec3::NEG_Z);
    let level = forward.cross(camera.up).try_normalize();
    let right = level.unwrap_or_else(|| forward.any_orthonormal_vector());
    let roll = turn(forward, camera.roll);
    let right = roll(right);
    [right, right.cross(forward), forward]
}

fn turn(axis: DVec3, degrees: f64) -> impl Fn(DVec3) -> DVec3 {
    let matrix = Step::Rotate { axis, degrees }.matrix();
    move |v| matrix.transform_vector3(v)
}

/// The camera with its position and view changed.
fn with(camera: &Camera, position: DVec3, view: DVec3) -> Camera {
    let mut camera = camera.clone();
    camera.position = position;
    if camera.target.is_some() {
        camera.target = Some(position + view);
    } else {
        camera.direction = Some(view);
    }
    camera
}

/// Goes around a point: by degrees about the axis that is up, and over it, never past the poles.
#[must_use]
pub fn orbit(camera: &Camera, pivot: DVec3, around: f64, over: f64) -> Camera {
    let [_, _, forward] = axes(camera);
    let up = camera.up.normalize_or(DVec3::Y);
    let level = forward.cross(up).try_normalize().unwrap_or_else(|| forward.any_orthonormal_vector());
    // Degrees between the view and the way up.
    let from_up = math::atan2(forward.cross(up).length(), forward.dot(up)).to_degrees();
    let over = over.clamp(1.0 - from_up, 179.0 - from_up).clamp(-90.0, 90.0);
    // Turning about the axis to the right by a positive angle lifts the view.
    let (pitch, yaw) = (turn(level, -over), turn(up, around));
    let moved = |v: DVec3| yaw(pitch(v));
    with(camera, pivot + moved(camera.position - pivot), moved(camera.view()))
}

/// Moves in the camera's own frame: to the right, up, and forward.
#[must_use]
pub fn shift(camera: &Camera, by: DVec3) -> Camera {
    let [right, up, forward] = axes(camera);
    with(camera, camera.position + right * by.x + up * by.y + forward * by.z, camera.view())
}

/// Goes toward a point, or away: the distances to it are multiplied, so that it stays where it is in the picture.
#[must_use]
pub fn zoom(camera: &Camera, about: DVec3, factor: f64) -> Camera {
    let position = about + (camera.position - about) * factor;
    // A target keeps its distance ratio, so that it does not fall behind the camera.
    with(camera, position, camera.view() * if camera.target.is_some() { factor } else { 1.0 })
}

/// Turns where it stands, by degrees to the right and up.
#[must_use]
pub fn look(camera: &Camera, right: f64, up: f64) -> Camera {
    let [own_right, own_up, _] = axes(camera);
    let (pitch, yaw) = (turn(own_right, up), turn(own_up, -right));
    with(camera, camera.position, yaw(pitch(camera.view())))
}

/// Turns about its view, by degrees clockwise.
#[must_use]
pub fn roll(camera: &Camera, degrees: f64) -> Camera {
    let roll = (camera.roll + degrees + 180.0).rem_euclid(360.0) - 180.0;
    Camera { roll, ..camera.clone() }
}

/// Goes so far back, or near, along its view that a sphere fills most of the picture.
#[must_use]
pub fn frame(camera: &Camera, center: DVec3, radius: f64) -> Camera {
    let half = camera.screen_distance.map_or_else(|| math::tan_degrees(0.5 * camera.field_of_view), |d| 0.5 / d);
    let distance = radius.max(1e-9) * 1.3 * (1.0 + 1.0 / (half * half)).sqrt();
    let [_, _, forward] = axes(camera);
    let mut camera = camera.clone();
    camera.position = center - forward * distance;
    (camera.target, camera.direction) = (Some(center), None);
    camera
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera {
        Camera { position: DVec3::new(1.0, 2.0, 6.0), target: Some(DVec3::new(0.0, 1.0, 0.0)), ..Camera::default() }
    }

    #[test]
    fn going_around_keeps_the_distance_and_comes_back() {
        let pivot = DVec3::new(0.3, 0.5, 0.2);
        let mut at = camera();
        for _ in 0..36 {
            at = orbit(&at, pivot, 10.0, 0.0);
            assert!((at.position.distance(pivot) - camera().position.distance(pivot)).abs() < 1e-9);
        }
        assert!(at.position.distance(camera().position) < 1e-9);
        assert!(orbit(&camera(), pivot, 0.0, 10.0).position.y > camera().position.y, "over is up");
    }

    #[test]
    fn going_over_stops_at_the_poles() {
        for over in [20.0, -20.0] {
            let mut at = camera();
            for _ in 0..50 {
                at = orbit(&at, DVec3::ZERO, 0.0, over);
                let lean = at.view().normalize().cross(DVec3::Y).length();
                assert!(lean > 0.017, "{lean}");
            }
        }
    }

    #[test]
    fn the_point_zoomed_at_stays_in_its_place() {
        let about = DVec3::new(2.0, -1.0, 0.5);
        let before = axes(&camera()).map(|axis| axis.dot((about - camera().position).normalize()));
        let near = zoom(&camera(), about, 0.25);
        let after = axes(&near).map(|axis| axis.dot((about - near.position).normalize()));
        for (a, b) in before.iter().zip(after) {
            assert!((a - b).abs() < 1e-12);
        }
    }

    #[test]
    fn moves_go_along_the_cameras_own_axes() {
        let plain = Camera { position: DVec3::ZERO, ..Camera::default() };
        assert_eq!(shift(&plain, DVec3::new(1.0, 2.0, 3.0)).position, DVec3::new(1.0, 2.0, -3.0));
        let rolled = roll(&plain, 90.0);
        assert!(shift(&rolled, DVec3::X).position.distance(DVec3::NEG_Y) < 1e-12);
        assert!(look(&plain, 90.0, 0.0).view().distance(DVec3::X) < 1e-12);
        assert!(look(&plain, 0.0, 90.0).view().distance(DVec3::Y) < 1e-12);
        assert_eq!(roll(&roll(&plain, 170.0), 20.0).roll, -170.0);
    }
}
