//! The camera: a pinhole before a screen; how it is moved and turned.

use crate::{
    describe::{Describe, Fault},
    math,
    transform::Step,
};
use bevy_ecs::prelude::*;
use glam::{DAffine3, DMat3, DVec3};
use smallvec::SmallVec;

/// A pinhole camera: rays start at the position and pass through the centres of the screen's pixels.
///
/// Without `target` and `direction` it looks along −z of its object space.
#[derive(Component, Clone, Debug, PartialEq, Describe)]
#[describe(check = Self::agrees)]
pub struct Camera {
    /// The pinhole, object space.
    #[describe(required)]
    pub position: DVec3,
    /// A point in the middle of the picture, object space.
    pub target: Option<DVec3>,
    /// The way the camera looks, object space; in place of `target`.
    #[describe(nonzero)]
    pub direction: Option<DVec3>,
    /// The way that is up in the picture, object space; need not be perpendicular to the view.
    #[describe(nonzero)]
    pub up: DVec3,
    /// Degrees by which the camera is turned about its view, clockwise seen from behind: the picture turns the other way.
    pub roll: f64,
    /// Vertical angle of view, degrees.
    #[describe(positive, at_most(179.9))]
    pub field_of_view: f64,
    /// Distance of the screen in screen heights; in place of `field_of_view`, which is `2·atan(1 / 2d)`.
    #[describe(positive)]
    pub screen_distance: Option<f64>,
    /// How it moves and turns from there, as [`Camera::step`] does, the first step first.
    pub moves: SmallVec<[Step; 4]>,
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            position: DVec3::ZERO,
            target: None,
            direction: None,
            up: DVec3::Y,
            roll: 0.0,
            field_of_view: 45.0,
            screen_distance: None,
            moves: SmallVec::new(),
        }
    }
}

impl Camera {
    /// A camera at a place, looking along −z.
    #[must_use]
    pub fn at(position: impl Into<DVec3>) -> Self {
        Self { position: position.into(), ..Self::default() }
    }

    /// The same camera with a point in the middle of its picture.
    #[must_use]
    pub fn looking_at(self, target: impl Into<DVec3>) -> Self {
        Self { target: Some(target.into()), direction: None, ..self }
    }
}

impl Camera {
    /// Whether the fields go together.
    fn agrees(&self) -> Result<(), Fault> {
        if self.target.is_some() && self.direction.is_some() {
            return Err(Fault::new("direction", "either `target` or `direction`, not both"));
        }
        if self.target == Some(self.position) {
            return Err(Fault::new("target", "a point other than `position`"));
        }
        if self.moves.iter().any(|step| matches!(step, Step::Scale(_))) {
            return Err(Fault::new("moves", "steps that move or turn: a camera has no size"));
        }
        Ok(())
    }
}

impl Camera {
    /// The way the camera looks before its `moves`, object space; any length but zero.
    #[must_use]
    pub fn view(&self) -> DVec3 {
        self.target.map(|target| target - self.position).or(self.direction).unwrap_or(DVec3::NEG_Z)
    }

    /// Moves or turns it in its own axes, which go with it: x to the right in its picture, y up, z back.
    ///
    /// `Translate((0, 0, −1))` goes in by one, `RotateY(10)` turns to the left about the pinhole, `RotateX(10)` up,
    /// `RotateZ(10)` rolls to the left. A `target` stays as far away as it was. A scale does nothing.
    pub fn step(&mut self, step: Step) {
        let (Some(forward), false) = (self.view().try_normalize(), matches!(step, Step::Scale(_))) else { return };
        let (right, up) = screen_axes(forward, self.up, self.roll);
        let own = DAffine3 { matrix3: DMat3::from_cols(right, up, -forward), translation: self.position };
        let own = own * step.matrix();
        let away = self.target.map(|target| target.distance(self.position));
        self.position = own.translation;
        let forward = -own.matrix3.z_axis;
        match away {
            Some(away) => self.target = Some(self.position + forward * away),
            None => self.direction = Some(forward),
        }
        // What was rolled is in the axes now.
        (self.up, self.roll) = (own.matrix3.y_axis, 0.0);
    }

    /// Moves it, or turns it about an axis through the origin, in the axes of its object space: those of the world where
    /// it has no placement of its own. It turns as a whole, with what it looks at.
    pub fn place(&mut self, step: Step) {
        let matrix = step.matrix();
        let direction = matrix.transform_vector3(self.view());
        self.position = matrix.transform_point3(self.position);
        self.up = matrix.transform_vector3(self.up);
        match self.target {
            Some(target) => self.target = Some(matrix.transform_point3(target)),
            None => self.direction = Some(direction),
        }
    }

    /// Moves it to a point; it looks the same way as before.
    pub fn move_to(&mut self, position: DVec3) {
        self.target = self.target.map(|target| target + (position - self.position));
        self.position = position;
    }

    /// Turns it to a point, which must not be its own position; up stays up.
    pub fn look_at(&mut self, target: DVec3) {
        (self.target, self.direction) = (Some(target), None);
    }

    /// Distance of the screen in screen heights, whichever way it is given.
    #[must_use]
    pub fn distance(&self) -> f64 {
        self.screen_distance.unwrap_or_else(|| 0.5 / math::tan_degrees(0.5 * self.field_of_view))
    }

    /// Vertical angle of view in degrees, whichever way it is given.
    #[must_use]
    pub fn angle(&self) -> f64 {
        self.screen_distance.map_or(self.field_of_view, |distance| 2.0 * math::atan2(0.5, distance).to_degrees())
    }

    /// The camera where its `moves` have led; it has none of its own.
    #[must_use]
    pub fn moved(&self) -> Self {
        let mut moved = Self { moves: SmallVec::new(), ..self.clone() };
        self.moves.iter().for_each(|step| moved.step(*step));
        moved
    }
}

/// Unit vectors to the right and up in the picture of a camera that looks along a unit vector and is rolled clockwise by
/// degrees.
#[must_use]
pub fn screen_axes(forward: DVec3, up: DVec3, roll: f64) -> (DVec3, DVec3) {
    // Looking along `up` leaves the roll open: take the axis farthest from the view instead.
    let right = forward.cross(up).try_normalize().unwrap_or_else(|| {
        let size = forward.abs();
        let axis = if size.y <= size.x && size.y <= size.z {
            DVec3::Y
        } else if size.z <= size.x {
            DVec3::Z
        } else {
            DVec3::X
        };
        forward.cross(axis).normalize()
    });
    let up = right.cross(forward);
    let (sin, cos) = math::sin_cos_degrees(roll);
    (right * cos - up * sin, up * cos + right * sin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn assert_near(found: DVec3, expected: DVec3) {
        assert!((found - expected).length() < 1e-14, "{found}, expected {expected}");
    }

    /// At (1, 2, 3), looking along +x.
    fn camera() -> Camera {
        Camera { position: DVec3::new(1.0, 2.0, 3.0), direction: Some(DVec3::X * 7.0), ..Camera::default() }
    }

    #[test]
    fn it_moves_along_its_own_axes() {
        for (by, expected) in [
            (DVec3::X, DVec3::new(1.0, 2.0, 4.0)),
            (DVec3::Y, DVec3::new(1.0, 3.0, 3.0)),
            (DVec3::NEG_Z, DVec3::new(2.0, 2.0, 3.0)),
        ] {
            let mut moved = camera();
            moved.step(Step::Translate(by));
            assert_near(moved.position, expected);
            assert_near(moved.view(), DVec3::X);
            let mut aimed = Camera { target: Some(DVec3::new(5.0, 2.0, 3.0)), direction: None, ..camera() };
            aimed.step(Step::Translate(by));
            assert_near(aimed.target.expect("a target") - aimed.position, DVec3::X * 4.0);
        }
    }

    #[test]
    fn it_turns_about_its_own_axes() {
        for (step, view, up) in [
            (Step::RotateY(90.0), DVec3::NEG_Z, DVec3::Y),
            (Step::RotateX(90.0), DVec3::Y, DVec3::NEG_X),
            (Step::RotateZ(90.0), DVec3::X, DVec3::NEG_Z),
            (Step::Rotate { axis: DVec3::ONE, degrees: 120.0 }, DVec3::NEG_Z, DVec3::NEG_X),
        ] {
            let mut turned = camera();
            turned.step(step);
            assert_eq!(turned.position, camera().position);
            assert_near(turned.view(), view);
            assert_near(turned.up, up);
        }
    }

    #[test]
    fn a_roll_is_part_of_its_own_axes() {
        // Rolled clockwise by a quarter, right is down.
        let mut rolled = Camera { roll: 90.0, ..camera() };
        rolled.step(Step::Translate(DVec3::X));
        assert_near(rolled.position, DVec3::new(1.0, 1.0, 3.0));
        let (right, up) = screen_axes(DVec3::X, rolled.up, rolled.roll);
        assert_near(right, DVec3::NEG_Y);
        assert_near(up, DVec3::Z);
    }

    #[test]
    fn it_is_placed_about_the_axes_of_the_world() {
        let mut placed = camera();
        placed.place(Step::RotateY(90.0));
        assert_near(placed.position, DVec3::new(3.0, 2.0, -1.0));
        assert_near(placed.view(), DVec3::NEG_Z * 7.0);
        let mut aimed = Camera { target: Some(DVec3::ZERO), direction: None, ..camera() };
        aimed.place(Step::Rotate { axis: DVec3::X, degrees: 180.0 });
        assert_near(aimed.position, DVec3::new(1.0, -2.0, -3.0));
        assert_near(aimed.target.expect("a target"), DVec3::ZERO);
        assert_near(aimed.up, DVec3::NEG_Y);
    }

    #[test]
    fn a_full_circle_of_small_steps_leads_back() {
        let mut camera = camera();
        for _ in 0..36_000 {
            camera.step(Step::Translate(DVec3::NEG_Z * 0.01));
            camera.step(Step::RotateY(0.01));
        }
        assert!((camera.position - DVec3::new(1.0, 2.0, 3.0)).length() < 1e-9, "{}", camera.position);
        assert!((camera.view() - DVec3::X).length() < 1e-11 && (camera.up - DVec3::Y).length() < 1e-11);
    }

    #[test]
    fn moving_to_a_point_keeps_the_view_and_looking_at_one_the_place() {
        let mut camera = Camera { target: Some(DVec3::ZERO), direction: None, ..camera() };
        let view = camera.view();
        camera.move_to(DVec3::new(-4.0, 0.0, 9.0));
        assert_near(camera.view(), view);
        camera.look_at(DVec3::new(-4.0, 5.0, 9.0));
        assert_near(camera.view(), DVec3::Y * 5.0);
        assert_eq!(camera.position, DVec3::new(-4.0, 0.0, 9.0));
    }

    #[test]
    fn angle_and_distance_say_the_same() {
        for angle in [10.0, 45.0, 90.0, 150.0] {
            let by_angle = Camera { field_of_view: angle, ..Camera::default() };
            let by_distance = Camera { screen_distance: Some(by_angle.distance()), ..Camera::default() };
            assert!((by_distance.angle() - angle).abs() < 1e-12 && by_angle.angle() == angle);
        }
        assert!((Camera { field_of_view: 90.0, ..Camera::default() }.distance() - 0.5).abs() < 1e-15);
    }
}
