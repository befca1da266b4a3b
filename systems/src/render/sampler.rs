//! Numbers for lights with an area: low-discrepancy, and a pure function of where they are used.

use glam::DVec2;

/// Where samples are used: pixel, ray through it, branch of its tree, light. Equal keys give equal samples, on every
/// machine and in every order of work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key(u64);

impl Key {
    /// The key of a ray through a pixel.
    #[must_use]
    pub fn of_pixel(x: u32, y: u32, ray: u32) -> Self {
        Self(u64::from(x) | u64::from(y) << 24 | u64::from(ray) << 48).child(0)
    }

    /// The key of a part: the n-th branch of a ray, the n-th light at a point.
    #[must_use]
    pub fn child(self, n: u32) -> Self {
        // splitmix64 (Steele, Lea, Flood: Fast Splittable Pseudorandom Number Generators, 2014).
        let mut z = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15).wrapping_add(u64::from(n) << 32 | u64::from(n));
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        Self(z ^ (z >> 31))
    }

    /// The n-th of a sequence of points in 0..1 × 0..1: Sobol's first two dimensions, scrambled by Owen's method with
    /// hashed permutations (Burley: Practical Hash-based Owen Scrambling, JCGT 9(4), 2020).
    ///
    /// Any aligned block of 2ᵏ points is spread as evenly as 2ᵏ points can be.
    #[must_use]
    pub fn sample(self, n: u32) -> DVec2 {
        let x = scramble(n.reverse_bits(), self.0 as u32);
        let y = scramble(second_sobol_dimension(n), (self.0 >> 32) as u32);
        let unit = |bits: u32| f64::from(bits) / (1u64 << 32) as f64;
        DVec2::new(unit(x), unit(y))
    }
}

/// Sobol's second dimension, whose direction numbers are the rows of Pascal's triangle modulo two.
fn second_sobol_dimension(mut n: u32) -> u32 {
    let mut direction = 1u32 << 31;
    let mut result = 0;
    while n != 0 {
        if n & 1 != 0 {
            result ^= direction;
        }
        direction ^= direction >> 1;
        n >>= 1;
    }
    result
}

/// Owen scrambling: flips every bit by a hash of the bits above it.
fn scramble(bits: u32, seed: u32) -> u32 {
    // On reversed bits, carries and products only move upward, from the digits above to those below.
    let mut x = bits.reverse_bits();
    x = x.wrapping_add(seed);
    x ^= x.wrapping_mul(0x6c50_b47c);
    x ^= x.wrapping_mul(0xb82f_1e52);
    x ^= x.wrapping_mul(0xc7af_e638);
    x ^= x.wrapping_mul(0x8d22_f6e6);
    x.reverse_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_block_of_sixteen_is_stratified() {
        for (pixel, block) in [(0, 0), (5, 1), (900, 7)] {
            let key = Key::of_pixel(pixel, 3, 0);
            for (columns, rows) in [(16.0, 1.0), (8.0, 2.0), (4.0, 4.0), (2.0, 8.0), (1.0, 16.0)] {
                let mut seen = std::collections::BTreeSet::new();
                for n in 0..16 {
                    let p = key.sample(block * 16 + n);
                    seen.insert(((p.x * columns) as u32, (p.y * rows) as u32));
                }
                assert_eq!(seen.len(), 16, "{columns} by {rows}");
            }
        }
    }

    #[test]
    fn neighbouring_pixels_are_not_alike() {
        let n = 10_000u32;
        let (mut sum, mut squares) = (0.0, 0.0);
        for x in 0..n {
            let [a, b] = [x, x + 1].map(|x| Key::of_pixel(x, 7, 0).child(2).sample(0).x - 0.5);
            sum += a * b;
            squares += a * a;
        }
        assert!((sum / squares).abs() < 0.05, "correlation {}", sum / squares);
    }
}
