//! Lanes as arrays: what every machine has, and the reference for all levels.

use super::Lanes;
use crate::math;
use core::array::from_fn;

/// Arrays and plain loops.
#[derive(Clone, Copy)]
pub(super) struct Portable;

#[inline(always)]
fn mask<const N: usize>(lane: impl Fn(usize) -> bool) -> u32 {
    (0..N).fold(0, |mask, i| mask | u32::from(lane(i)) << i)
}

impl super::sealed::Sealed for Portable {}

impl Lanes for Portable {
    type F = [f32; 8];
    type D = [f64; 4];
    type M = [u64; 8];

    #[inline(always)]
    fn f_load(self, from: &[f32; 8]) -> [f32; 8] {
        *from
    }
    #[inline(always)]
    fn f_store(self, a: [f32; 8], to: &mut [f32; 8]) {
        *to = a;
    }
    #[inline(always)]
    fn f_splat(self, x: f32) -> [f32; 8] {
        [x; 8]
    }
    #[inline(always)]
    fn f_sub(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        from_fn(|i| a[i] - b[i])
    }
    #[inline(always)]
    fn f_mul(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        from_fn(|i| a[i] * b[i])
    }
    #[inline(always)]
    fn f_min(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        from_fn(|i| if a[i] < b[i] { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn f_max(self, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        from_fn(|i| if a[i] > b[i] { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn f_le(self, a: [f32; 8], b: [f32; 8]) -> u32 {
        mask::<8>(|i| a[i] <= b[i])
    }
    #[inline(always)]
    fn f_least_of_le(self, a: [f32; 8], b: [f32; 8], c: [f32; 8]) -> ([f32; 8], u32) {
        (from_fn(|i| if a[i] <= b[i] && a[i] < c[i] { a[i] } else { c[i] }), self.f_le(a, b))
    }
    #[inline(always)]
    fn f_select(self, which: u32, a: [f32; 8], b: [f32; 8]) -> [f32; 8] {
        from_fn(|i| if which >> i & 1 != 0 { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn prefetch<T>(self, _: &T) {}
    #[inline(always)]
    fn m_none(self) -> [u64; 8] {
        [0; 8]
    }
    #[inline(always)]
    fn m_set(self, a: [u64; 8], which: u32, bits: u64) -> [u64; 8] {
        from_fn(|i| if which >> i & 1 != 0 { a[i] | bits } else { a[i] })
    }
    #[inline(always)]
    fn m_store(self, a: [u64; 8], to: &mut [u64; 8]) {
        *to = a;
    }

    #[inline(always)]
    fn d_load(self, from: &[f64; 4]) -> [f64; 4] {
        *from
    }
    #[inline(always)]
    fn d_store(self, a: [f64; 4], to: &mut [f64; 4]) {
        *to = a;
    }
    #[inline(always)]
    fn d_store_some(self, a: [f64; 4], which: u32, to: &mut [f64; 4]) {
        *to = self.d_select(which, a, *to);
    }
    #[inline(always)]
    fn d_widen(self, from: &[f32; 4]) -> [f64; 4] {
        from.map(f64::from)
    }
    #[inline(always)]
    fn d_narrow(self, a: [f64; 4]) -> [f32; 4] {
        a.map(|x| x as f32)
    }
    #[inline(always)]
    fn d_splat(self, x: f64) -> [f64; 4] {
        [x; 4]
    }
    #[inline(always)]
    fn d_add(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        from_fn(|i| a[i] + b[i])
    }
    #[inline(always)]
    fn d_sub(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        from_fn(|i| a[i] - b[i])
    }
    #[inline(always)]
    fn d_mul(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        from_fn(|i| a[i] * b[i])
    }
    #[inline(always)]
    fn d_div(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        from_fn(|i| a[i] / b[i])
    }
    #[inline(always)]
    fn d_sqrt(self, a: [f64; 4]) -> [f64; 4] {
        a.map(f64::sqrt)
    }
    #[inline(always)]
    fn d_min(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        from_fn(|i| if a[i] < b[i] { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn d_max(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        from_fn(|i| if a[i] > b[i] { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn d_abs(self, a: [f64; 4]) -> [f64; 4] {
        a.map(f64::abs)
    }
    #[inline(always)]
    fn d_floor(self, a: [f64; 4]) -> [f64; 4] {
        a.map(math::floor)
    }
    #[inline(always)]
    fn d_with_sign(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        from_fn(|i| a[i].copysign(b[i]))
    }
    #[inline(always)]
    fn d_signs(self, a: [f64; 4]) -> u32 {
        mask::<4>(|i| a[i].is_sign_negative())
    }
    #[inline(always)]
    fn d_lt(self, a: [f64; 4], b: [f64; 4]) -> u32 {
        mask::<4>(|i| a[i] < b[i])
    }
    #[inline(always)]
    fn d_le(self, a: [f64; 4], b: [f64; 4]) -> u32 {
        mask::<4>(|i| a[i] <= b[i])
    }
    #[inline(always)]
    fn d_select(self, which: u32, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        from_fn(|i| if which >> i & 1 != 0 { a[i] } else { b[i] })
    }
    #[inline(always)]
    fn d_if_lt(self, a: [f64; 4], b: [f64; 4], x: [f64; 4], y: [f64; 4]) -> [f64; 4] {
        from_fn(|i| if a[i] < b[i] { x[i] } else { y[i] })
    }
}
