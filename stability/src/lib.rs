//! The stability suite: every way in which a ray tracer is known to fail, with the usual method that fails beside the
//! one that Snell uses.
//!
//! A [`Case`] tries one thing many times with fixed seeds against an oracle that is exact, of higher precision, or a
//! matter of topology. It gives a [`Row`] per method and cell, and says of each whether it must hold
//! ([`Expected::Sound`]), must fail ([`Expected::Failing`], which shows that the check can), or is there to be seen.
//! The same cases run in the tests, a hundred thousand tries a cell, and by `snell stability --deep`, ten million.
//!
//! | module | holds |
//! |---|---|
//! | [`suite`] | cases, rows, running them |
//! | [`report`] , [`picture`] | the table as Markdown and JSON, the picture of failure rates |
//! | `cases` | one file per family of the catalogue |
//! | `kernels` | methods that fail and are not selectable in the renderer |
//! | `exact` | integers and double-doubles, the oracles |

mod cases;
mod exact;
mod kernels;
mod meshes;
pub mod picture;
mod random;
pub mod report;
pub mod suite;

pub use suite::{Case, Expected, Outcome, Row, Size, cases};
