//! What happens to light at a surface: one component per effect, in any combination.
//!
//! Per colour channel, with surface colour `C`, view `S`, normal `N`, direction to light `L` and its mirror image `R`:
//!
//! `I = ka·Ia·C + kd·C·Σ Ii·max(0, N·Li) + ks·Σ Ii·max(0, S·Ri)^p + kr·Ir + kt·It`
//!
//! (Whitted: An Improved Illumination Model for Shaded Display, 1980). Each component adds its term; a term without
//! component costs nothing. Lambert's and Phong's models are this sum with terms absent.
//!
//! The components may sit on an object itself, or on an entity of their own that many objects share by [`MadeOf`].

use crate::{
    color::{Encoding, Rgb},
    describe::{Describe, FieldVisitor, Spec, Value},
};
use bevy_ecs::{entity::EntityHashSet, prelude::*};

/// The material of an object: the entity that holds the effects.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
#[relationship(relationship_target = MaterialOf)]
pub struct MadeOf(pub Entity);

/// The objects made of a material; kept up to date by [`MadeOf`]. A set: its order means nothing.
#[derive(Component, Debug, Default)]
#[relationship_target(relationship = MadeOf)]
pub struct MaterialOf(EntityHashSet);

impl MaterialOf {
    /// Count of objects.
    #[must_use]
    pub fn count(&self) -> usize {
        self.0.len()
    }
}

/// The materials of an object's parts, by the `slot` of its surface; used where the object has no [`MadeOf`].
#[derive(Component, Clone, Debug, Default, PartialEq, Eq)]
pub struct MaterialSlots(pub Vec<Entity>);

macro_rules! effect {
    ($(#[$doc:meta])* $name:ident, $tag:literal, $default:expr, $field:literal, $spec:expr) => {
        $(#[$doc])*
        #[derive(Component, Clone, Copy, Debug, PartialEq)]
        pub struct $name(pub Rgb);

        impl $name {
            /// The same in every channel.
            #[must_use]
            pub fn grey(level: f64) -> Self {
                Self(Rgb::splat(level))
            }
        }

        impl Default for $name {
            fn default() -> Self {
                Self($default)
            }
        }

        impl Describe for $name {
            const TAG: &'static str = $tag;

            fn describe(&mut self, fields: &mut dyn FieldVisitor) {
                fields.field($field, Value::Color(&mut self.0), $spec);
            }
        }
    };
}

effect!(
    /// Surface colour `C`, linear RGB; white where absent. Textures multiply it.
    Color, "Color", Rgb::ONE, "color", Spec::not_negative("surface colour, linear RGB").required()
);
impl Color {
    /// A colour as screens show it: `0xrrggbb`, sRGB.
    #[must_use]
    pub fn srgb(rrggbb: u32) -> Self {
        let channel = |shift: u32| Encoding::Srgb.decode(f64::from(rrggbb >> shift & 0xff) / 255.0);
        Self(Rgb::new(channel(16), channel(8), channel(0)))
    }
}

effect!(
    /// `ka`: how much of the ambient light the surface returns.
    Ambient, "Ambient", Rgb::ONE, "strength", Spec::not_negative("share of the ambient light").required()
);
effect!(
    /// `kd`: Lambert's diffuse reflection.
    Diffuse, "Diffuse", Rgb::ONE, "strength", Spec::not_negative("share of the light scattered evenly").required()
);
effect!(
    /// `kr`: how much of what the mirror ray brings is added.
    Mirror, "Mirror", Rgb::ONE, "strength", Spec::within(0.0, 1.0, "share of the mirrored light").required()
);
effect!(
    /// `kt`: how much of what the transmitted ray brings is added. The ray goes straight on, unless the material has a
    /// [`Refraction`].
    Transmission, "Transmission", Rgb::ONE, "strength", Spec::within(0.0, 1.0, "share of the light let through").required()
);

/// `ks` and `p`: the highlight that a light leaves on the surface (Phong).
#[derive(Component, Clone, Copy, Debug, PartialEq, Describe)]
pub struct Highlight {
    /// `ks`, brightness of the highlight, linear RGB.
    #[describe(not_negative, required)]
    pub strength: Rgb,
    /// `p`, from 1, wide, to 200 and beyond, small.
    #[describe(within(0.0, 1e6))]
    pub exponent: f64,
}

impl Default for Highlight {
    fn default() -> Self {
        Self { strength: Rgb::ONE, exponent: 50.0 }
    }
}

/// Bends what [`Transmission`] lets through by Snell's law; nothing passes beyond the critical angle.
#[derive(Component, Clone, Copy, Debug, PartialEq, Describe)]
pub struct Refraction {
    /// Refractive index inside the body; where no body is it is 1.
    #[describe(positive, required)]
    pub index: f64,
}

impl Default for Refraction {
    fn default() -> Self {
        Self { index: 1.5 }
    }
}

/// A clear body that splits light by Fresnel's equations: of `part = 1 − ka − kd − ks` the share `F` is mirrored and
/// `1 − F` refracted; all of it is mirrored beyond the critical angle, and where the index exceeds
/// [`Dielectric::OPAQUE_INDEX`].
///
/// Takes the place of [`Mirror`], [`Transmission`] and [`Refraction`].
#[derive(Component, Clone, Copy, Debug, PartialEq, Describe)]
pub struct Dielectric {
    /// Refractive index inside the body; where no body is it is 1.
    #[describe(positive, required)]
    pub index: f64,
}

impl Dielectric {
    /// A body denser than this lets nothing through.
    pub const OPAQUE_INDEX: f64 = 10_000.0;
}

impl Default for Dielectric {
    fn default() -> Self {
        Self { index: 1.5 }
    }
}

/// `δ`: how strongly a clear body swallows light; of the light that goes a distance R inside, `exp(−δ·R)` is left.
///
/// It belongs to the whole body, and needs no [`Refraction`]: without, light goes straight.
#[derive(Component, Clone, Copy, Debug, PartialEq, Describe)]
pub struct Absorption(
    /// Share swallowed per world unit, as `exp(−δ·R)`; linear RGB.
    #[describe(name = "coefficient", not_negative, required)]
    pub Rgb,
);

impl Default for Absorption {
    fn default() -> Self {
        Self(Rgb::ZERO)
    }
}

/// Makes the index of a [`Refraction`] or [`Dielectric`] depend on the wavelength: white light fans out into colours.
///
/// The index follows Cauchy's formula `n(λ) = A + B/λ²` with the given index at 587.6 nm (the Fraunhofer line d).
#[derive(Component, Clone, Copy, Debug, PartialEq, Describe)]
pub struct Dispersion {
    /// Abbe number `(n_d − 1) / (n_F − n_C)`: 20 (flint, much) to 85 (crown, little).
    #[describe(within(1.0, 1e6), about = "Abbe number, from 20, much dispersion, to 85, little")]
    pub abbe: f64,
    /// Into how many wavelengths a white ray is split.
    #[describe(within(2.0, 64.0))]
    pub wavelengths: u32,
}

impl Default for Dispersion {
    fn default() -> Self {
        Self { abbe: 30.0, wavelengths: 8 }
    }
}

/// Which of several clear bodies counts where they overlap: the one of highest rank; of equal ones that which the ray
/// entered last, so that a body inside another needs no rank.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Describe)]
pub struct MediumRank(
    /// The higher one counts where clear bodies overlap.
    #[describe(name = "rank", required)]
    pub f64,
);

/// Alpha blending: the result is `α·A + (1 − α)·B`, `A` the surface's own light with all its other effects and `B` what
/// lies straight behind.
#[derive(Component, Clone, Copy, Debug, PartialEq, Describe)]
pub struct Opacity {
    /// 0, nothing to see, to 1, nothing shows through.
    #[describe(within(0.0, 1.0), required)]
    pub alpha: f64,
}

impl Default for Opacity {
    fn default() -> Self {
        Self { alpha: 1.0 }
    }
}
