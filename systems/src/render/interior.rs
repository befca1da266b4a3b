//! Inside which clear bodies a ray is.
//!
//! A ray carries the list of the bodies it entered and did not leave, in that order. Of those the one of highest rank
//! counts, of equal ranks the one entered last (after Schmidt, Budge: Simple Nested Dielectrics in Ray Traced Images,
//! 2002). A surface of a body that does not count where it lies is passed as if it were not there.

use crate::{
    accelerate::Geometry,
    snapshot::{Materials, Medium},
};
use glam::DVec3;
use smallvec::SmallVec;
use snell_components::{color::Rgb, math, method::Methods, primitive::Cost, space::Ray};

/// The clear bodies around a point, by rank of the object, in the order in which they were entered.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Interior(SmallVec<[u32; 4]>);

impl Clone for Interior {
    fn clone(&self) -> Self {
        // As a block of memory; the list's own clone takes one after the other.
        Self(SmallVec::from_slice(&self.0))
    }
}

/// The interiors of the rays of some trees, by number; that of the camera is number 0.
pub(super) struct Interiors<'a> {
    camera: &'a Interior,
    others: Vec<Interior>,
    crossings: Vec<Crossing<'a>>,
}

/// How rays that go through the same bodies cross the surface of a clear body.
pub(super) struct Crossing<'a> {
    inside: u32,
    object: u32,
    entering: bool,
    /// See [`Interior::sides`].
    pub sides: Option<Sides<'a>>,
    /// The number of the bodies beyond.
    pub beyond: u32,
    /// Whether those are any.
    pub encloses: bool,
}

/// So many crossings are looked through for one that is known.
const KNOWN: usize = 16;

impl<'a> Interiors<'a> {
    pub(super) fn new(camera: &'a Interior) -> Self {
        Self { camera, others: vec![], crossings: vec![] }
    }

    #[inline]
    pub(super) fn get(&self, number: u32) -> &Interior {
        if number == 0 { self.camera } else { &self.others[number as usize - 1] }
    }

    /// The number of how a ray through some bodies, by their number, crosses the surface of one.
    #[inline]
    pub(super) fn cross(&mut self, inside: u32, object: u32, entering: bool, materials: &'a Materials) -> u32 {
        let first = self.crossings.len().saturating_sub(KNOWN);
        let known = |c: &Crossing<'_>| c.inside == inside && c.object == object && c.entering == entering;
        match self.crossings[first..].iter().rposition(known) {
            Some(n) => (first + n) as u32,
            None => self.cross_anew(inside, object, entering, materials),
        }
    }

    #[cold]
    fn cross_anew(&mut self, inside: u32, object: u32, entering: bool, materials: &'a Materials) -> u32 {
        let interior = self.get(inside);
        let (sides, across) = (interior.sides(object, entering, materials), interior.across(object, entering));
        let encloses = !across.is_empty();
        // Bodies are crossed to and fro: few interiors are new.
        let known = core::iter::once(self.camera).chain(&self.others).position(|known| *known == across);
        let beyond = known.unwrap_or_else(|| {
            self.others.push(across);
            self.others.len()
        }) as u32;
        self.crossings.push(Crossing { inside, object, entering, sides, beyond, encloses });
        self.crossings.len() as u32 - 1
    }

    /// A crossing by its number.
    #[inline]
    pub(super) fn crossing(&self, number: u32) -> &Crossing<'a> {
        &self.crossings[number as usize]
    }
}

/// What lies on the two sides of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sides<'a> {
    pub before: &'a Medium,
    pub after: &'a Medium,
}

impl Interior {
    /// Whether the point lies in no clear body, where light loses nothing on its way.
    #[inline]
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The bodies that a point lies in: those which a ray from there leaves more often than it enters them.
    #[must_use]
    pub fn around(point: DVec3, geometry: &Geometry, materials: &Materials) -> Self {
        let mut bodies = SmallVec::new();
        if materials.media.is_empty() {
            return Self(bodies);
        }
        // Any direction will do; this one runs along no axis and no diagonal.
        let mut ray = Ray { origin: point, direction: DVec3::new(0.48, 0.64, 0.6) };
        let mut crossings: Vec<(u32, i64)> = vec![];
        while let Some(met) = geometry.closest(&ray, f64::INFINITY, &Methods::default(), &mut Cost::default()) {
            if materials.medium(met.object).is_some() {
                let step = if met.surface.normal.dot(ray.direction) > 0.0 { 1 } else { -1 };
                match crossings.iter_mut().find(|(object, _)| *object == met.object) {
                    Some((_, sum)) => *sum += step,
                    None => crossings.push((met.object, step)),
                }
            }
            ray.origin = met.surface.departure(ray.direction, met.t);
        }
        // What is left last was entered first.
        bodies.extend(crossings.iter().rev().filter(|(_, sum)| *sum > 0).map(|(object, _)| *object));
        Self(bodies)
    }

    /// What fills the point.
    pub(super) fn medium<'a>(&self, materials: &'a Materials) -> &'a Medium {
        self.counting(materials).map_or(&Medium::VACUUM, |(_, medium)| medium)
    }

    /// The body that counts.
    fn counting<'a>(&self, materials: &'a Materials) -> Option<(u32, &'a Medium)> {
        let bodies = self.0.iter().filter_map(|&object| materials.medium(object).map(|medium| (object, medium)));
        // Among equals the last: `max_by` keeps it.
        bodies.max_by(|a, b| a.1.rank.total_cmp(&b.1.rank))
    }

    /// The bodies on the other side of a surface of `object`.
    pub(super) fn across(&self, object: u32, entering: bool) -> Self {
        let Self(mut bodies) = self.clone();
        if entering {
            bodies.push(object);
        } else if let Some(last) = bodies.iter().rposition(|&body| body == object) {
            bodies.remove(last);
        }
        Self(bodies)
    }

    /// The media on the two sides of a surface of a clear body; none if the surface lies in a body that counts before
    /// it.
    pub(super) fn sides<'a>(&self, object: u32, entering: bool, materials: &'a Materials) -> Option<Sides<'a>> {
        let own = materials.medium(object)?;
        let across = self.across(object, entering);
        // A surface left that was never entered, as of a body that is not closed, still bounds its own medium.
        let known = entering || self.0.contains(&object);
        let inner = if entering { &across } else { self };
        if known && inner.counting(materials).is_some_and(|(counts, _)| counts != object) {
            return None;
        }
        let before = if known { self.medium(materials) } else { own };
        Some(Sides { before, after: across.medium(materials) })
    }
}

/// Share of light that is left after a way through a medium; `length` may be infinite.
#[must_use]
pub(super) fn transmittance(medium: &Medium, length: f64) -> Rgb {
    let left = |coefficient: f64| if coefficient == 0.0 { 1.0 } else { math::exp(-coefficient * length) };
    let Rgb { x, y, z } = medium.absorption;
    Rgb::new(left(x), left(y), left(z))
}
