//! Who is told how a pixel comes about.

use crate::{accelerate::Intersection, snapshot::Effect};
use glam::DVec3;
use serde::Serialize;
use snell_components::{color::Rgb, light::Illumination, space::Ray};

/// Told of every ray of a pixel's tree, of what it meets and brings, and of what was not followed, in the order in which
/// the light is added up. `()` is told nothing and costs nothing.
///
/// The light of a ray through the pixel is the sum, in this order, of `weight * light` over all calls of
/// [`Observer::added`] since [`Observer::sample`]; the pixel is the sum, in this order, of the light of a ray times its
/// share over all calls of [`Observer::shared`].
pub trait Observer {
    /// Whether it is told anything: what only an observer wants to know is worked out for those that are.
    const WATCHES: bool = true;

    /// The tree of another ray through the pixel begins.
    fn sample(&mut self) {}

    /// The light of a ray through the pixel, by its number from zero up, is added to the pixel times a share; a ray may
    /// be added several times.
    fn shared(&mut self, _sample: u32, _share: f64) {}

    /// A ray is to be traced, after those that are put forward later.
    fn put_forward(&mut self, _ray: &Forward<'_>) {}

    /// The ray put forward last is traced; what follows is about it.
    fn traced(&mut self, _traced: &Traced<'_>) {}

    /// A light was looked at from the point.
    fn looked(&mut self, _look: &Look<'_>) {}

    /// What a lamp, by its number, adds to a term; the mean over all looks at it.
    fn lamp(&mut self, _lamp: u32, _light: Rgb) {}

    /// A term of the light at the point: of ambient light, or the product of `factor` and the sum over the lamps told
    /// since the term before.
    fn term(&mut self, _effect: &Effect, _factor: Rgb, _light: Rgb) {}

    /// Light is added to the sum.
    fn added(&mut self, _what: Added, _weight: Rgb, _light: Rgb) {}

    /// A ray is not followed.
    fn dropped(&mut self, _ray: &Forward<'_>, _why: Dropped) {}
}

impl Observer for () {
    const WATCHES: bool = false;
}

/// How a ray came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Way {
    /// It comes from the camera.
    Camera,
    /// It was mirrored.
    Mirrored,
    /// It was let through, straight or bent.
    Transmitted,
    /// It goes on through a surface that lies inside a body that counts before its own.
    Onward,
}

/// A ray that is put forward.
#[derive(Clone, Copy, Debug)]
pub struct Forward<'a> {
    /// How it came about.
    pub way: Way,
    /// The ray, world space.
    pub ray: &'a Ray,
    /// What its light is multiplied by at the surface it starts from.
    pub share: Rgb,
    /// What its light is multiplied by in the pixel.
    pub weight: Rgb,
    /// In nanometres; none for white light.
    pub wavelength: Option<f64>,
}

/// A ray that was traced.
#[derive(Clone, Copy, Debug)]
pub struct Traced<'a> {
    /// What it met, if anything.
    pub met: Option<&'a Intersection>,
    /// Its weight less what the bodies on its way swallowed.
    pub weight: Rgb,
}

/// A look at one part of a lamp.
#[derive(Clone, Copy, Debug)]
pub struct Look<'a> {
    /// The number of the lamp.
    pub lamp: u32,
    /// Where the look starts, world space.
    pub from: DVec3,
    /// What comes from there; none if that part of the lamp does not shine here.
    pub light: Option<&'a Illumination>,
    /// The share that gets through; none if nothing was traced because the surface faces away.
    pub visible: Option<Rgb>,
}

/// What light comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Added {
    /// The surface: all terms of the light at the point.
    Surface,
    /// The background.
    Background,
    /// What a ray beyond the depth is taken to bring.
    BeyondDepth,
}

/// Why a ray is not followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Dropped {
    /// It weighs less than the cut-off.
    Cut,
    /// It would exceed the depth.
    TooDeep,
}
