//! Building by the surface-area heuristic over bins (Wald: On fast Construction of SAH-based Bounding Volume
//! Hierarchies, 2007), eight children at once.
//!
//! The result depends on the boxes and their order alone: bins are merged by minimum, maximum and count, subtrees are
//! joined in order, and the number of threads only decides who does the work.

use super::{Box32, Bvh, Child, MAX_LEAF, MAX_LEN, Node, WIDTH};
use rayon::prelude::*;

const BINS: usize = 16;

/// From this many things on, subtrees are built in parallel.
const PARALLEL: usize = 4096;

/// Below this depth every split halves the count, so the depth stays near `log2 n` whatever the input.
const MAX_SAH_DEPTH: usize = 40;

/// One thing to be sorted into the tree.
#[derive(Clone, Copy)]
struct Item {
    bounds: Box32,
    index: u32,
}

/// A run of items, and what is known of it.
#[derive(Clone, Copy)]
struct Span {
    first: usize,
    len: usize,
    bounds: Box32,
}

impl Bvh {
    /// Builds a tree with at most `leaf` (1 to [`MAX_LEAF`]) things in a leaf.
    ///
    /// # Panics
    /// With more than [`MAX_LEN`] boxes.
    #[must_use]
    pub fn build(boxes: impl ExactSizeIterator<Item = Box32>, leaf: usize) -> Self {
        assert!(boxes.len() <= MAX_LEN, "a tree holds at most {MAX_LEN} things");
        let leaf = leaf.clamp(1, MAX_LEAF);
        let mut items: Vec<Item> = boxes.enumerate().map(|(i, bounds)| Item { bounds, index: i as u32 }).collect();
        let nodes = if items.is_empty() { vec![] } else { subtree(&mut items, 0, leaf, 0) };
        Self { nodes, order: items.iter().map(|item| item.index).collect() }
    }
}

/// Nodes of the tree over `items`, root first; `offset` is the position of `items` in the whole.
fn subtree(items: &mut [Item], offset: usize, leaf: usize, depth: usize) -> Vec<Node> {
    let spans = children(items, leaf, depth);
    let mut node = Node::EMPTY;
    for (lane, span) in spans.iter().enumerate() {
        for axis in 0..3 {
            node.min[axis][lane] = span.bounds.min[axis];
            node.max[axis][lane] = span.bounds.max[axis];
        }
    }

    // Split the items among the children that are not leaves and build each.
    let mut work = vec![];
    let (mut rest, mut at) = (items, 0);
    for (lane, span) in spans.iter().enumerate() {
        let (mine, others) = rest.split_at_mut(span.len);
        if span.len <= leaf {
            node.child[lane] = Child::leaf(offset + at, span.len);
        } else {
            work.push((lane, mine, offset + at));
        }
        (rest, at) = (others, at + span.len);
    }
    let build = |(lane, items, offset): (usize, &mut [Item], usize)| (lane, subtree(items, offset, leaf, depth + 1));
    let total: usize = spans.iter().map(|span| span.len).sum();
    let built: Vec<(usize, Vec<Node>)> = if total >= PARALLEL {
        work.into_par_iter().map(build).collect()
    } else {
        work.into_iter().map(build).collect()
    };

    let mut nodes = vec![node];
    for (lane, subnodes) in built {
        let shift = nodes.len();
        nodes[0].child[lane] = Child::node(shift);
        nodes.extend(subnodes.into_iter().map(|mut node| {
            node.child = node.child.map(|child| child.shifted(shift));
            node
        }));
    }
    nodes
}

/// Partitions `items` into two to eight runs, in order: the run that costs most is split until there are eight.
fn children(items: &mut [Item], leaf: usize, depth: usize) -> Vec<Span> {
    let mut spans = vec![Span { first: 0, len: items.len(), bounds: bounds_of(items) }];
    while spans.len() < WIDTH {
        let cost = |span: &Span| span.bounds.half_area() * span.len as f64;
        let widest = spans
            .iter()
            .enumerate()
            .filter(|(_, span)| span.len > leaf)
            // On equal cost the first: `max_by` would take the last.
            .fold(None, |best: Option<(usize, f64)>, (i, span)| match best {
                Some((_, most)) if cost(span) <= most => best,
                _ => Some((i, cost(span))),
            });
        let Some((i, _)) = widest else { break };
        let Span { first, len, .. } = spans[i];
        let run = &mut items[first..first + len];
        let left = if depth < MAX_SAH_DEPTH { split(run) } else { halve(run) };
        let (a, b) = run.split_at(left);
        spans[i] = Span { first, len: left, bounds: bounds_of(a) };
        spans.insert(i + 1, Span { first: first + left, len: len - left, bounds: bounds_of(b) });
    }
    spans
}

fn bounds_of(items: &[Item]) -> Box32 {
    let fold = |items: &[Item]| items.iter().fold(Box32::EMPTY, |b, item| b.union(&item.bounds));
    if items.len() < PARALLEL {
        fold(items)
    } else {
        items.par_chunks(PARALLEL).map(fold).reduce(|| Box32::EMPTY, |a, b| a.union(&b))
    }
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Box32,
    count: usize,
}

type Bins = [[Bin; BINS]; 3];

const EMPTY_BINS: Bins = [[Bin { bounds: Box32::EMPTY, count: 0 }; BINS]; 3];

/// Maps centres along an axis to bins.
#[derive(Clone, Copy)]
struct Scale {
    low: f32,
    per_unit: f32,
}

impl Scale {
    #[inline]
    fn bin(&self, center: f32) -> usize {
        // Saturates: not-a-number gives 0, overflow the last bin.
        (((center - self.low) * self.per_unit) as usize).min(BINS - 1)
    }
}

/// Partitions by the cheapest plane between bins; returns how many go left, never none or all.
fn split(items: &mut [Item]) -> usize {
    let centers = |items: &[Item]| {
        items.iter().fold(Box32::EMPTY, |b, item| {
            let c = core::array::from_fn(|axis| item.bounds.center2(axis));
            b.union(&Box32 { min: c, max: c })
        })
    };
    let parallel = items.len() >= 4 * PARALLEL;
    let reach = if parallel {
        items.par_chunks(PARALLEL).map(centers).reduce(|| Box32::EMPTY, |a, b| a.union(&b))
    } else {
        centers(items)
    };
    let scales: [Scale; 3] = core::array::from_fn(|axis| {
        let extent = reach.max[axis] - reach.min[axis];
        let per_unit = BINS as f32 / extent;
        Scale { low: reach.min[axis], per_unit: if per_unit.is_finite() { per_unit } else { 0.0 } }
    });

    let fill = |items: &[Item]| {
        let mut bins = EMPTY_BINS;
        for item in items {
            for axis in 0..3 {
                let bin = &mut bins[axis][scales[axis].bin(item.bounds.center2(axis))];
                bin.bounds = bin.bounds.union(&item.bounds);
                bin.count += 1;
            }
        }
        bins
    };
    let bins = if parallel { items.par_chunks(PARALLEL).map(fill).reduce(|| EMPTY_BINS, merge) } else { fill(items) };

    match cheapest(&bins) {
        Some((axis, plane)) => {
            let scale = scales[axis];
            partition(items, |item| scale.bin(item.bounds.center2(axis)) <= plane)
        }
        None => halve(items),
    }
}

fn merge(mut a: Bins, b: Bins) -> Bins {
    for (a, b) in a.iter_mut().flatten().zip(b.iter().flatten()) {
        a.bounds = a.bounds.union(&b.bounds);
        a.count += b.count;
    }
    a
}

/// The axis and the last bin on the left of the split with the least expected cost; none if all centres share a bin.
fn cheapest(bins: &Bins) -> Option<(usize, usize)> {
    let mut best: Option<(f64, usize, usize)> = None;
    for (axis, bins) in bins.iter().enumerate() {
        let mut right_costs = [0.0; BINS];
        let mut right = Bin { bounds: Box32::EMPTY, count: 0 };
        for plane in (1..BINS).rev() {
            right = Bin { bounds: right.bounds.union(&bins[plane].bounds), count: right.count + bins[plane].count };
            right_costs[plane - 1] =
                if right.count == 0 { f64::NAN } else { right.bounds.half_area() * right.count as f64 };
        }
        let mut left = Bin { bounds: Box32::EMPTY, count: 0 };
        for plane in 0..BINS - 1 {
            left = Bin { bounds: left.bounds.union(&bins[plane].bounds), count: left.count + bins[plane].count };
            let cost = left.bounds.half_area() * left.count as f64 + right_costs[plane];
            // An empty side has cost NaN on the right; on the left it is skipped here.
            if left.count > 0 && best.map_or(!cost.is_nan(), |(least, ..)| cost < least) {
                best = Some((cost, axis, plane));
            }
        }
    }
    best.map(|(_, axis, plane)| (axis, plane))
}

/// Moves the items that belong left to the front.
fn partition(items: &mut [Item], left: impl Fn(&Item) -> bool) -> usize {
    let mut end = 0;
    for i in 0..items.len() {
        if left(&items[i]) {
            items.swap(i, end);
            end += 1;
        }
    }
    end
}

/// Splits by count about the median of the widest axis; equal centres go by index, so coincident things are separated too.
fn halve(items: &mut [Item]) -> usize {
    let bounds = bounds_of(items);
    let extent = |axis: usize| f64::from(bounds.max[axis]) - f64::from(bounds.min[axis]);
    let axis = (1..3).fold(0, |widest, axis| if extent(axis) > extent(widest) { axis } else { widest });
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| {
        let by_center = a.bounds.center2(axis).total_cmp(&b.bounds.center2(axis));
        by_center.then(a.index.cmp(&b.index))
    });
    middle
}
