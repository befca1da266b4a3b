//! Where smoothed facets lift rays to lights, so that no facet shades what its interpolated normals say is lit.
//!
//! Normals that are interpolated tell of a curved surface above the facet. A light that they face and the facet does not
//! would be hidden by the facet itself, in a shadow of hard corners. So the point is lifted: to where the planes at right
//! angles to the vertices' normals lie above it, weighted as the normals are (Hanika: Hacking the Shadow Terminator, Ray
//! Tracing Gems II, chapter 4). What is curved inward is left where it is.

use super::mesh_surface::blend;
use crate::lanes::{Lanes, vector};
use glam::DVec3;

/// The way from a point of a facet to the curved surface above it.
///
/// `normals` are unit vectors, or zero where there is none, toward the side that is seen; `weights` those of the point.
pub(super) fn lift(vertices: [DVec3; 3], normals: [DVec3; 3], weights: [f64; 3]) -> DVec3 {
    let [a, b, c] = vertices;
    let [u, v, w] = weights;
    let point = a * u + b * v + c * w;
    let mut lift = DVec3::ZERO;
    for ((vertex, normal), weight) in vertices.into_iter().zip(normals).zip(weights) {
        let below = (vertex - point).dot(normal);
        if below > 0.0 {
            lift += normal * (below * weight);
        }
    }
    lift
}

/// [`lift`] of four points.
#[inline(always)]
pub(super) fn lift_of_four<L: Lanes>(
    l: L,
    vertices: [vector::Four<L>; 3],
    normals: [vector::Four<L>; 3],
    weights: [L::D; 3],
) -> vector::Four<L> {
    let point = blend(l, vertices, weights);
    let mut lift = vector::splat(l, DVec3::ZERO);
    for i in 0..3 {
        let below = vector::dot(l, vector::sub(l, vertices[i], point), normals[i]);
        let more = vector::add(l, lift, vector::times(l, normals[i], l.d_mul(below, weights[i])));
        lift = vector::select(l, l.d_lt(l.d_splat(0.0), below), more, lift);
    }
    lift
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_bulges_is_lifted_and_what_is_hollow_or_flat_is_not() {
        let vertices = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let third = [1.0 / 3.0; 3];
        let middle = (DVec3::X + DVec3::Y) / 3.0;
        // Normals that lean outward from the middle, as on a ball.
        let outward = vertices.map(|v| (v - middle + DVec3::Z).normalize());
        assert!(lift(vertices, outward, third).z > 0.1);
        assert_eq!(lift(vertices, outward, [1.0, 0.0, 0.0]), DVec3::ZERO, "a vertex is on the surface");
        let inward = vertices.map(|v| (middle - v + DVec3::Z).normalize());
        assert_eq!(lift(vertices, inward, third), DVec3::ZERO);
        assert_eq!(lift(vertices, [DVec3::Z; 3], third), DVec3::ZERO);
        assert_eq!(lift(vertices, [DVec3::ZERO; 3], third), DVec3::ZERO);
    }
}
