//! All that a render needs, copied out of the world: immutable, cheap to clone, independent of the world's future.

use crate::{accelerate::Geometry, extract::Ceiling, render::Interior};
use glam::DVec3;
use snell_components::{
    color::Rgb,
    light::{Lamp, PointLight, Sampling},
    name::Name,
    settings::Settings,
    space::Ray,
    texture::Pattern,
};
use std::sync::Arc;

/// A scene as the render sees it.
#[derive(Clone)]
pub struct Snapshot {
    /// Where rays start.
    pub view: View,
    /// The clear bodies that the pinhole lies in.
    pub inside: Interior,
    /// How the picture is taken.
    pub settings: Settings,
    /// The most that rays can bring, if the settings promise an error and the scene tells a limit.
    pub ceiling: Option<Arc<Ceiling>>,
    /// What rays meet.
    pub geometry: Arc<Geometry>,
    /// The same for rays toward a light, if light passes through anything.
    pub parted: Option<Arc<Parted>>,
    /// What objects are made of.
    pub materials: Arc<Materials>,
    /// What shines.
    pub lights: Arc<Lights>,
    /// Names of the objects by rank; `None` for those without.
    pub names: Arc<Vec<Option<Name>>>,
    /// Objects that are left out of the picture, by name, with the reason.
    pub left_out: Arc<Vec<(String, String)>>,
}

/// The shapes of a scene, those that light passes through apart: what is opaque blocks a light wherever it is on the way.
pub struct Parted {
    /// Shapes that no light passes through.
    pub opaque: Geometry,
    /// Shapes that some light passes through somewhere, or that bound a medium.
    pub clear: Geometry,
}

/// The lights of a scene.
#[derive(Clone, Default)]
pub struct Lights {
    /// Sum of the ambient lights, linear RGB.
    pub ambient: Rgb,
    /// All others, in the order of names.
    pub lamps: Vec<Arc<dyn Lamp>>,
    /// Each that is a point light, beside itself: most scenes have no other, and need no call to ask them.
    pub points: Vec<Option<PointLight>>,
    /// How finely each is sampled; none for those without area.
    pub sampling: Vec<Option<Sampling>>,
    /// Names of the lamps' entities, and the tags of their components.
    pub labels: Vec<(Option<Name>, &'static str)>,
}

/// The materials of a scene, and which object is made of which.
#[derive(Clone, Debug, Default)]
pub struct Materials {
    /// Every material once, in the order of names; the first is the one of objects that have none.
    pub all: Vec<Material>,
    /// Names of the entities that hold them.
    pub names: Vec<Option<Name>>,
    /// By rank of the object.
    pub of_object: Vec<MaterialOfObject>,
    /// The clear bodies, by rank of the object; empty if there are none.
    pub media: Vec<Option<Medium>>,
    /// Whether light passes through any material.
    pub any_transparent: bool,
    /// Whether any texture asks how much of a surface a ray stands for.
    pub any_filtered: bool,
}

/// What a clear body is filled with.
#[derive(Clone, Debug, PartialEq)]
pub struct Medium {
    /// Refractive index at 587.6 nm.
    pub index: f64,
    /// Share swallowed per world unit, as `exp(−δ·R)`.
    pub absorption: Rgb,
    /// Which of overlapping bodies counts: the higher.
    pub rank: f64,
    /// How the index depends on the wavelength, if it does.
    pub spectrum: Option<Spectrum>,
}

impl Medium {
    /// Where nothing is.
    pub const VACUUM: Self = Self { index: 1.0, absorption: Rgb::ZERO, rank: f64::NEG_INFINITY, spectrum: None };

    /// The index at a wavelength in nanometres; without one, that of white light.
    #[must_use]
    pub fn index_at(&self, wavelength: Option<f64>) -> f64 {
        match (wavelength, &self.spectrum) {
            (Some(wavelength), Some(spectrum)) => spectrum.index(wavelength),
            _ => self.index,
        }
    }
}

/// How an index depends on the wavelength, and into which wavelengths white light is split.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Constant term of Cauchy's formula.
    pub a: f64,
    /// Coefficient of `1/λ²`, in square nanometres.
    pub b: f64,
    /// Wavelengths in nanometres, and how much red, green and blue each carries; together white.
    pub lines: Box<[(f64, Rgb)]>,
}

impl Spectrum {
    /// Cauchy's formula `n(λ) = A + B/λ²`.
    #[must_use]
    pub fn index(&self, wavelength: f64) -> f64 {
        self.a + self.b / (wavelength * wavelength)
    }
}

/// What one object is made of: indices into [`Materials::all`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MaterialOfObject {
    /// One material.
    Whole(u32),
    /// A material for each slot of the surface.
    Slots(Box<[u32]>),
}

impl Materials {
    /// What an object is filled with, if it is a clear body.
    #[must_use]
    #[inline]
    pub fn medium(&self, object: u32) -> Option<&Medium> {
        self.media.get(object as usize).and_then(Option::as_ref)
    }

    /// The number of the material of an object at a surface slot, in [`Materials::all`]; slots beyond the last have the last one's.
    #[must_use]
    #[inline]
    pub fn number_at(&self, object: u32, slot: u32) -> usize {
        match &self.of_object[object as usize] {
            MaterialOfObject::Whole(index) => *index as usize,
            MaterialOfObject::Slots(slots) => slots[(slot as usize).min(slots.len() - 1)] as usize,
        }
    }

    /// The material of an object at a surface slot; slots beyond the last have the last one's.
    #[must_use]
    #[inline]
    pub fn at(&self, object: u32, slot: u32) -> &Material {
        &self.all[self.number_at(object, slot)]
    }
}

/// A material: the effects it has and nothing else.
#[derive(Clone, Debug)]
pub struct Material {
    /// Surface colour, linear RGB.
    pub color: Rgb,
    /// Multiplies the colour.
    pub texture: Option<Arc<dyn Pattern>>,
    /// The terms of the Whitted sum that are present: light at the point, then rays that go on.
    pub effects: Box<[Effect]>,
}

/// One term of the Whitted sum, its strength per channel not zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Effect {
    /// Ambient light times the surface colour.
    Ambient(Rgb),
    /// Lambert's reflection of every light that is not hidden.
    Diffuse(Rgb),
    /// Lambert's reflection and Phong's highlight of every light that is not hidden.
    Glossy {
        /// Of the reflection; may be zero.
        diffuse: Rgb,
        /// Of the highlight.
        highlight: Rgb,
        /// How small the highlight is.
        exponent: f64,
    },
    /// What the mirror ray brings.
    Mirror(Rgb),
    /// What lies straight behind.
    Through(Rgb),
    /// What lies behind, seen through the surface of a clear body.
    Refract(Rgb),
    /// Mirror and refraction at the surface of a clear body, which share this by Fresnel's equations.
    Split(Rgb),
}

impl Effect {
    /// Whether the term is light at the point, not a ray that goes on.
    #[must_use]
    #[inline]
    pub fn is_light(&self) -> bool {
        matches!(self, Self::Ambient(_) | Self::Diffuse(_) | Self::Glossy { .. })
    }
}

impl Material {
    /// Whether the texture asks how much of the surface a ray stands for.
    #[must_use]
    pub fn is_filtered(&self) -> bool {
        self.texture.as_ref().is_some_and(|texture| texture.filters())
    }

    /// Whether rays go on from the surface.
    #[must_use]
    pub fn goes_on(&self) -> bool {
        self.effects.last().is_some_and(|effect| !effect.is_light())
    }

    /// The term of the rays that go on, if there is one alone.
    #[must_use]
    #[inline]
    pub fn alone_goes_on(&self) -> Option<&Effect> {
        match &*self.effects {
            [alone] | [.., Effect::Ambient(_) | Effect::Diffuse(_) | Effect::Glossy { .. }, alone] => {
                (!alone.is_light()).then_some(alone)
            }
            _ => None,
        }
    }

    /// Whether light passes through.
    #[must_use]
    pub fn is_transparent(&self) -> bool {
        self.effects.iter().any(|e| matches!(e, Effect::Through(_) | Effect::Refract(_) | Effect::Split(_)))
    }
}

/// The camera as the render sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The pinhole, world space.
    pub eye: DVec3,
    /// To the right in the picture, one screen height long, world space.
    pub right: DVec3,
    /// Up in the picture, one screen height long, world space.
    pub up: DVec3,
    /// From the pinhole to the middle of the screen, world space.
    pub forward: DVec3,
}

impl View {
    /// The ray through a point of a picture of `width` by `height` pixels, `x` to the right and `y` down from its upper
    /// left corner, in pixels.
    #[must_use]
    pub fn ray(&self, x: f64, y: f64, width: u32, height: u32) -> Ray {
        let (width, height) = (f64::from(width), f64::from(height));
        let right = (x - 0.5 * width) / height;
        let up = (0.5 * height - y) / height;
        let direction = self.right * right + self.up * up + self.forward;
        Ray { origin: self.eye, direction: direction.normalize() }
    }
}
