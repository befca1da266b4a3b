//! Snell: a Whitted ray tracer on an entity-component-system.
//!
//! Objects, materials, lights and the camera are entities; systems turn them, in a fixed order, into a picture that is
//! the same to the last bit on every machine, for any number of threads and any way of building the scene.
//!
//! ```
//! use snell::prelude::*;
//!
//! let mut scene = Renderer::new();
//! scene.set_size(40, 30);
//! scene.add("camera", Camera::at([0.0, 1.0, 5.0]));
//! scene.add("lamp", PointLight::at([3.0, 5.0, 4.0]));
//! let red = scene.add("red", (Color::srgb(0xe06060), Diffuse::grey(0.9))).id();
//! scene.add("ball", Sphere { radius: 1.0 }).at([0.0, 1.0, 0.0]).made_of(red);
//! scene.add("ground", Plane {});
//!
//! let snapshot = scene.snapshot()?;
//! let frame = render(&snapshot, &Options::default());
//! assert!(frame.is_complete());
//! # Ok::<(), snell::SceneError>(())
//! ```

#![forbid(unsafe_code)]

pub mod cli;

pub mod golden;

pub use snell_charts as charts;
pub use snell_components as components;
pub use snell_systems as systems;
pub use snell_systems::conformance;

pub use snell_components::method::{Accelerator, Methods, Precision, SphereTest, TriangleTest};
pub use snell_systems::{
    build::Added,
    extract::SceneError,
    load::{Fault, Faults, Notice},
    pipeline::Renderer,
    render::{Counts, Frame, Options, Picture, Progress, Region, Stop, render},
    snapshot::Snapshot,
    why::{RayTree, why},
};

/// What a program that builds and renders scenes needs.
pub mod prelude {
    pub use crate::{
        Accelerator, Frame, Methods, Options, Picture, Region, Renderer, SceneError, Snapshot, Stop, render,
    };
    pub use bevy_ecs::prelude::*;
    pub use glam::{DAffine3, DVec2, DVec3};
    pub use snell_components::{
        camera::Camera,
        choice,
        color::Rgb,
        describe::{Describe, Fault, FieldVisitor, Spec, Value},
        figure::{Arrangement, Figure, HeightField, Lathe, SphereFlake, TriangleField},
        hidden::Hidden,
        light::{
            AmbientLight, ConeLight, DirectionalLight, DiskLight, Emission, FallOff, Illumination, Lamp, Light,
            PointLight,
        },
        material::{
            Absorption, Ambient, Color, Dielectric, Diffuse, Dispersion, Highlight, MadeOf, MaterialSlots, MediumRank,
            Mirror, Opacity, Refraction, Transmission,
        },
        name::Name,
        primitive::{Cost, Degenerate, Extent, Hit, Primitive, Surface},
        settings::{Antialias, Settings},
        shape::{Cone, Cuboid, Cylinder, Mesh, MeshError, Plane, Shading, Sphere, Triangle, TriangleMesh},
        space::{Bounds, Ray},
        texture::{Checker, Filter, Image, ImageTexture, Pattern, Texture, TexturePoint, Wrap},
        transform::{Step, Transform},
    };
}

/// The README's Rust code, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// The tutorial's Rust code, compiled.
#[cfg(doctest)]
#[doc = include_str!("../docs/extending.md")]
struct Extending;
