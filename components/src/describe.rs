//! One description of a component's fields, for scene files, editors and bindings.
//!
//! A component names each of its fields once, with its range and meaning; whoever visits the description reads, writes
//! or shows the fields without knowing the type. `#[derive(Describe)]` makes it of the struct: its types, the doc comments
//! of its fields, and attributes for what holds for them; see [`snell_derive`].

use crate::{asset::Asset, color::Rgb, shape::TriangleMesh, texture::Image, transform::Step};
use glam::{DVec2, DVec3};
use smallvec::SmallVec;

pub use snell_derive::Describe;

/// A component with named fields.
///
/// `Default` gives the value of every field that a scene may leave out.
pub trait Describe: Default + Clone {
    /// The component's tag in a scene file, unique among registered components.
    const TAG: &'static str;

    /// Shows each field to `fields`, always all of them and in the same order.
    fn describe(&mut self, fields: &mut dyn FieldVisitor);

    /// Checks what no single field shows, after the fields were read.
    ///
    /// # Errors
    /// The fault, at one of the fields.
    fn check(&self) -> Result<(), Fault> {
        Ok(())
    }
}

/// A fault between fields: which field to point at, and what was expected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Name of a described field.
    pub field: &'static str,
    /// What was expected, to follow the word "expected".
    pub expected: String,
}

impl Fault {
    /// A fault at `field`.
    pub fn new(field: &'static str, expected: impl Into<String>) -> Self {
        Self { field, expected: expected.into() }
    }
}

/// The place of one field's value, by kind.
#[derive(Debug)]
pub enum Value<'a> {
    /// A finite number.
    Number(&'a mut f64),
    /// A finite number that may be left out.
    OptionalNumber(&'a mut Option<f64>),
    /// A whole number.
    Integer(&'a mut u32),
    /// True or false.
    Bool(&'a mut bool),
    /// Three finite numbers.
    Vector(&'a mut DVec3),
    /// Three finite numbers that may be left out.
    OptionalVector(&'a mut Option<DVec3>),
    /// Any count of three finite numbers each.
    Vectors(&'a mut Vec<DVec3>),
    /// Any count of two finite numbers each.
    Vectors2(&'a mut Vec<DVec2>),
    /// One number for all channels, three numbers of linear light, or sRGB `"#rrggbb"`.
    Color(&'a mut Rgb),
    /// One of a few words.
    Choice(&'a mut dyn Choice),
    /// Steps of a placement, applied in the written order.
    Steps(&'a mut SmallVec<[Step; 4]>),
    /// A model file.
    Model(&'a mut Asset<TriangleMesh>),
    /// An image file.
    Image(&'a mut Asset<Image>),
}

/// A value that is one of a few words; made by [`choice!`](crate::choice).
pub trait Choice: core::fmt::Debug {
    /// All words, in order.
    fn words(&self) -> &'static [&'static str];

    /// The position of this word.
    fn position(&self) -> usize;

    /// Becomes the word at a position; stays as it is if there is none.
    fn choose(&mut self, position: usize);
}

/// Declares an enum whose variants are the words of a [`Choice`]; one is marked `#[default]`.
///
/// ```
/// use snell_components::{choice, describe::Choice};
///
/// choice! {
///     /// Which way up.
///     pub enum Side {
///         /// Head.
///         #[default]
///         Head,
///         /// Tail.
///         Tail,
///     }
/// }
/// let mut side = Side::default();
/// side.choose(1);
/// assert_eq!((side, side.words()), (Side::Tail, ["Head", "Tail"].as_slice()));
/// ```
#[macro_export]
macro_rules! choice {
    (
        $(#[$meta:meta])*
        $visibility:vis enum $name:ident { $($(#[$variant_meta:meta])* $variant:ident),+ $(,)? }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        $visibility enum $name { $($(#[$variant_meta])* $variant),+ }

        impl $name {
            /// All words, in order.
            pub const WORDS: &'static [&'static str] = &[$(stringify!($variant)),+];
            const ALL: &'static [Self] = &[$(Self::$variant),+];
        }

        impl $crate::describe::Choice for $name {
            fn words(&self) -> &'static [&'static str] {
                Self::WORDS
            }

            fn position(&self) -> usize {
                *self as usize
            }

            fn choose(&mut self, position: usize) {
                if let Some(choice) = Self::ALL.get(position) {
                    *self = *choice;
                }
            }
        }
    };
}

/// Who reads, writes or shows the fields of a component.
pub trait FieldVisitor {
    /// Visits one field.
    fn field(&mut self, name: &'static str, value: Value<'_>, spec: Spec);
}

/// The numbers a field may hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Lower limit.
    pub min: f64,
    /// Upper limit.
    pub max: f64,
    /// Whether `min` itself is allowed.
    pub min_inclusive: bool,
}

impl Range {
    /// Whether `x` is finite and within the limits.
    #[must_use]
    pub fn contains(&self, x: f64) -> bool {
        x.is_finite() && x <= self.max && if self.min_inclusive { x >= self.min } else { x > self.min }
    }
}

/// What holds for a field: its range, whether it must be given, and what it means.
#[derive(Clone, Copy, Debug)]
pub struct Spec {
    /// Limits of every number in the field.
    pub range: Range,
    /// Whether a scene must give the field.
    pub required: bool,
    /// Whether the vector must differ from zero.
    pub nonzero: bool,
    /// Meaning and unit, a short phrase.
    pub about: &'static str,
}

impl Spec {
    /// Any finite number.
    #[must_use]
    pub const fn any(about: &'static str) -> Self {
        let range = Range { min: f64::MIN, max: f64::MAX, min_inclusive: true };
        Self { range, required: false, nonzero: false, about }
    }

    /// Numbers from `min` to `max`, both allowed.
    #[must_use]
    pub const fn within(min: f64, max: f64, about: &'static str) -> Self {
        let range = Range { min, max, min_inclusive: true };
        Self { range, required: false, nonzero: false, about }
    }

    /// Zero or more.
    #[must_use]
    pub const fn not_negative(about: &'static str) -> Self {
        Self::within(0.0, f64::MAX, about)
    }

    /// More than zero.
    #[must_use]
    pub const fn positive(about: &'static str) -> Self {
        let range = Range { min: 0.0, max: f64::MAX, min_inclusive: false };
        Self { range, required: false, nonzero: false, about }
    }

    /// Numbers up to `max`, itself allowed.
    #[must_use]
    pub const fn at_most(self, max: f64) -> Self {
        Self { range: Range { max, ..self.range }, ..self }
    }

    /// The field must be given.
    #[must_use]
    pub const fn required(self) -> Self {
        Self { required: true, ..self }
    }

    /// The vector must have a direction.
    #[must_use]
    pub const fn nonzero(self) -> Self {
        Self { nonzero: true, ..self }
    }
}
