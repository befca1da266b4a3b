//! A suite for shapes, lights and patterns: whether a [`Primitive`], a [`Light`] or a [`Texture`] keeps its contract.
//!
//! ```
//! use snell_components::shape::Sphere;
//! use snell_systems::conformance::{Form, check};
//!
//! check(&[Sphere { radius: 1.0 }, Sphere { radius: 0.2 }], Form::Closed).assert();
//! ```
//!
//! Every shape is tried as it is, small, large, far away, mirrored and sheared. What is checked:
//!
//! | check | what must hold |
//! |---|---|
//! | `pack` | bounds are finite and in order |
//! | `bounds` | every hit lies within them |
//! | `nearest` | `hit` equals `hit_with` without a tree bit for bit, and nothing nearer is hit with any lower limit |
//! | `blocks` | `blocks` agrees with `hit` |
//! | `packet` | rays in a packet hit and are blocked as each is alone, to the last bit |
//! | `surface` | the point is where the ray is, within its stated error; normals have length 1 |
//! | `normal` | the normal is that of the hits nearby, by finite differences |
//! | `departure` | a ray that leaves the surface does not meet it where it starts |
//! | `parity` | for closed shapes: a ray enters and leaves in turn, outward normals tell which |
//! | `leak` | for closed shapes: no ray from inside gets out unseen, none slips through at a silhouette |
//! | `placement` | scaled or moved, the shape is hit at the scaled or moved place |
//! | `ends` | every answer comes: none takes a minute |
//! | `extremes` | the least and greatest values of every number give a shape, or an error, never a panic |
//! | `text` | its fields can be read from a scene file as they were written |
//! | `faults` | misspelt, missing and wrong fields are told with their place |
//!
//! [`check_light`] and [`check_texture`] try lights and patterns at points near and far; `text`, `faults` and `ends` are
//! checked as for shapes, and:
//!
//! | check | what must hold |
//! |---|---|
//! | `light` | light comes from somewhere, and no channel is less than zero or not a number |
//! | `pattern` | the same of colours |
//! | `brightest` | nothing is brighter than is told |
//! | `repeatable` | the same question has the same answer |
//! | `placement` | a light that is moved and turned gives the same light at the points moved and turned |
//! | `footprint` | a colour that depends on the footprint says so |

mod case;
mod closed;
mod fields;
mod geometry;
mod shades;
mod watch;

use crate::registry::Kind;
use case::Case;
use snell_components::{describe::Describe, light::Light, primitive::Primitive, texture::Texture};
use std::fmt;
use watch::{PATIENCE, Watch, watched};

/// Whether a shape has an inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The surface encloses a body; normals point out of it.
    Closed,
    /// It does not.
    Open,
}

/// Where a shape breaks its contract; empty if nowhere.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[must_use]
pub struct Report {
    /// At most one for each check, shape and placement.
    pub failures: Vec<Failure>,
}

/// A check that failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// The check, as in the table of [the module](self).
    pub check: &'static str,
    /// Which of the shapes, and its placement.
    pub shape: String,
    /// What is wrong, with the ray that shows it.
    pub what: String,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({}): {}", self.check, self.shape, self.what)
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for failure in &self.failures {
            writeln!(f, "{failure}")?;
        }
        write!(f, "{} checks failed", self.failures.len())
    }
}

impl Report {
    /// Passes if nothing failed.
    ///
    /// # Panics
    /// If something failed, with all of it.
    #[track_caller]
    pub fn assert(&self) {
        assert!(self.failures.is_empty(), "the shape breaks its contract:\n{self}");
    }

    /// Whether a check failed.
    #[must_use]
    pub fn has(&self, check: &str) -> bool {
        self.failures.iter().any(|failure| failure.check == check)
    }

    fn add(&mut self, check: &'static str, shape: &str, what: impl Into<String>) {
        if !self.failures.iter().any(|known| known.check == check && known.shape == shape) {
            self.failures.push(Failure { check, shape: shape.into(), what: what.into() });
        }
    }
}

/// Checks shapes of one type; give as many as differ in what may go wrong.
pub fn check<P: Primitive + Clone>(shapes: &[P], form: Form) -> Report {
    let shapes = shapes.to_vec();
    watched(PATIENCE, move |watch| check_all(&shapes, form, watch))
}

fn check_all<P: Primitive + Clone>(shapes: &[P], form: Form, watch: &Watch) -> Report {
    let mut report = Report::default();
    for (number, shape) in shapes.iter().enumerate() {
        let name = name::<P>(number, shapes.len());
        let cases = Case::all(shape, &name, watch, &mut report);
        for case in &cases {
            geometry::check(case, &mut report);
            if form == Form::Closed {
                closed::check(case, &mut report);
            }
        }
        geometry::check_placements(&cases, &mut report);
        fields::check(shape, &name, watch, &mut report);
    }
    report
}

/// What one of several is called.
fn name<D: Describe>(number: usize, of: usize) -> String {
    if of == 1 { D::TAG.to_owned() } else { format!("{} {}", D::TAG, number + 1) }
}

/// Checks lights of one type, which shine somewhere near the origin.
pub fn check_light<L: Light>(lights: &[L]) -> Report {
    let lights = lights.to_vec();
    watched(PATIENCE, move |watch| {
        let mut report = Report::default();
        for (number, light) in lights.iter().enumerate() {
            let name = name::<L>(number, lights.len());
            shades::check_light(light, &name, watch, &mut report);
            fields::check_text(light, Kind::Light, &name, &mut report);
        }
        report
    })
}

/// Checks patterns of one type.
pub fn check_texture<T: Texture>(textures: &[T]) -> Report {
    let textures = textures.to_vec();
    watched(PATIENCE, move |watch| {
        let mut report = Report::default();
        for (number, texture) in textures.iter().enumerate() {
            let name = name::<T>(number, textures.len());
            shades::check_texture(texture, &name, watch, &mut report);
            fields::check_text(texture, Kind::Texture, &name, &mut report);
        }
        report
    })
}
