//! Stage 5: the Whitted trace, in parallel over tiles of the picture.
//!
//! A pixel is a pure function of the snapshot and its coordinates, so neither the number of threads nor the size or
//! order of tiles nor the region can change a bit of it.

mod ahead;
mod antialias;
mod area;
mod arrive;
mod block;
mod budget;
mod corners;
mod counts;
mod footprint;
mod interior;
mod lamps;
mod observe;
mod onward;
mod optics;
mod part;
mod picture;
mod point;
mod rows;
mod sampler;
mod shade;
mod split;
mod through;
mod tile;
mod trace;
mod view_rays;
mod wave;
mod within_error;

pub use counts::Counts;
pub use interior::Interior;
pub use observe::{Added, Dropped, Forward, Look, Observer, Traced, Way};
pub(crate) use onward::beyond_depth;
pub use optics::{fresnel, reflect, refract};
pub use picture::{Picture, Region};
pub use sampler::Key;
pub use tile::{Frame, OnTile, Options, Progress, Stop, Tile, render};
pub use trace::{pixel, pixel_observed};
