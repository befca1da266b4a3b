//! The contract every shape meets.
//!
//! A new shape is one component with two trait impls, [`Describe`] for its fields and [`Primitive`] for its geometry,
//! and one registration call; nothing else names it.

use crate::{
    describe::{Describe, Fault},
    method::Methods,
    packet::{self, Hits, Mask, Packet, PerRay},
    space::{BoundingSphere, Bounds, Ray},
    surfaces::{Meeting, Surfaces},
};
use bevy_ecs::{component::Mutable, prelude::*};
use glam::{DAffine3, DVec2, DVec3};

/// A shape that rays can hit.
pub trait Primitive: Describe + Component<Mutability = Mutable> {
    /// The read-only form that the inner loop walks; cheap to clone (large data sits behind an `Arc`).
    type Packed: Clone + Send + Sync + 'static;

    /// Makes the packed form and the bounds of the shape placed by `world_from_object`.
    ///
    /// The bounds must hold every point that `hit` can return, rounding included; where they are not finite the shape is
    /// left out, and told.
    ///
    /// # Errors
    /// A reason why the shape has no surface to hit; it is then left out of the picture and reported.
    fn pack(&self, world_from_object: &DAffine3) -> Result<(Extent, Self::Packed), Degenerate>;

    /// Nearest hit with `0 < t <= t_max`, by a rule that depends on nothing but its arguments.
    fn hit(packed: &Self::Packed, ray: &Ray, t_max: f64, cost: &mut Cost) -> Option<Hit>;

    /// The nearest hit by other methods than the default ones, for shapes that have others.
    ///
    /// The accelerator must not change a bit of the hit: without one, this is the oracle for `hit`.
    fn hit_with(packed: &Self::Packed, ray: &Ray, t_max: f64, _with: &Methods, cost: &mut Cost) -> Option<Hit> {
        Self::hit(packed, ray, t_max, cost)
    }

    /// Whether anything is hit with `0 < t < t_max`; must agree with `hit`.
    fn blocks(packed: &Self::Packed, ray: &Ray, t_max: f64, cost: &mut Cost) -> bool {
        Self::hit(packed, ray, t_max, cost).is_some_and(|hit| hit.t < t_max)
    }

    /// Like `blocks` by other methods; must agree with `hit_with`.
    fn blocks_with(packed: &Self::Packed, ray: &Ray, t_max: f64, with: &Methods, cost: &mut Cost) -> bool {
        Self::hit_with(packed, ray, t_max, with, cost).is_some_and(|hit| hit.t < t_max)
    }

    /// `hit` for some rays of a packet, each with a `t_max` of its own: tells which hit, and where. By default one after
    /// the other; worth writing for shapes that test several rays at once faster, with the very same bits.
    fn hit_packet(
        packed: &Self::Packed,
        packet: &Packet,
        rays: Mask,
        t_max: &PerRay,
        hits: &mut Hits,
        cost: &mut Cost,
    ) -> Mask {
        packet::hit_each(rays, hits, |i| Self::hit(packed, &packet.ray(i), t_max[i], cost))
    }

    /// `blocks` for some rays of a packet, each with a `t_max` of its own: tells which are blocked.
    fn blocks_packet(packed: &Self::Packed, packet: &Packet, rays: Mask, t_max: &PerRay, cost: &mut Cost) -> Mask {
        packet::those(rays, |i| Self::blocks(packed, &packet.ray(i), t_max[i], cost))
    }

    /// The surface at a hit that `hit` returned for this ray; runs once per ray, for the nearest hit only.
    ///
    /// For filtered textures it is also asked how the surface goes on beside such a hit: for a ray that is off by a
    /// small part of a pixel and may pass the shape's edge, at the `t` where it crosses the tangent plane.
    fn surface(packed: &Self::Packed, ray: &Ray, hit: Hit) -> Surface;

    /// [`Primitive::surface`] to the last bit, but for the texture coordinates, which may be anything: for a surface on
    /// which no texture lies. Worth writing where they cost much.
    fn surface_without_uv(packed: &Self::Packed, ray: &Ray, hit: Hit) -> Surface {
        Self::surface(packed, ray, hit)
    }

    /// The way from the point of a hit to the curved surface above it that interpolated normals tell of, on the side from
    /// which the ray comes; nothing where normals are not interpolated. Rays to lights start there.
    fn lift(_packed: &Self::Packed, _ray: &Ray, _hit: Hit) -> DVec3 {
        DVec3::ZERO
    }

    /// [`Primitive::surface`] and [`Primitive::lift`] for rays of a packet that met some of these shapes. Texture
    /// coordinates may be anything where they are not asked for, and the lift is nothing where there is none; what stands
    /// for other rays stays as it is. By default one after the other; worth writing for shapes that work out several at
    /// once faster, with the very same bits.
    fn surface_packet(shapes: &[Self::Packed], met: &Meeting<'_>, surfaces: &mut Surfaces) {
        for i in packet::each(met.rays) {
            let (ray, shape, hit) = met.of(i);
            surface_alone::<Self>(&shapes[shape], &ray, hit, met.textured >> i & 1 != 0, i, surfaces);
        }
    }

    /// A sphere that holds the shape; by default the one about the bounds.
    fn bounding_sphere(_packed: &Self::Packed, bounds: &Bounds) -> BoundingSphere {
        BoundingSphere::of_bounds(bounds)
    }
}

/// [`Primitive::surface_packet`] for one ray, by what shapes tell of rays alone.
#[inline]
pub fn surface_alone<P: Primitive>(
    packed: &P::Packed,
    ray: &Ray,
    hit: Hit,
    textured: bool,
    i: usize,
    surfaces: &mut Surfaces,
) {
    let of = if textured { P::surface } else { P::surface_without_uv };
    let surface = of(packed, ray, hit);
    let smooth = surface.shading_normal != surface.normal;
    surfaces.set(i, &surface, if smooth { P::lift(packed, ray, hit) } else { DVec3::ZERO });
}

/// How far a shape reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extent {
    /// Within a box, world space.
    Bounded(Bounds),
    /// To infinity; such shapes live beside the tree and are tested by every ray.
    Unbounded,
}

/// Why a shape has no surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Degenerate(pub String);

impl From<Fault> for Degenerate {
    fn from(Fault { field, expected }: Fault) -> Self {
        Self(format!("its {field}: expected {expected}"))
    }
}

/// Where a ray met a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance in units of the ray's direction.
    pub t: f64,
    /// Which part of the shape: the face of a box, the triangle of a mesh; equal distances go to the lowest.
    pub part: u32,
}

/// The surface at a hit, world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The point, as near the true surface as the shape can say.
    pub point: DVec3,
    /// Unit geometric normal, outward.
    pub normal: DVec3,
    /// Unit normal for shading; equals `normal` where the shape is not smoothed.
    pub shading_normal: DVec3,
    /// Texture coordinates; images span 0..=1 with v upward.
    pub uv: DVec2,
    /// Which of the object's materials, for shapes that have several.
    pub slot: u32,
    /// How far `point` may be from the true surface, world units, beyond the rounding of its own coordinates;
    /// [`Surface::rounding`] of the largest number that entered the computation, for most shapes.
    pub error: f64,
}

/// What tracing cost, in counts that do not depend on the machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Tree nodes visited.
    pub nodes: u64,
    /// Shapes and triangles tested.
    pub primitives: u64,
}

impl core::ops::AddAssign for Cost {
    fn add_assign(&mut self, other: Self) {
        self.nodes += other.nodes;
        self.primitives += other.primitives;
    }
}

impl Surface {
    /// The rounding error that a computation with numbers up to `magnitude` is taken to have.
    #[must_use]
    pub fn rounding(magnitude: f64) -> f64 {
        OFFSET_ULPS * f64::EPSILON * magnitude
    }

    /// Where a ray that leaves the surface toward `direction` starts: beyond the error of the point, on that side.
    ///
    /// There is no absolute epsilon: the step is the shape's own error and [`OFFSET_ULPS`] of the point's largest
    /// coordinate and of the distance `travelled` to get here, in world units.
    #[must_use]
    pub fn departure(&self, direction: DVec3, travelled: f64) -> DVec3 {
        let step = self.error + Self::rounding(self.point.abs().max_element() + travelled);
        self.point + self.normal * if self.normal.dot(direction) < 0.0 { -step } else { step }
    }
}

/// How many ulps of the largest coordinate a secondary ray starts away from its surface.
///
/// 64 gives neither self-hits nor lost contacts over scales 1e-6 to 1e6 and offsets up to 1e8 times the object's size.
pub const OFFSET_ULPS: f64 = 64.0;
