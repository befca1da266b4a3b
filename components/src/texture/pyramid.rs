//! Smaller copies of an image, for textures seen from far away (Williams: Pyramidal Parametrics, 1983).

use glam::DVec3;

/// A smaller copy of an image; each texel is the mean of the part of the image that it covers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Level {
    width: u32,
    height: u32,
    texels: Vec<[f32; 3]>,
}

impl Level {
    /// The copy of half a size, rounded down to at least one; none of a single texel.
    ///
    /// Where a size is odd, texels of the copy cover parts of those of the image, so that every level has the mean of
    /// the whole.
    pub(super) fn half_of((width, height): (u32, u32), texel: impl Fn(u32, u32) -> [f32; 3]) -> Option<Self> {
        if (width, height) == (1, 1) {
            return None;
        }
        let half = |size: u32| (size / 2).max(1);
        let columns: Vec<_> = (0..half(width)).map(|column| parts(column, width, half(width))).collect();
        let mut texels = Vec::with_capacity(half(width) as usize * half(height) as usize);
        for row in 0..half(height) {
            let rows = parts(row, height, half(height));
            for columns in &columns {
                let mut sum = DVec3::ZERO;
                for &(y, tall) in &rows {
                    for &(x, wide) in columns {
                        sum += DVec3::from_array(texel(x, y).map(f64::from)) * (tall * wide);
                    }
                }
                texels.push(sum.as_vec3().to_array());
            }
        }
        Some(Self { width: half(width), height: half(height), texels })
    }

    pub(super) fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    #[inline]
    pub(super) fn texel(&self, column: u32, row: u32) -> [f32; 3] {
        self.texels[row as usize * self.width as usize + column as usize]
    }
}

/// Which of `from` texels in a line a texel out of `to` covers, and which part of it each makes up.
fn parts(texel: u32, from: u32, to: u32) -> Vec<(u32, f64)> {
    // In units in which a large texel is `from` wide and a small one `to`.
    let (texel, from, to) = (u64::from(texel), u64::from(from), u64::from(to));
    let (start, end) = (texel * from, (texel + 1) * from);
    let covered = start / to..end.div_ceil(to);
    covered.map(|i| (i as u32, (end.min((i + 1) * to) - start.max(i * to)) as f64 / from as f64)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_make_up_the_whole() {
        assert_eq!(parts(1, 6, 3), [(2, 0.5), (3, 0.5)]);
        assert_eq!(parts(0, 3, 1), [(0, 1.0 / 3.0), (1, 1.0 / 3.0), (2, 1.0 / 3.0)]);
        assert_eq!(parts(1, 5, 2), [(2, 0.2), (3, 0.4), (4, 0.4)]);
        assert_eq!(parts(0, 1, 1), [(0, 1.0)]);
        for from in 2..200 {
            for texel in 0..from / 2 {
                let sum: f64 = parts(texel, from, from / 2).iter().map(|(_, part)| part).sum();
                assert!((sum - 1.0).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn every_level_has_the_mean_of_the_whole() {
        let number = |x: u32, y: u32| ((x * 7 + y * 13) % 11) as f32 / 11.0;
        for (width, height) in [(64, 16), (7, 5), (1, 9), (13, 1), (100, 37)] {
            let sum: f64 = (0..width * height).map(|i| f64::from(number(i % width, i / width))).sum();
            let mean = sum / f64::from(width * height);
            let mut level = Level::half_of((width, height), |x, y| [number(x, y); 3]).expect("a level");
            let mut count = 1;
            loop {
                let sum: f64 = level.texels.iter().map(|texel| f64::from(texel[0])).sum();
                assert!((sum / level.texels.len() as f64 - mean).abs() < 1e-6, "{width}x{height}, level {count}");
                let Some(next) = Level::half_of(level.size(), |x, y| level.texel(x, y)) else { break };
                level = next;
                count += 1;
            }
            assert_eq!((level.size(), count), ((1, 1), width.max(height).ilog2()));
        }
    }
}
