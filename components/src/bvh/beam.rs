//! Box tests of many rays that run alike.

use super::{Node, box_ray::BoxRays};
use crate::{
    lanes::Lanes,
    packet::{Mask, PACKET},
};

/// Many rays as one: what it does not enter, none of them does.
///
/// Rays must run to the same side along every axis. Then a near distance `(plane − origin) · inverse` is least for the
/// origin that lies farthest ahead and either the least or the greatest inverse, and rounding keeps that order; so far
/// distances the other way round.
pub(super) struct Beam<L: Lanes> {
    /// By axis: the origin that decides, and the two inverses.
    near: [[L::F; 3]; 3],
    far: [[L::F; 3]; 3],
    /// Whether they run backward.
    negative: [usize; 3],
}

impl<L: Lanes> Beam<L> {
    /// Of some rays; none if they run to several sides, or along a plane.
    #[inline(always)]
    pub(super) fn around(l: L, all: &BoxRays, rays: Mask) -> Option<Self> {
        let mut negative = [0; 3];
        for (axis, of) in all.negative.iter().enumerate() {
            negative[axis] = usize::from(of & rays != 0);
            if of & rays != 0 && of & rays != rays {
                return None;
            }
        }
        let none = [[l.f_splat(0.0); 3]; 3];
        let mut this = Self { near: none, far: none, negative };
        for (axis, [near, shrunk, far, grown]) in all.planes.iter().enumerate() {
            let backward = negative[axis] == 1;
            let ([near_least, near_most], [far_least, far_most]) = (range(l, near, rays), range(l, far, rays));
            let ([a, b], [c, d]) = (range(l, shrunk, rays), range(l, grown, rays));
            if c.is_infinite() || d.is_infinite() {
                return None;
            }
            let (ahead, behind) = if backward { (near_least, far_most) } else { (near_most, far_least) };
            this.near[axis] = [l.f_splat(ahead), l.f_splat(a), l.f_splat(b)];
            this.far[axis] = [l.f_splat(behind), l.f_splat(c), l.f_splat(d)];
        }
        Some(this)
    }

    /// Distances before which none of the rays enters the children of a node, and which children some may enter.
    #[inline(always)]
    pub(super) fn enter(&self, l: L, node: &Node) -> (L::F, u32) {
        let mut near = l.f_splat(0.0);
        let mut far = l.f_splat(f32::INFINITY);
        for axis in 0..3 {
            let side = 3 * self.negative[axis];
            let [origin, a, b] = self.near[axis];
            let way = l.f_sub(l.f_load(&node.planes[axis + side]), origin);
            near = l.f_max(l.f_min(l.f_mul(way, a), l.f_mul(way, b)), near);
            let [origin, a, b] = self.far[axis];
            let way = l.f_sub(l.f_load(&node.planes[axis + 3 - side]), origin);
            far = l.f_min(l.f_max(l.f_mul(way, a), l.f_mul(way, b)), far);
        }
        (near, l.f_le(near, far))
    }

    /// Which of the rays enter one child of a node within their limits.
    #[inline(always)]
    pub(super) fn entering(
        &self,
        l: L,
        all: &BoxRays,
        node: &Node,
        lane: usize,
        limits: &[f32; PACKET],
        rays: Mask,
    ) -> Mask {
        let mut planes = [[l.f_splat(0.0); 2]; 3];
        for (axis, planes) in planes.iter_mut().enumerate() {
            let side = 3 * self.negative[axis];
            *planes = [l.f_splat(node.planes[axis + side][lane]), l.f_splat(node.planes[axis + 3 - side][lane])];
        }
        let mut come = 0;
        for (group, limits) in limits.as_chunks().0.iter().enumerate() {
            if rays >> (8 * group) & 0xff == 0 {
                continue;
            }
            // As for one ray and eight boxes: see `BoxRay::distances`.
            let mut near = l.f_splat(0.0);
            let mut far = l.f_load(limits);
            for (axis, [near_plane, far_plane]) in planes.iter().enumerate() {
                let of = |which: usize| l.f_load(&all.planes[axis][which].as_chunks().0[group]);
                near = l.f_max(l.f_mul(l.f_sub(*near_plane, of(0)), of(1)), near);
                far = l.f_min(l.f_mul(l.f_sub(*far_plane, of(2)), of(3)), far);
            }
            come |= Mask::from(l.f_le(near, far)) << (8 * group);
        }
        come & rays
    }
}

/// The least and the greatest of the numbers of some rays.
#[inline(always)]
fn range<L: Lanes>(l: L, numbers: &[f32; PACKET], rays: Mask) -> [f32; 2] {
    let (mut least, mut most) = (l.f_splat(f32::INFINITY), l.f_splat(f32::NEG_INFINITY));
    for (group, numbers) in numbers.as_chunks().0.iter().enumerate() {
        let which = (rays >> (8 * group)) as u32 & 0xff;
        let numbers = l.f_load(numbers);
        least = l.f_min(l.f_select(which, numbers, least), least);
        most = l.f_max(l.f_select(which, numbers, most), most);
    }
    let mut each = [[0.0; 8]; 2];
    l.f_store(least, &mut each[0]);
    l.f_store(most, &mut each[1]);
    let [least, most] = each;
    [
        least.into_iter().fold(f32::INFINITY, |a, b| if b < a { b } else { a }),
        most.into_iter().fold(f32::NEG_INFINITY, |a, b| if b > a { b } else { a }),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        bvh::{WIDTH, box_ray::BoxRay},
        lanes::{self, Job, Level, vector},
        packet::{self, Vectors},
        random::SplitMix64,
    };

    /// For each ray of a mask and each child of a node: whether the ray alone enters it, whether it does by a beam, and
    /// whether the beam does, before the ray.
    struct Compare<'a>(&'a Vectors, &'a Vectors, &'a Node, Mask);

    impl Job for Compare<'_> {
        type Output = Option<Vec<[bool; 3]>>;

        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> Self::Output {
            let Self(origins, directions, node, rays) = self;
            let mut all = BoxRays::new();
            for group in 0..PACKET / 4 {
                all.set(l, group, vector::load(l, origins, group), vector::load(l, directions, group));
            }
            let beam = Beam::around(l, &all, rays)?;
            let limits = [9.0; PACKET];
            let (near, entered) = beam.enter(l, node);
            let mut least = [0.0; WIDTH];
            l.f_store(near, &mut least);
            let mut seen = vec![];
            for lane in 0..WIDTH {
                let by_beam = beam.entering(l, &all, node, lane, &limits, rays);
                for i in packet::each(rays) {
                    let (near, alone) = BoxRay::one_of(l, &all, i).enter(l, node, limits[i]);
                    let mut distances = [0.0; WIDTH];
                    l.f_store(near, &mut distances);
                    let before = entered >> lane & 1 == 1 && least[lane] <= distances[lane];
                    seen.push([alone >> lane & 1 == 1, by_beam >> i & 1 == 1, before]);
                }
            }
            Some(seen)
        }
    }

    #[test]
    fn a_beam_enters_what_any_of_its_rays_enters_and_not_later() {
        let mut random = SplitMix64::new(5);
        let mut counts = [0; 3];
        for round in 0..400 {
            let mut number = |size: f64| size * (2.0 * random.unit() - 1.0);
            let (spread, about) = ([0.0, 0.01, 1.0][round % 3], [number(2.0), number(2.0), number(2.0)]);
            let sides = [number(1.0), number(1.0), number(1.0)];
            let (mut origins, mut directions) = ([[0.0; PACKET]; 3], [[0.0; PACKET]; 3]);
            let mut node = Node::EMPTY;
            for axis in 0..3 {
                for i in 0..PACKET {
                    origins[axis][i] = about[axis] + number(spread);
                    directions[axis][i] = (sides[axis].abs() + 1e-3 + number(spread).abs()).copysign(sides[axis]);
                }
                for lane in 0..WIDTH {
                    let (a, b) = (number(3.0) as f32, number(3.0) as f32);
                    (node.planes[axis][lane], node.planes[axis + 3][lane]) = (a.min(b), a.max(b));
                }
            }
            let rays = random.bits() | random.bits();
            // Others may run anywhere.
            for i in packet::each(!rays) {
                directions[round % 3][i] = f64::NAN;
            }
            let at = |level: Level| {
                level.choose();
                lanes::run(Compare(&origins, &directions, &node, rays)).expect("a beam")
            };
            let seen = at(Level::Baseline);
            for [alone, by_beam, before] in &seen {
                assert_eq!(alone, by_beam);
                assert!(*before || !alone, "round {round}");
                counts[0] += u32::from(*alone);
                counts[1] += u32::from(!before);
            }
            for level in Level::ALL.into_iter().filter(|level| level.is_available()) {
                assert_eq!(at(level), seen, "{level:?}");
            }
            directions[1][rays.trailing_zeros() as usize] *= -1.0;
            assert!(lanes::run(Compare(&origins, &directions, &node, rays)).is_none(), "to two sides");
            directions[1][rays.trailing_zeros() as usize] = 0.0;
            assert!(lanes::run(Compare(&origins, &directions, &node, rays)).is_none(), "along a plane");
        }
        assert!(counts[0] > 10_000 && counts[1] > 10_000, "{counts:?}");
    }
}
