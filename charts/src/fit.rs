//! Straight lines through points.

use snell_components::math;

/// A line `y = a + b·x` by least squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Where it crosses x = 0.
    pub a: f64,
    /// Its slope.
    pub b: f64,
    /// Share of the variance of y that it explains, 0 to 1.
    pub r_squared: f64,
}

/// The line through points; nothing unless two of them differ in x.
#[must_use]
pub fn line(points: &[(f64, f64)]) -> Option<Line> {
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for p in points {
        let (dx, dy) = (p.0 - x, p.1 - y);
        xx += dx * dx;
        xy += dx * dy;
        yy += dy * dy;
    }
    (points.len() > 1 && xx > 0.0).then(|| {
        let b = xy / xx;
        Line { a: y - b * x, b, r_squared: if yy > 0.0 { xy * xy / (xx * yy) } else { 1.0 } }
    })
}

/// The exponent `p` of the power law `y = c·xᵖ` through points with positive coordinates, and how well it fits.
#[must_use]
pub fn power(points: &[(f64, f64)]) -> Option<Line> {
    let logs: Vec<_> =
        points.iter().filter(|p| p.0 > 0.0 && p.1 > 0.0).map(|p| (math::log2(p.0), math::log2(p.1))).collect();
    line(&logs)
}

/// The middle of some values; of an even count the mean of the middle two; 0 of none.
#[must_use]
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => 0.0,
        n if n % 2 == 1 => sorted[n / 2],
        n => 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_powers_are_found() {
        let found = line(&[(0.0, 1.0), (1.0, 3.0), (2.0, 5.0)]).expect("a line");
        assert!((found.a - 1.0).abs() < 1e-12 && (found.b - 2.0).abs() < 1e-12 && found.r_squared > 0.999);
        let root = power(&[(1.0, 2.0), (4.0, 4.0), (16.0, 8.0), (0.0, 0.0)]).expect("a power");
        assert!((root.b - 0.5).abs() < 1e-12);
        let noisy = line(&[(0.0, 0.0), (1.0, 5.0), (2.0, 0.0)]).expect("a line");
        assert!(noisy.r_squared < 0.1);
        assert!(line(&[(1.0, 1.0), (1.0, 2.0)]).is_none() && line(&[]).is_none());
    }

    #[test]
    fn the_median_is_the_middle() {
        assert_eq!([median(&[]), median(&[3.0, 1.0, 2.0]), median(&[4.0, 1.0])], [0.0, 2.0, 2.5]);
    }
}
