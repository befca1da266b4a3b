//! Why a pixel has its colour: the tree of its rays, which adds up to it to the last bit.

mod record;
mod svg;
mod text;
mod tree;

pub use tree::{Contribution, DroppedRay, LampLight, Met, RayTree, Sample, Share, Start, Term, Thing, TracedRay};

use crate::{
    render::{Counts, pixel_observed},
    snapshot::Snapshot,
};
use record::Recorder;
use snell_components::method::Methods;

/// How the pixel in a column and row comes about.
///
/// [`RayTree::locate`] adds the lines of the scene file; `Display` shows the tree as text, [`RayTree::svg`] draws it.
#[must_use]
pub fn why(snapshot: &Snapshot, x: u32, y: u32) -> RayTree {
    let mut recorder = Recorder::new(snapshot);
    let light = pixel_observed(snapshot, x, y, &Methods::default(), &mut Counts::default(), &mut recorder);
    let (width, height) = (snapshot.settings.width, snapshot.settings.height);
    let shown = light.as_vec3();
    let pixel = if shown.is_finite() { shown.to_array() } else { [0.0; 3] };
    let (samples, shares) = recorder.finish();
    let encoding = snapshot.settings.encoding;
    RayTree { x, y, width, height, encoding, light: light.to_array(), pixel, samples, shares }
}
