//! Vectors on lanes: four at once, a coordinate in each `D`.
//!
//! Each does the operations of its scalar counterpart in [`glam`] in the same order, and gives the same bits.

use super::Lanes;
use crate::packet::{Vectors, four};
use glam::{DAffine3, DMat3, DVec3};

/// Four vectors.
pub type Four<L> = [<L as Lanes>::D; 3];

/// The vectors of four rays, from four times `group` on.
#[inline(always)]
pub fn load<L: Lanes>(l: L, from: &Vectors, group: usize) -> Four<L> {
    let [x, y, z] = from;
    [l.d_load(four(x, group)), l.d_load(four(y, group)), l.d_load(four(z, group))]
}

/// Stores the vectors of those of four rays that a mask tells.
#[inline(always)]
pub fn store<L: Lanes>(l: L, [x, y, z]: Four<L>, which: u32, to: &mut Vectors, group: usize) {
    l.d_store_some(x, which, &mut to[0].as_chunks_mut().0[group]);
    l.d_store_some(y, which, &mut to[1].as_chunks_mut().0[group]);
    l.d_store_some(z, which, &mut to[2].as_chunks_mut().0[group]);
}

/// One vector in all lanes.
#[inline(always)]
pub fn splat<L: Lanes>(l: L, v: DVec3) -> Four<L> {
    [l.d_splat(v.x), l.d_splat(v.y), l.d_splat(v.z)]
}

/// Sums.
#[inline(always)]
pub fn add<L: Lanes>(l: L, a: Four<L>, b: Four<L>) -> Four<L> {
    [l.d_add(a[0], b[0]), l.d_add(a[1], b[1]), l.d_add(a[2], b[2])]
}

/// Differences.
#[inline(always)]
pub fn sub<L: Lanes>(l: L, a: Four<L>, b: Four<L>) -> Four<L> {
    [l.d_sub(a[0], b[0]), l.d_sub(a[1], b[1]), l.d_sub(a[2], b[2])]
}

/// Products coordinate by coordinate.
#[inline(always)]
pub fn mul<L: Lanes>(l: L, a: Four<L>, b: Four<L>) -> Four<L> {
    [l.d_mul(a[0], b[0]), l.d_mul(a[1], b[1]), l.d_mul(a[2], b[2])]
}

/// Each vector times a number.
#[inline(always)]
pub fn times<L: Lanes>(l: L, a: Four<L>, s: L::D) -> Four<L> {
    [l.d_mul(a[0], s), l.d_mul(a[1], s), l.d_mul(a[2], s)]
}

/// The opposite number; of zero, too.
#[inline(always)]
pub fn minus<L: Lanes>(l: L, a: L::D) -> L::D {
    l.d_sub(l.d_splat(-0.0), a)
}

/// The opposite vectors.
#[inline(always)]
pub fn neg<L: Lanes>(l: L, a: Four<L>) -> Four<L> {
    [minus(l, a[0]), minus(l, a[1]), minus(l, a[2])]
}

/// Dot products.
#[inline(always)]
pub fn dot<L: Lanes>(l: L, a: Four<L>, b: Four<L>) -> L::D {
    l.d_add(l.d_add(l.d_mul(a[0], b[0]), l.d_mul(a[1], b[1])), l.d_mul(a[2], b[2]))
}

/// Cross products.
#[inline(always)]
pub fn cross<L: Lanes>(l: L, a: Four<L>, b: Four<L>) -> Four<L> {
    [
        l.d_sub(l.d_mul(a[1], b[2]), l.d_mul(b[1], a[2])),
        l.d_sub(l.d_mul(a[2], b[0]), l.d_mul(b[2], a[0])),
        l.d_sub(l.d_mul(a[0], b[1]), l.d_mul(b[0], a[1])),
    ]
}

/// The lanes of a mask of `a`, the others of `b`.
#[inline(always)]
pub fn select<L: Lanes>(l: L, which: u32, a: Four<L>, b: Four<L>) -> Four<L> {
    [l.d_select(which, a[0], b[0]), l.d_select(which, a[1], b[1]), l.d_select(which, a[2], b[2])]
}

/// Unit vectors of the same directions; where there is none, of `other`.
#[inline(always)]
pub fn unit_or<L: Lanes>(l: L, a: Four<L>, other: Four<L>) -> Four<L> {
    let inverse = l.d_div(l.d_splat(1.0), l.d_sqrt(dot(l, a, a)));
    let known = l.d_lt(l.d_splat(0.0), inverse) & l.d_lt(inverse, l.d_splat(f64::INFINITY));
    let unit = times(l, a, inverse);
    if known == 0b1111 { unit } else { select(l, known, unit, other) }
}

/// The largest coordinates.
#[inline(always)]
pub fn largest<L: Lanes>(l: L, a: Four<L>) -> L::D {
    l.d_max(l.d_max(a[0], a[1]), a[2])
}

/// The largest of the sizes of the coordinates.
#[inline(always)]
pub fn reach<L: Lanes>(l: L, a: Four<L>) -> L::D {
    largest(l, [l.d_abs(a[0]), l.d_abs(a[1]), l.d_abs(a[2])])
}

/// Vectors turned by a matrix.
#[inline(always)]
pub fn turned<L: Lanes>(l: L, by: &DMat3, a: Four<L>) -> Four<L> {
    let x = times(l, splat(l, by.x_axis), a[0]);
    let y = times(l, splat(l, by.y_axis), a[1]);
    let z = times(l, splat(l, by.z_axis), a[2]);
    add(l, add(l, x, y), z)
}

/// Points in another space.
#[inline(always)]
pub fn moved<L: Lanes>(l: L, by: &DAffine3, a: Four<L>) -> Four<L> {
    add(l, turned(l, &by.matrix3, a), splat(l, by.translation))
}

/// Which vectors differ.
#[inline(always)]
pub fn differ<L: Lanes>(l: L, a: Four<L>, b: Four<L>) -> u32 {
    !(equal(l, a[0], b[0]) & equal(l, a[1], b[1]) & equal(l, a[2], b[2])) & 0b1111
}

/// Which numbers are equal.
#[inline(always)]
pub fn equal<L: Lanes>(l: L, a: L::D, b: L::D) -> u32 {
    l.d_le(a, b) & l.d_le(b, a)
}

/// Unit vectors of the same directions, which must not be zero.
#[inline(always)]
pub fn unit<L: Lanes>(l: L, a: Four<L>) -> Four<L> {
    times(l, a, l.d_div(l.d_splat(1.0), l.d_sqrt(dot(l, a, a))))
}
