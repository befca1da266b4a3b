//! Oracles: whole numbers, which are exact, and double-doubles, good to thirty digits.

use glam::DVec3;
use snell_components::space::Ray;

/// Three whole coordinates.
pub(crate) type Whole = [i128; 3];

/// The coordinates of a point that has whole ones.
pub(crate) fn whole(v: DVec3) -> Whole {
    v.to_array().map(|x| {
        debug_assert!(x == x.trunc());
        x as i128
    })
}

pub(crate) fn dot(a: Whole, b: Whole) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Whole, b: Whole) -> Whole {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn minus(a: Whole, b: Whole) -> Whole {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// What holds for a ray and a triangle of whole coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    /// Twice the signed areas that the ray cuts off at the edges.
    pub(crate) edges: [i128; 3],
    /// The distance.
    pub(crate) distance: Fraction,
}

impl Crossing {
    pub(crate) fn of(ray: &Ray, vertices: [DVec3; 3]) -> Self {
        let [a, b, c] = vertices.map(|v| whole(v - ray.origin));
        let d = whole(ray.direction);
        let edges = [dot(d, cross(b, c)), dot(d, cross(c, a)), dot(d, cross(a, b))];
        let normal = cross(minus(b, a), minus(c, a));
        Self { edges, distance: (dot(a, normal) * dot(d, normal).signum(), dot(d, normal).abs()) }
    }

    /// Whether the half-line meets the closed triangle other than edge-on or at its own start.
    pub(crate) fn hits(&self) -> bool {
        let (over, under) = self.distance;
        let inside = self.edges.iter().all(|e| *e >= 0) || self.edges.iter().all(|e| *e <= 0);
        inside && under != 0 && over > 0
    }

    /// Whether this distance is less than another; both must be hits.
    pub(crate) fn nearer(&self, other: &Self) -> bool {
        let ((a, b), (c, d)) = (self.distance, other.distance);
        a * d < c * b
    }
}

/// A distance: numerator and positive denominator.
type Fraction = (i128, i128);

/// How far a value is from a fraction that is not zero, as a share of that.
pub(crate) fn relative_error(t: f64, (over, under): Fraction) -> f64 {
    let (over, under) = (Double::of_whole(over), Double::of_whole(under));
    ((Double::from(t) * under - over) / over).to_f64().abs()
}

/// Where a half-line enters and leaves a closed box; it enters at zero if it starts within.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub(crate) enter: Fraction,
    /// None for a ray without direction.
    pub(crate) leave: Option<Fraction>,
}

/// Whether a half-line meets a closed box, all of whole coordinates: by fractions.
pub(crate) fn meets_box(ray: &Ray, min: DVec3, max: DVec3) -> bool {
    box_span(ray, min, max).is_some()
}

/// Where a half-line meets a closed box, all of whole coordinates: by fractions.
pub(crate) fn box_span(ray: &Ray, min: DVec3, max: DVec3) -> Option<Span> {
    let (o, d, min, max) = (whole(ray.origin), whole(ray.direction), whole(min), whole(max));
    let (mut enter, mut leave): (Fraction, Option<Fraction>) = ((0, 1), None);
    for axis in 0..3 {
        if d[axis] == 0 {
            if o[axis] < min[axis] || o[axis] > max[axis] {
                return None;
            }
            continue;
        }
        let sign = d[axis].signum();
        let (near, far) = if sign > 0 { (min[axis], max[axis]) } else { (max[axis], min[axis]) };
        let under = d[axis].abs();
        let (near, far) = (((near - o[axis]) * sign, under), ((far - o[axis]) * sign, under));
        if near.0 * enter.1 > enter.0 * near.1 {
            enter = near;
        }
        if leave.is_none_or(|leave| far.0 * leave.1 < leave.0 * far.1) {
            leave = Some(far);
        }
    }
    leave.is_none_or(|leave| enter.0 * leave.1 <= leave.0 * enter.1).then_some(Span { enter, leave })
}

/// A number as the sum of two that do not overlap (Dekker 1971, Knuth).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Double {
    high: f64,
    low: f64,
}

impl From<f64> for Double {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

/// The rounded sum and what rounding lost.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// The rounded product and what rounding lost, by splitting each factor in two.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let split = |x: f64| {
        let t = 134_217_729.0 * x;
        let high = t - (t - x);
        (high, x - high)
    };
    let product = a * b;
    let ((a, al), (b, bl)) = (split(a), split(b));
    (product, ((a * b - product) + a * bl + al * b) + al * bl)
}

impl Double {
    /// A whole number below 2^106.
    fn of_whole(whole: i128) -> Self {
        let high = whole as f64;
        Self::normal(high, (whole - high as i128) as f64)
    }

    pub(crate) fn to_f64(self) -> f64 {
        self.high + self.low
    }

    fn normal(high: f64, low: f64) -> Self {
        let (high, low) = two_sum(high, low);
        Self { high, low }
    }

    /// The square root of a number not below zero.
    pub(crate) fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::from(0.0);
        }
        let root = Self::from(self.high.sqrt());
        let rest = self - root * root;
        root + Self::from(rest.high / (2.0 * root.high))
    }
}

impl core::ops::Add for Double {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (high, low) = two_sum(self.high, other.high);
        let (a, b) = two_sum(self.low, other.low);
        let Self { high, low } = Self::normal(high, low + a);
        Self::normal(high, low + b)
    }
}

impl core::ops::Neg for Double {
    type Output = Self;

    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl core::ops::Sub for Double {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl core::ops::Mul for Double {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let (high, low) = two_product(self.high, other.high);
        Self::normal(high, low + (self.high * other.low + self.low * other.high))
    }
}

impl core::ops::Div for Double {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * Self::from(first);
        let second = rest.high / other.high;
        let rest = rest - other * Self::from(second);
        Self::normal(first, second) + Self::from(rest.high / other.high)
    }
}

type Vector = [Double; 3];

fn vector(v: DVec3) -> Vector {
    v.to_array().map(Double::from)
}

fn dot_double(a: Vector, b: Vector) -> Double {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// How far the point at `t` is from the surface of a sphere.
pub(crate) fn sphere_residual(ray: &Ray, t: f64, center: DVec3, radius: f64) -> f64 {
    let (o, d, c) = (vector(ray.origin), vector(ray.direction), vector(center));
    let off: Vector = core::array::from_fn(|i| o[i] + d[i] * Double::from(t) - c[i]);
    (dot_double(off, off).sqrt() - Double::from(radius)).to_f64().abs()
}

/// The distance at which a ray crosses the plane through a point, by its normal, which may have any length.
pub(crate) fn plane_distance(ray: &Ray, point: DVec3, normal: DVec3) -> f64 {
    let (o, d, p, n) = (vector(ray.origin), vector(ray.direction), vector(point), vector(normal));
    let off: Vector = core::array::from_fn(|i| p[i] - o[i]);
    (dot_double(n, off) / dot_double(n, d)).to_f64()
}

/// The roots of a ray and a sphere, nearer first, none if the line misses it.
pub(crate) fn sphere_roots(ray: &Ray, center: DVec3, radius: f64) -> Option<[f64; 2]> {
    let (o, d, c) = (vector(ray.origin), vector(ray.direction), vector(center));
    let f: Vector = core::array::from_fn(|i| o[i] - c[i]);
    let dot = dot_double;
    let (a, b) = (dot(d, d), dot(f, d));
    // By the foot, so that thirty digits stay thirty.
    let foot: [Double; 3] = core::array::from_fn(|i| f[i] - d[i] * (b / a));
    let r = Double::from(radius);
    let gap = r * r - dot(foot, foot);
    if gap.to_f64() < 0.0 {
        return None;
    }
    let half = (gap / a).sqrt();
    let middle = -(b / a);
    Some([(middle - half).to_f64(), (middle + half).to_f64()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn double_doubles_have_thirty_digits() {
        let third = Double::from(1.0) / Double::from(3.0);
        let rest = third * Double::from(3.0) - Double::from(1.0);
        assert!(rest.to_f64().abs() < 1e-31);
        let root = Double::from(2.0).sqrt();
        assert!((root * root - Double::from(2.0)).to_f64().abs() < 1e-30);
        let tiny = Double::from(1.0) + Double::from(1e-25);
        assert_eq!((tiny - Double::from(1.0)).to_f64(), 1e-25);
    }

    #[test]
    fn fractions_decide_boxes() {
        let ray = |origin, direction| Ray { origin, direction };
        let (min, max) = (DVec3::NEG_ONE, DVec3::ONE);
        assert!(meets_box(&ray(DVec3::new(-1.0, 0.0, -5.0), DVec3::Z), min, max));
        assert!(!meets_box(&ray(DVec3::new(-2.0, 0.0, -5.0), DVec3::Z), min, max));
        assert!(meets_box(&ray(DVec3::new(-3.0, -3.0, 0.0), DVec3::new(1.0, 1.0, 0.0)), min, max));
        assert!(!meets_box(&ray(DVec3::Z * 2.0, DVec3::Z), min, max));
        assert!(meets_box(&ray(DVec3::ONE, DVec3::ONE), min, max), "it starts at a corner");
    }
}
