//! A picture that was drawn.

use pyo3::{exceptions::PyOSError, prelude::*, types::PyBytes};
use snell::{
    Frame,
    components::{color::Encoding, settings::Settings},
    systems::image::{self, Format, Metadata},
};
use std::path::{Path, PathBuf};

/// Linear light, red, green and blue, by rows from the top.
#[pyclass(frozen)]
pub(crate) struct Picture {
    frame: Frame,
    encoding: Encoding,
    metadata: Metadata,
}

impl Picture {
    pub(crate) fn new(frame: Frame, settings: &Settings, scene: &Path) -> Self {
        let metadata = Metadata::of(&frame, settings, scene);
        Self { frame, encoding: settings.encoding, metadata }
    }
}

#[pymethods]
impl Picture {
    /// Rows, columns and 3, as of an array.
    #[getter]
    fn shape(&self) -> (u32, u32, u32) {
        (self.frame.picture.height, self.frame.picture.width, 3)
    }

    /// SHA-256 of the linear pixels: equal on every machine.
    #[getter]
    fn hash(&self) -> String {
        self.frame.picture.hash()
    }

    /// Rays traced.
    #[getter]
    fn rays(&self) -> u64 {
        self.frame.counts.rays()
    }

    /// The pixels as 32-bit floats, lowest byte first: `numpy.frombuffer(p.tobytes(), "<f4").reshape(p.shape)`.
    fn tobytes<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        let pixels = &self.frame.picture.pixels;
        let bytes: Vec<u8> = pixels.iter().flatten().flat_map(|channel| channel.to_le_bytes()).collect();
        PyBytes::new(py, &bytes)
    }

    /// The pixels with 8 bits a channel, encoded as the scene's settings ask.
    fn tobytes8<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, image::levels8(&self.frame.picture, self.encoding).as_flattened())
    }

    /// The linear light of a pixel.
    fn pixel(&self, x: u32, y: u32) -> Option<(f32, f32, f32)> {
        self.frame.picture.pixel(x, y).map(|[r, g, b]| (r, g, b))
    }

    /// Writes it as PNG or OpenEXR, whichever the name ends with, with how it was made.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        let failed = |why: image::FileError| PyOSError::new_err(why.to_string());
        image::write(&path, Format::of(&path).map_err(failed)?, &self.frame.picture, &self.metadata).map_err(failed)
    }
}
