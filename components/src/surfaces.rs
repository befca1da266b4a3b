//! The surfaces that rays of a packet met, as a structure of arrays.

use crate::{
    packet::{Mask, PACKET, Packet, PerRay, Vectors, set_vector, those, vector_of},
    primitive::{Hit, Surface},
    space::Ray,
};
use glam::{DVec2, DVec3};

/// What some rays of a packet met of the shapes of one type.
#[derive(Clone, Copy, Debug)]
pub struct Meeting<'a> {
    /// The packet.
    pub packet: &'a Packet,
    /// Which of its rays.
    pub rays: Mask,
    /// Those of the rays for which texture coordinates are asked.
    pub textured: Mask,
    /// Which of the shapes each ray met.
    pub shape: &'a [u32; PACKET],
    /// At what distance: see [`Hit`].
    pub t: &'a PerRay,
    /// Which part of the shape.
    pub part: &'a [u32; PACKET],
}

impl Meeting<'_> {
    /// A ray, the number of the shape it met, and where.
    #[must_use]
    #[inline]
    pub fn of(&self, i: usize) -> (Ray, usize, Hit) {
        (self.packet.ray(i), self.shape[i] as usize, Hit { t: self.t[i], part: self.part[i] })
    }

    /// Those of the rays that met one shape, by its number.
    #[must_use]
    #[inline]
    pub fn with(&self, shape: u32) -> Mask {
        those(self.rays, |i| self.shape[i] == shape)
    }
}

/// A [`Surface`] for each ray of a packet, and the [lift](crate::primitive::Primitive::lift) of its point.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub struct Surfaces {
    /// See [`Surface::point`].
    pub point: Vectors,
    /// See [`Surface::normal`].
    pub normal: Vectors,
    /// See [`Surface::shading_normal`].
    pub shading_normal: Vectors,
    /// See [`crate::primitive::Primitive::lift`]; nothing where the shading normal is the normal.
    pub lift: Vectors,
    /// See [`Surface::error`].
    pub error: PerRay,
    /// See [`Surface::uv`].
    pub uv: [PerRay; 2],
    /// See [`Surface::slot`].
    pub slot: [u32; PACKET],
}

impl Default for Surfaces {
    fn default() -> Self {
        let none = [[0.0; PACKET]; 3];
        Self {
            point: none,
            normal: none,
            shading_normal: none,
            lift: none,
            error: [0.0; PACKET],
            uv: [[0.0; PACKET]; 2],
            slot: [0; PACKET],
        }
    }
}

impl Surfaces {
    /// Sets that of a ray.
    #[inline]
    pub fn set(&mut self, i: usize, surface: &Surface, lift: DVec3) {
        let Surface { point, normal, shading_normal, uv, slot, error } = *surface;
        set_vector(&mut self.point, i, point);
        set_vector(&mut self.normal, i, normal);
        set_vector(&mut self.shading_normal, i, shading_normal);
        set_vector(&mut self.lift, i, lift);
        self.error[i] = error;
        self.slot[i] = slot;
        self.set_uv(i, uv);
    }

    /// Sets the texture coordinates of a ray.
    #[inline]
    pub fn set_uv(&mut self, i: usize, uv: DVec2) {
        (self.uv[0][i], self.uv[1][i]) = (uv.x, uv.y);
    }

    /// That of a ray.
    #[must_use]
    #[inline]
    pub fn get(&self, i: usize) -> Surface {
        Surface {
            point: vector_of(&self.point, i),
            normal: vector_of(&self.normal, i),
            shading_normal: vector_of(&self.shading_normal, i),
            uv: DVec2::new(self.uv[0][i], self.uv[1][i]),
            slot: self.slot[i],
            error: self.error[i],
        }
    }
}
