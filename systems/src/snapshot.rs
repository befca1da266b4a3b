//! All that a render needs, copied out of the world: immutable, cheap to clone, independent of the world's future.

use crate::accelerate::Geometry;
use glam::DVec3;
use snell_components::{
    color::Rgb,
    light::Lamp,
    name::Name,
    settings::Settings,
    space::Ray,
    texture::{Pattern, TexturePoint},
};
use std::sync::Arc;

/// A scene as the render sees it.
#[derive(Clone)]
pub struct Snapshot {
    /// Where rays start.
    pub view: View,
    /// How the picture is taken.
    pub settings: Settings,
    /// What rays meet.
    pub geometry: Arc<Geometry>,
    /// What objects are made of.
    pub materials: Arc<Materials>,
    /// What shines.
    pub lights: Arc<Lights>,
    /// Names of the objects by rank; `None` for those without.
    pub names: Arc<Vec<Option<Name>>>,
    /// Objects that are left out of the picture, by name, with the reason.
    pub left_out: Arc<Vec<(String, String)>>,
}

/// The lights of a scene.
#[derive(Clone, Default)]
pub struct Lights {
    /// Sum of the ambient lights, linear RGB.
    pub ambient: Rgb,
    /// All others, in the order of names.
    pub lamps: Vec<Arc<dyn Lamp>>,
}

/// The materials of a scene, and which object is made of which.
#[derive(Clone, Debug, Default)]
pub struct Materials {
    /// Every material once, in the order of names; the first is the one of objects that have none.
    pub all: Vec<Material>,
    /// By rank of the object.
    pub of_object: Vec<MaterialOfObject>,
    /// Whether light passes through any material.
    pub any_transparent: bool,
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
    /// The material of an object at a surface slot; slots beyond the last have the last one's.
    #[must_use]
    #[inline]
    pub fn at(&self, object: u32, slot: u32) -> &Material {
        let index = match &self.of_object[object as usize] {
            MaterialOfObject::Whole(index) => *index,
            MaterialOfObject::Slots(slots) => slots[(slot as usize).min(slots.len() - 1)],
        };
        &self.all[index as usize]
    }
}

/// A material: the effects it has and nothing else.
#[derive(Clone, Debug)]
pub struct Material {
    /// Surface colour, linear RGB.
    pub color: Rgb,
    /// Multiplies the colour.
    pub texture: Option<Arc<dyn Pattern>>,
    /// The terms of the Whitted sum that are present.
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
    /// What lies behind, seen through the surface of a body with this index.
    Refract {
        /// Strength.
        strength: Rgb,
        /// Index inside.
        index: f64,
    },
    /// Mirror and refraction by Fresnel's equations.
    Split {
        /// What the two share.
        part: Rgb,
        /// Index inside.
        index: f64,
    },
}

impl Material {
    /// The surface colour at a point.
    #[must_use]
    #[inline]
    pub fn color_at(&self, at: &TexturePoint) -> Rgb {
        match &self.texture {
            None => self.color,
            Some(pattern) => self.color * pattern.color(at),
        }
    }

    /// Whether light passes through.
    #[must_use]
    pub fn is_transparent(&self) -> bool {
        self.effects.iter().any(|e| matches!(e, Effect::Through(_) | Effect::Refract { .. } | Effect::Split { .. }))
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
