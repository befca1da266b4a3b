//! What the builder computes with: boxes in whole registers, bins, and the cheapest plane between them.

use super::Box32;

/// Most bins along an axis.
pub(super) const BINS: usize = 16;

/// From this many items on two sets of bins are worth their merging.
const MANY: usize = 512;

/// Three coordinates and a lane to spare: a whole register.
type Four = [f32; 4];

#[inline]
fn lower(a: Four, b: Four) -> Four {
    core::array::from_fn(|i| if b[i] < a[i] { b[i] } else { a[i] })
}

#[inline]
fn upper(a: Four, b: Four) -> Four {
    core::array::from_fn(|i| if b[i] > a[i] { b[i] } else { a[i] })
}

/// A box; what the last lanes hold means nothing.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
pub(super) struct Box4 {
    pub(super) min: Four,
    pub(super) max: Four,
}

impl Box4 {
    pub(super) const EMPTY: Self = Self { min: [f32::INFINITY; 4], max: [f32::NEG_INFINITY; 4] };

    #[inline]
    pub(super) fn union(self, other: &Self) -> Self {
        Self { min: lower(self.min, other.min), max: upper(self.max, other.max) }
    }

    /// Half the surface area; `f64`, which no `f32` box overflows.
    #[inline]
    pub(super) fn half_area(&self) -> f64 {
        let along = |i: usize| f64::from(self.max[i]) - f64::from(self.min[i]);
        let (x, y, z) = (along(0), along(1), along(2));
        if x < 0.0 { 0.0 } else { x * y + y * z + z * x }
    }
}

/// One thing to be sorted into the tree: its box, with its index in the last lane of `min`.
#[derive(Clone, Copy)]
pub(super) struct Item(pub(super) Box4);

/// Added to indices so that as `f32` they are neither subnormal, which would be slow, nor not-a-number.
const NORMAL: u32 = 1 << 29;

impl Item {
    pub(super) fn new(bounds: &Box32, index: usize) -> Self {
        let ([a, b, c], [d, e, f]) = (bounds.min, bounds.max);
        let index = f32::from_bits(NORMAL + index as u32);
        Self(Box4 { min: [a, b, c, index], max: [d, e, f, index] })
    }

    pub(super) fn index(&self) -> u32 {
        self.0.min[3].to_bits() - NORMAL
    }

    #[inline]
    pub(super) fn center(&self) -> Four {
        // Halved first: the sum of two extremes would overflow.
        core::array::from_fn(|i| self.0.min[i] * 0.5 + self.0.max[i] * 0.5)
    }
}

/// What fell into each bin along each axis.
pub(super) struct Bins {
    boxes: [[Box4; BINS]; 3],
    counts: [[u32; BINS]; 3],
}

impl Bins {
    pub(super) fn new() -> Self {
        Self { boxes: [[Box4::EMPTY; BINS]; 3], counts: [[0; BINS]; 3] }
    }

    /// Empties the first bins of each axis; the others are not looked at.
    pub(super) fn clear(&mut self, count: usize) {
        for axis in 0..3 {
            self.boxes[axis][..count].fill(Box4::EMPTY);
            self.counts[axis][..count].fill(0);
        }
    }

    pub(super) fn fill(&mut self, items: &[Item], scale: &Scale) {
        if items.len() < MANY {
            return items.iter().for_each(|item| self.add(item, scale));
        }
        // Neighbours often fall into one bin, and each would wait for the one before: two sets by turns.
        let mut other = Self::new();
        let (pairs, rest) = items.as_chunks();
        for [a, b] in pairs {
            self.add(a, scale);
            other.add(b, scale);
        }
        rest.iter().for_each(|item| self.add(item, scale));
        self.merge(&other);
    }

    #[inline(always)]
    fn add(&mut self, item: &Item, scale: &Scale) {
        let [x, y, z, _] = scale.bins_of(item.center());
        for (axis, bin) in [x, y, z].into_iter().enumerate() {
            self.boxes[axis][bin] = self.boxes[axis][bin].union(&item.0);
            self.counts[axis][bin] += 1;
        }
    }

    pub(super) fn merged(mut self, other: &Self) -> Self {
        self.merge(other);
        self
    }

    fn merge(&mut self, other: &Self) {
        for axis in 0..3 {
            for bin in 0..BINS {
                self.boxes[axis][bin] = self.boxes[axis][bin].union(&other.boxes[axis][bin]);
                self.counts[axis][bin] += other.counts[axis][bin];
            }
        }
    }

    /// All bins of a range as one.
    pub(super) fn sum(&self, axis: usize, range: core::ops::Range<usize>) -> (usize, Box4) {
        let count: u32 = self.counts[axis][range.clone()].iter().sum();
        (count as usize, self.boxes[axis][range].iter().fold(Box4::EMPTY, Box4::union))
    }
}

/// Maps centres to bins.
#[derive(Clone, Copy)]
pub(super) struct Scale {
    /// Number of the last bin.
    last: f32,
    low: Four,
    per_unit: Four,
}

impl Scale {
    /// So many bins over a box around centres.
    pub(super) fn over(reach: &Box4, bins: usize) -> Self {
        let per_unit = core::array::from_fn(|i| {
            let per_unit = bins as f32 / (reach.max[i] - reach.min[i]);
            if per_unit.is_finite() { per_unit } else { 0.0 }
        });
        Self { last: (bins - 1) as f32, low: reach.min, per_unit }
    }

    /// The same for one axis, in every lane.
    pub(super) fn along(&self, axis: usize) -> Self {
        Self { last: self.last, low: [self.low[axis]; 4], per_unit: [self.per_unit[axis]; 4] }
    }

    /// The bin of a centre along each axis.
    #[inline]
    pub(super) fn bins_of(&self, center: Four) -> [usize; 4] {
        // Lane by lane in steps, so that the compiler takes four at a time.
        let at: Four = core::array::from_fn(|i| (center[i] - self.low[i]) * self.per_unit[i] - 0.5);
        let at = lower([self.last; 4], upper([0.0; 4], at));
        // To the nearest whole number, by the addition's own rounding: cheaper than a cast, which saturates.
        let at: Four = core::array::from_fn(|i| at[i] + WHOLE);
        at.map(|at| at.to_bits() as usize % BINS)
    }
}

/// From here on `f32` have no fraction.
const WHOLE: f32 = (1u32 << 23) as f32;

/// The axis and the last bin on the left of the split with the least expected cost; none if all centres share a bin.
///
/// Things are tested in blocks of `block` together, so a block that is not full costs as much as a full one.
pub(super) fn cheapest(bins: &Bins, count: usize, block: u32) -> Option<(usize, usize)> {
    let blocks = |things: u32| f64::from(things.div_ceil(block));
    let mut best: Option<(f64, usize, usize)> = None;
    for axis in 0..3 {
        let (boxes, counts) = (&bins.boxes[axis], &bins.counts[axis]);
        let mut right_costs = [f64::NAN; BINS];
        let (mut bounds, mut sum) = (Box4::EMPTY, 0);
        for plane in (1..count).rev() {
            (bounds, sum) = (bounds.union(&boxes[plane]), sum + counts[plane]);
            // An empty side stays not-a-number, which is less than nothing.
            if sum > 0 {
                right_costs[plane - 1] = bounds.half_area() * blocks(sum);
            }
        }
        let (mut bounds, mut sum) = (Box4::EMPTY, 0);
        for plane in 0..count - 1 {
            (bounds, sum) = (bounds.union(&boxes[plane]), sum + counts[plane]);
            let cost = bounds.half_area() * blocks(sum) + right_costs[plane];
            if sum > 0 && best.map_or(!cost.is_nan(), |(least, ..)| cost < least) {
                best = Some((cost, axis, plane));
            }
        }
    }
    best.map(|(_, axis, plane)| (axis, plane))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Unit boxes at some places along y.
    fn row(places: &[f32]) -> Vec<Item> {
        let at = |(i, &y): (usize, &f32)| Item::new(&Box32 { min: [0.0, y, 0.0], max: [1.0, y + 1.0, 1.0] }, i);
        places.iter().enumerate().map(at).collect()
    }

    fn filled(items: &[Item], bins: usize) -> Bins {
        let reach = Box4 { min: [0.5, 0.5, 0.5, 0.0], max: [0.5, 100.5, 0.5, 0.0] };
        let mut filled = Bins::new();
        filled.fill(items, &Scale::over(&reach, bins));
        filled
    }

    #[test]
    fn the_cheapest_plane_lies_in_the_gap() {
        let items = row(&[0.0, 1.0, 2.0, 3.0, 30.0, 99.0, 100.0]);
        // Areas times counts, by hand: after four 9 · 4 + 143 · 3 = 465; after five 63 · 5 + 5 · 2 = 325; elsewhere more.
        let bins = filled(&items, 8);
        let (axis, plane) = cheapest(&bins, 8, 1).expect("a plane");
        assert_eq!((axis, bins.sum(axis, 0..plane + 1).0, bins.sum(axis, plane + 1..8).0), (1, 5, 2));
        assert_eq!(cheapest(&filled(&items[..1], 8), 8, 1), None, "one thing cannot be split");
        // In blocks of four: after four 9 · 1 + 143 · 1 = 152, after five 63 · 2 + 5 · 1 = 131, after six 201 · 2 + 1.
        let (_, plane) = cheapest(&bins, 8, 4).expect("a plane");
        assert_eq!(bins.sum(1, 0..plane + 1).0, 5);
        // In blocks of three: after three 7 · 1 + 145 · 2 = 297, after five 63 · 2 + 5 = 131; in blocks of five 63 + 5.
        let five = cheapest(&bins, 8, 5).expect("a plane").1;
        assert_eq!(bins.sum(1, 0..five + 1).0, 5);
    }

    #[test]
    fn many_items_fill_bins_as_one_by_one() {
        let places: Vec<f32> = (0..MANY + 3).map(|i| (i * 37 % 101) as f32).collect();
        let items = row(&places);
        let many = filled(&items, BINS);
        let each = items.chunks(1).map(|item| filled(item, BINS)).reduce(|a, b| a.merged(&b)).expect("items");
        assert_eq!(many.counts, each.counts);
        let edges = |bins: &Bins| bins.boxes.map(|of| of.map(|b| [&b.min[..3], &b.max[..3]].concat()));
        assert_eq!(edges(&many), edges(&each));
    }

    #[test]
    fn bins_of_parts_together_are_the_bins_of_all() {
        let items = row(&[5.0, 80.0, 33.0, 100.0, 0.0, 51.0]);
        let (a, b) = items.split_at(2);
        let (all, merged) = (filled(&items, BINS), filled(a, BINS).merged(&filled(b, BINS)));
        assert_eq!((all.counts, all.counts[1].iter().sum::<u32>()), (merged.counts, 6));
        let edges = |bins: &Bins| bins.boxes.map(|of| of.map(|b| [b.min, b.max]));
        assert_eq!(edges(&all), edges(&merged));
    }

    #[test]
    fn both_ends_of_the_reach_and_what_is_no_number_fall_into_bins() {
        let reach = Box4 { min: [0.0; 4], max: [1.0, f32::INFINITY, 0.0, 0.0] };
        let scale = Scale::over(&reach, 10);
        assert_eq!(scale.bins_of([0.0, 5.0, 0.0, 0.0]), [0; 4]);
        assert_eq!(scale.bins_of([1.0, f32::NAN, f32::INFINITY, 0.0])[..2], [9, 0]);
    }
}
