//! What keeps a world from being rendered.

use snell_components::name::Name;

/// Why there is no snapshot of a world.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SceneError(String);

impl SceneError {
    pub(super) fn no_camera() -> Self {
        Self("the scene has no camera; add an entity with the component `Camera(position: (x, y, z))`".into())
    }

    pub(super) fn several_cameras<'a>(names: impl Iterator<Item = Option<&'a Name>>) -> Self {
        let mut names: Vec<_> =
            names.map(|name| name.map_or("a nameless one".into(), |name| format!("`{name}`"))).collect();
        names.sort();
        Self(format!("the scene has {} cameras, and one is needed: {}", names.len(), names.join(", ")))
    }

    pub(super) fn duplicate_name(name: &Name) -> Self {
        Self(format!("two entities are named `{name}`; names are unique in a scene"))
    }

    pub(super) fn camera(why: &str) -> Self {
        Self(format!("the camera cannot be used: {why}"))
    }
}

impl core::fmt::Display for SceneError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(&self.0)
    }
}

impl core::error::Error for SceneError {}
