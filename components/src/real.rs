//! Arithmetic in either precision, for the tests that exist in both.

use core::ops::{Add, Div, Mul, Neg, Sub};
use glam::DVec3;

/// `f32` or `f64`.
pub trait Real:
    Copy
    + core::fmt::Debug
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;

    /// The nearest number of this precision.
    fn of(x: f64) -> Self;

    /// The same number, exactly.
    fn to_f64(self) -> f64;

    /// The square root, correctly rounded.
    fn sqrt(self) -> Self;

    /// Whether it is neither infinite nor not-a-number.
    fn is_finite(self) -> bool;

    /// Its absolute value.
    fn abs(self) -> Self;
}

macro_rules! real {
    ($float:ty) => {
        impl Real for $float {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;

            #[inline(always)]
            fn of(x: f64) -> Self {
                x as Self
            }

            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                <$float>::sqrt(self)
            }

            #[inline(always)]
            fn is_finite(self) -> bool {
                <$float>::is_finite(self)
            }

            #[inline(always)]
            fn abs(self) -> Self {
                <$float>::abs(self)
            }
        }
    };
}

real!(f32);
real!(f64);

/// A vector in either precision.
pub type Vector<R> = [R; 3];

/// A vector rounded to a precision.
#[inline]
pub fn vector<R: Real>(v: DVec3) -> Vector<R> {
    [R::of(v.x), R::of(v.y), R::of(v.z)]
}

/// `a + b`.
#[inline]
pub fn plus<R: Real>(a: Vector<R>, b: Vector<R>) -> Vector<R> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a − b`.
#[inline]
pub fn minus<R: Real>(a: Vector<R>, b: Vector<R>) -> Vector<R> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a · k`.
#[inline]
pub fn times<R: Real>(a: Vector<R>, k: R) -> Vector<R> {
    [a[0] * k, a[1] * k, a[2] * k]
}

/// Scalar product, summed in the order x, y, z.
#[inline]
pub fn dot<R: Real>(a: Vector<R>, b: Vector<R>) -> R {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
#[inline]
pub fn cross<R: Real>(a: Vector<R>, b: Vector<R>) -> Vector<R> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
