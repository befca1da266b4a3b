//! The order of everything, and the doors for shapes, lights and textures from outside.

use crate::{
    accelerate::{self, Scenery},
    extract::{self, SceneError},
    load::{self, Faults, Notice},
    registry::{Kind, Registry},
    snapshot::Snapshot,
    transform,
};
use bevy_ecs::{
    prelude::*,
    schedule::{LogLevel, ScheduleBuildSettings, ScheduleLabel, SingleThreadedExecutor},
};
use snell_components::{
    camera::Camera,
    describe::Describe,
    figure::{HeightField, Lathe, SphereFlake, TriangleField},
    hidden::Hidden,
    light::{AmbientLight, ConeLight, DirectionalLight, DiskLight, Light, PointLight},
    material::{
        Absorption, Ambient, Color, Dielectric, Diffuse, Dispersion, Highlight, MediumRank, Mirror, Opacity,
        Refraction, Transmission,
    },
    primitive::Primitive,
    settings::Settings,
    shape::{Cone, Cuboid, Cylinder, Mesh, Plane, Sphere, Triangle},
    texture::{Checker, ImageTexture, Texture},
    transform::{GlobalTransform, Transform},
};
use std::{path::Path, sync::Arc};

/// The schedule that turns the world into a snapshot.
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
pub struct Prepare;

/// The stages of [`Prepare`], in order.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stage {
    /// Placements become matrices in the world.
    Transform,
    /// What was made of components that are gone is taken away.
    Unpack,
    /// Shapes and lights take the form that rays meet.
    Pack,
    /// Bounding spheres are written and the tree over all shapes is built.
    Accelerate,
    /// What a render needs is copied out of the world.
    Extract,
}

/// A world of entities and the schedule that turns it into a [`Snapshot`].
///
/// Everything in the world may be changed between snapshots; only what changed is done again.
pub struct Renderer {
    /// Objects, materials, lights and the camera, as entities.
    pub world: World,
    schedule: Schedule,
}

/// What [`Renderer::new`] knows beyond [`Renderer::bare`], in any order: it means nothing to a picture.
pub const BUILT_IN: [fn(Renderer) -> Renderer; 17] = [
    Renderer::with_primitive::<Sphere>,
    Renderer::with_primitive::<Plane>,
    Renderer::with_primitive::<Cuboid>,
    Renderer::with_primitive::<Cone>,
    Renderer::with_primitive::<Cylinder>,
    Renderer::with_primitive::<Triangle>,
    Renderer::with_primitive::<Mesh>,
    Renderer::with_primitive::<Lathe>,
    Renderer::with_primitive::<HeightField>,
    Renderer::with_primitive::<TriangleField>,
    Renderer::with_primitive::<SphereFlake>,
    Renderer::with_light::<PointLight>,
    Renderer::with_light::<DirectionalLight>,
    Renderer::with_light::<ConeLight>,
    Renderer::with_light::<DiskLight>,
    Renderer::with_texture::<ImageTexture>,
    Renderer::with_texture::<Checker>,
];

impl Default for Renderer {
    fn default() -> Self {
        Self::new()
    }
}

impl Renderer {
    /// An empty world that knows the built-in shapes, lights, textures and effects.
    #[must_use]
    pub fn new() -> Self {
        BUILT_IN.iter().fold(Self::bare(), |renderer, add| add(renderer))
    }

    /// An empty world that knows effects and ambient light, but no shape, no other light and no texture: for those who
    /// choose from [`BUILT_IN`] or bring their own.
    #[must_use]
    pub fn bare() -> Self {
        let mut world = World::new();
        world.init_resource::<Registry>();
        world.init_resource::<Settings>();
        world.init_resource::<transform::ScenePlacement>();
        world.init_resource::<Scenery>();
        world.init_resource::<extract::Parts>();
        world.init_resource::<extract::Outcome>();

        let mut schedule = Schedule::new(Prepare);
        schedule.set_executor(SingleThreadedExecutor::new());
        // An order between two systems that matters must be written down.
        schedule
            .set_build_settings(ScheduleBuildSettings { ambiguity_detection: LogLevel::Error, ..Default::default() });
        schedule
            .configure_sets((Stage::Transform, Stage::Unpack, Stage::Pack, Stage::Accelerate, Stage::Extract).chain());
        schedule.add_systems((
            (transform::propagate, transform::place_scene).in_set(Stage::Transform),
            accelerate::build.in_set(Stage::Accelerate),
            (extract::gather_lights, extract::gather_materials, extract::extract).chain().in_set(Stage::Extract),
        ));

        let mut this = Self { world, schedule };
        this.register::<Transform>(Kind::Placement);
        this.register::<Hidden>(Kind::Visibility);
        this.register::<Camera>(Kind::Camera);
        this.world.register_required_components::<Camera, Transform>();
        this.world.register_required_components::<Transform, GlobalTransform>();
        this.register::<AmbientLight>(Kind::Light);
        this.register::<Color>(Kind::Effect);
        this.register::<Ambient>(Kind::Effect);
        this.register::<Diffuse>(Kind::Effect);
        this.register::<Highlight>(Kind::Effect);
        this.register::<Mirror>(Kind::Effect);
        this.register::<Transmission>(Kind::Effect);
        this.register::<Refraction>(Kind::Filling);
        this.register::<Dielectric>(Kind::Effect);
        this.register::<Opacity>(Kind::Effect);
        this.register::<Absorption>(Kind::Filling);
        this.register::<Dispersion>(Kind::Filling);
        this.register::<MediumRank>(Kind::Filling);
        this
    }

    /// Teaches the renderer a kind of shape: from here on scenes may name it and rays meet it.
    ///
    /// # Panics
    /// If its tag is taken.
    #[must_use]
    pub fn with_primitive<P: Primitive>(mut self) -> Self {
        self.register::<P>(Kind::Shape);
        self.world.register_required_components::<P, Transform>();
        // Types of shapes touch separate components and pools, so their order among each other means nothing.
        self.schedule.add_systems(accelerate::unpack::<P>.in_set(Stage::Unpack).ambiguous_with(Stage::Unpack));
        let systems = (accelerate::pack::<P>, accelerate::pool::<P>).chain();
        self.schedule.add_systems(systems.in_set(Stage::Pack).ambiguous_with(Stage::Pack));
        self
    }

    /// Teaches the renderer a kind of light.
    ///
    /// # Panics
    /// If its tag is taken.
    #[must_use]
    pub fn with_light<L: Light>(mut self) -> Self {
        self.register::<L>(Kind::Light);
        self.world.register_required_components::<L, Transform>();
        self.schedule.add_systems(extract::unpack_lights::<L>.in_set(Stage::Unpack).ambiguous_with(Stage::Unpack));
        self.schedule.add_systems(extract::pack_lights::<L>.in_set(Stage::Pack).ambiguous_with(Stage::Pack));
        self
    }

    /// Teaches the renderer a kind of texture.
    ///
    /// # Panics
    /// If its tag is taken.
    #[must_use]
    pub fn with_texture<T: Texture>(mut self) -> Self {
        self.register::<T>(Kind::Texture);
        self.schedule.add_systems(extract::unpack_textures::<T>.in_set(Stage::Unpack).ambiguous_with(Stage::Unpack));
        self.schedule.add_systems(extract::pack_textures::<T>.in_set(Stage::Pack).ambiguous_with(Stage::Pack));
        self
    }

    fn register<C: Describe + Component>(&mut self, kind: Kind) {
        self.world.resource_mut::<Registry>().register::<C>(kind);
    }

    /// Adds the entities of a scene file to the world and takes over its settings.
    ///
    /// # Errors
    /// Everything that is wrong with the file and the files it uses; the world is then as before.
    pub fn load(&mut self, path: impl AsRef<Path>) -> Result<Vec<Notice>, Faults> {
        load::read_scene(&mut self.world, path.as_ref())
    }

    /// Like [`Renderer::load`] for text in memory; `path` names it in messages and is where relative paths start.
    ///
    /// # Errors
    /// Everything that is wrong with the text and the files it uses; the world is then as before.
    pub fn load_text(&mut self, text: &str, path: impl AsRef<Path>) -> Result<Vec<Notice>, Faults> {
        load::read_scene_text(&mut self.world, text, path.as_ref())
    }

    /// Brings everything up to date with the world and returns what a render needs; the very same snapshot if nothing
    /// changed.
    ///
    /// # Errors
    /// What keeps the world from being rendered.
    pub fn snapshot(&mut self) -> Result<Arc<Snapshot>, SceneError> {
        self.schedule.run(&mut self.world);
        self.world.clear_trackers();
        self.world.resource::<extract::Outcome>().get()
    }

    /// The settings of the scene.
    pub fn settings(&mut self) -> Mut<'_, Settings> {
        self.world.resource_mut::<Settings>()
    }
}
