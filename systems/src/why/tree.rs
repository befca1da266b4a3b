//! The tree of rays of one pixel, as data.

use crate::render::{Added, Dropped, Way};
use bevy_ecs::prelude::*;
use serde::{Serialize, Serializer};
use snell_components::{
    color::{Encoding, Rgb},
    describe::Choice,
    name::Name,
    written::{Line, WrittenAt},
};
use std::collections::BTreeMap;

/// How a pixel comes about: every ray, what it met, what it brings, and what was not followed.
///
/// Triples are vectors in world space, or linear light by channel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RayTree {
    /// Column, from the left.
    pub x: u32,
    /// Row, from the top.
    pub y: u32,
    /// Columns of the picture.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
    /// What the numbers of the scene's colours, and of the picture's file, mean.
    #[serde(serialize_with = "word")]
    pub encoding: Encoding,
    /// The light of the pixel: the sum of the samples' light times their shares.
    pub light: [f64; 3],
    /// The pixel as it is in the picture.
    pub pixel: [f32; 3],
    /// Each ray through the pixel with the tree that starts with it.
    pub samples: Vec<Sample>,
    /// How the samples make the pixel, in the order in which they are added; one may be added several times, or never if
    /// it was only looked at.
    pub shares: Vec<Share>,
}

/// What a sample adds to the pixel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Share {
    /// The number of the sample, in [`RayTree::samples`].
    pub sample: usize,
    /// What its light is multiplied by.
    pub share: f64,
}

/// One ray through the pixel and all that it leads to.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Sample {
    /// Its light: the sum of its contributions, in their order.
    pub light: [f64; 3],
    /// Every ray that was traced, in that order: each comes behind the one that sent it, with all that it leads to.
    pub rays: Vec<TracedRay>,
    /// All that adds to the light, in the order in which it is added.
    pub contributions: Vec<Contribution>,
}

/// One summand of a sample's light.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contribution {
    /// The number of the ray that brings it, in [`Sample::rays`].
    pub ray: usize,
    /// What it comes from.
    pub what: Added,
    /// What its light is multiplied by.
    pub weight: [f64; 3],
    /// The light.
    pub light: [f64; 3],
    /// Weight times light: what is added.
    pub amount: [f64; 3],
}

/// A ray that was traced.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TracedRay {
    /// How it came about.
    #[serde(flatten)]
    pub start: Start,
    /// How many surfaces lie between it and the camera.
    pub depth: usize,
    /// Its weight where it arrives, less what bodies on the way swallowed.
    pub weight_at_end: [f64; 3],
    /// What it met; none if nothing, so that it shows the background.
    pub met: Option<Met>,
    /// The terms of the light at the surface, in the order in which they are added.
    pub terms: Vec<Term>,
    /// Rays that were not followed from here.
    pub dropped: Vec<DroppedRay>,
}

/// How a ray came about.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Start {
    /// The number of the ray that it continues, in [`Sample::rays`].
    pub parent: Option<usize>,
    /// What sent it.
    pub way: Way,
    /// The effect that sent it, of the material where it starts.
    pub effect: Option<Thing>,
    /// Where it starts.
    pub origin: [f64; 3],
    /// Unit.
    pub direction: [f64; 3],
    /// What its light is multiplied by at the surface where it starts.
    pub share: [f64; 3],
    /// What its light is multiplied by in the pixel.
    pub weight: [f64; 3],
    /// In nanometres; none for white light.
    pub wavelength: Option<f64>,
}

/// What a ray met.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Met {
    /// The object.
    pub object: Thing,
    /// The entity that holds its material; nameless where the object has none.
    pub material: Thing,
    #[serde(skip)]
    pub(super) material_number: usize,
    /// Distance along the ray, world units.
    pub distance: f64,
    /// The point.
    pub point: [f64; 3],
    /// Geometric normal, outward, unit.
    pub normal: [f64; 3],
    /// Normal for shading, outward, unit.
    pub shading_normal: [f64; 3],
    /// Texture coordinates.
    pub uv: [f64; 2],
    /// Whether the ray comes from outside.
    pub from_outside: bool,
}

/// A term of the light at a surface.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Term {
    /// The effect, as in a scene file.
    pub effect: Thing,
    /// What the light is multiplied by; for highlights that is in the light already.
    pub factor: [f64; 3],
    /// The ambient light, or the sum over the lamps.
    pub light: [f64; 3],
    /// Factor times light: what the term adds.
    pub amount: [f64; 3],
    /// The lamps, in the order in which they are added.
    pub lamps: Vec<LampLight>,
}

/// What one lamp adds to a term.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LampLight {
    /// The lamp.
    pub lamp: Thing,
    /// What it adds.
    pub light: [f64; 3],
    /// How often it was looked at; more than once if it has an area.
    pub looks: u32,
    /// Looks at parts that do not shine here.
    pub unlit: u32,
    /// Looks from the side of the surface that faces away.
    pub facing_away: u32,
    /// Looks that something opaque ended.
    pub hidden: u32,
    /// The share that gets through, over all looks that were traced; none if none was.
    pub visible: Option<[f64; 3]>,
    /// What stands in the way of the first look that not all of the light passes.
    pub in_the_way: Vec<Thing>,
}

/// A ray that was not followed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DroppedRay {
    /// How it came about.
    #[serde(flatten)]
    pub start: Start,
    /// Why it was not followed.
    pub why: Dropped,
}

/// An entity of the scene, or one of its components.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Thing {
    /// The entity's name, if it has one.
    pub name: Option<String>,
    /// The component's tag.
    pub component: Option<&'static str>,
    /// Where it is written, once [`RayTree::locate`] was called.
    #[serde(serialize_with = "line")]
    pub line: Option<Line>,
    /// Tags of the components that may have given it, the first one that the entity has counts.
    #[serde(skip)]
    pub(super) tags: &'static [&'static str],
}

fn line<S: Serializer>(line: &Option<Line>, serializer: S) -> Result<S::Ok, S::Error> {
    line.as_ref().map(Line::to_string).serialize(serializer)
}

impl Thing {
    pub(super) fn entity(name: Option<&Name>) -> Self {
        Self { name: name.map(Name::to_string), ..Self::default() }
    }

    fn locate(&mut self, lines: &BTreeMap<&str, &WrittenAt>) {
        let Some(written) = self.name.as_deref().and_then(|name| lines.get(name)) else { return };
        // The component the line belongs to is the one to name.
        let mut tags = self.tags.iter().copied().chain(self.component);
        let found = tags.find(|tag| written.line_of(tag).is_some());
        self.component = found.or(self.component);
        self.line = found.and_then(|tag| written.line_of(tag)).or(Some(written.line())).cloned();
    }
}

impl Sample {
    /// The sum of the contributions in their order: the sample's light, to the last bit.
    #[must_use]
    pub fn sum(&self) -> Rgb {
        self.contributions.iter().fold(Rgb::ZERO, |sum, part| {
            // As the render adds them: the product is rounded, then the sum.
            sum + Rgb::from_array(part.weight) * Rgb::from_array(part.light)
        })
    }
}

impl RayTree {
    /// The sum of the samples' sums times their shares: the pixel's light, to the last bit.
    #[must_use]
    pub fn sum(&self) -> Rgb {
        let sums: Vec<_> = self.samples.iter().map(Sample::sum).collect();
        self.shares
            .iter()
            .filter_map(|share| Some(*sums.get(share.sample)? * share.share))
            .fold(Rgb::ZERO, |a, b| a + b)
    }

    /// What a sample adds to the pixel in all, as a share of its light.
    #[must_use]
    pub fn share_of(&self, sample: usize) -> f64 {
        self.shares.iter().filter(|share| share.sample == sample).map(|share| share.share).sum()
    }

    /// Fills in where everything is written, from the world that the snapshot was made of.
    pub fn locate(&mut self, world: &mut World) {
        let mut query = world.query::<(&Name, &WrittenAt)>();
        let lines: BTreeMap<&str, &WrittenAt> = query.iter(world).map(|(name, line)| (name.as_str(), line)).collect();
        self.things().for_each(|thing| thing.locate(&lines));
    }

    fn things(&mut self) -> impl Iterator<Item = &mut Thing> {
        self.samples.iter_mut().flat_map(|sample| &mut sample.rays).flat_map(|ray| {
            let met = ray.met.iter_mut().flat_map(|met| [&mut met.object, &mut met.material]);
            let terms = ray.terms.iter_mut().flat_map(|term| {
                let lamps = term.lamps.iter_mut().flat_map(|lamp| lamp.in_the_way.iter_mut().chain([&mut lamp.lamp]));
                lamps.chain([&mut term.effect])
            });
            let sent = ray.dropped.iter_mut().filter_map(|dropped| dropped.start.effect.as_mut());
            ray.start.effect.iter_mut().chain(met).chain(terms).chain(sent)
        })
    }
}

/// A word of a choice.
fn word<S: Serializer>(choice: &impl Choice, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(choice.words().get(choice.position()).copied().unwrap_or_default())
}
