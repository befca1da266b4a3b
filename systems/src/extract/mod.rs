//! Stage 4: what a render needs is copied out of the world.
//!
//! Each part of the [`Snapshot`] is kept and made again only when what it shows changed.

mod ceiling;
mod error;
mod lights;
mod materials;
mod spectrum;
mod view;

pub use ceiling::Ceiling;
pub use error::SceneError;
pub use lights::{PackedLamps, gather_lights, pack_lights, unpack_lights};
pub use materials::{PackedTexture, gather_materials, pack_textures, unpack_textures};

use crate::{
    accelerate::Scenery,
    render::{Interior, beyond_depth},
    snapshot::{Lights, Materials, Parted, Snapshot},
};
use bevy_ecs::prelude::*;
use snell_components::{camera::Camera, name::Name, settings::Settings, transform::GlobalTransform};
use std::{collections::BTreeSet, sync::Arc};

/// The parts of the snapshot that are kept from one to the next.
#[derive(Resource, Default)]
pub struct Parts {
    /// What objects are made of.
    pub materials: Arc<Materials>,
    /// The shapes, those that light passes through apart, if there are any.
    pub parted: Option<Arc<Parted>>,
    /// What shines.
    pub lights: Arc<Lights>,
}

/// The latest snapshot, or why there is none.
#[derive(Resource)]
pub struct Outcome(Result<Arc<Snapshot>, SceneError>);

impl Default for Outcome {
    fn default() -> Self {
        Self(Err(SceneError::no_camera()))
    }
}

impl Outcome {
    /// The latest snapshot.
    ///
    /// # Errors
    /// What keeps the world from being rendered.
    pub fn get(&self) -> Result<Arc<Snapshot>, SceneError> {
        self.0.clone()
    }
}

/// Puts the parts together when any of them changed.
pub fn extract(
    scenery: Res<Scenery>,
    parts: Res<Parts>,
    settings: Res<Settings>,
    cameras: Query<(Option<&Name>, Ref<Camera>, Ref<GlobalTransform>)>,
    mut removed: RemovedComponents<Camera>,
    mut unnamed: RemovedComponents<Name>,
    names: Query<(Entity, &Name)>,
    renamed: Query<(), Changed<Name>>,
    mut outcome: ResMut<Outcome>,
) {
    let camera_changed = cameras.iter().any(|(_, camera, placed)| camera.is_changed() || placed.is_changed());
    let resources_changed = scenery.is_changed() || parts.is_changed() || settings.is_changed();
    // All are read, so that nothing is seen again next time.
    let removed = removed.read().count() + unnamed.read().count();
    if !camera_changed && removed == 0 && !resources_changed && renamed.is_empty() {
        return;
    }
    outcome.0 = (|| {
        let mut seen = BTreeSet::new();
        if let Some((_, name)) = names.iter().find(|(_, name)| !seen.insert(*name)) {
            return Err(SceneError::duplicate_name(name));
        }
        let mut found: Vec<_> = cameras.iter().collect();
        let (_, camera, placed) = match found.len() {
            1 => found.remove(0),
            0 => return Err(SceneError::no_camera()),
            _ => return Err(SceneError::several_cameras(found.iter().map(|(name, ..)| *name))),
        };
        let name_of = |entity: Entity| names.get(entity).ok().map(|(_, name)| name.clone());
        let shown = |entity: Entity| name_of(entity).map_or_else(|| format!("{entity}"), |name| name.to_string());
        let mut left_out: Vec<_> = scenery.left_out.iter().map(|(entity, why)| (shown(*entity), why.clone())).collect();
        left_out.sort();
        let view = view::view(&camera, &placed.0)?;
        // Only a render that promises an error needs it.
        let ceiling = || {
            let beyond_depth = beyond_depth(settings.background);
            Ceiling::of(&settings, &parts.materials, &parts.lights, beyond_depth).map(Arc::new)
        };
        let ceiling = if settings.error > 0.0 { ceiling() } else { None };
        let inside = Interior::around(view.eye, &scenery.geometry, &parts.materials);
        Ok(Arc::new(Snapshot {
            view,
            inside,
            settings: settings.clone(),
            ceiling,
            geometry: scenery.geometry.clone(),
            parted: parts.parted.clone(),
            materials: parts.materials.clone(),
            lights: parts.lights.clone(),
            names: Arc::new(scenery.objects.iter().map(|entity| name_of(*entity)).collect()),
            left_out: Arc::new(left_out),
        }))
    })();
}
