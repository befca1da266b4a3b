//! Ways to find what a ray meets: Snell's own, and those it is measured against.
//!
//! The default of every choice is the one that the pictures are promised for. The others are the usual or the older
//! methods, kept to chart speed against accuracy and to show where they fail (see `docs/accuracy.md`); a picture made
//! with them may have holes and specks that the scene does not.

use crate::{choice, describe::Choice};

choice! {
    /// How the things along a ray are found; every way gives the same bits.
    pub enum Accelerator {
        /// By trees of boxes.
        #[default]
        Tree,
        /// By trees of spheres split into octants, as in 2004; see [`SphereTree`](crate::sphere_tree::SphereTree).
        SphereTree,
        /// By testing every shape and every triangle: the oracle.
        BruteForce,
    }
}

choice! {
    /// How a ray is tested against a triangle.
    pub enum TriangleTest {
        /// Sheared edge functions (Woop, Benthin, Wald 2013): no ray slips between neighbours.
        #[default]
        Sheared,
        /// Barycentric coordinates by cross products (Möller, Trumbore 1997).
        MollerTrumbore,
        /// The triangle turned into the frame of the ray and a test of signs there, as in 2004.
        RayFrame,
    }
}

choice! {
    /// How a ray is tested against a sphere.
    pub enum SphereTest {
        /// By the foot of the perpendicular from the centre, which does not cancel.
        #[default]
        Robust,
        /// By the coefficients of the quadratic as textbooks have them.
        Naive,
    }
}

choice! {
    /// The numbers in which triangles and spheres are tested; planes and boxes always are in `f64`.
    pub enum Precision {
        /// 53 bits.
        #[default]
        F64,
        /// 24 bits; secondary rays then start as much farther from their surface.
        F32,
    }
}

/// A choice of methods.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Methods {
    /// How things along a ray are found.
    pub accelerator: Accelerator,
    /// How triangles are tested.
    pub triangle: TriangleTest,
    /// How spheres are tested.
    pub sphere: SphereTest,
    /// In which numbers they are tested.
    pub precision: Precision,
}

impl core::fmt::Display for Methods {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { accelerator, triangle, sphere, precision } = self;
        write!(f, "accelerator {accelerator:?}, triangle {triangle:?}, sphere {sphere:?}, precision {precision:?}")
    }
}

impl core::str::FromStr for Methods {
    type Err = String;

    /// Reads what `Display` writes; what is not named is the default.
    fn from_str(text: &str) -> Result<Self, String> {
        let mut methods = Self::default();
        for part in text.split(',').map(str::trim) {
            let (name, word) = part.split_once(' ').unwrap_or((part, ""));
            let choice: &mut dyn Choice = match name {
                "accelerator" => &mut methods.accelerator,
                "triangle" => &mut methods.triangle,
                "sphere" => &mut methods.sphere,
                "precision" => &mut methods.precision,
                _ => return Err(format!("`{name}` is no choice of methods")),
            };
            let known = choice.words().iter().position(|known| *known == word);
            choice.choose(known.ok_or_else(|| format!("`{word}` is none of {:?}", choice.words()))?);
        }
        Ok(methods)
    }
}

impl Methods {
    /// The default methods without any tree: the oracle for them.
    pub const BRUTE_FORCE: Self = Self {
        accelerator: Accelerator::BruteForce,
        triangle: TriangleTest::Sheared,
        sphere: SphereTest::Robust,
        precision: Precision::F64,
    };

    /// Whether these are the methods that every shape has: those for which it has no other code.
    #[must_use]
    #[inline]
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// These methods if they are not the default ones.
    #[must_use]
    #[inline]
    pub fn other(&self) -> Option<&Self> {
        (!self.is_default()).then_some(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn methods_are_read_as_they_are_written() {
        let (triangle, precision) = (TriangleTest::RayFrame, Precision::F32);
        for methods in [Methods::default(), Methods::BRUTE_FORCE, Methods { triangle, precision, ..Methods::default() }]
        {
            assert_eq!(methods.to_string().parse(), Ok(methods));
        }
        assert_eq!("sphere Naive".parse(), Ok(Methods { sphere: SphereTest::Naive, ..Methods::default() }));
        for wrong in ["", "sphere", "sphere naive", "speed Fast"] {
            assert!(wrong.parse::<Methods>().is_err(), "{wrong}");
        }
    }
}
