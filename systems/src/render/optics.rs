//! Mirror, Snell and Fresnel.

use glam::DVec3;
use snell_components::lanes::{Lanes, vector};

/// The direction mirrored at a surface with unit normal; as long as `direction`.
#[must_use]
#[inline]
pub fn reflect(direction: DVec3, normal: DVec3) -> DVec3 {
    direction - normal * (2.0 * direction.dot(normal))
}

/// The unit direction refracted at a surface, or none beyond the critical angle.
///
/// `direction` is a unit vector, `normal` a unit vector against it, and `eta` the index where the ray comes from over
/// the one where it goes. With `L = −direction`: `T = eta·(cos α·N − L) − N·√(1 − sin²γ)`, Snell's law in vector form.
#[must_use]
#[inline]
pub fn refract(direction: DVec3, normal: DVec3, eta: f64) -> Option<DVec3> {
    // The same medium on both sides bends nothing, to the last bit.
    if eta == 1.0 {
        return Some(direction);
    }
    let cos_in = -direction.dot(normal);
    let square = cos_out_squared(cos_in, eta);
    if square < 0.0 {
        return None;
    }
    Some((direction * eta + normal * (eta * cos_in - square.sqrt())).normalize())
}

/// Square of the cosine of the refracted angle; negative beyond the critical angle. The one place that decides it.
#[inline]
fn cos_out_squared(cos_in: f64, eta: f64) -> f64 {
    1.0 - eta * eta * (1.0 - cos_in * cos_in)
}

/// Share of unpolarised light that is reflected, 0 to 1, by Fresnel's equations.
///
/// `cos_in` is the cosine of the angle of incidence, clamped to 0..=1; `eta` as in [`refract`]. Beyond the critical
/// angle 1; between equal media 0.
#[must_use]
#[inline]
pub fn fresnel(cos_in: f64, eta: f64) -> f64 {
    if eta == 1.0 {
        return 0.0;
    }
    let cos_in = cos_in.clamp(0.0, 1.0);
    let square = cos_out_squared(cos_in, eta);
    if square < 0.0 {
        return 1.0;
    }
    let cos_out = square.sqrt();
    // Both indices divided by the one where the ray goes.
    let s = (eta * cos_in - cos_out) / (eta * cos_in + cos_out);
    let p = (eta * cos_out - cos_in) / (eta * cos_out + cos_in);
    (0.5 * (s * s + p * p)).min(1.0)
}

/// [`reflect`] of four rays.
#[inline(always)]
pub(super) fn reflect_four<L: Lanes>(l: L, direction: vector::Four<L>, normal: vector::Four<L>) -> vector::Four<L> {
    let twice = l.d_mul(l.d_splat(2.0), vector::dot(l, direction, normal));
    vector::sub(l, direction, vector::times(l, normal, twice))
}

/// [`refract`] of four rays: which are refracted, and where to.
#[inline(always)]
pub(super) fn refract_four<L: Lanes>(
    l: L,
    direction: vector::Four<L>,
    normal: vector::Four<L>,
    eta: L::D,
) -> (u32, vector::Four<L>) {
    let (zero, one) = (l.d_splat(0.0), l.d_splat(1.0));
    let same = vector::equal(l, eta, one);
    let cos_in = vector::minus(l, vector::dot(l, direction, normal));
    let square = cos_out_squared_of_four(l, cos_in, eta);
    let beyond = l.d_lt(square, zero) & !same;
    let along = vector::times(l, direction, eta);
    let across = vector::times(l, normal, l.d_sub(l.d_mul(eta, cos_in), l.d_sqrt(square)));
    let refracted = vector::unit(l, vector::add(l, along, across));
    (!beyond & 0b1111, if same == 0 { refracted } else { vector::select(l, same, direction, refracted) })
}

#[inline(always)]
fn cos_out_squared_of_four<L: Lanes>(l: L, cos_in: L::D, eta: L::D) -> L::D {
    let one = l.d_splat(1.0);
    let sin_in_squared = l.d_sub(one, l.d_mul(cos_in, cos_in));
    l.d_sub(one, l.d_mul(l.d_mul(eta, eta), sin_in_squared))
}

/// [`fresnel`] of four rays.
#[inline(always)]
pub(super) fn fresnel_four<L: Lanes>(l: L, cos_in: L::D, eta: L::D) -> L::D {
    let (zero, one) = (l.d_splat(0.0), l.d_splat(1.0));
    let cos_in = l.d_if_lt(cos_in, zero, zero, cos_in);
    let cos_in = l.d_if_lt(one, cos_in, one, cos_in);
    let square = cos_out_squared_of_four(l, cos_in, eta);
    let cos_out = l.d_sqrt(square);
    let (thin_in, thin_out) = (l.d_mul(eta, cos_in), l.d_mul(eta, cos_out));
    let s = l.d_div(l.d_sub(thin_in, cos_out), l.d_add(thin_in, cos_out));
    let p = l.d_div(l.d_sub(thin_out, cos_in), l.d_add(thin_out, cos_in));
    let mean = l.d_mul(l.d_splat(0.5), l.d_add(l.d_mul(s, s), l.d_mul(p, p)));
    let reflected = l.d_if_lt(square, zero, one, l.d_if_lt(mean, one, mean, one));
    l.d_select(vector::equal(l, eta, one), zero, reflected)
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use snell_components::{
        lanes::{self, Job},
        math,
    };

    #[test]
    fn fresnel_has_its_known_values() {
        assert!((fresnel(1.0, 1.0 / 1.5) - 0.04).abs() < 1e-15);
        assert_eq!(fresnel(0.0, 1.0 / 1.5), 1.0);
        assert_eq!(fresnel(0.0, 1.0), 0.0);
        assert_eq!(fresnel(0.5, 1.5), 1.0, "beyond the critical angle");
        // Brewster's angle, tan θ = 1.5: only the perpendicular part is reflected, ((n²−1)/(n²+1))².
        let cos = 1.0 / (1.0f64 + 1.5 * 1.5).sqrt();
        let perpendicular = (1.25 / 3.25) * (1.25 / 3.25);
        assert!((fresnel(cos, 1.0 / 1.5) - 0.5 * perpendicular).abs() < 1e-15);
        assert!((0.0..=1.0).contains(&fresnel(1.0 + 1e-7, 1.0 / 1.5)) && fresnel(-1e-7, 1.0 / 1.5) == 1.0);
    }

    /// F62. Within 1e-12 of the critical angle either side may be taken; beyond that, the right one, by both functions, and
    /// what is refracted is a unit vector that keeps to Snell's law.
    #[test]
    fn the_critical_angle_is_where_it_is() {
        for index in [1.5, 1.0001, 2.4] {
            let critical = (0.5 * PI - math::acos(1.0 / index)).to_degrees();
            for exponent in 2..=11 {
                let off = math::pow(10.0, -f64::from(exponent)).to_degrees();
                // Beyond grazing there is nothing to bend.
                for angle in [critical - off, critical + off].into_iter().filter(|angle| *angle < 90.0) {
                    let (sin, cos) = math::sin_cos_degrees(angle);
                    let bent = refract(DVec3::new(sin, -cos, 0.0), DVec3::Y, index);
                    assert_eq!(bent.is_some(), angle < critical, "{index}, {off:e}");
                    let reflected = fresnel(cos, index);
                    assert!((0.0..=1.0).contains(&reflected));
                    assert_eq!(reflected < 1.0, angle < critical, "{index}, {off:e}: {reflected}");
                    if let Some(bent) = bent {
                        assert!((bent.length() - 1.0).abs() <= 4.0 * f64::EPSILON);
                        assert!((bent.x - index * sin).abs() <= 8.0 * f64::EPSILON, "{index}, {off:e}");
                    }
                }
            }
        }
    }

    /// Mirrored, refracted if at all, and the share reflected, of four rays: as bits, any number that is none alike.
    struct Together([DVec3; 4], [DVec3; 4], [f64; 4]);

    impl Job for Together {
        type Output = [(DVec3, Option<DVec3>, f64); 4];

        #[inline(always)]
        fn run<L: Lanes>(self, l: L) -> Self::Output {
            let Self(directions, normals, etas) = self;
            let load = |of: [DVec3; 4]| {
                let axis = |axis: usize| l.d_load(&of.map(|v| v[axis]));
                [axis(0), axis(1), axis(2)]
            };
            let (direction, normal, eta) = (load(directions), load(normals), l.d_load(&etas));
            let of = |four: vector::Four<L>, lane: usize| {
                DVec3::from_array(four.map(|axis| {
                    let mut numbers = [0.0; 4];
                    l.d_store(axis, &mut numbers);
                    numbers[lane]
                }))
            };
            let mirrored = reflect_four(l, direction, normal);
            let (bends, bent) = refract_four(l, direction, normal, eta);
            let mut reflected = [0.0; 4];
            let cosine = vector::minus(l, vector::dot(l, direction, normal));
            l.d_store(fresnel_four(l, cosine, eta), &mut reflected);
            core::array::from_fn(|i| (of(mirrored, i), (bends >> i & 1 != 0).then(|| of(bent, i)), reflected[i]))
        }
    }

    #[test]
    fn four_rays_together_come_to_what_each_does_alone() {
        let canonical = |x: f64| if x.is_nan() { u64::MAX } else { x.to_bits() };
        let bits = |(mirrored, bent, reflected): (DVec3, Option<DVec3>, f64)| {
            let bent = bent.map(|bent| bent.to_array().map(canonical));
            (mirrored.to_array().map(canonical), bent, canonical(reflected))
        };
        let etas = [1.0, 1.5, 1.0 / 1.5, 2.4, 1.0 / 1.0001, 1.0001, f64::NAN, 1e9];
        let (mut bent, mut total) = (0, 0);
        for n in 0..4000u32 {
            let [directions, normals] = [3, 5].map(|step| {
                core::array::from_fn(|i| {
                    let angle = f64::from(n * step + 97 * i as u32) * 0.09;
                    let (sin, cos) = math::sin_cos_degrees(angle);
                    // Some along the axes, grazing, and none at all.
                    if (n + i as u32).is_multiple_of(191) { DVec3::NAN } else { DVec3::new(sin, -cos, 0.25 * sin) }
                })
            });
            let normals: [DVec3; 4] = normals.map(DVec3::normalize);
            let directions: [DVec3; 4] = directions.map(DVec3::normalize);
            let eta = core::array::from_fn(|i| etas[(n as usize / 3 + i) % etas.len()]);
            let together = lanes::run(Together(directions, normals, eta));
            for i in 0..4 {
                let (direction, normal, eta) = (directions[i], normals[i], eta[i]);
                let alone =
                    (reflect(direction, normal), refract(direction, normal, eta), fresnel(-direction.dot(normal), eta));
                bent += u32::from(alone.1.is_some());
                total += u32::from(alone.1.is_none());
                assert_eq!(bits(together[i]), bits(alone), "{direction} at {normal}, {eta}");
            }
        }
        assert!(bent > 1000 && total > 1000, "{bent}, {total}");
    }

    #[test]
    fn refraction_obeys_snell_on_both_ways() {
        for degrees in [0.0, 10.0, 45.0, 80.0, 89.9] {
            let (sin, cos) = math::sin_cos_degrees(degrees);
            let inside = refract(DVec3::new(sin, -cos, 0.0), DVec3::Y, 1.0 / 1.5).expect("entering");
            assert!((inside.x - sin / 1.5).abs() < 1e-15, "{degrees}");
            let out = refract(inside, DVec3::Y, 1.5).expect("leaving where it entered");
            assert!((out - DVec3::new(sin, -cos, 0.0)).length() < 1e-12, "{degrees}: {out}");
        }
        assert_eq!(refract(DVec3::new(0.8, -0.6, 0.0), DVec3::Y, 1.5), None);
    }
}
