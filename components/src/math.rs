//! The only door to functions beyond `+ − × ÷ √`.
//!
//! The picture must be the same to the last bit on every machine. IEEE 754 fixes the five operations above;
//! everything else differs between system libraries, so it goes through the pure-Rust `libm`, pinned to one version.
//! `mul_add` and `powi` are not used: the first fuses, the second has no specified precision.

/// Unit roundoff of `f64`, 2⁻⁵³: the largest relative error of one rounded operation.
pub const ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// `base` to the power `exponent`.
#[must_use]
pub fn pow(base: f64, exponent: f64) -> f64 {
    libm::pow(base, exponent)
}

/// e to the power `x`.
#[must_use]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// Logarithm to base 2.
#[must_use]
pub fn log2(x: f64) -> f64 {
    libm::log2(x)
}

/// Angle of the point `(x, y)` in radians, −π to π; zero for the origin.
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Angle in radians, 0 to π, whose cosine is `x`; `x` is clamped to −1..=1 first.
#[must_use]
pub fn acos(x: f64) -> f64 {
    libm::acos(x.clamp(-1.0, 1.0))
}

/// Largest integer not above `x`, exact.
#[must_use]
#[inline]
pub fn floor(x: f64) -> f64 {
    // Whole numbers are their own floor, the sign of zero included; so are all from 2⁵² up, infinities and NaN.
    let cut = x as i64 as f64;
    if x.abs() >= 4_503_599_627_370_496.0 || cut == x || x.is_nan() {
        x
    } else if cut > x {
        cut - 1.0
    } else {
        cut
    }
}

/// Tangent of an angle in degrees.
#[must_use]
pub fn tan_degrees(degrees: f64) -> f64 {
    let (sin, cos) = sin_cos_degrees(degrees);
    sin / cos
}

/// Sine and cosine of an angle in degrees; exact at every multiple of 90°, so quarter turns do not skew a scene.
#[must_use]
pub fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    // The remainder by 360 is exact, as is the distance to the nearest quarter turn.
    let turn = degrees % 360.0;
    let quarter = libm::rint(turn / 90.0);
    let (sin, cos) = {
        let rest = (turn - quarter * 90.0) * (core::f64::consts::PI / 180.0);
        (libm::sin(rest), libm::cos(rest))
    };
    // `quarter` is −4..=4.
    match (quarter as i32).rem_euclid(4) {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// The largest `f32` not above `x`.
#[must_use]
pub fn f32_below(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) > x { nearest.next_down() } else { nearest }
}

/// The smallest `f32` not below `x`.
#[must_use]
pub fn f32_above(x: f64) -> f32 {
    let nearest = x as f32;
    if f64::from(nearest) < x { nearest.next_up() } else { nearest }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        assert_eq!(sin_cos_degrees(90.0), (1.0, -0.0));
        assert_eq!(sin_cos_degrees(-90.0), (-1.0, 0.0));
        assert_eq!(sin_cos_degrees(180.0), (-0.0, -1.0));
        assert_eq!(sin_cos_degrees(720.0), (0.0, 1.0));
        let (sin, cos) = sin_cos_degrees(30.0);
        assert!((sin - 0.5).abs() <= ROUNDOFF && (cos - 0.75f64.sqrt()).abs() <= 2.0 * ROUNDOFF);
    }

    #[test]
    fn the_floor_is_that_of_libm_to_the_last_bit() {
        let mut numbers = vec![0.0, f64::NAN, f64::INFINITY, f64::MIN_POSITIVE, f64::from_bits(1), 0.5, 2.5, 1e300];
        for exponent in 0..70u32 {
            let power = (1u128 << exponent) as f64;
            numbers.extend([power.next_down(), power, power.next_up(), power + 0.5, power - 0.5]);
        }
        for x in numbers.into_iter().flat_map(|x| [x, -x]) {
            assert_eq!(floor(x).to_bits(), libm::floor(x).to_bits(), "{x:e}");
        }
    }

    #[test]
    fn rounding_to_f32_brackets_the_value() {
        for x in [0.1, -0.1, 1e-50, -1e-50, 1e300, -1e300, 16_777_217.0, 0.5] {
            assert!(f64::from(f32_below(x)) <= x && x <= f64::from(f32_above(x)), "{x}");
        }
        assert_eq!(f32_below(0.5), f32_above(0.5));
    }
}
