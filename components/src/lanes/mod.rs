//! Arithmetic on several numbers at once, at the level the machine has, with the same bits at every level.
//!
//! Inner loops are written once, as a `Job` generic over `Lanes`, and compiled for each [`Level`]. All levels do the
//! same operations in the same order and round each of them, so they differ in speed alone: there is no fused
//! multiply-add and no approximate reciprocal here.

mod portable;
mod stack;
pub mod vector;
#[cfg(target_arch = "x86_64")]
mod x86;

use core::sync::atomic::{AtomicU8, Ordering};
use portable::Portable;
pub(crate) use stack::{Room, Stack};

/// How much of the machine inner loops use; decides speed, never a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Level {
    /// What every machine of the architecture has.
    Baseline = 1,
    /// x86-64 with AVX2.
    Avx2 = 2,
    /// x86-64 with AVX-512 on 256 bits.
    Avx512 = 3,
}

/// The level in use; zero until it is asked for.
static LEVEL: AtomicU8 = AtomicU8::new(0);

impl Level {
    /// All levels, lowest first.
    pub const ALL: [Self; 3] = [Self::Baseline, Self::Avx2, Self::Avx512];

    /// The level in use: the highest the machine has, unless another was chosen.
    #[must_use]
    #[inline]
    pub fn current() -> Self {
        // Every level gives the same results, so it does not matter when another thread sees a choice.
        match LEVEL.load(Ordering::Relaxed) {
            1 => Self::Baseline,
            2 => Self::Avx2,
            3 => Self::Avx512,
            _ => Self::detect(),
        }
    }

    #[cold]
    fn detect() -> Self {
        let level = Self::ALL.into_iter().rfind(|level| level.is_available()).unwrap_or(Self::Baseline);
        level.choose();
        level
    }

    /// Whether this machine has it.
    #[must_use]
    pub fn is_available(self) -> bool {
        match self {
            Self::Baseline => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => x86::Avx2::is_available(),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => x86::Avx512::is_available(),
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx2 | Self::Avx512 => false,
        }
    }

    /// Makes all work from now on use this level, or the baseline where the machine does not have it: for tests that
    /// compare levels.
    pub fn choose(self) {
        let level = if self.is_available() { self } else { Self::Baseline };
        LEVEL.store(level as u8, Ordering::Relaxed);
    }
}

/// Work to be done at the current level.
pub trait Job {
    /// What comes of it.
    type Output;

    /// Does the work. To be compiled for the level, it must be `#[inline(always)]`, as must all that it calls with
    /// `lanes`.
    fn run<L: Lanes>(self, lanes: L) -> Self::Output;
}

/// Does a job at the current level.
#[inline(always)]
pub fn run<J: Job>(job: J) -> J::Output {
    run_at(Level::current(), job)
}

/// Does a job at a level, which must be available.
#[inline(always)]
fn run_at<J: Job>(level: Level, job: J) -> J::Output {
    match level {
        #[cfg(target_arch = "x86_64")]
        Level::Avx2 => x86::run_avx2(job),
        #[cfg(target_arch = "x86_64")]
        Level::Avx512 => x86::run_avx512(job),
        _ => run_portable(job),
    }
}

/// Never inlined: callers must not set up the room that a walk at another level takes.
#[inline(never)]
fn run_portable<J: Job>(job: J) -> J::Output {
    job.run(Portable)
}

/// Lanes are those of the levels, and of no other crate: an operation may be added.
mod sealed {
    pub trait Sealed {}
}

/// Eight `f32` or four `f64` at once.
///
/// Minimum and maximum give the second argument on equality and for NaN: `if a < b { a } else { b }`. Comparisons give a
/// bit per lane, the lowest for the first.
#[expect(missing_docs, reason = "the operations are those of their names, on every lane")]
pub trait Lanes: Copy + sealed::Sealed {
    /// Eight `f32`.
    type F: Copy;
    /// Four `f64`.
    type D: Copy;
    /// Eight `u64`.
    type M: Copy;

    fn f_load(self, from: &[f32; 8]) -> Self::F;
    fn f_store(self, a: Self::F, to: &mut [f32; 8]);
    fn f_splat(self, x: f32) -> Self::F;
    fn f_sub(self, a: Self::F, b: Self::F) -> Self::F;
    fn f_mul(self, a: Self::F, b: Self::F) -> Self::F;
    fn f_min(self, a: Self::F, b: Self::F) -> Self::F;
    fn f_max(self, a: Self::F, b: Self::F) -> Self::F;
    fn f_le(self, a: Self::F, b: Self::F) -> u32;
    /// Where `a <= b`, the minimum of `a` and `c`; elsewhere `c`. Also tells where that is.
    fn f_least_of_le(self, a: Self::F, b: Self::F, c: Self::F) -> (Self::F, u32);
    /// The lanes of a mask of `a`, the others of `b`.
    fn f_select(self, which: u32, a: Self::F, b: Self::F) -> Self::F;
    /// A hint that something will be read soon.
    fn prefetch<T>(self, soon: &T);
    /// Eight zeros.
    fn m_none(self) -> Self::M;
    /// Sets bits in the lanes of a mask.
    fn m_set(self, a: Self::M, which: u32, bits: u64) -> Self::M;
    fn m_store(self, a: Self::M, to: &mut [u64; 8]);

    fn d_load(self, from: &[f64; 4]) -> Self::D;
    fn d_store(self, a: Self::D, to: &mut [f64; 4]);
    /// Stores the lanes of a mask, and leaves the others as they are.
    fn d_store_some(self, a: Self::D, which: u32, to: &mut [f64; 4]);
    /// Exact.
    fn d_widen(self, from: &[f32; 4]) -> Self::D;
    /// To nearest; beyond the range of `f32`, infinite.
    fn d_narrow(self, a: Self::D) -> [f32; 4];
    fn d_splat(self, x: f64) -> Self::D;
    fn d_add(self, a: Self::D, b: Self::D) -> Self::D;
    fn d_sub(self, a: Self::D, b: Self::D) -> Self::D;
    fn d_mul(self, a: Self::D, b: Self::D) -> Self::D;
    fn d_div(self, a: Self::D, b: Self::D) -> Self::D;
    /// Correctly rounded.
    fn d_sqrt(self, a: Self::D) -> Self::D;
    fn d_min(self, a: Self::D, b: Self::D) -> Self::D;
    fn d_max(self, a: Self::D, b: Self::D) -> Self::D;
    fn d_abs(self, a: Self::D) -> Self::D;
    /// The largest integers not above.
    fn d_floor(self, a: Self::D) -> Self::D;
    /// The magnitudes of `a` with the signs of `b`.
    fn d_with_sign(self, a: Self::D, b: Self::D) -> Self::D;
    /// The sign bits.
    fn d_signs(self, a: Self::D) -> u32;
    fn d_lt(self, a: Self::D, b: Self::D) -> u32;
    fn d_le(self, a: Self::D, b: Self::D) -> u32;
    /// Where `a < b`, of `x`; elsewhere, and for NaN, of `y`.
    fn d_if_lt(self, a: Self::D, b: Self::D, x: Self::D, y: Self::D) -> Self::D;
    /// The lanes of a mask of `a`, the others of `b`.
    fn d_select(self, which: u32, a: Self::D, b: Self::D) -> Self::D;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation on some numbers, as bits.
    struct All([[f64; 4]; 2], [[f32; 8]; 2]);

    impl Job for All {
        type Output = Vec<u64>;

        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> Vec<u64> {
            let mut bits = vec![];
            let [a, b] = [l.d_load(&self.0[0]), l.d_load(&self.0[1])];
            let few: &[f32; 4] = self.1[0].first_chunk().expect("eight");
            for d in [
                l.d_add(a, b),
                l.d_sub(a, b),
                l.d_mul(a, b),
                l.d_div(a, b),
                l.d_sqrt(a),
                l.d_min(a, b),
                l.d_max(a, b),
                l.d_abs(a),
                l.d_floor(a),
                l.d_with_sign(a, b),
                l.d_widen(few),
                l.d_splat(self.0[0][3]),
                l.d_if_lt(a, b, b, a),
                l.d_if_lt(l.d_splat(0.0), a, a, b),
                l.d_select(self.0[0][1].to_bits() as u32 & 15, a, b),
            ] {
                let mut to = [0.0; 4];
                l.d_store(d, &mut to);
                bits.extend(to.map(canonical));
            }
            let mut some = self.0[1];
            l.d_store_some(a, self.0[0][2].to_bits() as u32 >> 3 & 15, &mut some);
            bits.extend(some.map(canonical));
            bits.extend(l.d_narrow(a).map(|x| canonical(f64::from(x))));
            let [a32, b32] = [l.f_load(&self.1[0]), l.f_load(&self.1[1])];
            let (least, le) = l.f_least_of_le(a32, b32, l.f_splat(1.0));
            for f in [
                l.f_sub(a32, b32),
                l.f_mul(a32, b32),
                l.f_min(a32, b32),
                l.f_max(a32, b32),
                l.f_select(self.0[0][1].to_bits() as u32 & 255, a32, b32),
                l.f_splat(self.1[1][7]),
                least,
            ] {
                let mut to = [0.0; 8];
                l.f_store(f, &mut to);
                bits.extend(to.map(|x| canonical(f64::from(x))));
            }
            bits.extend([l.d_lt(a, b), l.d_le(a, b), l.d_signs(a), l.f_le(a32, b32), le].map(u64::from));
            let mut masks = [0; 8];
            let set = l.m_set(l.m_none(), self.0[0][0].to_bits() as u32 & 255, self.0[1][1].to_bits());
            l.m_store(l.m_set(set, le, 5), &mut masks);
            bits.extend(masks);
            bits
        }
    }

    /// Not-a-number has many forms, of which none is promised.
    fn canonical(x: f64) -> u64 {
        if x.is_nan() { u64::MAX } else { x.to_bits() }
    }

    #[test]
    fn every_level_gives_the_same_bits() {
        let odd =
            [0.0, -0.0, 1.0, -1.5, 1e-310, 1e-40, 3e38, -1e39, 1e308, f64::INFINITY, f64::NEG_INFINITY, 1.0 / 3.0];
        let pick = |i: usize| if i % 13 == 12 { f64::INFINITY - f64::INFINITY } else { odd[i % 13] };
        for i in 0..169 * 3 {
            let d = [[0, 1, 2, 3].map(|lane| pick(i + 5 * lane)), [0, 1, 2, 3].map(|lane| pick(i / 13 + 3 * lane))];
            let f = d.map(|d| core::array::from_fn(|lane| d[lane % 4] as f32));
            let expected = run_at(Level::Baseline, All(d, f));
            for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
                assert_eq!(run_at(level, All(d, f)), expected, "{level:?} on {d:?}");
            }
        }
    }

    #[test]
    fn minimum_and_maximum_give_the_second_on_equality_and_for_nan() {
        let all = |a: f64, b: f64| run_at(Level::current(), All([[a; 4], [b; 4]], [[0.0; 8]; 2]));
        let (min, max) = (5 * 4, 6 * 4);
        assert_eq!(all(0.0, -0.0)[min], (-0.0f64).to_bits());
        assert_eq!(all(-0.0, 0.0)[max], 0.0f64.to_bits());
        assert_eq!((all(f64::NAN, 1.0)[min], all(f64::NAN, 1.0)[max]), (1.0f64.to_bits(), 1.0f64.to_bits()));
        assert_eq!((all(1.0, f64::NAN)[min], all(1.0, f64::NAN)[max]), (u64::MAX, u64::MAX));
    }
}
