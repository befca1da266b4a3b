//! Stage 1: placements become matrices in the world.

use bevy_ecs::prelude::*;
use snell_components::transform::{GlobalTransform, Transform};

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
    let mut pending: Vec<_> = roots.iter().map(|root| (root, glam::DAffine3::IDENTITY)).collect();
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
