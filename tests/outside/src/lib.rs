//! A crate as an outside user would write it: a shape, a light and two textures, each in one file.

mod beam;
mod grain;
mod stripes;
mod torus;

pub use beam::Beam;
pub use grain::Grain;
pub use stripes::Stripes;
pub use torus::Torus;

/// Snell with all of them.
pub fn renderer() -> snell::Renderer {
    snell::Renderer::new()
        .with_primitive::<Torus>()
        .with_light::<Beam>()
        .with_texture::<Stripes>()
        .with_texture::<Grain>()
}
