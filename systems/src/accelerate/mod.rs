//! Stages 2 and 3: shapes take the form that rays meet, get their bounding spheres, and a tree is built over them all.
//!
//! One tree holds all shapes of all types; a leaf lists runs of one type each. A run costs one dynamic call, inside
//! which the loop is compiled for the type, so an outside shape is as fast as a built-in one. A mesh is a single shape
//! here and owns a tree of its own; unbounded shapes stand beside the tree.

mod geometry;
mod pack;
mod pool;

pub use geometry::{Geometry, Intersection};
pub use pack::{Scenery, build, pack, pool, unpack};
pub use pool::{Bests, ErasedPool, Nearest, Pool};
