//! The most light that a ray can bring: what a cut by an error rests on.

use crate::snapshot::{Effect, Lights, Material, MaterialOfObject, Materials};
use snell_components::{color::Rgb, settings::Settings};

/// The most light that a ray can bring, by how many mirrored and transmitted rays may still follow one another behind
/// it.
///
/// A ray that meets nothing brings the background `G`; one that meets a surface brings the surface's own light and, by
/// the surface's share of it, what rays go on to bring. With `L` the most that a material's terms of light add up to and
/// `s` the sum of its shares, all per channel and over all materials in use,
///
/// `B₀ = max(G, g, L + s·g)` and `Bₖ = max(G, L + s·Bₖ₋₁)`,
///
/// `g` being what a ray beyond the depth is taken to bring. Bodies on the way only take light away, and cosines, shares
/// of the visible and Fresnel's shares are at most 1, so by induction no ray brings more than `B`. Rounding is within
/// the margin that is added.
#[derive(Clone, Debug, PartialEq)]
pub struct Ceiling {
    levels: Box<[Rgb]>,
    rays_go_on: bool,
}

/// Covers the rounding of shading and of the sums here: per factor an ulp or two, for a highlight its exponent of at
/// most 1e6 times as much.
const MARGIN: f64 = 1.0 + 1e-9;

/// Depths that are told apart; the last entry holds for all beyond.
const LEVELS: usize = 256;

impl Ceiling {
    /// The ceiling of a scene; none if some light or texture in use does not tell how bright it can be, or if there is
    /// no limit.
    pub(super) fn of(settings: &Settings, materials: &Materials, lights: &Lights, beyond_depth: Rgb) -> Option<Self> {
        let lamps = lights.lamps.iter().try_fold(Rgb::ZERO, |sum, lamp| Some(sum + lamp.brightest()?))?;
        let mut terms = Vec::with_capacity(materials.all.len());
        for (material, _) in materials.all.iter().zip(in_use(materials)).filter(|(_, used)| *used) {
            terms.push(material_terms(material, lights.ambient, lamps)?);
        }
        let next = |behind: Rgb| {
            terms.iter().fold(settings.background, |most, (own, shares)| most.max(*own + *shares * behind))
        };
        let mut levels = vec![next(beyond_depth).max(beyond_depth)];
        let mut last = levels[0];
        for _ in 0..settings.depth {
            let higher = next(last);
            if higher == last {
                break;
            }
            last = higher;
            if levels.len() < LEVELS {
                levels.push(last);
            }
        }
        // Rising, so the highest holds for every depth that is not told apart.
        if let Some(level) = levels.last_mut() {
            *level = last;
        }
        levels
            .iter()
            .all(|level| level.max_element() < 1e100)
            .then(|| Self { levels: levels.into(), rays_go_on: terms.iter().any(|(_, shares)| *shares != Rgb::ZERO) })
    }

    /// The same for all rays.
    #[cfg(test)]
    pub(crate) fn flat(most: Rgb) -> Self {
        Self { levels: Box::new([most]), rays_go_on: true }
    }

    /// Whether anything mirrors or lets light through, so that there may be rays to cut.
    #[must_use]
    pub fn rays_go_on(&self) -> bool {
        self.rays_go_on
    }

    /// The most that a ray can bring behind which so many more may follow one another.
    #[must_use]
    pub fn of_ray(&self, followers: u32) -> Rgb {
        self.levels[(followers as usize).min(self.levels.len() - 1)]
    }
}

/// Which materials some object is made of.
fn in_use(materials: &Materials) -> Vec<bool> {
    let mut used = vec![false; materials.all.len()];
    for object in &materials.of_object {
        match object {
            MaterialOfObject::Whole(index) => used[*index as usize] = true,
            MaterialOfObject::Slots(slots) => slots.iter().for_each(|index| used[*index as usize] = true),
        }
    }
    used
}

/// The most that a material's terms of light add up to, and the sum of the shares of the rays that go on.
fn material_terms(material: &Material, ambient: Rgb, lamps: Rgb) -> Option<(Rgb, Rgb)> {
    let color = match &material.texture {
        None => material.color,
        Some(pattern) => material.color * pattern.brightest()?,
    };
    let (mut own, mut shares) = (Rgb::ZERO, Rgb::ZERO);
    for effect in &material.effects {
        match *effect {
            Effect::Ambient(strength) => own += strength * color * ambient,
            Effect::Diffuse(strength) => own += strength * color * lamps,
            Effect::Glossy { diffuse, highlight, .. } => own += (diffuse * color + highlight) * lamps,
            Effect::Mirror(share) | Effect::Through(share) | Effect::Refract(share) | Effect::Split(share) => {
                shares += share;
            }
        }
    }
    Some((own * MARGIN, shares * MARGIN))
}

#[cfg(test)]
mod tests {
    use super::*;
    use snell_components::light::PointLight;
    use std::sync::Arc;

    fn scene(effects: &[Effect], depth: u32, background: f64) -> Option<Ceiling> {
        let material = Material { color: Rgb::splat(0.5), texture: None, effects: effects.into() };
        let of_object = vec![MaterialOfObject::Whole(0)];
        let materials = Materials { all: vec![material], of_object, ..Materials::default() };
        let lamp = PointLight { intensity: Rgb::splat(0.8), ..PointLight::default() };
        let lights = Lights { ambient: Rgb::splat(0.2), lamps: vec![Arc::new(lamp)], ..Lights::default() };
        let settings = Settings { depth, background: Rgb::splat(background), ..Settings::default() };
        Ceiling::of(&settings, &materials, &lights, Rgb::splat(background))
    }

    #[test]
    fn mirrors_add_up_as_a_geometric_series() {
        let effects = [Effect::Ambient(Rgb::ONE), Effect::Diffuse(Rgb::ONE), Effect::Mirror(Rgb::splat(0.5))];
        // 0.5·(0.2 + 0.8), again and again by one half; the ceiling stops rising at twice as much.
        for (depth, expected) in [(0, 0.5), (1, 0.75), (2, 0.875), (100_000, 1.0)] {
            let ceiling = scene(&effects, depth, 0.0).expect("a limit");
            assert!((ceiling.of_ray(depth).x - expected).abs() < 1e-8, "{depth}: {ceiling:?}");
            assert!(ceiling.of_ray(depth).x >= expected - 1e-15, "{depth}");
        }
    }

    #[test]
    fn a_bright_background_counts() {
        let ceiling = scene(&[Effect::Mirror(Rgb::splat(0.5))], 3, 4.0).expect("a limit");
        assert_eq!(ceiling.of_ray(3), Rgb::splat(4.0));
    }

    #[test]
    fn what_grows_without_limit_has_no_ceiling() {
        let double = [Effect::Diffuse(Rgb::ONE), Effect::Mirror(Rgb::ONE), Effect::Through(Rgb::ONE)];
        assert!(scene(&double, 1000, 1.0).is_none());
        assert!(scene(&double, 3, 1.0).is_some_and(|ceiling| ceiling.of_ray(3).x > 16.0));
    }
}
