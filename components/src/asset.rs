//! Files that components refer to.

use std::sync::Arc;

/// A file's path as the scene gives it, and what was read from it; instances share the contents.
#[derive(Debug)]
pub struct Asset<T> {
    /// Path as written in the scene, relative to the scene's file; empty for data made in memory.
    pub path: String,
    /// The contents; `None` only until the loader has run.
    pub data: Option<Arc<T>>,
}

impl<T> Asset<T> {
    /// An asset made in memory.
    #[must_use]
    pub fn from_data(data: impl Into<Arc<T>>) -> Self {
        Self { path: String::new(), data: Some(data.into()) }
    }
}

impl<T> Default for Asset<T> {
    fn default() -> Self {
        Self { path: String::new(), data: None }
    }
}

// Not derived: a derive would ask `T: Clone`.
impl<T> Clone for Asset<T> {
    fn clone(&self) -> Self {
        Self { path: self.path.clone(), data: self.data.clone() }
    }
}
