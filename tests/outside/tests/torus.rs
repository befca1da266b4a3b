//! What a shape from outside gets without a line of its own: scene files and their messages, shadows, textures,
//! instances, bounds, picking.

use outside::Torus;
use snell::{Faults, Snapshot, components::space::BoundingSphere, prelude::*, systems::registry::Registry, why};
use std::sync::Arc;

const SCENE: &str = include_str!("../scenes/torus.ron");
const RING: Torus = Torus { major: 1.0, minor: 0.35 };

fn load(text: &str) -> Result<Renderer, Faults> {
    let mut renderer = outside::renderer();
    renderer.load_text(text, "torus.ron")?;
    Ok(renderer)
}

fn snapshot(text: &str) -> Arc<Snapshot> {
    load(text).expect("a sound scene").snapshot().expect("a scene that can be drawn")
}

/// Whether a ray of object space meets the ring, by walking along it in small steps; nothing where it nearly does.
fn meets(ray: &Ray) -> Option<bool> {
    let distance = |p: DVec3| {
        let ring = DVec2::new(p.x, p.z).length() - RING.major;
        DVec2::new(ring, p.y).length() - RING.minor
    };
    let direction = ray.direction.normalize();
    let least =
        (1..8000).map(|n| distance(ray.origin + direction * (f64::from(n) * 1e-3))).fold(f64::INFINITY, f64::min);
    (least.abs() > 2e-3).then_some(least < 0.0)
}

/// The ray of a pixel's centre and what is there, by name, with its surface.
fn pick(snapshot: &Snapshot, x: u32, y: u32) -> (Ray, Option<(String, Surface)>) {
    let (width, height) = (snapshot.settings.width, snapshot.settings.height);
    let ray = snapshot.view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5, width, height);
    let met = snapshot.geometry.closest(&ray, f64::INFINITY, &Methods::default(), &mut Cost::default());
    let named = |object: u32| snapshot.names[object as usize].as_ref().map_or("", Name::as_str).to_owned();
    (ray, met.map(|met| (named(met.object), met.surface)))
}

/// The ring alone, at (0, 0.35, 0), with some components more.
fn alone(more: &str) -> String {
    format!(
        "(version: 1, settings: (width: 60, height: 40, background: (0, 0, 1)), entities: {{
            \"camera\": [Camera(position: (0, 3, 4), target: (0, 0.3, 0), field_of_view: 30)],
            \"sun\": [DirectionalLight(direction: (-1, -2, -1))],
            \"ring\": [Torus(major: 1, minor: 0.35), Transform([Translate((0, 0.35, 0))]), {more}],
            \"ground\": [Plane(), Diffuse(1)],
        }})"
    )
}

const TO_OBJECT: DVec3 = DVec3::new(0.0, -0.35, 0.0);

#[test]
fn a_pixel_picks_it_exactly_where_its_ray_meets_it() {
    let snapshot = snapshot(&alone("Diffuse(1)"));
    let mut counts = [0, 0];
    for (x, y) in (0..40).flat_map(|y| (0..60).map(move |x| (x, y))) {
        let (ray, picked) = pick(&snapshot, x, y);
        let is_ring = picked.is_some_and(|(name, _)| name == "ring");
        let Some(expected) = meets(&Ray { origin: ray.origin + TO_OBJECT, ..ray }) else { continue };
        assert_eq!(is_ring, expected, "column {x}, row {y}");
        counts[usize::from(is_ring)] += 1;
    }
    assert!(counts.iter().all(|count| *count > 400), "{counts:?}");
}

#[test]
fn it_casts_a_shadow_exactly_where_it_stands_before_the_light() {
    let snapshot = snapshot(&alone("Diffuse(1)"));
    let picture = render(&snapshot, &Options::default()).picture;
    let to_light = DVec3::new(1.0, 2.0, 1.0).normalize();
    let mut counts = [0, 0];
    for (x, y) in (0..40).flat_map(|y| (0..60).map(move |x| (x, y))) {
        let Some((name, surface)) = pick(&snapshot, x, y).1 else { continue };
        let Some(shadow) = meets(&Ray { origin: surface.point + TO_OBJECT, direction: to_light }) else { continue };
        if name != "ground" {
            continue;
        }
        // Lambert's law on the ground.
        let expected = if shadow { 0.0 } else { to_light.y as f32 };
        let found = picture.pixel(x, y).expect("a pixel")[0];
        assert!((found - expected).abs() < 1e-6, "column {x}, row {y}: {found}, expected {expected}");
        counts[usize::from(shadow)] += 1;
    }
    assert!(counts[0] > 500 && counts[1] > 50, "{counts:?}");
}

#[test]
fn it_takes_textures_by_its_coordinates() {
    let snapshot = snapshot(
        &alone("Checker(even: 0.75, odd: 0.25, frequency: 8), Ambient(1)")
            .replace("sun", "a\": [AmbientLight(1)], \"sun"),
    );
    let picture = render(&snapshot, &Options::default()).picture;
    let mut seen = [0, 0];
    for (x, y) in (0..40).flat_map(|y| (0..60).map(move |x| (x, y))) {
        let Some((name, surface)) = pick(&snapshot, x, y).1 else { continue };
        if name != "ring" {
            continue;
        }
        // u once around the ring, v once around the tube, both from −½.
        let p = surface.point + TO_OBJECT;
        let out = DVec2::new(p.x, p.z).length() - RING.major;
        let uv = DVec2::new(p.z.atan2(p.x), p.y.atan2(out)) / std::f64::consts::TAU;
        let squares = uv * 8.0;
        if (squares - squares.round()).abs().min_element() < 1e-6 {
            continue;
        }
        let odd = (squares.x.floor() + squares.y.floor()).rem_euclid(2.0) == 1.0;
        assert_eq!(picture.pixel(x, y).expect("a pixel")[0], if odd { 0.25 } else { 0.75 }, "column {x}, row {y}");
        seen[usize::from(odd)] += 1;
    }
    assert!(seen.iter().all(|count| *count > 100), "{seen:?}");
}

#[test]
fn it_stands_in_many_places_at_once() {
    let mut renderer = outside::renderer();
    let world = &mut renderer.world;
    world.spawn(Camera { position: DVec3::Z * 20.0, ..Camera::default() });
    let middles = [(-4.0, 2.5), (0.0, -1.0), (4.0, 3.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
    for (n, middle) in middles.into_iter().enumerate() {
        let turned = Transform::new([Step::RotateX(90.0), Step::Translate(middle)]);
        world.spawn((Name::new(format!("ring {n}")), RING, turned));
    }
    let snapshot = renderer.snapshot().expect("a scene");
    for (n, middle) in middles.into_iter().enumerate() {
        let through = |point: DVec3| Ray { origin: point + DVec3::Z * 20.0, direction: DVec3::NEG_Z };
        let met = |ray| snapshot.geometry.closest(&ray, f64::INFINITY, &Methods::default(), &mut Cost::default());
        for way in [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y] {
            let hit = met(through(middle + way)).expect("on the tube");
            let name = snapshot.names[hit.object as usize].as_ref().map(Name::as_str);
            assert_eq!(name, Some(&*format!("ring {n}")));
            assert!((hit.t - (20.0 - RING.minor)).abs() < 1e-12, "{}", hit.t);
        }
        assert!(met(through(middle)).is_none(), "through the hole");
    }
}

#[test]
fn its_bounds_are_those_of_the_ring() {
    let mut renderer = load(SCENE).expect("sound");
    renderer.snapshot().expect("a scene");
    let mut bounds = renderer.world.query::<(&BoundingSphere, &Torus)>();
    let (sphere, _) = bounds.single(&renderer.world).expect("one ring");
    assert!(sphere.center.distance(DVec3::Y * 0.35) < 1e-12, "{sphere:?}");
    // Of the box about it: 1.35, 0.35 and 1.35 to either side.
    assert!((sphere.radius - DVec3::new(1.35, 0.35, 1.35).length()).abs() < 1e-6, "{sphere:?}");
    let (Extent::Bounded(bounds), _) = RING.pack(&DAffine3::IDENTITY).expect("a ring") else { panic!("bounded") };
    assert!((bounds.max - DVec3::new(1.35, 0.35, 1.35)).abs().max_element() < 1e-6, "{bounds:?}");
}

#[test]
fn the_tree_and_brute_force_draw_the_same_bits() {
    let snapshot = snapshot(SCENE);
    let draw = |methods| render(&snapshot, &Options { methods, ..Options::default() });
    let [tree, brute] = [Methods::default(), Methods::BRUTE_FORCE].map(draw);
    assert_eq!(tree.picture.hash(), brute.picture.hash());
    assert_eq!(tree.counts.not_finite, 0);
}

#[test]
fn the_tree_of_rays_names_it_and_adds_up() {
    let mut renderer = load(SCENE).expect("sound");
    let snapshot = renderer.snapshot().expect("a scene");
    let picture = render(&snapshot, &Options::default()).picture;
    let mut tree = why(&snapshot, 25, 40);
    tree.locate(&mut renderer.world);
    assert_eq!(tree.sum().as_vec3().to_array(), picture.pixel(25, 40).expect("a pixel"));
    assert!(tree.to_string().contains("meets `ring` (torus.ron:7)"), "{tree}");
}

#[test]
fn its_fields_are_checked_like_those_of_the_built_in_shapes() {
    let faults = |from: &str, to: &str| {
        assert!(SCENE.contains(from));
        load(&SCENE.replace(from, to)).err().expect("a fault").to_string()
    };
    let misspelt = faults("minor: 0.35", "minr: 0.35");
    assert!(misspelt.contains("torus.ron:8:29") && misspelt.contains("did you mean `minor`"), "{misspelt}");
    let added = faults("minor: 0.35", "minor: 0.35, colour: 3");
    assert!(added.contains("torus.ron:8:42") && added.contains("`colour`"), "{added}");
    let missing = faults(", minor: 0.35", "");
    assert!(missing.contains("torus.ron:8") && missing.contains("`minor`"), "{missing}");
    assert!(missing.contains("radius of the tube, object units"), "{missing}");
    let negative = faults("minor: 0.35", "minor: -0.35");
    assert!(negative.contains("from 0.000000001"), "{negative}");
    let together = faults("minor: 0.35", "minor: 1.5");
    assert!(
        together.contains("torus.ron:8:36") && together.contains("from a millionth of `major` to `major`"),
        "{together}"
    );
    let tag = faults("Torus(", "Tours(");
    assert!(tag.contains("did you mean `Torus`"), "{tag}");
    let twice = faults("Torus(", "Sphere(radius: 1), Torus(");
    assert!(twice.contains("an entity has one shape at most"), "{twice}");
}

/// Sets numbers by name and notes what it sees, as an inspector or bindings to another language do.
struct ByName<'a>(&'a [(&'a str, f64)], Vec<String>);

impl FieldVisitor for ByName<'_> {
    fn field(&mut self, name: &'static str, value: Value<'_>, spec: Spec) {
        let Value::Number(place) = value else { panic!("numbers only") };
        if let Some((_, number)) = self.0.iter().find(|(known, _)| *known == name) {
            assert!(spec.range.contains(*number));
            *place = *number;
        }
        let need = if spec.required { ", required" } else { "" };
        self.1.push(format!("{name} = {place}: {}, {:e} to {:e}{need}", spec.about, spec.range.min, spec.range.max));
    }
}

#[test]
fn who_knows_nothing_but_names_can_make_it_and_show_its_fields() {
    let mut renderer = outside::renderer();
    let entry = *renderer.world.resource::<Registry>().get("Torus").expect("a tag");
    let mut component = (entry.new)();
    let mut fields = ByName(&[("major", 1.0), ("minor", 0.35)], vec![]);
    component.visit(&mut fields);
    assert_eq!(
        fields.1,
        [
            "major = 1: radius of the ring, object units, 1e-9 to 1e9, required",
            "minor = 0.35: radius of the tube, object units, 1e-9 to 1e9, required"
        ]
    );
    component.validate().expect("a ring");
    let entity = renderer.add("ring", ()).id();
    component.insert(&mut renderer.world.entity_mut(entity));
    renderer.add("camera", Camera::at([0.0, 3.0, 4.0]).looking_at([0.0, 0.0, 0.0]));
    renderer.set_size(60, 40);
    let snapshot = renderer.snapshot().expect("a scene");
    assert!((0..60).any(|x| pick(&snapshot, x, 25).1.is_some_and(|(name, _)| name == "ring")));
    // And what is wrong between fields is told at one of them.
    component = (entry.new)();
    component.visit(&mut ByName(&[("major", 1.0), ("minor", 2.0)], vec![]));
    assert_eq!(component.validate().map_err(|fault| fault.field), Err("minor"));
}
