//! Only what changed is done again, and the result is what a fresh world would give.
//!
//! The oracle is a world made anew: whatever is done to a world, its picture must have the hash of one that was put
//! together that way from the start.

mod support {
    pub(crate) mod random;
}

use snell::components::space::BoundingSphere;
use snell::prelude::*;
use std::sync::Arc;
use support::random::Random;

/// Named things before a camera: a red ball, a box, a mesh, a ground, a material and two lights.
fn studio() -> Renderer {
    let mut renderer = Renderer::new();
    *renderer.settings() = Settings { width: 32, height: 24, background: Rgb::splat(0.2), ..Settings::default() };
    let world = &mut renderer.world;
    let camera = Camera { position: DVec3::new(0.0, 2.0, 8.0), target: Some(DVec3::Y), ..Camera::default() };
    world.spawn((Name::new("camera"), camera));
    world.spawn((Name::new("sun"), DirectionalLight { direction: DVec3::new(1.0, -2.0, -1.0), ..Default::default() }));
    let lamp = PointLight { position: DVec3::new(3.0, 5.0, 4.0), intensity: Rgb::splat(0.5), ..PointLight::default() };
    world.spawn((Name::new("lamp"), lamp));
    let red = world.spawn((Name::new("red"), Color(Rgb::new(0.8, 0.1, 0.1)), Diffuse(Rgb::splat(0.9)))).id();
    world.spawn((Name::new("ball"), Sphere { radius: 1.0 }, Transform::at(DVec3::Y), MadeOf(red)));
    world.spawn((Name::new("crate"), Cuboid::default(), Transform::at(DVec3::new(2.0, 0.5, 0.0))));
    world.spawn((Name::new("model"), Mesh::new(tetrahedron()), Transform::at(DVec3::new(-2.0, 0.0, 0.0))));
    world.spawn((Name::new("ground"), Plane {}));
    renderer
}

fn tetrahedron() -> TriangleMesh {
    let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.5, 0.0]];
    TriangleMesh::new(positions, vec![[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]).expect("a mesh")
}

fn find(renderer: &mut Renderer, name: &str) -> Entity {
    let mut names = renderer.world.query::<(Entity, &Name)>();
    let found = names.iter(&renderer.world).find(|(_, found)| found.as_str() == name);
    found.unwrap_or_else(|| panic!("nothing is named {name}")).0
}

fn hash(renderer: &mut Renderer) -> String {
    let snapshot = renderer.snapshot().expect("a snapshot");
    render(&snapshot, &Options::default()).picture.hash()
}

/// Makes a change to a studio that was rendered before and to one that was not; gives the pictures' hashes before and
/// after, once sure that the latter does not depend on it, and that a further snapshot is the same one.
fn changed(change: impl Fn(&mut Renderer)) -> (String, String) {
    let mut old = studio();
    let before = hash(&mut old);
    change(&mut old);
    let after = hash(&mut old);
    let mut fresh = studio();
    change(&mut fresh);
    assert_eq!(after, hash(&mut fresh), "a fresh world gives another picture");
    let again = (old.snapshot().expect("a snapshot"), old.snapshot().expect("a snapshot"));
    assert!(Arc::ptr_eq(&again.0, &again.1), "nothing changed, yet the snapshot is a new one");
    (before, after)
}

fn edit<C: Component<Mutability = bevy_ecs::component::Mutable>>(
    name: &'static str,
    f: impl Fn(&mut C),
) -> impl Fn(&mut Renderer) {
    move |renderer| {
        let entity = find(renderer, name);
        f(&mut renderer.world.get_mut::<C>(entity).expect("the component"));
    }
}

fn on(name: &'static str, f: impl Fn(&mut EntityWorldMut<'_>)) -> impl Fn(&mut Renderer) {
    move |renderer| {
        let entity = find(renderer, name);
        f(&mut renderer.world.entity_mut(entity));
    }
}

fn assert_shows(change: impl Fn(&mut Renderer)) {
    let (before, after) = changed(change);
    assert_ne!(before, after, "the change does not show");
}

#[test]
fn an_unchanged_world_gives_the_very_same_snapshot() {
    let mut renderer = studio();
    let first = renderer.snapshot().expect("a snapshot");
    for _ in 0..3 {
        assert!(Arc::ptr_eq(&first, &renderer.snapshot().expect("a snapshot")));
    }
}

#[test]
fn after_any_one_edit_the_snapshot_settles_at_once() {
    // Each edit removes something, or removes and adds at once: nothing of it may be seen twice.
    let edits: [(&str, &dyn Fn(&mut Renderer)); 6] = [
        ("move", &edit::<Transform>("ball", |t| *t = Transform::at(DVec3::Y * 2.0))),
        ("despawn", &|renderer| {
            let ball = find(renderer, "ball");
            renderer.world.despawn(ball);
        }),
        ("replace an object", &|renderer| {
            let ball = find(renderer, "ball");
            renderer.world.despawn(ball);
            renderer.world.spawn((Name::new("ball"), Sphere { radius: 0.5 }));
        }),
        ("replace the camera", &|renderer| {
            let camera = find(renderer, "camera");
            renderer.world.despawn(camera);
            renderer.world.spawn((Name::new("camera"), Camera { position: DVec3::Z * 9.0, ..Camera::default() }));
        }),
        ("replace a light", &|renderer| {
            let lamp = find(renderer, "lamp");
            renderer.world.despawn(lamp);
            renderer.world.spawn((Name::new("lamp"), PointLight { position: DVec3::Y * 9.0, ..Default::default() }));
        }),
        ("replace a material", &|renderer| {
            let red = find(renderer, "red");
            renderer.world.despawn(red);
            let ball = find(renderer, "ball");
            let blue = renderer.world.spawn((Name::new("blue"), Color(Rgb::Z), Diffuse(Rgb::ONE))).id();
            renderer.world.entity_mut(ball).insert(MadeOf(blue));
        }),
    ];
    for (what, edit) in edits {
        let mut renderer = studio();
        let before = renderer.snapshot().expect("a snapshot");
        edit(&mut renderer);
        let after = renderer.snapshot().expect("a snapshot");
        assert!(!Arc::ptr_eq(&before, &after), "{what}: the change was not noticed");
        assert!(Arc::ptr_eq(&after, &renderer.snapshot().expect("a snapshot")), "{what}: was done twice");
    }
}

#[test]
fn moving_one_object_leaves_everything_else_as_it_was() {
    let mut renderer = studio();
    let model = find(&mut renderer, "model");
    let data =
        |renderer: &Renderer| renderer.world.get::<Mesh>(model).expect("a mesh").model.data.clone().expect("data");
    let before = renderer.snapshot().expect("a snapshot");
    // The tree is built once, on first use; its bytes are counted from then on.
    let (mesh, bytes) = (data(&renderer), data(&renderer).bytes());
    edit::<Transform>("model", |t| *t = Transform::at(DVec3::Y * 2.0))(&mut renderer);
    let after = renderer.snapshot().expect("a snapshot");
    assert!(Arc::ptr_eq(&mesh, &data(&renderer)) && bytes == data(&renderer).bytes());
    assert!(Arc::ptr_eq(&before.lights, &after.lights), "the lights were gathered again");
    assert!(!Arc::ptr_eq(&before.geometry, &after.geometry));
    // An old snapshot does not see the world's future.
    assert_eq!(hash(&mut studio()), render(&before, &Options::default()).picture.hash());
}

#[test]
fn recolouring_leaves_the_geometry_as_it_was() {
    let mut renderer = studio();
    let before = renderer.snapshot().expect("a snapshot");
    edit::<Color>("red", |c| c.0 = Rgb::Y)(&mut renderer);
    let after = renderer.snapshot().expect("a snapshot");
    assert!(Arc::ptr_eq(&before.geometry, &after.geometry) && Arc::ptr_eq(&before.lights, &after.lights));
    assert!(!Arc::ptr_eq(&before.materials, &after.materials));
}

#[test]
fn moving_the_camera_leaves_all_but_the_view_as_it_was() {
    let mut renderer = studio();
    let before = renderer.snapshot().expect("a snapshot");
    edit::<Camera>("camera", |c| c.roll = 10.0)(&mut renderer);
    let after = renderer.snapshot().expect("a snapshot");
    assert!(Arc::ptr_eq(&before.geometry, &after.geometry) && Arc::ptr_eq(&before.materials, &after.materials));
    assert_ne!(before.view, after.view);
}

#[test]
fn shapes_may_be_moved_resized_added_and_taken_away() {
    assert_shows(edit::<Transform>("ball", |t| *t = Transform::at(DVec3::Y * 2.0)));
    assert_shows(edit::<Transform>("model", |t| t.0.push(Step::Scale(DVec3::new(-1.0, 1.0, 1.0)))));
    assert_shows(edit::<Transform>("ground", |t| *t = Transform::at(DVec3::Y * 0.2)));
    assert_shows(edit::<Sphere>("ball", |s| s.radius = 0.5));
    assert_shows(edit::<Cuboid>("crate", |c| c.size.y = 2.0));
    assert_shows(|renderer| {
        renderer.world.spawn((Name::new("extra"), Sphere { radius: 0.5 }, Transform::at(DVec3::Z * 2.0)));
    });
    for name in ["ball", "crate", "model", "ground"] {
        assert_shows(on(name, |entity| {
            entity.remove::<(Sphere, Cuboid, Mesh, Plane)>();
        }));
        assert_shows(|renderer| {
            let entity = find(renderer, name);
            renderer.world.despawn(entity);
        });
    }
}

#[test]
fn a_shape_taken_away_and_given_back_between_snapshots_stays() {
    assert_shows(on("ball", |entity| {
        entity.remove::<Sphere>();
        entity.insert(Sphere { radius: 0.5 });
    }));
}

#[test]
fn a_shape_may_become_one_of_another_type() {
    assert_shows(on("ball", |entity| {
        entity.remove::<Sphere>().insert(Cuboid::default());
    }));
    assert_shows(on("crate", |entity| {
        entity.remove::<Cuboid>().insert(Sphere { radius: 0.5 });
    }));
    for (from, to) in [("ball", "crate"), ("crate", "ball")] {
        let mut renderer = studio();
        renderer.snapshot().expect("a snapshot");
        let [from, to] = [from, to].map(|name| find(&mut renderer, name));
        let world = &mut renderer.world;
        if world.get::<Sphere>(from).is_some() {
            world.entity_mut(from).remove::<Sphere>().insert(Cuboid::default());
        } else {
            world.entity_mut(from).remove::<Cuboid>().insert(Sphere::default());
        }
        renderer.snapshot().expect("a snapshot");
        for entity in [from, to] {
            assert!(renderer.world.get::<BoundingSphere>(entity).is_some(), "a bounded shape without its sphere");
        }
    }
}

#[test]
fn lights_may_be_moved_dimmed_added_taken_away_and_changed_in_kind() {
    assert_shows(edit::<PointLight>("lamp", |l| l.intensity = Rgb::splat(0.1)));
    assert_shows(edit::<DirectionalLight>("sun", |l| l.direction = DVec3::NEG_Y));
    assert_shows(edit::<Transform>("lamp", |t| *t = Transform::at(DVec3::new(-5.0, 0.0, 0.0))));
    assert_shows(|renderer| {
        renderer.world.spawn((Name::new("sky"), AmbientLight { intensity: Rgb::splat(0.5) }));
    });
    assert_shows(on("lamp", |entity| {
        entity.remove::<PointLight>();
    }));
    assert_shows(on("lamp", |entity| {
        entity.remove::<PointLight>();
        entity.insert(PointLight { position: DVec3::Y * 9.0, ..Default::default() });
    }));
    assert_shows(on("lamp", |entity| {
        entity.remove::<PointLight>().insert(DirectionalLight::default());
    }));
    assert_shows(on("sun", |entity| {
        entity.remove::<DirectionalLight>().insert(PointLight { position: DVec3::Y * 9.0, ..Default::default() });
    }));
}

#[test]
fn an_entity_with_two_kinds_of_light_shines_with_both() {
    let both = |together: bool| {
        let mut renderer = studio();
        let point = (Name::new("z"), PointLight { position: DVec3::new(0.0, 4.0, 6.0), ..Default::default() });
        let one = renderer.world.spawn(point).id();
        let beam = DirectionalLight::default();
        if together {
            renderer.world.entity_mut(one).insert(beam);
            renderer.snapshot().expect("a snapshot");
            renderer.world.entity_mut(one).remove::<PointLight>();
        } else {
            renderer.world.entity_mut(one).remove::<PointLight>();
            renderer.world.entity_mut(one).insert(beam);
        }
        let alone = hash(&mut renderer);
        renderer.world.entity_mut(one).insert(PointLight { position: DVec3::new(0.0, 4.0, 6.0), ..Default::default() });
        (alone, hash(&mut renderer))
    };
    assert_eq!(both(true), both(false));
    assert_ne!(both(true).0, both(true).1);
}

#[test]
fn materials_may_be_changed_shared_and_taken_away() {
    assert_shows(edit::<Color>("red", |c| c.0 = Rgb::Y));
    assert_shows(on("red", |entity| {
        entity.insert(Mirror(Rgb::splat(0.5)));
    }));
    assert_shows(on("red", |entity| {
        entity.remove::<Color>();
    }));
    assert_shows(on("crate", |entity| {
        entity.insert((Color(Rgb::X), Diffuse(Rgb::ONE)));
    }));
    assert_shows(on("red", |entity| {
        entity.insert(Checker { frequency: 5.0, ..Checker::default() });
    }));
    assert_shows(|renderer| {
        let red = find(renderer, "red");
        on("crate", |entity| {
            entity.insert(MaterialSlots(vec![red]));
        })(renderer);
    });
}

#[test]
fn a_texture_may_become_one_of_another_type() {
    let image = || {
        let image = Image::new(1, 1, vec![[0.1, 0.2, 0.9]]).expect("an image");
        ImageTexture::from(image)
    };
    for to_checker in [true, false] {
        let mut renderer = studio();
        let red = find(&mut renderer, "red");
        let mut fresh = studio();
        let fresh_red = find(&mut fresh, "red");
        if to_checker {
            renderer.world.entity_mut(red).insert(image());
            renderer.snapshot().expect("a snapshot");
            renderer.world.entity_mut(red).remove::<ImageTexture>().insert(Checker::default());
            fresh.world.entity_mut(fresh_red).insert(Checker::default());
        } else {
            renderer.world.entity_mut(red).insert(Checker::default());
            renderer.snapshot().expect("a snapshot");
            renderer.world.entity_mut(red).remove::<Checker>().insert(image());
            fresh.world.entity_mut(fresh_red).insert(image());
        }
        assert_eq!(hash(&mut renderer), hash(&mut fresh), "to checker: {to_checker}");
    }
}

#[test]
fn objects_whose_material_is_gone_become_plain() {
    let (_, after) = changed(|renderer| {
        let red = find(renderer, "red");
        renderer.world.despawn(red);
    });
    let (_, plain) = changed(on("ball", |entity| {
        entity.remove::<MadeOf>();
    }));
    assert_eq!(after, plain);
    let (_, without_effects) = changed(on("red", |entity| {
        entity.remove::<(Color, Diffuse)>();
    }));
    assert_eq!(after, without_effects);
}

#[test]
fn placements_pass_down_from_parents_that_come_move_and_go() {
    assert_shows(|renderer| {
        let group = renderer.world.spawn((Name::new("group"), Transform::at(DVec3::X))).id();
        for name in ["ball", "lamp", "camera"] {
            let entity = find(renderer, name);
            renderer.world.entity_mut(entity).insert(ChildOf(group));
        }
    });
    let grouped = |steps: &'static [&str]| {
        let mut renderer = studio();
        let (ball, crate_) = (find(&mut renderer, "ball"), find(&mut renderer, "crate"));
        renderer.world.entity_mut(ball).insert(ChildOf(crate_));
        let mut seen = vec![hash(&mut renderer)];
        for step in steps {
            match *step {
                "move parent" => {
                    *renderer.world.get_mut::<Transform>(crate_).expect("placed") = Transform::at(DVec3::Y)
                }
                "release" => {
                    renderer.world.entity_mut(ball).remove::<ChildOf>();
                }

                "reset child" => {
                    renderer.world.entity_mut(ball).remove::<Transform>();
                }

                "reset parent" => {
                    renderer.world.entity_mut(crate_).remove::<Transform>();
                }

                step => unreachable!("{step}"),
            }
            seen.push(hash(&mut renderer));
        }
        seen
    };
    // The same end by another way.
    let reset = |name: &str, parented: bool| {
        let mut renderer = studio();
        let (ball, crate_) = (find(&mut renderer, "ball"), find(&mut renderer, "crate"));
        if parented {
            renderer.world.entity_mut(ball).insert(ChildOf(crate_));
        }
        let entity = find(&mut renderer, name);
        renderer.world.entity_mut(entity).insert(Transform::default());
        hash(&mut renderer)
    };
    let released = grouped(&["move parent", "release"]);
    assert_ne!(released[0], released[1]);
    assert_ne!(released[1], released[2]);
    assert_eq!(grouped(&["release"])[1], hash(&mut studio()));
    assert_eq!(grouped(&["reset child"])[1], reset("ball", true));
    assert_eq!(grouped(&["reset parent"])[1], reset("crate", true));
    assert_eq!(grouped(&["release", "reset child"])[2], reset("ball", false));
    assert_eq!(grouped(&["release", "reset parent"])[2], reset("crate", false));
}

#[test]
fn a_despawned_parent_takes_its_children_along() {
    let (_, after) = changed(|renderer| {
        let group = renderer.world.spawn((Name::new("group"), Transform::at(DVec3::X))).id();
        let ball = find(renderer, "ball");
        renderer.world.entity_mut(ball).insert(ChildOf(group));
        renderer.world.despawn(group);
    });
    let (_, without) = changed(|renderer| {
        let ball = find(renderer, "ball");
        renderer.world.despawn(ball);
    });
    assert_eq!(after, without);
}

#[test]
fn names_decide_between_coincident_things_whenever_they_are_given() {
    // A red and a green ball in one place: the first in the order of names is seen, nameless ones come last, by age.
    let seen = |first: &[Option<&str>], then: &[Option<&str>]| {
        let mut renderer = studio();
        let mut balls = vec![];
        for (i, name) in first.iter().enumerate() {
            let color = Color(if i == 0 { Rgb::X } else { Rgb::Y });
            let place = Transform::at(DVec3::new(0.0, 1.0, 4.0));
            let mut ball = renderer.world.spawn((Sphere { radius: 0.5 }, place, color, Ambient(Rgb::ONE)));
            if let Some(name) = name {
                ball.insert(Name::new(*name));
            }
            balls.push(ball.id());
        }
        renderer.world.spawn((Name::new("sky"), AmbientLight::default()));
        renderer.snapshot().expect("a snapshot");
        for (ball, name) in balls.iter().zip(then) {
            match name {
                Some(name) => renderer.world.entity_mut(*ball).insert(Name::new(*name)),
                None => renderer.world.entity_mut(*ball).remove::<Name>(),
            };
        }
        let snapshot = renderer.snapshot().expect("a snapshot");
        let [r, g, _] = render(&snapshot, &Options::default()).picture.pixel(16, 12).expect("the middle");
        if r > g { "first" } else { "second" }
    };
    assert_eq!(seen(&[Some("a"), Some("b")], &[]), "first");
    assert_eq!(seen(&[Some("b"), Some("a")], &[]), "second");
    assert_eq!(seen(&[None, Some("b")], &[]), "second");
    assert_eq!(seen(&[None, None], &[]), "first");
    assert_eq!(seen(&[Some("a"), Some("b")], &[Some("c")]), "second");
    assert_eq!(seen(&[None, None], &[None, Some("a")]), "second");
    assert_eq!(seen(&[Some("a"), Some("b")], &[None]), "second");
}

#[test]
fn a_hundred_edits_and_their_undoing_leave_no_trace() {
    let mut renderer = studio();
    let before = hash(&mut renderer);
    let names = ["ball", "crate", "model", "lamp"];
    let mut random = Random::new(3);
    let mut undo: Vec<(Entity, Transform)> = vec![];
    for _ in 0..100 {
        let entity = find(&mut renderer, names[random.below(names.len())]);
        let mut transform = renderer.world.get_mut::<Transform>(entity).expect("a placement");
        undo.push((entity, transform.clone()));
        transform
            .0
            .push(Step::Rotate { axis: DVec3::new(random.unit(), 1.0, random.unit()), degrees: 360.0 * random.unit() });
        if random.below(4) == 0 {
            renderer.snapshot().expect("a snapshot");
        }
    }
    assert_ne!(before, hash(&mut renderer));
    for (entity, transform) in undo.into_iter().rev() {
        *renderer.world.get_mut::<Transform>(entity).expect("a placement") = transform;
        if random.below(4) == 0 {
            renderer.snapshot().expect("a snapshot");
        }
    }
    assert_eq!(before, hash(&mut renderer));
}

#[test]
fn settings_are_taken_over() {
    assert_shows(|renderer| renderer.settings().background = Rgb::ONE);
    assert_shows(|renderer| renderer.settings().shadows = false);
    assert_shows(|renderer| renderer.settings().antialias = Antialias::Four);
}

#[test]
fn bounding_spheres_hold_their_objects() {
    let mut random = Random::new(5);
    let mut renderer = Renderer::new();
    let world = &mut renderer.world;
    world.spawn(Camera::default());
    let steps = |random: &mut Random| {
        let mut vector = |reach: f64| DVec3::new(random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5) * reach;
        let (axis, scale, by) = (vector(1.0), vector(6.0), vector(2000.0));
        let degrees = 360.0 * axis.x;
        Transform::new([
            Step::Rotate { axis: axis.normalize_or(DVec3::X), degrees },
            Step::Scale(scale),
            Step::Rotate { axis: DVec3::ONE, degrees: 2.0 * degrees },
            Step::Translate(by),
        ])
    };
    let mesh = Arc::new(tetrahedron());
    for _ in 0..50 {
        world.spawn((Sphere { radius: 1.5 }, steps(&mut random)));
        world.spawn((Sphere { radius: 1.5 }, Transform::at(DVec3::splat(1e6 * random.unit()))));
        world.spawn((Cuboid { size: DVec3::new(1.0, 2.0, 0.5) }, steps(&mut random)));
        world.spawn((Triangle { b: DVec3::X, c: DVec3::Y, ..Triangle::default() }, steps(&mut random)));
        world.spawn((Mesh::new(mesh.clone()), steps(&mut random)));
    }
    let plane = world.spawn(Plane {}).id();
    renderer.snapshot().expect("a snapshot");
    let world = &mut renderer.world;
    assert!(world.get::<BoundingSphere>(plane).is_none(), "nothing holds a plane");

    type Shapes<'a> = (
        &'a BoundingSphere,
        &'a snell::components::transform::GlobalTransform,
        Option<&'a Sphere>,
        Option<&'a Cuboid>,
        Option<&'a Triangle>,
    );
    let mut objects = world.query::<Shapes<'_>>();
    let mut count = 0;
    for (bound, placed, sphere, cuboid, triangle) in objects.iter(world) {
        count += 1;
        let points: Vec<DVec3> = match (sphere, cuboid, triangle) {
            (Some(sphere), ..) => {
                let mut direction = || DVec3::new(random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5);
                (0..200).map(|_| direction().normalize_or(DVec3::X) * sphere.radius).collect()
            }
            (_, Some(cuboid), _) => Bounds { min: cuboid.size * -0.5, max: cuboid.size * 0.5 }.corners().into(),
            (_, _, Some(triangle)) => vec![triangle.a, triangle.b, triangle.c],
            _ => (0..4).flat_map(|i| mesh.corners(i)).collect(),
        };
        for point in points {
            let point = placed.0.transform_point3(point);
            // The test's own arithmetic rounds too.
            let slack = 1e-14 * point.abs().max_element();
            assert!(point.distance(bound.center) <= bound.radius + slack, "{point} is outside {bound:?}");
        }
    }
    assert_eq!(count, 250);
}

/// A ball that says its bounds are the whole of space.
#[derive(Component, Clone, Default, Describe)]
struct Vast {}

impl Primitive for Vast {
    type Packed = <Sphere as Primitive>::Packed;

    fn pack(&self, world_from_object: &DAffine3) -> Result<(Extent, Self::Packed), Degenerate> {
        let (_, packed) = Sphere { radius: 1.0 }.pack(world_from_object)?;
        Ok((Extent::Bounded(Bounds { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY }), packed))
    }

    fn hit(packed: &Self::Packed, ray: &Ray, t_max: f64, cost: &mut Cost) -> Option<Hit> {
        Sphere::hit(packed, ray, t_max, cost)
    }

    fn surface(packed: &Self::Packed, ray: &Ray, hit: Hit) -> Surface {
        Sphere::surface(packed, ray, hit)
    }
}

#[test]
fn a_shape_whose_bounds_are_not_numbers_is_left_out_and_reported() {
    let mut renderer = Renderer::new().with_primitive::<Vast>();
    renderer.add("camera", Camera::at([0.0, 0.0, 5.0]));
    renderer.add("vast", Vast {});
    let snapshot = renderer.snapshot().expect("a snapshot");
    assert_eq!(*snapshot.left_out, [("vast".into(), "it is larger than numbers are".into())]);
}

#[test]
fn shapes_without_a_surface_are_left_out_and_reported() {
    let flat = || Transform::new([Step::Scale(DVec3::new(1.0, 0.0, 1.0))]);
    let mut renderer = studio();
    let before = hash(&mut renderer);
    let world = &mut renderer.world;
    world.spawn((Name::new("a flattened sphere"), Sphere::default(), flat()));
    world.spawn((Name::new("a flattened plane"), Plane {}, flat()));
    world.spawn((Name::new("a line"), Triangle { b: DVec3::ONE, c: DVec3::ONE * 2.0, ..Triangle::default() }));
    world.spawn((
        Name::new("a triangle beyond numbers"),
        Triangle { b: DVec3::X, c: DVec3::NAN, ..Triangle::default() },
    ));
    world.spawn((Name::new("no model"), Mesh::default()));
    let needle = TriangleMesh::new(vec![[0.0; 3], [1.0; 3]], vec![[0, 1, 1]]).expect("a mesh");
    world.spawn((Name::new("a model of needles"), Mesh::new(needle)));
    for (name, radius) in [("no radius", 0.0), ("a negative radius", -1.0), ("a radius beyond numbers", f64::NAN)] {
        world.spawn((Name::new(name), Sphere { radius }));
    }
    world.spawn((Name::new("a negative box"), Cuboid { size: DVec3::new(1.0, -1.0, 1.0) }));
    world.spawn((Name::new("a flat box"), Cuboid { size: DVec3::new(1.0, 0.0, 1.0) }));
    world.spawn((Name::new("an endless box"), Cuboid { size: DVec3::splat(f64::INFINITY) }));
    assert_eq!(before, hash(&mut renderer), "the picture shows them");
    let left_out = renderer.snapshot().expect("a snapshot").left_out.clone();
    let names: Vec<&str> = left_out.iter().map(|(name, _)| name.as_str()).collect();
    let expected = [
        "a flat box",
        "a flattened plane",
        "a flattened sphere",
        "a line",
        "a model of needles",
        "a negative box",
        "a negative radius",
        "a radius beyond numbers",
        "a triangle beyond numbers",
        "an endless box",
        "no model",
        "no radius",
    ];
    assert_eq!(names, expected);
    assert!(left_out.iter().all(|(_, why)| !why.is_empty()));

    // Repaired, they are back.
    edit::<Sphere>("no radius", |s| s.radius = 3.0)(&mut renderer);
    assert_ne!(before, hash(&mut renderer));
    assert_eq!(renderer.snapshot().expect("a snapshot").left_out.len(), expected.len() - 1);
}

#[test]
fn without_exactly_one_camera_there_is_no_snapshot() {
    let message = |renderer: &mut Renderer| match renderer.snapshot() {
        Ok(_) => "a snapshot".to_owned(),
        Err(error) => error.to_string(),
    };
    let mut renderer = Renderer::new();
    assert!(message(&mut renderer).contains("no camera"));
    let one = renderer.world.spawn((Name::new("one"), Camera::default())).id();
    assert_eq!(message(&mut renderer), "a snapshot");
    renderer.world.spawn((Name::new("another"), Camera::default()));
    assert_eq!(message(&mut renderer), "the scene has 2 cameras, and one is needed: `another`, `one`");
    renderer.world.despawn(one);
    assert_eq!(message(&mut renderer), "a snapshot");
}

#[test]
fn a_camera_that_looks_nowhere_is_an_error() {
    for camera in [
        Camera { direction: Some(DVec3::ZERO), ..Camera::default() },
        Camera { target: Some(DVec3::ZERO), ..Camera::default() },
    ] {
        let mut renderer = Renderer::new();
        renderer.world.spawn(camera);
        assert!(renderer.snapshot().is_err_and(|error| error.to_string().contains("looks nowhere")));
    }
    let mut renderer = Renderer::new();
    renderer.world.spawn((Camera::default(), Transform::new([Step::Scale(DVec3::ZERO)])));
    assert!(renderer.snapshot().is_err_and(|error| error.to_string().contains("singular")));
}

#[test]
fn a_name_given_twice_is_an_error_until_it_is_not() {
    let mut renderer = studio();
    let twin = renderer.world.spawn(Name::new("ball")).id();
    let message = renderer.snapshot().err().expect("an error").to_string();
    assert_eq!(message, "two entities are named `ball`; names are unique in a scene");
    for repair in ["rename", "remove", "despawn"] {
        let mut renderer = studio();
        let twin = renderer.world.spawn(Name::new("ball")).id();
        assert!(renderer.snapshot().is_err());
        match repair {
            "rename" => {
                renderer.world.entity_mut(twin).insert(Name::new("twin"));
            }

            "remove" => {
                renderer.world.entity_mut(twin).remove::<Name>();
            }

            _ => {
                renderer.world.despawn(twin);
            }
        }
        assert!(renderer.snapshot().is_ok(), "{repair}");
    }
    renderer.world.despawn(twin);
}

#[test]
fn the_whole_schedule_initialises_without_ambiguities() {
    // Ambiguity detection is set to an error, so the first run of the schedule would panic.
    let mut renderer = Renderer::new();
    renderer.world.spawn(Camera::default());
    assert!(renderer.snapshot().is_ok());
}
