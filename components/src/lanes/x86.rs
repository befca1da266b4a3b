//! Lanes of x86-64.
//!
//! An [`Avx2`] or [`Avx512`] is made in one place, after the machine was asked; having one is the proof that the
//! instructions exist.
//! Intrinsics are inlined into the function that enables them, so each is one instruction.

use super::{Job, Lanes};
use core::arch::x86_64::*;

/// Proof that the machine has AVX2.
#[derive(Clone, Copy)]
pub(super) struct Avx2(());

impl Avx2 {
    pub(super) fn is_available() -> bool {
        is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("popcnt")
            && is_x86_feature_detected!("lzcnt")
    }
}

/// Does a job with AVX2; the level must be available.
#[inline(always)]
pub(super) fn run_avx2<J: Job>(job: J) -> J::Output {
    #[target_feature(enable = "avx2,bmi1,bmi2,popcnt,lzcnt")]
    fn enabled<J: Job>(job: J) -> J::Output {
        job.run(Avx2(()))
    }
    // SAFETY: `Level::choose` stores a level only if it is available.
    unsafe { enabled(job) }
}

/// Proof that the machine has AVX-512 with its forms for 256 bits: as many lanes as with AVX2, but twice the registers,
/// so that a ray stays in them, and comparisons that give masks.
#[derive(Clone, Copy)]
pub(super) struct Avx512(());

impl Avx512 {
    pub(super) fn is_available() -> bool {
        Avx2::is_available()
            && is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512bw")
    }
}

/// Does a job with AVX-512; the level must be available.
#[inline(always)]
pub(super) fn run_avx512<J: Job>(job: J) -> J::Output {
    #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,bmi1,bmi2,popcnt,lzcnt")]
    fn enabled<J: Job>(job: J) -> J::Output {
        job.run(Avx512(()))
    }
    // SAFETY: `Level::choose` stores a level only if it is available.
    unsafe { enabled(job) }
}

macro_rules! op {
    ($name:ident($($arg:ident: $ty:ty),*) -> $out:ty = $body:expr) => {
        #[inline(always)]
        fn $name(self, $($arg: $ty),*) -> $out {
            // SAFETY: `self` proves that the machine has the level; what is read or written is behind references of that size.
            unsafe { $body }
        }
    };
}

/// Bytes that come into the caches together.
const LINE: usize = 64;

/// The operations that both levels have alike.
macro_rules! common {
    () => {
        type F = __m256;
        type D = __m256d;

        op!(f_load(from: &[f32; 8]) -> __m256 = _mm256_loadu_ps(from.as_ptr()));
        op!(f_store(a: __m256, to: &mut [f32; 8]) -> () = _mm256_storeu_ps(to.as_mut_ptr(), a));
        op!(f_splat(x: f32) -> __m256 = _mm256_set1_ps(x));
        op!(f_sub(a: __m256, b: __m256) -> __m256 = _mm256_sub_ps(a, b));
        op!(f_mul(a: __m256, b: __m256) -> __m256 = _mm256_mul_ps(a, b));
        op!(f_min(a: __m256, b: __m256) -> __m256 = _mm256_min_ps(a, b));
        op!(f_max(a: __m256, b: __m256) -> __m256 = _mm256_max_ps(a, b));
        op!(d_load(from: &[f64; 4]) -> __m256d = _mm256_loadu_pd(from.as_ptr()));
        op!(d_store(a: __m256d, to: &mut [f64; 4]) -> () = _mm256_storeu_pd(to.as_mut_ptr(), a));
        op!(d_widen(from: &[f32; 4]) -> __m256d = _mm256_cvtps_pd(_mm_loadu_ps(from.as_ptr())));
        op!(d_narrow(a: __m256d) -> [f32; 4] = core::mem::transmute::<__m128, [f32; 4]>(_mm256_cvtpd_ps(a)));
        op!(d_splat(x: f64) -> __m256d = _mm256_set1_pd(x));
        op!(d_add(a: __m256d, b: __m256d) -> __m256d = _mm256_add_pd(a, b));
        op!(d_sub(a: __m256d, b: __m256d) -> __m256d = _mm256_sub_pd(a, b));
        op!(d_mul(a: __m256d, b: __m256d) -> __m256d = _mm256_mul_pd(a, b));
        op!(d_div(a: __m256d, b: __m256d) -> __m256d = _mm256_div_pd(a, b));
        op!(d_min(a: __m256d, b: __m256d) -> __m256d = _mm256_min_pd(a, b));
        op!(d_max(a: __m256d, b: __m256d) -> __m256d = _mm256_max_pd(a, b));
        op!(d_abs(a: __m256d) -> __m256d = _mm256_andnot_pd(_mm256_set1_pd(-0.0), a));
        op!(d_floor(a: __m256d) -> __m256d = _mm256_floor_pd(a));
        op!(d_with_sign(a: __m256d, b: __m256d) -> __m256d = {
            let sign = _mm256_set1_pd(-0.0);
            _mm256_or_pd(_mm256_andnot_pd(sign, a), _mm256_and_pd(sign, b))
        });
        op!(d_sqrt(a: __m256d) -> __m256d = _mm256_sqrt_pd(a));
        #[inline(always)]
        fn prefetch<T>(self, soon: &T) {
            for line in 0..(size_of::<T>()).div_ceil(LINE) {
                let at = core::ptr::from_ref(soon).cast::<i8>().wrapping_add(line * LINE);
                // SAFETY: a hint reads nothing, wherever it points.
                unsafe { _mm_prefetch::<_MM_HINT_T0>(at) };
            }
        }
        op!(d_signs(a: __m256d) -> u32 = _mm256_movemask_pd(a) as u32);
    };
}

/// Masks of lanes as AVX2 wants them.
const MASKS: [[i64; 4]; 16] = {
    let mut masks = [[0; 4]; 16];
    let mut i = 0;
    while i < 64 {
        masks[i / 4][i % 4] = -(((i / 4) >> (i % 4) & 1) as i64);
        i += 1;
    }
    masks
};

impl super::sealed::Sealed for Avx2 {}
impl super::sealed::Sealed for Avx512 {}

impl Lanes for Avx2 {
    type M = [__m256i; 2];
    common!();

    op!(m_none() -> [__m256i; 2] = [_mm256_setzero_si256(); 2]);
    op!(m_set(a: [__m256i; 2], which: u32, bits: u64) -> [__m256i; 2] = {
        let (which, bits) = (_mm256_set1_epi64x(i64::from(which)), _mm256_set1_epi64x(bits as i64));
        let (low, high) = (_mm256_setr_epi64x(1, 2, 4, 8), _mm256_setr_epi64x(16, 32, 64, 128));
        let low = _mm256_cmpeq_epi64(_mm256_and_si256(which, low), low);
        let high = _mm256_cmpeq_epi64(_mm256_and_si256(which, high), high);
        [_mm256_or_si256(a[0], _mm256_and_si256(low, bits)), _mm256_or_si256(a[1], _mm256_and_si256(high, bits))]
    });
    op!(m_store(a: [__m256i; 2], to: &mut [u64; 8]) -> () = {
        _mm256_storeu_si256(to.as_mut_ptr().cast(), a[0]);
        _mm256_storeu_si256(to[4..].as_mut_ptr().cast(), a[1]);
    });

    op!(f_select(which: u32, a: __m256, b: __m256) -> __m256 = {
        let bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
        let of_lane = _mm256_and_si256(_mm256_set1_epi32(which as i32), bits);
        _mm256_blendv_ps(b, a, _mm256_castsi256_ps(_mm256_cmpeq_epi32(of_lane, bits)))
    });
    op!(d_select(which: u32, a: __m256d, b: __m256d) -> __m256d =
        _mm256_blendv_pd(b, a, _mm256_loadu_pd(MASKS[which as usize & 15].as_ptr().cast())));
    op!(d_store_some(a: __m256d, which: u32, to: &mut [f64; 4]) -> () = {
        let mask = _mm256_loadu_si256(MASKS[which as usize & 15].as_ptr().cast());
        _mm256_maskstore_pd(to.as_mut_ptr(), mask, a);
    });

    op!(f_least_of_le(a: __m256, b: __m256, c: __m256) -> (__m256, u32) = {
        let le = _mm256_cmp_ps::<_CMP_LE_OQ>(a, b);
        (_mm256_blendv_ps(c, _mm256_min_ps(a, c), le), _mm256_movemask_ps(le) as u32)
    });
    op!(d_if_lt(a: __m256d, b: __m256d, x: __m256d, y: __m256d) -> __m256d =
        _mm256_blendv_pd(y, x, _mm256_cmp_pd::<_CMP_LT_OQ>(a, b)));

    op!(f_le(a: __m256, b: __m256) -> u32 = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32);
    op!(d_lt(a: __m256d, b: __m256d) -> u32 = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(a, b)) as u32);
    op!(d_le(a: __m256d, b: __m256d) -> u32 = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(a, b)) as u32);
}

impl Lanes for Avx512 {
    type M = __m512i;
    common!();

    op!(m_none() -> __m512i = _mm512_setzero_si512());
    op!(m_set(a: __m512i, which: u32, bits: u64) -> __m512i =
        _mm512_mask_or_epi64(a, which as u8, a, _mm512_set1_epi64(bits as i64)));
    op!(m_store(a: __m512i, to: &mut [u64; 8]) -> () = _mm512_storeu_si512(to.as_mut_ptr().cast(), a));

    op!(f_select(which: u32, a: __m256, b: __m256) -> __m256 = _mm256_mask_blend_ps(which as u8, b, a));
    op!(d_select(which: u32, a: __m256d, b: __m256d) -> __m256d = _mm256_mask_blend_pd(which as u8, b, a));
    op!(d_store_some(a: __m256d, which: u32, to: &mut [f64; 4]) -> () =
        _mm256_mask_storeu_pd(to.as_mut_ptr(), which as u8, a));

    op!(f_least_of_le(a: __m256, b: __m256, c: __m256) -> (__m256, u32) = {
        let le = _mm256_cmp_ps_mask::<_CMP_LE_OQ>(a, b);
        (_mm256_mask_min_ps(c, le, a, c), u32::from(le))
    });
    op!(d_if_lt(a: __m256d, b: __m256d, x: __m256d, y: __m256d) -> __m256d =
        _mm256_mask_blend_pd(_mm256_cmp_pd_mask::<_CMP_LT_OQ>(a, b), y, x));

    op!(f_le(a: __m256, b: __m256) -> u32 = u32::from(_mm256_cmp_ps_mask::<_CMP_LE_OQ>(a, b)));
    op!(d_lt(a: __m256d, b: __m256d) -> u32 = u32::from(_mm256_cmp_pd_mask::<_CMP_LT_OQ>(a, b)));
    op!(d_le(a: __m256d, b: __m256d) -> u32 = u32::from(_mm256_cmp_pd_mask::<_CMP_LE_OQ>(a, b)));
}
