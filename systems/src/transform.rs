//! Stage 1: placements become matrices in the world.

use bevy_ecs::prelude::*;
use glam::DAffine3;
use snell_components::{
    settings::Settings,
    transform::{GlobalTransform, Transform},
};

/// Where the scene as a whole lies in the world, from the settings.
#[derive(Resource, Clone, Debug, Default, PartialEq)]
pub struct ScenePlacement {
    /// None where the settings have no steps: nothing is multiplied then.
    world_from_scene: Option<DAffine3>,
    lights_too: bool,
}

impl ScenePlacement {
    /// Maps a shape's object space to the world.
    #[must_use]
    pub fn of_shape(&self, placed: &GlobalTransform) -> DAffine3 {
        self.world_from_scene.map_or(placed.0, |world_from_scene| world_from_scene * placed.0)
    }

    /// Maps a light's object space to the world.
    #[must_use]
    pub fn of_light(&self, placed: &GlobalTransform) -> DAffine3 {
        if self.lights_too { self.of_shape(placed) } else { placed.0 }
    }
}

/// Takes the placement of the scene from the settings.
pub fn place_scene(settings: Res<Settings>, mut scene: ResMut<ScenePlacement>) {
    if settings.is_changed() {
        let steps = &settings.transform;
        scene.set_if_neq(ScenePlacement {
            world_from_scene: (!steps.0.is_empty()).then(|| steps.matrix()),
            lights_too: settings.transform_lights,
        });
    }
}

/// What changes placements in the world.
type Moved = Or<(Changed<Transform>, Changed<ChildOf>, Changed<Children>)>;

/// Multiplies placements down from the roots; an entity without [`Transform`] passes its parent's placement on.
pub fn propagate(
    moved: Query<(), Moved>,
    mut orphans: RemovedComponents<ChildOf>,
    mut reset: RemovedComponents<Transform>,
    roots: Query<Entity, (Without<ChildOf>, Or<(With<GlobalTransform>, With<Children>)>)>,
    transforms: Query<&Transform>,
    children: Query<&Children>,
    mut placed: Query<&mut GlobalTransform>,
) {
    // Both are read, so that nothing is seen again next time.
    let removed = orphans.read().count() + reset.read().count();
    if moved.is_empty() && removed == 0 {
        return;
    }
    let mut pending: Vec<_> = roots.iter().map(|root| (root, DAffine3::IDENTITY)).collect();
    while let Some((entity, world_from_parent)) = pending.pop() {
        let local = transforms.get(entity).map(Transform::matrix).unwrap_or_default();
        let world_from_object = world_from_parent * local;
        if let Ok(mut placed) = placed.get_mut(entity) {
            placed.set_if_neq(GlobalTransform(world_from_object));
        }
        if let Ok(children) = children.get(entity) {
            pending.extend(children.iter().map(|child| (child, world_from_object)));
        }
    }
}
