//! A scene of which the settings are changed for a while.

use super::Hindrance;
use crate::measure::{Candidate, Effort};
use bevy_ecs::prelude::*;
use snell_components::{
    light::DiskLight,
    name::Name,
    settings::{Antialias, Settings},
    texture::{Checker, ImageTexture},
};
use snell_systems::{pipeline::Renderer, render::Options, snapshot::Snapshot};
use std::sync::Arc;

/// A scene and its name.
pub struct Scene {
    /// What it is called in titles.
    pub name: String,
    renderer: Renderer,
}

impl Scene {
    /// A scene that was loaded or built.
    #[must_use]
    pub fn new(name: impl Into<String>, renderer: Renderer) -> Self {
        Self { name: name.into(), renderer }
    }

    /// The renderer, without what the scene named, for another scene.
    #[must_use]
    pub fn cleared(self) -> Renderer {
        let mut renderer = self.renderer;
        let world = &mut renderer.world;
        let named: Vec<Entity> = world.query_filtered::<Entity, With<Name>>().iter(world).collect();
        for entity in named {
            // It may have gone with its parent.
            let _ = world.try_despawn(entity);
        }
        *renderer.settings() = Settings::default();
        renderer
    }

    /// The settings that the scene gives.
    #[must_use]
    pub fn settings(&self) -> Settings {
        self.renderer.world.resource::<Settings>().clone()
    }

    /// Whether some light has an area.
    pub fn has_soft_lights(&mut self) -> bool {
        let mut lights = self.renderer.world.query::<&DiskLight>();
        lights.iter(&self.renderer.world).any(|light| light.radius > 0.0)
    }

    /// Whether some texture can be filtered.
    pub fn has_textures(&mut self) -> bool {
        let mut textures = self.renderer.world.query_filtered::<(), Or<(With<ImageTexture>, With<Checker>)>>();
        textures.iter(&self.renderer.world).next().is_some()
    }

    /// The scene as small as the effort asks for, with a change; the scene itself stays as it is.
    ///
    /// # Errors
    /// What keeps the scene from being rendered.
    pub fn with(&mut self, effort: Effort, change: impl FnOnce(&mut World)) -> Result<Arc<Snapshot>, Hindrance> {
        self.at_its_size(|world| {
            let small = &mut *world.resource_mut::<Settings>();
            let height = f64::from(effort.width) * f64::from(small.height) / f64::from(small.width);
            (small.width, small.height) = (effort.width, height.round().max(1.0) as u32);
            change(world);
        })
    }

    /// The scene as large as it says, with a change; the scene itself stays as it is.
    ///
    /// # Errors
    /// What keeps the scene from being rendered.
    pub fn at_its_size(&mut self, change: impl FnOnce(&mut World)) -> Result<Arc<Snapshot>, Hindrance> {
        let world = &mut self.renderer.world;
        let settings = world.resource::<Settings>().clone();
        let lights = saved::<DiskLight>(world);
        let images = saved::<ImageTexture>(world);
        let checkers = saved::<Checker>(world);
        change(world);
        let snapshot = self.renderer.snapshot();
        let world = &mut self.renderer.world;
        *world.resource_mut::<Settings>() = settings;
        restore(world, lights);
        restore(world, images);
        restore(world, checkers);
        Ok(snapshot?)
    }

    /// A candidate with changed settings.
    ///
    /// # Errors
    /// What keeps the scene from being rendered.
    pub fn candidate(
        &mut self,
        effort: Effort,
        group: &str,
        label: impl Into<String>,
        change: impl FnOnce(&mut Settings),
    ) -> Result<Candidate, Hindrance> {
        let snapshot = self.with(effort, |world| change(&mut world.resource_mut::<Settings>()))?;
        let (group, label) = (group.into(), label.into());
        Ok(Candidate { group, label, default: false, snapshot, options: Options::default() })
    }

    /// The scene as converged as can be waited for: many rays to a pixel, each with a few samples of every light, and
    /// nothing cut that could add more than a tenth of what eight bits show.
    ///
    /// # Errors
    /// What keeps the scene from being rendered.
    pub fn converged(&mut self, effort: Effort) -> Result<Arc<Snapshot>, Hindrance> {
        self.with(effort, |world| {
            converge_lights(world, 48);
            let settings = &mut *world.resource_mut::<Settings>();
            (settings.antialias, settings.grid) = (Antialias::Grid, if effort.quick { 8 } else { 16 });
            cut_nothing_visible(settings);
        })
    }
}

/// Cuts by the weight alone, at a weight that shows nowhere: the error of a setting would loosen the lights, too.
pub(super) fn cut_nothing_visible(settings: &mut Settings) {
    (settings.cutoff, settings.error) = (1e-5, 0.0);
}

/// Takes exactly so many samples of every light with an area.
pub(super) fn converge_lights(world: &mut World, samples: u32) {
    for mut light in world.query::<&mut DiskLight>().iter_mut(world) {
        (light.error, light.samples) = (0.0, samples);
    }
}

fn saved<C: Component + Clone>(world: &mut World) -> Vec<(Entity, C)> {
    world.query::<(Entity, &C)>().iter(world).map(|(entity, component)| (entity, component.clone())).collect()
}

/// Puts back what differs, so that what did not change is not packed again.
fn restore<C: Component<Mutability = bevy_ecs::component::Mutable>>(world: &mut World, saved: Vec<(Entity, C)>) {
    for (entity, component) in saved {
        if let Some(mut place) = world.get_mut::<C>(entity) {
            *place = component;
        }
    }
}
