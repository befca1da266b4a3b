//! How much of a surface a ray stands for.

use glam::{DVec2, DVec3};

/// How far a lookup moves from one ray to the next in the picture, to the right and down: the sides of the parallelogram
/// whose mean colour the ray stands for. Infinite where nothing is known of the neighbours.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Footprint {
    /// In texture coordinates.
    pub uv: [DVec2; 2],
    /// In world space.
    pub point: [DVec3; 2],
}

/// The axes of the ellipse that has the same second moments as a parallelogram; of a rectangle, its sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// The longer axis as a vector.
    pub major: DVec2,
    /// Length of the longer axis.
    pub longer: f64,
    /// Length of the shorter axis.
    pub shorter: f64,
}

impl Axes {
    /// Of a parallelogram with two sides; none if they are not finite.
    #[must_use]
    pub fn of([a, b]: [DVec2; 2]) -> Option<Self> {
        // Eigenvalues of the symmetric matrix of second moments; the smaller by the determinant, which does not cancel.
        let (xx, xy, yy) = (a.x * a.x + b.x * b.x, a.x * a.y + b.x * b.y, a.y * a.y + b.y * b.y);
        let (middle, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        let apart = (half * half + xy * xy).sqrt();
        let longer = (middle + apart).sqrt();
        if !longer.is_finite() {
            return None;
        }
        let direction = if half > 0.0 { DVec2::new(half + apart, xy) } else { DVec2::new(xy, apart - half) };
        let shorter = if longer > 0.0 { a.perp_dot(b).abs() / longer } else { 0.0 };
        Some(Self { major: direction.normalize_or(DVec2::X) * longer, longer, shorter })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axes_of_a_rectangle_are_its_sides() {
        for (sin, cos) in [(0.0, 1.0), (0.6, 0.8), (1.0, 0.0), (-0.8, 0.6)] {
            let (long, short) = (DVec2::new(cos, sin) * 5.0, DVec2::new(-sin, cos) * 0.25);
            for sides in [[long, short], [short, long], [-long, short]] {
                let axes = Axes::of(sides).expect("axes");
                assert!((axes.longer - 5.0).abs() < 1e-14 && (axes.shorter - 0.25).abs() < 1e-14, "{axes:?}");
                assert!(axes.major.perp_dot(long).abs() < 1e-13, "{axes:?}");
            }
        }
    }

    #[test]
    fn a_square_a_line_and_a_point_have_axes_too() {
        let axes = Axes::of([DVec2::new(3.0, 4.0), DVec2::new(-4.0, 3.0)]).expect("axes");
        assert!((axes.longer - 5.0).abs() < 1e-14 && (axes.shorter - 5.0).abs() < 1e-14);
        let axes = Axes::of([DVec2::new(3.0, 4.0), DVec2::new(6.0, 8.0)]).expect("axes");
        assert!((axes.longer - 125f64.sqrt()).abs() < 1e-13 && axes.shorter == 0.0);
        assert_eq!(Axes::of([DVec2::ZERO; 2]), Some(Axes { major: DVec2::ZERO, longer: 0.0, shorter: 0.0 }));
        for wrong in [f64::NAN, f64::INFINITY, 1e300] {
            assert_eq!(Axes::of([DVec2::X * wrong, DVec2::Y]), None);
        }
    }
}
