//! What an image shows beyond its edges.

use crate::{choice, math};

choice! {
    /// What an image shows beyond its edges.
    pub enum Wrap {
        /// Itself again.
        #[default]
        Repeat,
        /// Itself mirrored, again and again, so that edges meet themselves.
        Mirror,
        /// The texel at the edge.
        Clamp,
        /// Nothing: the surface keeps its colour.
        Once,
    }
}

impl Wrap {
    /// A coordinate that shows the same and is near the image, so that nothing is lost in counting texels.
    pub(super) fn fold(self, coordinate: f64) -> f64 {
        match self {
            Self::Repeat => coordinate - math::floor(coordinate),
            Self::Mirror => coordinate - 2.0 * math::floor(0.5 * coordinate),
            // Beyond this distance all is the same.
            Self::Clamp | Self::Once => coordinate.clamp(-2.0, 3.0),
        }
    }

    /// The texel out of `count` that a texel counted beyond the edges shows; none where nothing is shown.
    pub(super) fn texel(self, index: i64, count: u32) -> Option<u32> {
        let count = i64::from(count);
        let index = match self {
            Self::Repeat => index.rem_euclid(count),
            Self::Mirror => {
                let index = index.rem_euclid(2 * count);
                if index < count { index } else { 2 * count - 1 - index }
            }
            Self::Clamp => index.clamp(0, count - 1),
            Self::Once if (0..count).contains(&index) => index,
            Self::Once => return None,
        };
        Some(index as u32)
    }

    /// The texel that holds a coordinate; of what is not finite, the first.
    pub(super) fn nearest(self, coordinate: f64, count: u32) -> Option<u32> {
        if !coordinate.is_finite() {
            return self.texel(0, count);
        }
        if self == Self::Once && !(0.0..=1.0).contains(&coordinate) {
            return None;
        }
        let folded = self.fold(coordinate);
        let index = math::floor(folded * f64::from(count)) as i64;
        // For a coordinate just below a whole number the fraction rounds up to it; 1 itself is the end of an image that
        // does not repeat.
        let last = match self {
            Self::Mirror if folded > 1.0 => 2 * i64::from(count) - 1,
            _ => i64::from(count) - 1,
        };
        self.texel(index.min(last), count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Wrap; 4] = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp, Wrap::Once];

    #[test]
    fn each_goes_on_beyond_the_edges_in_its_way() {
        let shown = |wrap: Wrap| -> Vec<Option<u32>> { (-4..7).map(|i| wrap.texel(i, 3)).collect() };
        let all = |indices: [u32; 11]| indices.map(Some).to_vec();
        assert_eq!(shown(Wrap::Repeat), all([2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0]));
        assert_eq!(shown(Wrap::Mirror), all([2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0]));
        assert_eq!(shown(Wrap::Clamp), all([0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2]));
        let nothing = [None; 4].into_iter();
        let once = nothing.clone().chain([Some(0), Some(1), Some(2)]).chain(nothing);
        assert_eq!(shown(Wrap::Once), once.collect::<Vec<_>>());
    }

    #[test]
    fn coordinates_and_counted_texels_agree() {
        for wrap in ALL {
            for i in -40..40 {
                let coordinate = (f64::from(i) + 0.5) / 10.0;
                assert_eq!(wrap.nearest(coordinate, 10), wrap.texel(i64::from(i), 10), "{wrap:?} at {coordinate}");
            }
        }
    }

    #[test]
    fn odd_numbers_find_a_texel_of_the_image() {
        let last = 1.0 - f64::EPSILON / 2.0;
        let texels = |wrap: Wrap| [-1e-300, -0.0, 0.0, last, 1.0, -1e-9].map(|u| wrap.nearest(u, 7));
        assert_eq!(texels(Wrap::Repeat), [6, 0, 0, 6, 0, 6].map(Some));
        assert_eq!(texels(Wrap::Mirror), [0, 0, 0, 6, 6, 0].map(Some));
        assert_eq!(texels(Wrap::Clamp), [0, 0, 0, 6, 6, 0].map(Some));
        assert_eq!(texels(Wrap::Once), [None, Some(0), Some(0), Some(6), Some(6), None]);
        for u in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(ALL.iter().all(|wrap| wrap.nearest(u, 7) == Some(0)));
        }
    }

    #[test]
    fn a_million_random_bit_patterns_find_a_texel_or_nothing() {
        let mut state = 1u64;
        for _ in 0..1_000_000 {
            // splitmix64.
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            let coordinate = f64::from_bits(z ^ (z >> 31));
            let count = 1 + (z >> 40) as u32 % 5000;
            for wrap in ALL {
                let texel = wrap.nearest(coordinate, count);
                assert!(texel.is_none_or(|texel| texel < count), "{wrap:?}, {coordinate} of {count}: {texel:?}");
                assert!(texel.is_some() || wrap == Wrap::Once);
            }
        }
    }
}
