//! How do I add a shape of my own? `cargo run --example own_shape`
//!
//! One component with two trait impls and one call; `docs/extending.md` goes through it line by line.

use snell::{
    conformance::{Form, check},
    prelude::*,
};

/// `Disk(radius: 1)`: a flat disk in the plane Oxz.
#[derive(Component, Clone, Default, Describe)]
struct Disk {
    /// Radius, object units.
    #[describe(within(0.0, 1e9), required)]
    radius: f64,
}

#[derive(Clone)]
struct PackedDisk {
    radius: f64,
    object_from_world: DAffine3,
    world_from_object: DAffine3,
}

impl Primitive for Disk {
    type Packed = PackedDisk;

    fn pack(&self, world_from_object: &DAffine3) -> Result<(Extent, PackedDisk), Degenerate> {
        let reach = DVec3::new(self.radius, 0.0, self.radius);
        let bounds = Bounds { min: -reach, max: reach }.transformed(world_from_object);
        let (radius, object_from_world) = (self.radius, world_from_object.inverse());
        Ok((Extent::Bounded(bounds), PackedDisk { radius, object_from_world, world_from_object: *world_from_object }))
    }

    fn hit(packed: &PackedDisk, ray: &Ray, t_max: f64, cost: &mut Cost) -> Option<Hit> {
        cost.primitives += 1;
        let local = ray.transformed(&packed.object_from_world);
        let t = -local.origin.y / local.direction.y;
        let point = local.at(t);
        let inside = point.x * point.x + point.z * point.z <= packed.radius * packed.radius;
        (t > 0.0 && t <= t_max && t.is_finite() && inside).then_some(Hit { t, part: 0 })
    }

    fn surface(packed: &PackedDisk, ray: &Ray, hit: Hit) -> Surface {
        let local = packed.object_from_world.transform_point3(ray.at(hit.t));
        let point = packed.world_from_object.transform_point3(DVec3::new(local.x, 0.0, local.z));
        let normal = (packed.object_from_world.matrix3.transpose() * DVec3::Y).normalize_or(DVec3::Y);
        let error = Surface::rounding(point.abs().max_element() + hit.t * ray.direction.length());
        Surface { point, normal, shading_normal: normal, uv: DVec2::new(local.x, local.z), slot: 0, error }
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    check(&[Disk { radius: 1.0 }], Form::Open).assert();
    let mut renderer = Renderer::new().with_primitive::<Disk>();
    let scene = r##"(version: 1, settings: (width: 64, height: 48), entities: {
        "camera": [Camera(position: (0, 2, 4), target: (0, 0, 0))],
        "sun": [DirectionalLight(direction: (-1, -2, -1))],
        "disk": [Disk(radius: 1.2), Color("#3070c0")],
    })"##;
    renderer.load_text(scene, "own_shape.rs")?;
    println!("{}", render(&*renderer.snapshot()?, &Options::default()).picture.hash());
    // Misspelt, it gets the same messages as the shapes that are built in.
    let fault = renderer.load_text(&scene.replace("Disk(radius", "Disk(raduis"), "own_shape.rs");
    println!("{}", fault.err().ok_or("a fault")?);
    Ok(())
}
