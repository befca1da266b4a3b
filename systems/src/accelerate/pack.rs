//! The systems that keep packed shapes, pools and the tree up to date with the world.

use super::{
    geometry::Geometry,
    pool::{ErasedPool, Pool},
};
use crate::transform::ScenePlacement;
use bevy_ecs::prelude::*;
use snell_components::{
    hidden::Hidden,
    name::{Name, Rank},
    primitive::{Degenerate, Extent, Primitive},
    space::BoundingSphere,
    transform::{GlobalTransform, is_invertible},
};
use std::{collections::BTreeMap, sync::Arc};

/// A shape's packed form, kept on its entity until shape or placement change.
#[derive(Component)]
pub struct Packed<P: Primitive>(Result<(Extent, P::Packed), Degenerate>);

/// The shapes of the world as the renderer knows them.
#[derive(Resource, Default)]
pub struct Scenery {
    /// Pools by tag, so that their order is the same in every program.
    pools: BTreeMap<&'static str, Entry>,
    changed: bool,
    /// The tree over all of them.
    pub geometry: Arc<Geometry>,
    /// All objects in the order of names.
    pub objects: Arc<Vec<Entity>>,
    /// Shapes that are left out, with the reason.
    pub left_out: Vec<(Entity, String)>,
}

/// The shapes of one type before the tree is built.
struct Entry {
    owners: Vec<Entity>,
    ranks: Vec<Rank>,
    left_out: Vec<(Entity, String)>,
    pool: Box<dyn Fn(&[u32]) -> Arc<dyn ErasedPool> + Send + Sync>,
}

/// Takes away the packed form and the bounding sphere where a shape of one type is gone.
pub fn unpack<P: Primitive>(
    mut removed: RemovedComponents<P>,
    gone: Query<(), (With<Packed<P>>, Without<P>)>,
    mut commands: Commands,
) {
    for entity in removed.read().filter(|entity| gone.contains(*entity)) {
        commands.entity(entity).remove::<(Packed<P>, BoundingSphere)>();
    }
}

/// Packs the shapes of one type that were changed or moved, and writes their bounding spheres.
pub fn pack<P: Primitive>(
    shapes: Query<(Entity, Ref<P>, Ref<GlobalTransform>)>,
    scene: Res<ScenePlacement>,
    mut commands: Commands,
) {
    for (entity, shape, placed) in &shapes {
        if !(shape.is_changed() || placed.is_changed() || scene.is_changed()) {
            continue;
        }
        let placed = scene.of_shape(&placed);
        let result = if is_invertible(&placed) {
            shape.pack(&placed).and_then(finite)
        } else {
            Err(Degenerate("its placement is singular or not finite".into()))
        };
        let mut entity = commands.entity(entity);
        match &result {
            Ok((Extent::Bounded(bounds), form)) => entity.insert(P::bounding_sphere(form, bounds)),
            _ => entity.remove::<BoundingSphere>(),
        };
        entity.insert(Packed::<P>(result));
    }
}

/// Refuses a shape whose bounds are not numbers.
fn finite<F>((extent, form): (Extent, F)) -> Result<(Extent, F), Degenerate> {
    match extent {
        Extent::Bounded(bounds) if !(bounds.min.is_finite() && bounds.max.is_finite()) => {
            Err(Degenerate("it is larger than numbers are".into()))
        }
        _ => Ok((extent, form)),
    }
}

/// Gathers the packed shapes of one type when any of them changed.
pub fn pool<P: Primitive>(
    changed: Query<(), Or<(Changed<Packed<P>>, (With<Packed<P>>, Or<(Changed<Name>, Changed<Hidden>)>))>>,
    mut removed: RemovedComponents<Packed<P>>,
    mut unnamed: RemovedComponents<Name>,
    mut shown: RemovedComponents<Hidden>,
    all: Query<(Entity, Option<&Name>, &Packed<P>), Without<Hidden>>,
    mut scenery: ResMut<Scenery>,
) {
    // All are read, so that nothing is seen again next time.
    let other = unnamed.read().chain(shown.read()).filter(|entity| all.contains(*entity)).count();
    let removed = removed.read().count() + other;
    if changed.is_empty() && removed == 0 {
        return;
    }
    let mut shapes: Vec<_> =
        all.iter().map(|(entity, name, packed)| (Rank::of(entity, name), entity, packed)).collect();
    shapes.sort_unstable_by(|a, b| a.0.cmp(&b.0));
    let (mut owners, mut ranks, mut left_out, mut forms) = (vec![], vec![], vec![], vec![]);
    for (rank, entity, packed) in shapes {
        match &packed.0 {
            Ok((extent, form)) => {
                owners.push(entity);
                ranks.push(rank);
                forms.push((form.clone(), *extent));
            }
            Err(Degenerate(why)) => left_out.push((entity, why.clone())),
        }
    }
    let pool = move |objects: &[u32]| -> Arc<dyn ErasedPool> {
        Arc::new(Pool::<P>::new(
            forms.iter().zip(objects).map(|((form, extent), object)| (form.clone(), *extent, *object)),
        ))
    };
    scenery.pools.insert(P::TAG, Entry { owners, ranks, left_out, pool: Box::new(pool) });
    scenery.changed = true;
}

/// Builds the tree over all shapes when any of them changed.
pub fn build(mut scenery: ResMut<Scenery>) {
    // Looked at without marking the resource as changed.
    if !scenery.changed {
        return;
    }
    let scenery = &mut *scenery;
    scenery.changed = false;
    let entries = || scenery.pools.values();
    let mut ranked: Vec<_> = entries()
        .enumerate()
        .flat_map(|(pool, entry)| {
            entry.ranks.iter().zip(&entry.owners).enumerate().map(move |(i, (rank, owner))| (rank, *owner, pool, i))
        })
        .collect();
    ranked.sort_unstable_by(|a, b| a.0.cmp(b.0));
    let mut numbers: Vec<Vec<u32>> = entries().map(|entry| vec![0; entry.owners.len()]).collect();
    for (number, (_, _, pool, i)) in ranked.iter().enumerate() {
        numbers[*pool][*i] = number as u32;
    }
    let pools: Vec<_> = entries().zip(&numbers).map(|(entry, numbers)| (entry.pool)(numbers)).collect();
    let objects = ranked.iter().map(|(_, owner, ..)| *owner).collect();
    let left_out = entries().flat_map(|entry| entry.left_out.iter().cloned()).collect();
    scenery.geometry = Arc::new(Geometry::build(pools.iter()));
    scenery.objects = Arc::new(objects);
    scenery.left_out = left_out;
}
