//! Scenes in the language of POV-Ray 3.7: the part of ours that both know.

use snell::components::transform::GlobalTransform;
use snell::prelude::*;
use std::fmt::Write as _;

/// Everything that a snapshot was made of.
///
/// Panics where a scene has something that is not translated.
pub(crate) fn scene(renderer: &mut Renderer, snapshot: &Snapshot) -> String {
    let settings = renderer.settings().clone();
    let view = &snapshot.view;
    let aspect = f64::from(settings.width) / f64::from(settings.height);
    let mut text = format!(
        "#version 3.7;\n\
         global_settings {{ assumed_gamma 1 max_trace_level {} adc_bailout 1e-9 ambient_light rgb {} }}\n\
         background {{ rgb {} }}\n\
         camera {{ location {} direction {} right {} up {} }}\n",
        settings.depth,
        vector(snapshot.lights.ambient),
        vector(settings.background),
        vector(view.eye),
        vector(view.forward),
        vector(view.right * aspect),
        vector(view.up),
    );
    let world = &mut renderer.world;
    // A light without shadows makes no highlights in POV-Ray: scenes with both are not translated.
    let dim = world.query::<&PointLight>().iter(world).any(|light| !light.shadows);
    assert!(!dim || world.query::<&Highlight>().iter(world).next().is_none(), "highlights in a light without shadows");
    for light in world.query::<&PointLight>().iter(world) {
        let shadowless = if light.shadows { "" } else { " shadowless" };
        text += &format!("light_source {{ {} rgb {}{shadowless} }}\n", vector(light.position), vector(light.intensity));
    }
    for light in world.query::<&DirectionalLight>().iter(world) {
        let from = light.direction.normalize() * -1e4;
        text += &format!("light_source {{ {} rgb {} parallel point_at 0 }}\n", vector(from), vector(light.intensity));
    }
    let shapes: Vec<_> = world
        .query::<(Entity, &GlobalTransform)>()
        .iter(world)
        .filter_map(|(entity, placed)| Some((entity, shape(world, entity)?, placed.0)))
        .collect();
    for (entity, shape, placed) in shapes {
        let m = placed.matrix3;
        let rows =
            [m.x_axis, m.y_axis, m.z_axis, placed.translation].map(|row| format!("{row}").replace(['[', ']'], ""));
        let material = world.get::<MadeOf>(entity).map_or(entity, |made_of| made_of.0);
        let look = look(world, material);
        writeln!(text, "{shape} {look} matrix <{}> }}", rows.join(", ")).expect("a text");
    }
    text
}

fn vector(v: DVec3) -> String {
    format!("<{:e}, {:e}, {:e}>", v.x, v.y, v.z)
}

/// An object's shape, without its last brace; none for what has no shape.
fn shape(world: &World, entity: Entity) -> Option<String> {
    let on_axis = |y: f64| vector(DVec3::Y * y);
    if let Some(Sphere { radius }) = world.get(entity) {
        return Some(format!("sphere {{ 0, {radius}"));
    }
    if world.get::<Plane>(entity).is_some() {
        return Some("plane { y, 0".into());
    }
    if let Some(Cuboid { size }) = world.get(entity) {
        return Some(format!("box {{ {}, {}", vector(-0.5 * *size), vector(0.5 * *size)));
    }
    if let Some(Cone { radius, top, height }) = world.get(entity) {
        return Some(format!("cone {{ 0, {radius}, {}, {top}", on_axis(*height)));
    }
    if let Some(Cylinder { radius, height }) = world.get(entity) {
        return Some(format!("cylinder {{ 0, {}, {radius}", on_axis(*height)));
    }
    let lathe = world.get::<Lathe>(entity)?;
    assert_eq!(lathe.shading, Shading::Flat, "normals of meshes are not translated");
    let mesh = lathe.triangles().expect("a mesh");
    let corners: Vec<_> = (0..mesh.len()).flat_map(|n| mesh.corners(n)).map(vector).collect();
    let faces: Vec<_> = (0..mesh.len()).map(|n| format!("<{}, {}, {}>", 3 * n, 3 * n + 1, 3 * n + 2)).collect();
    Some(format!(
        "mesh2 {{ vertex_vectors {{ {}, {} }} face_indices {{ {}, {} }}",
        corners.len(),
        corners.join(", "),
        faces.len(),
        faces.join(", ")
    ))
}

/// Pigment and finish of a material.
///
/// POV-Ray weakens the ambient and diffuse terms of a surface by what it lets through, but neither highlight nor mirror.
fn look(world: &World, material: Entity) -> String {
    let strength = |value: Option<Rgb>| value.unwrap_or(Rgb::ZERO);
    let ambient = world.get::<Ambient>(material).map(|k| k.0);
    let diffuse = world.get::<Diffuse>(material).map(|k| k.0);
    let mirror = strength(world.get::<Mirror>(material).map(|k| k.0));
    let through = strength(world.get::<Transmission>(material).map(|k| k.0));
    let alpha = world.get::<Opacity>(material).map_or(1.0, |opacity| opacity.alpha);
    let color = world.get::<Color>(material).map_or(Rgb::ONE, |color| color.0);
    for absent in [world.get::<Dielectric>(material).is_some(), world.get::<Refraction>(material).is_some()] {
        assert!(!absent, "bodies that bend light are not translated");
    }
    let plain = |k: Rgb| {
        assert!(k.x == k.y && k.y == k.z, "a strength of three channels is not translated: {k}");
        k.x
    };
    let (mut ambient, mut diffuse) = (plain(strength(ambient)), plain(strength(diffuse)));
    let grey = through.x == through.y && through.y == through.z;
    let pigment = if !grey {
        // A filter that lets all through takes the colour of the light that passes.
        assert!(ambient == 0.0 && diffuse == 0.0 && alpha == 1.0, "a coloured filter has no colour of its own");
        format!("pigment {{ rgbf <{}, {}, {}, 1> }}", through.x, through.y, through.z)
    } else if let Some(Checker { even, odd, frequency, .. }) = world.get(material) {
        assert!(through == Rgb::ZERO && alpha == 1.0, "checkers let nothing through");
        // POV-Ray's are cubes, and z runs against v.
        let [even, odd] = [*even * color, *odd * color].map(vector);
        let to = format!("translate -y/2 scale <{0:e}, 1, {1:e}>", 1.0 / frequency, -1.0 / frequency);
        format!("pigment {{ checker rgb {even}, rgb {odd} {to} }}")
    } else {
        let transmit = 1.0 - alpha + alpha * through.x;
        // The terms are those of what does not let light through.
        let rest = 1.0 - transmit;
        if rest > 0.0 {
            (ambient, diffuse) = (ambient * alpha / rest, diffuse * alpha / rest);
        }
        format!("pigment {{ rgbt <{}, {}, {}, {transmit}> }}", color.x, color.y, color.z)
    };
    let (shine, exponent) =
        world.get::<Highlight>(material).map_or((0.0, 1.0), |h| (plain(h.strength) * alpha, h.exponent));
    let mirror = vector(mirror * alpha);
    format!(
        "{pigment} finish {{ ambient {ambient} diffuse {diffuse} phong {shine} phong_size {exponent} reflection {{ rgb {mirror} }} }}"
    )
}
