//! Rays that are traced together: what they meet on the way is read once for all of them, and they keep the machine busy
//! where one alone would wait.
//!
//! A packet changes how fast a hit is found, never the hit: every shape gives each ray of a packet what it gives the ray
//! alone, to the last bit.

use crate::{
    lanes::{self, Job, Lanes, vector},
    primitive::Hit,
    space::Ray,
};
use glam::DVec3;

/// Most rays in a packet.
pub const PACKET: usize = 64;

/// Some rays of a packet: bit `i` stands for the ray `i`.
pub type Mask = u64;

/// A number for each ray of a packet.
pub type PerRay = [f64; PACKET];

/// A vector for each ray of a packet, by axis.
pub type Vectors = [PerRay; 3];

/// One of some vectors.
#[must_use]
#[inline]
pub fn vector_of([x, y, z]: &Vectors, i: usize) -> DVec3 {
    DVec3::new(x[i], y[i], z[i])
}

/// Sets one of some vectors.
#[inline]
pub fn set_vector([x, y, z]: &mut Vectors, i: usize, to: DVec3) {
    (x[i], y[i], z[i]) = (to.x, to.y, to.z);
}

/// The rays of a mask, lowest first.
#[inline]
pub fn each(mut mask: Mask) -> impl Iterator<Item = usize> {
    core::iter::from_fn(move || {
        let ray = mask.trailing_zeros() as usize;
        mask &= mask.wrapping_sub(1);
        (ray < PACKET).then_some(ray)
    })
}

/// Up to [`PACKET`] rays, their coordinates as a structure of arrays.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct Packet {
    /// World space. Whoever writes here says so by [`Packet::check`].
    pub origins: Vectors,
    /// World space, of any length but zero. Whoever writes here says so by [`Packet::check`].
    pub directions: Vectors,
    len: usize,
    valid: Mask,
}

impl Default for Packet {
    fn default() -> Self {
        Self { origins: [[0.0; PACKET]; 3], directions: [[0.0; PACKET]; 3], len: 0, valid: 0 }
    }
}

impl Packet {
    /// Takes all rays out.
    pub fn clear(&mut self) {
        (self.len, self.valid) = (0, 0);
    }

    /// Adds a ray, and tells its number.
    ///
    /// # Panics
    /// If there are [`PACKET`] already.
    #[inline]
    pub fn push(&mut self, ray: &Ray) -> usize {
        let i = self.len;
        self.set(i, ray);
        self.len += 1;
        i
    }

    /// Sets a ray where it stands; that does not count as [adding](Self::push) one.
    ///
    /// # Panics
    /// If its number is [`PACKET`] or more.
    #[inline]
    pub fn set(&mut self, i: usize, ray: &Ray) {
        set_vector(&mut self.origins, i, ray.origin);
        set_vector(&mut self.directions, i, ray.direction);
        self.valid = self.valid & !(1 << i) | Mask::from(ray.is_valid()) << i;
    }

    /// Tells which of some rays, whose origins and directions were set, are valid.
    #[inline]
    pub fn check(&mut self, rays: Mask) {
        self.valid = self.valid & !rays | lanes::run(Valid(self, rays));
    }

    /// Count of rays.
    #[must_use]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is no ray.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// All its rays.
    #[must_use]
    pub fn all(&self) -> Mask {
        Mask::MAX.checked_shr((PACKET - self.len) as u32).unwrap_or(0)
    }

    /// The rays that are [valid](Ray::is_valid): the others meet nothing.
    #[must_use]
    pub fn valid(&self) -> Mask {
        self.valid
    }

    /// A ray.
    ///
    /// # Panics
    /// If its number is [`PACKET`] or more.
    #[must_use]
    #[inline]
    pub fn ray(&self, i: usize) -> Ray {
        Ray { origin: vector_of(&self.origins, i), direction: vector_of(&self.directions, i) }
    }

    /// Coordinates of four rays: by axis, origins and then directions.
    #[inline(always)]
    pub(crate) fn four(&self, group: usize) -> [[&[f64; 4]; 3]; 2] {
        let [x, y, z] = &self.origins;
        let [u, v, w] = &self.directions;
        [[four(x, group), four(y, group), four(z, group)], [four(u, group), four(v, group), four(w, group)]]
    }
}

/// [`Ray::is_valid`] of some rays.
struct Valid<'a>(&'a Packet, Mask);

impl Job for Valid<'_> {
    type Output = Mask;

    #[inline(always)]
    fn run<L: Lanes>(self, l: L) -> Mask {
        let Self(packet, rays) = self;
        let mut valid = 0;
        for (group, which) in groups(rays) {
            let origin = vector::load(l, &packet.origins, group);
            let direction = vector::load(l, &packet.directions, group);
            valid |= Mask::from(valid_of_four(l, origin, direction) & which) << (4 * group);
        }
        valid
    }
}

/// [`Ray::is_valid`] of four rays.
#[inline(always)]
pub(crate) fn valid_of_four<L: Lanes>(l: L, origins: vector::Four<L>, directions: vector::Four<L>) -> u32 {
    let zero = l.d_splat(0.0);
    let nothing = vector::add(l, vector::times(l, origins, zero), vector::times(l, directions, zero));
    let sum = l.d_add(l.d_add(nothing[0], nothing[1]), nothing[2]);
    vector::equal(l, sum, zero) & l.d_lt(zero, vector::reach(l, directions))
}

/// Four numbers, from four times `group` on.
///
/// # Panics
/// If there are not so many.
#[must_use]
#[inline(always)]
pub fn four(numbers: &PerRay, group: usize) -> &[f64; 4] {
    &numbers.as_chunks().0[group]
}

/// What the rays of a packet meet of one shape: distance and part, as in [`Hit`], for the rays that are told to hit, and
/// anything for the others.
#[derive(Clone, Debug)]
pub struct Hits {
    /// Distances in units of the rays' directions.
    pub t: PerRay,
    /// Which parts of the shape.
    pub part: [u32; PACKET],
}

impl Default for Hits {
    fn default() -> Self {
        Self { t: [0.0; PACKET], part: [0; PACKET] }
    }
}

/// The groups of four that hold some rays: the number of each, and which of its four they are.
#[inline(always)]
pub fn groups(mut rays: Mask) -> impl Iterator<Item = (usize, u32)> {
    core::iter::from_fn(move || {
        let group = rays.trailing_zeros() as usize / 4;
        let which = rays.checked_shr(4 * group as u32)? as u32 & 0b1111;
        rays &= !(0b1111 << (4 * group));
        Some((group, which))
    })
}

/// Asks for the hit of one ray after the other; tells which hit.
#[inline]
pub fn hit_each(rays: Mask, hits: &mut Hits, mut hit: impl FnMut(usize) -> Option<Hit>) -> Mask {
    let mut met = 0;
    for i in each(rays) {
        if let Some(Hit { t, part }) = hit(i) {
            (hits.t[i], hits.part[i]) = (t, part);
            met |= 1 << i;
        }
    }
    met
}

/// Those of some rays of which something holds; asked of one after the other.
#[inline]
pub fn those(rays: Mask, mut holds: impl FnMut(usize) -> bool) -> Mask {
    each(rays).filter(|&i| holds(i)).fold(0, |those, i| those | 1 << i)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_packet_gives_back_its_rays_and_knows_which_are_valid() {
        let mut packet = Packet::default();
        let rays: Vec<_> = (0..PACKET)
            .map(|i| {
                let x = i as f64;
                let direction = if i % 5 == 3 { DVec3::ZERO } else { DVec3::new(1.0, x, -x) };
                Ray { origin: DVec3::new(x, x + 0.5, -x), direction }
            })
            .collect();
        for (i, ray) in rays.iter().enumerate() {
            assert_eq!(packet.push(ray), i);
        }
        for (i, ray) in rays.iter().enumerate() {
            assert_eq!(packet.ray(i), *ray);
            assert_eq!(packet.valid() >> i & 1 == 1, ray.is_valid());
        }
        let numbers: Vec<_> = each(packet.valid()).collect();
        assert_eq!(numbers, (0..PACKET).filter(|i| i % 5 != 3).collect::<Vec<_>>());
        assert_eq!(packet.four(2)[0][0], &[8.0, 9.0, 10.0, 11.0]);
        let valid = packet.valid();
        packet.valid = 0;
        packet.check(packet.all());
        assert_eq!(packet.valid(), valid);
        packet.set(0, &Ray { origin: DVec3::NAN, direction: DVec3::X });
        packet.check(1);
        assert_eq!(packet.valid(), valid & !1);
        assert_eq!(groups(0b1001 << 60 | 0b0110).collect::<Vec<_>>(), [(0, 0b0110), (15, 0b1001)]);
        packet.clear();
        assert!(packet.is_empty() && packet.valid() == 0 && each(0).next().is_none());
        assert_eq!(each(1 << 63).collect::<Vec<_>>(), [63]);
    }
}
