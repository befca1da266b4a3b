//! Scene text → picture.

use crate::{SceneError, picture::Picture};
use pyo3::prelude::*;
use snell::{Options, Region, Renderer, render};
use std::{fmt::Display, path::PathBuf};

/// A world of entities.
#[pyclass(name = "Renderer")]
pub(crate) struct PyRenderer {
    renderer: Renderer,
    /// What pictures tell of where they come from.
    name: PathBuf,
}

impl PyRenderer {
    pub(crate) fn new(renderer: Renderer) -> Self {
        Self { renderer, name: PathBuf::from("scene.ron") }
    }
}

fn scene_error(why: impl Display) -> PyErr {
    SceneError::new_err(why.to_string())
}

#[pymethods]
impl PyRenderer {
    /// Adds the entities of a scene file; returns what there is to note of it.
    fn load(&mut self, path: PathBuf) -> PyResult<Vec<String>> {
        let notices = self.renderer.load(&path).map_err(scene_error)?;
        self.name = path;
        Ok(notices.iter().map(ToString::to_string).collect())
    }

    /// Adds the entities of a scene's text; `name` is where relative paths start.
    fn load_text(&mut self, text: &str, name: PathBuf) -> PyResult<Vec<String>> {
        let notices = self.renderer.load_text(text, &name).map_err(scene_error)?;
        self.name = name;
        Ok(notices.iter().map(ToString::to_string).collect())
    }

    /// Draws the picture, or a region of it: x, y, width and height in pixels. Other threads of Python run meanwhile.
    #[pyo3(signature = (threads=None, region=None))]
    fn render(
        &mut self,
        py: Python<'_>,
        threads: Option<usize>,
        region: Option<(u32, u32, u32, u32)>,
    ) -> PyResult<Picture> {
        let region = region.map(|(x, y, width, height)| Region { x, y, width, height });
        let snapshot = self.renderer.snapshot().map_err(scene_error)?;
        let options = Options { threads, region, ..Options::default() };
        let frame = py.detach(|| render(&snapshot, &options));
        let settings = self.renderer.settings().clone();
        Ok(Picture::new(frame, &settings, &self.name))
    }
}
