//! Scenes made in code: as a scene file reads, entity by entity.

use crate::pipeline::Renderer;
use bevy_ecs::prelude::*;
use glam::DVec3;
use snell_components::{
    material::MadeOf,
    name::Name,
    transform::{Step, Transform},
};
use std::sync::Arc;

impl Renderer {
    /// Adds an entity: its name and its components, as in a scene file. Where it is and what it is made of may follow.
    ///
    /// ```
    /// use snell_components::{light::DirectionalLight, material::{Color, Diffuse}, camera::Camera, shape::Sphere};
    /// use snell_systems::pipeline::Renderer;
    ///
    /// let mut scene = Renderer::new();
    /// scene.add("camera", Camera::at([0.0, 2.0, 6.0]).looking_at([0.0, 0.5, 0.0]));
    /// scene.add("sun", DirectionalLight::along([-1.0, -2.0, -1.0]));
    /// let clay = scene.add("clay", (Color::srgb(0xc06040), Diffuse::grey(0.9))).id();
    /// scene.add("ball", Sphere { radius: 0.5 }).at([0.0, 0.5, 0.0]).made_of(clay);
    /// scene.set_size(64, 48);
    /// assert!(scene.snapshot().is_ok());
    /// ```
    ///
    /// It is an entity of [`Renderer::world`] like any other. Names should differ: the order of everything follows them.
    pub fn add(&mut self, name: impl Into<Arc<str>>, components: impl Bundle) -> Added<'_> {
        Added(self.world.spawn((Name::new(name), components)))
    }

    /// Sets the size of the picture, in pixels.
    pub fn set_size(&mut self, width: u32, height: u32) {
        let mut settings = self.settings();
        (settings.width, settings.height) = (width, height);
    }
}

/// An entity that was added: more can be said of it.
pub struct Added<'w>(EntityWorldMut<'w>);

impl Added<'_> {
    /// The entity.
    #[must_use = "for what is made of it or lies in its space"]
    pub fn id(self) -> Entity {
        self.0.id()
    }

    /// More components, each in place of the one of its type.
    pub fn with(mut self, components: impl Bundle) -> Self {
        self.0.insert(components);
        self
    }

    /// Made of a material: the entity that holds it.
    pub fn made_of(self, material: Entity) -> Self {
        self.with(MadeOf(material))
    }

    /// Placed in the space of another entity.
    pub fn within(self, parent: Entity) -> Self {
        self.with(ChildOf(parent))
    }

    /// Moved, after the steps so far; the parent's units.
    pub fn at(self, position: impl Into<DVec3>) -> Self {
        self.step(Step::Translate(position.into()))
    }

    /// Turned about an axis through the origin, after the steps so far; degrees, counter-clockwise seen against the axis.
    pub fn turned(self, axis: impl Into<DVec3>, degrees: f64) -> Self {
        self.step(Step::Rotate { axis: axis.into(), degrees })
    }

    /// Scaled about the origin, after the steps so far.
    pub fn scaled(self, by: f64) -> Self {
        self.step(Step::Scale(DVec3::splat(by)))
    }

    /// A further step of the placement.
    pub fn step(mut self, step: Step) -> Self {
        self.0.entry::<Transform>().or_default().get_mut().0.push(step);
        self
    }
}
