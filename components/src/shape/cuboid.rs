//! `Box(size: (1, 2, 3))`: a parallelepiped about the origin of its object space; its placement turns and shears it.
//!
//! Each face carries the whole image: u and v run 0..=1 over it, upright on the four sides.

use crate::{
    describe::Describe,
    primitive::{Cost, Degenerate, Extent, Hit, Primitive, Surface},
    space::{Bounds, Ray},
};
use bevy_ecs::prelude::*;
use glam::{DAffine3, DVec2, DVec3};

/// A box about the origin of its object space (tag `Box`).
#[derive(Component, Clone, Debug, PartialEq, Describe)]
#[describe(tag = "Box")]
pub struct Cuboid {
    /// Edge lengths, object units.
    #[describe(positive, required)]
    pub size: DVec3,
}

impl Default for Cuboid {
    fn default() -> Self {
        Self { size: DVec3::ONE }
    }
}

/// A box as the inner loop sees it.
#[derive(Clone, Debug)]
pub struct PackedCuboid {
    half: DVec3,
    object_from_world: DAffine3,
    world_from_object: DAffine3,
    /// Of a point of the surface, world units.
    error: f64,
}

/// Distances at which a line enters and leaves the box −half..=half, and the axes of those faces.
///
/// Near and far planes are told apart by the sign of the direction, and a comparison with NaN (the line lies in a face)
/// keeps what was known, so every special value gives the answer for the closed box.
#[inline]
fn slabs(half: DVec3, ray: &Ray) -> Option<((f64, usize), (f64, usize))> {
    let (mut enter, mut leave) = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
    for axis in 0..3 {
        let (origin, direction) = (ray.origin[axis], ray.direction[axis]);
        if direction == 0.0 {
            if origin.abs() > half[axis] {
                return None;
            }
            continue;
        }
        let near = if direction > 0.0 { -half[axis] } else { half[axis] };
        let (near, far) = ((near - origin) / direction, (-near - origin) / direction);
        if near > enter.0 {
            enter = (near, axis);
        }
        if far < leave.0 {
            leave = (far, axis);
        }
    }
    (enter.0 <= leave.0).then_some((enter, leave))
}

impl Primitive for Cuboid {
    type Packed = PackedCuboid;

    fn pack(&self, world_from_object: &DAffine3) -> Result<(Extent, PackedCuboid), Degenerate> {
        if !(self.size.is_finite() && self.size.cmpgt(DVec3::ZERO).all()) {
            return Err(Degenerate(format!("its size is not three numbers above zero: {}", self.size)));
        }
        let half = self.size * 0.5;
        let bounds = Bounds { min: -half, max: half }.transformed(world_from_object);
        let error = Surface::rounding(bounds.min.abs().max(bounds.max.abs()).max_element());
        Ok((
            Extent::Bounded(bounds),
            PackedCuboid {
                half,
                object_from_world: world_from_object.inverse(),
                world_from_object: *world_from_object,
                error,
            },
        ))
    }

    #[inline]
    fn hit(packed: &PackedCuboid, ray: &Ray, t_max: f64, cost: &mut Cost) -> Option<Hit> {
        cost.primitives += 1;
        let ray = ray.transformed(&packed.object_from_world);
        let (enter, leave) = slabs(packed.half, &ray)?;
        let ((t, axis), leaving) = if enter.0 > 0.0 { (enter, false) } else { (leave, true) };
        if !(t > 0.0 && t <= t_max) {
            return None;
        }
        let high = (ray.direction[axis] > 0.0) == leaving;
        Some(Hit { t, part: 2 * axis as u32 + u32::from(high) })
    }

    fn surface(packed: &PackedCuboid, ray: &Ray, hit: Hit) -> Surface {
        let axis = (hit.part / 2) as usize;
        let sign = if hit.part % 2 == 1 { 1.0 } else { -1.0 };
        let mut local = ray.transformed(&packed.object_from_world).at(hit.t).clamp(-packed.half, packed.half);
        local[axis] = sign * packed.half[axis];
        let mut outward = DVec3::ZERO;
        outward[axis] = sign;
        let normal = (packed.object_from_world.matrix3.transpose() * outward).normalize();
        // Seen from outside with +y up (the top seen with −z up).
        let unit = local / packed.half;
        let (u, v) = match axis {
            0 => (-sign * unit.z, unit.y),
            1 => (unit.x, -sign * unit.z),
            _ => (sign * unit.x, unit.y),
        };
        Surface {
            point: packed.world_from_object.transform_point3(local),
            normal,
            shading_normal: normal,
            uv: DVec2::new(0.5 + 0.5 * u, 0.5 + 0.5 * v),
            slot: 0,
            error: packed.error,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hit(placement: DAffine3, origin: DVec3, direction: DVec3) -> Option<(f64, DVec3)> {
        let (_, packed) = Cuboid { size: DVec3::splat(2.0) }.pack(&placement).expect("a box");
        let ray = Ray { origin, direction };
        let hit = Cuboid::hit(&packed, &ray, f64::INFINITY, &mut Cost::default())?;
        Some((hit.t, Cuboid::surface(&packed, &ray, hit).normal))
    }

    #[test]
    fn faces_from_outside_and_inside() {
        let id = DAffine3::IDENTITY;
        assert_eq!(hit(id, DVec3::X * -5.0, DVec3::X), Some((4.0, DVec3::NEG_X)));
        assert_eq!(hit(id, DVec3::ZERO, DVec3::X), Some((1.0, DVec3::X)));
        assert_eq!(hit(id, DVec3::Y * 3.0, DVec3::NEG_Y), Some((2.0, DVec3::Y)));
        assert_eq!(hit(id, DVec3::new(0.0, 1.5, -5.0), DVec3::Z), None);
    }

    #[test]
    fn rays_in_a_face_hit_the_closed_box() {
        assert_eq!(hit(DAffine3::IDENTITY, DVec3::new(-5.0, 1.0, 0.0), DVec3::X).map(|h| h.0), Some(4.0));
        assert_eq!(hit(DAffine3::IDENTITY, DVec3::new(-5.0, -1.0, 1.0), DVec3::X).map(|h| h.0), Some(4.0));
    }

    #[test]
    fn a_sheared_box_is_a_parallelepiped() {
        let shear = DAffine3::from_cols_array(&[1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
        let (t, normal) = hit(shear, DVec3::new(-5.0, 0.5, 0.0), DVec3::X).expect("a hit");
        assert_eq!(t, 4.5);
        assert!((normal - DVec3::new(-1.0, 1.0, 0.0).normalize()).length() < 1e-15);
    }
}
