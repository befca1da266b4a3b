//! Rays and the boxes and spheres that bound things.

use bevy_ecs::prelude::*;
use glam::{DAffine3, DVec3};

/// A half-line. Distances along it are in units of `direction`, which need not have length one: a ray taken to another
/// space keeps its distances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: DVec3,
    /// Where it goes; finite and not zero.
    pub direction: DVec3,
}

impl Ray {
    /// The point at distance `t`.
    #[must_use]
    #[inline]
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// The same ray in another space; distances stay as they are.
    #[must_use]
    #[inline]
    pub fn transformed(&self, to: &DAffine3) -> Self {
        Self { origin: to.transform_point3(self.origin), direction: to.transform_vector3(self.direction) }
    }

    /// Whether every coordinate is finite and the direction is not zero; nothing else may be traced.
    #[must_use]
    #[inline]
    pub fn is_valid(&self) -> bool {
        // Zero times a number is zero unless that is infinite or not a number.
        let zero = self.origin * 0.0 + self.direction * 0.0;
        zero.x + zero.y + zero.z == 0.0 && self.direction != DVec3::ZERO
    }
}

/// An axis-aligned box, closed: points on its faces belong to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates.
    pub min: DVec3,
    /// Greatest coordinates.
    pub max: DVec3,
}

impl Bounds {
    /// The box that holds nothing.
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The smallest box around some points.
    #[must_use]
    pub fn of_points(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self { min: b.min.min(p), max: b.max.max(p) })
    }

    /// The smallest box around two.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The middle.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// Whether a point lies in the box or on its faces.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        self.min.cmple(point).all() && point.cmple(self.max).all()
    }

    /// The eight corners.
    #[must_use]
    pub fn corners(&self) -> [DVec3; 8] {
        let pick = |high: bool, axis: usize| if high { self.max[axis] } else { self.min[axis] };
        core::array::from_fn(|i| DVec3::new(pick(i & 1 != 0, 0), pick(i & 2 != 0, 1), pick(i & 4 != 0, 2)))
    }

    /// A box around the image of this box under an affine map, widened to hold despite rounding.
    #[must_use]
    pub fn transformed(&self, to: &DAffine3) -> Self {
        Self::of_points(self.corners().map(|corner| to.transform_point3(corner)))
            .widened(16.0 * f64::EPSILON * affine_magnitude(to, self))
    }

    /// Grown on every side.
    #[must_use]
    pub fn widened(&self, by: f64) -> Self {
        Self { min: self.min - by, max: self.max + by }
    }
}

/// Largest intermediate magnitude when `to` maps a point of `bounds`: the scale of its rounding error.
fn affine_magnitude(to: &DAffine3, bounds: &Bounds) -> f64 {
    let reach = bounds.min.abs().max(bounds.max.abs());
    let m = &to.matrix3;
    let image = m.x_axis.abs() * reach.x + m.y_axis.abs() * reach.y + m.z_axis.abs() * reach.z;
    (image + to.translation.abs()).max_element()
}

/// A sphere around an object, in the world.
///
/// Written by the acceleration system for every bounded object; contains all of it.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub struct BoundingSphere {
    /// Centre, world space.
    pub center: DVec3,
    /// Radius, world units.
    pub radius: f64,
}

impl BoundingSphere {
    /// The sphere about the centre of a box that reaches its corners.
    #[must_use]
    pub fn of_bounds(bounds: &Bounds) -> Self {
        let center = bounds.center();
        Self::about(center, [bounds.min, bounds.max])
    }

    /// The least sphere around a triangle: about the middle of its longest side where the angle there is not acute, else
    /// through all three corners; widened to hold despite rounding.
    #[must_use]
    pub fn of_triangle([a, b, c]: [DVec3; 3]) -> Self {
        let (ab, ac) = (b - a, c - a);
        let (x, y, z) = ((c - b).length_squared(), ac.length_squared(), ab.length_squared());
        let center = if x >= y + z {
            b + (c - b) * 0.5
        } else if y >= x + z {
            a + ac * 0.5
        } else if z >= x + y {
            a + ab * 0.5
        } else {
            let normal = ab.cross(ac);
            a + (normal.cross(ab) * y + ac.cross(normal) * z) / (2.0 * normal.length_squared())
        };
        // Of needles and of numbers beyond squaring, the centre may be none.
        let center = if center.is_finite() { center } else { Bounds::of_points([a, b, c]).center() };
        Self::about(center, [a, b, c])
    }

    /// The sphere about `center` that reaches the farthest of some points, widened to hold despite rounding.
    #[must_use]
    pub fn about(center: DVec3, points: impl IntoIterator<Item = DVec3>) -> Self {
        let reach = points.into_iter().map(|p| p.distance_squared(center)).fold(0.0, f64::max).sqrt();
        Self { center, radius: reach + 8.0 * f64::EPSILON * (reach + center.abs().max_element()) }
    }
}
