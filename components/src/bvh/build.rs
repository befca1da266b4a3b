//! Building by the surface-area heuristic over bins (Wald: On fast Construction of SAH-based Bounding Volume
//! Hierarchies, 2007), eight children at once.
//!
//! The result depends on the boxes and their order alone: bins are merged by minimum, maximum and count, runs are
//! partitioned in pieces of fixed size, subtrees are joined in order; the number of threads only decides who does the
//! work.

use super::bins::{BINS, Bins, Box4, Item, Scale, cheapest};
use super::{Box32, Bvh, Child, MAX_LEAF, MAX_LEN, Node, WIDTH};
use crate::pages;
use rayon::prelude::*;
use smallvec::SmallVec;

/// From this many things on, subtrees are built in parallel.
const PARALLEL: usize = 4096;

/// From this many things on, each step of a split is done in parallel, too, in pieces of [`PARALLEL`].
const LARGE: usize = 4 * PARALLEL;

/// Below this depth every split halves the count, so the depth stays near `log2 n` whatever the input.
const MAX_SAH_DEPTH: usize = 40;

impl Bvh {
    /// Builds a tree with at most `leaf` (1 to [`MAX_LEAF`]) things in a leaf.
    ///
    /// # Panics
    /// With more than [`MAX_LEN`] boxes.
    #[must_use]
    pub fn build(boxes: impl ExactSizeIterator<Item = Box32>, leaf: usize) -> Self {
        Self::over(boxes.enumerate().map(|(i, bounds)| Item::new(&bounds, i)).collect(), leaf, 1)
    }

    /// The same of `len` boxes, which are made in parallel if they are many, for leaves whose things are tested together.
    ///
    /// # Panics
    /// With more than [`MAX_LEN`] boxes.
    #[must_use]
    pub fn build_with(len: usize, bounds: impl Fn(usize) -> Box32 + Sync, leaf: usize) -> Self {
        let item = |i| Item::new(&bounds(i), i);
        let mut items = pages::with_room(len);
        (0..len).into_par_iter().with_min_len(PARALLEL).map(item).collect_into_vec(&mut items);
        Self::over(items, leaf, leaf)
    }

    fn over(mut items: Vec<Item>, leaf: usize, block: usize) -> Self {
        assert!(items.len() <= MAX_LEN, "a tree holds at most {MAX_LEN} things");
        let most = leaf.clamp(1, MAX_LEAF);
        let leaf = Leaves { most, block: block.clamp(1, most) as u32 };
        let mut nodes = vec![];
        if !items.is_empty() {
            let whole = Span { first: 0, len: items.len(), bounds: bounds_of(&items) };
            let tree = subtree(&mut items, whole, leaf, 0);
            nodes = pages::with_room(tree.count());
            tree.flatten(&mut nodes);
        }
        Self { nodes, order: items.iter().map(Item::index).collect() }
    }
}

/// What leaves are to hold.
#[derive(Clone, Copy)]
struct Leaves {
    /// Most things in one.
    most: usize,
    /// How many things are tested together, at the cost of one.
    block: u32,
}

/// A run of items, and the box around them.
#[derive(Clone, Copy)]
struct Span {
    first: usize,
    len: usize,
    bounds: Box4,
}

/// A part of the tree: nodes, root first, and the parts that hang below its root.
struct Part {
    nodes: Vec<Node>,
    below: Vec<(usize, Self)>,
}

impl Part {
    fn count(&self) -> usize {
        self.nodes.len() + self.below.iter().map(|(_, part)| part.count()).sum::<usize>()
    }

    /// Appends all nodes in depth-first order.
    fn flatten(self, nodes: &mut Vec<Node>) {
        let shift = nodes.len();
        nodes.extend(self.nodes.into_iter().map(|mut node| {
            node.child = node.child.map(|child| child.shifted(shift));
            node
        }));
        for (lane, part) in self.below {
            nodes[shift].child[lane] = Child::node(nodes.len());
            part.flatten(nodes);
        }
    }
}

/// The tree over a run, which is sorted on the way.
fn subtree(items: &mut [Item], whole: Span, leaf: Leaves, depth: usize) -> Part {
    if whole.len < PARALLEL {
        let mut nodes = Vec::with_capacity(whole.len / leaf.most);
        grow(&mut nodes, items, whole, leaf, depth, &mut Bins::new());
        return Part { nodes, below: vec![] };
    }
    let spans = children(items, whole, leaf, depth, &mut Bins::new());
    let mut work = vec![];
    let mut rest = items;
    for (lane, span) in spans.iter().enumerate() {
        let (mine, others) = rest.split_at_mut(span.len);
        rest = others;
        if span.len > leaf.most {
            work.push((lane, mine, *span));
        }
    }
    let below = work.into_par_iter().map(|(lane, items, span)| (lane, subtree(items, span, leaf, depth + 1))).collect();
    Part { nodes: vec![node(&spans, leaf)], below }
}

/// Appends the tree over a run; returns the number of its root.
fn grow(nodes: &mut Vec<Node>, items: &mut [Item], whole: Span, leaf: Leaves, depth: usize, bins: &mut Bins) -> usize {
    let spans = children(items, whole, leaf, depth, bins);
    let root = nodes.len();
    nodes.push(node(&spans, leaf));
    for (lane, span) in spans.iter().enumerate() {
        if span.len > leaf.most {
            let first = span.first - whole.first;
            let child = grow(nodes, &mut items[first..first + span.len], *span, leaf, depth + 1, bins);
            nodes[root].child[lane] = Child::node(child);
        }
    }
    root
}

/// A node whose leaves are in place, but not its other children.
fn node(spans: &[Span], leaf: Leaves) -> Node {
    let mut node = Node::EMPTY;
    for (lane, span) in spans.iter().enumerate() {
        for axis in 0..3 {
            node.planes[axis][lane] = span.bounds.min[axis];
            node.planes[3 + axis][lane] = span.bounds.max[axis];
        }
        if span.len <= leaf.most {
            node.child[lane] = Child::leaf(span.first, span.len);
        }
    }
    node
}

/// Partitions a run into two to eight, in order: the run that costs most is split until there are eight.
fn children(items: &mut [Item], whole: Span, leaf: Leaves, depth: usize, bins: &mut Bins) -> SmallVec<[Span; WIDTH]> {
    let mut spans: SmallVec<[Span; WIDTH]> = SmallVec::new();
    spans.push(whole);
    while spans.len() < WIDTH {
        let cost = |span: &Span| span.bounds.half_area() * span.len as f64;
        let mut most: Option<(usize, f64)> = None;
        for (i, span) in spans.iter().enumerate().filter(|(_, span)| span.len > leaf.most) {
            // On equal cost the first.
            if most.is_none_or(|(_, most)| cost(span) > most) {
                most = Some((i, cost(span)));
            }
        }
        let Some((i, _)) = most else { break };
        let span = spans[i];
        let run = &mut items[span.first - whole.first..][..span.len];
        let [a, b] = if depth < MAX_SAH_DEPTH { split(run, bins, leaf) } else { halve(run) };
        spans[i] = Span { first: span.first, len: a.0, bounds: a.1 };
        spans.insert(i + 1, Span { first: span.first + a.0, len: b.0, bounds: b.1 });
    }
    spans
}

/// The sides of a split: how many things, and the box around them.
type Sides = [(usize, Box4); 2];

/// Folds over items: in pieces and in parallel if there are many.
fn fold<T: Copy + Send + Sync>(
    items: &[Item],
    none: T,
    add: impl Fn(T, &Item) -> T + Sync,
    merge: impl Fn(T, T) -> T + Send + Sync,
) -> T {
    if items.len() < LARGE {
        return items.iter().fold(none, add);
    }
    items.par_chunks(PARALLEL).map(|piece| piece.iter().fold(none, &add)).reduce(|| none, merge)
}

fn bounds_of(items: &[Item]) -> Box4 {
    fold(items, Box4::EMPTY, |b, item| b.union(&item.0), |a, b| a.union(&b))
}

/// The box around the centres.
fn reach_of(items: &[Item]) -> Box4 {
    let add = |b: Box4, item: &Item| {
        let center = item.center();
        b.union(&Box4 { min: center, max: center })
    };
    fold(items, Box4::EMPTY, add, |a, b| a.union(&b))
}

/// Partitions by the cheapest plane between bins; neither side is empty.
fn split(items: &mut [Item], bins: &mut Bins, leaf: Leaves) -> Sides {
    let count = (4 + items.len() / 8).min(BINS);
    let scale = Scale::over(&reach_of(items), count);
    if items.len() < LARGE {
        bins.clear(count);
        bins.fill(items, &scale);
    } else {
        let fill = |piece: &[Item]| {
            let mut bins = Bins::new();
            bins.fill(piece, &scale);
            bins
        };
        *bins = items.par_chunks(PARALLEL).map(fill).reduce(Bins::new, |a, b| a.merged(&b));
    }
    let Some((axis, plane)) = cheapest(bins, count, leaf.block) else { return halve(items) };
    let along = scale.along(axis);
    partition(items, |item| along.bins_of([item.center()[axis]; 4])[0] <= plane);
    [bins.sum(axis, 0..plane + 1), bins.sum(axis, plane + 1..count)]
}

/// Moves the items that belong left to the front; returns how many they are.
fn partition(items: &mut [Item], left: impl Fn(&Item) -> bool + Sync) -> usize {
    if items.len() < LARGE {
        return partition_piece(items, &left);
    }
    let counts: Vec<usize> = items.par_chunks_mut(PARALLEL).map(|piece| partition_piece(piece, &left)).collect();
    let middle = counts.iter().sum();
    // What stands on the wrong side, as runs; as many items on one side as on the other.
    let pieces = || counts.iter().enumerate().map(|(i, count)| (i * PARALLEL, i * PARALLEL + count));
    let end = items.len();
    let (front, back) = items.split_at_mut(middle);
    let mut belong_right = pieces().map(|(start, split)| (split, (start + PARALLEL).min(end).min(middle)));
    let mut belong_left = pieces().map(|(start, split)| (start.max(middle), split));
    let (mut here, mut there) = ((0, 0), (0, 0));
    loop {
        while here.0 >= here.1 {
            let Some(next) = belong_right.next() else { return middle };
            here = next;
        }
        while there.0 >= there.1 {
            let Some(next) = belong_left.next() else { return middle };
            there = next;
        }
        let len = (here.1 - here.0).min(there.1 - there.0);
        let there_in_back = there.0 - middle;
        front[here.0..][..len].swap_with_slice(&mut back[there_in_back..][..len]);
        here.0 += len;
        there.0 += len;
    }
}

fn partition_piece(items: &mut [Item], left: &impl Fn(&Item) -> bool) -> usize {
    let mut end = 0;
    for i in 0..items.len() {
        // Swapped always: which side an item belongs to cannot be foreseen, so a branch on it would cost more.
        let is_left = left(&items[i]);
        items.swap(i, end);
        end += usize::from(is_left);
    }
    end
}

/// Splits by count about the median of the widest axis; equal centres go by index, so coincident things are separated too.
fn halve(items: &mut [Item]) -> Sides {
    let bounds = bounds_of(items);
    let extent = |axis: usize| f64::from(bounds.max[axis]) - f64::from(bounds.min[axis]);
    let axis = (1..3).fold(0, |widest, axis| if extent(axis) > extent(widest) { axis } else { widest });
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| {
        let by_center = a.center()[axis].total_cmp(&b.center()[axis]);
        by_center.then(a.index().cmp(&b.index()))
    });
    let (left, right) = items.split_at(middle);
    [left, right].map(|side| (side.len(), bounds_of(side)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random(seed: &mut u64) -> f32 {
        *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*seed >> 40) as f32 / (1u32 << 24) as f32
    }

    /// Small boxes along a spiral: dense in some places, far apart in others.
    fn boxes(count: usize) -> Vec<Box32> {
        let mut seed = count as u64;
        let one = |_| {
            let reach = random(&mut seed) * random(&mut seed);
            let min = [0; 3].map(|_| reach * random(&mut seed));
            Box32 { min, max: min.map(|x| x + 0.01 * reach) }
        };
        (0..count).map(one).collect()
    }

    fn build(boxes: &[Box32], leaf: usize, threads: usize) -> Bvh {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| Bvh::build(boxes.iter().copied(), leaf))
    }

    fn build_with(boxes: &[Box32], leaf: usize, threads: usize) -> Bvh {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| Bvh::build_with(boxes.len(), |i| boxes[i], leaf))
    }

    #[test]
    fn the_tree_is_the_same_for_any_number_of_threads() {
        for count in [PARALLEL - 1, 3 * PARALLEL, 3 * LARGE + 5] {
            let boxes = boxes(count);
            let alone = build_with(&boxes, 4, 1);
            for threads in [2, 5] {
                let together = build_with(&boxes, 4, threads);
                assert_eq!(alone.order, together.order);
                assert_eq!(format!("{:?}", alone.nodes), format!("{:?}", together.nodes));
            }
        }
    }

    #[test]
    fn every_thing_is_in_one_leaf_and_every_box_is_the_smallest_around_what_it_holds() {
        for (count, leaf) in [(1, 1), (2, 1), (100, 3), (LARGE + 1, 4)] {
            let boxes = boxes(count);
            let tree = build(&boxes, leaf, 2);
            let mut order = tree.order.clone();
            order.sort_unstable();
            assert!(order.into_iter().eq(0..count as u32));
            let mut reached = 0;
            let whole = check(&tree, &boxes, 0, leaf, &mut reached);
            assert_eq!(whole, boxes.iter().fold(Box32::EMPTY, |sum, b| sum.union(b)));
            assert_eq!(reached, count);
        }
    }

    /// The box around all below a node, after checking each of its lanes.
    fn check(tree: &Bvh, boxes: &[Box32], node: usize, leaf: usize, reached: &mut usize) -> Box32 {
        let node = &tree.nodes[node];
        let mut whole = Box32::EMPTY;
        for lane in (0..WIDTH).filter(|&lane| node.holds(lane)) {
            let child = node.child[lane];
            let below = if child.is_leaf() {
                assert!(child.run().len() <= leaf);
                assert_eq!(child.run().start, *reached, "leaves follow one another");
                *reached += child.run().len();
                tree.order[child.run()].iter().fold(Box32::EMPTY, |sum, &i| sum.union(&boxes[i as usize]))
            } else {
                check(tree, boxes, child.0 as usize, leaf, reached)
            };
            let [a, b, c, d, e, f] = node.planes.map(|of| of[lane]);
            let stored = Box32 { min: [a, b, c], max: [d, e, f] };
            assert_eq!(stored, below);
            whole = whole.union(&below);
        }
        whole
    }

    #[test]
    fn a_partition_loses_nothing_and_leaves_nothing_on_the_wrong_side() {
        let mut seed = 7;
        for count in [0, 1, 2, LARGE - 1, LARGE, LARGE + PARALLEL + 1, 2 * LARGE + 17] {
            for share in [0.0, 0.01, 0.5, 0.99, 1.0] {
                let belongs: Vec<bool> = (0..count).map(|_| random(&mut seed) < share).collect();
                let empty = Box32 { min: [0.0; 3], max: [0.0; 3] };
                let mut items: Vec<Item> = (0..count).map(|i| Item::new(&empty, i)).collect();
                let left = |item: &Item| belongs[item.index() as usize];
                let middle = partition(&mut items, left);
                assert_eq!(middle, belongs.iter().filter(|b| **b).count());
                assert!(items[..middle].iter().all(left) && !items[middle..].iter().any(left));
                let mut indices: Vec<u32> = items.iter().map(Item::index).collect();
                indices.sort_unstable();
                assert!(indices.into_iter().eq(0..count as u32));
            }
        }
    }

    #[test]
    fn boxes_without_end_are_kept_like_others() {
        let endless = Box32 { min: [f32::NEG_INFINITY; 3], max: [f32::INFINITY; 3] };
        let half = Box32 { min: [f32::MIN; 3], max: [f32::INFINITY, 0.0, 1.0] };
        let mut all = boxes(50);
        all.extend([endless; 9]);
        all.extend([half; 9]);
        let tree = build(&all, 2, 1);
        let mut order = tree.order.clone();
        order.sort_unstable();
        assert!(order.into_iter().eq(0..68));
    }
}
