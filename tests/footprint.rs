//! How much of a surface a ray stands for, against what the rays next to it meet.

use bevy_ecs::component::Component;
use snell::components::{
    math,
    texture::{Pattern, TexturePoint},
};
use snell::prelude::*;
use snell::systems::render::pixel;
use std::sync::Arc;

/// Shows where a texture is looked up.
#[derive(Component, Clone, Copy, Debug, Default)]
struct Probe(Show);

#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Show {
    #[default]
    Uv,
    UvFootprint(usize),
    Point,
    PointFootprint(usize),
}

impl Describe for Probe {
    const TAG: &'static str = "Probe";

    fn describe(&mut self, _: &mut dyn FieldVisitor) {}
}

impl Texture for Probe {
    fn pack(&self) -> Option<Arc<dyn Pattern>> {
        Some(Arc::new(*self))
    }
}

impl Pattern for Probe {
    fn color(&self, at: &TexturePoint) -> Rgb {
        match self.0 {
            Show::Uv => at.uv.extend(0.0),
            Show::UvFootprint(axis) => at.footprint.uv[axis].extend(0.0),
            Show::Point => at.point,
            Show::PointFootprint(axis) => at.footprint.point[axis],
        }
    }

    fn filters(&self) -> bool {
        matches!(self.0, Show::UvFootprint(_) | Show::PointFootprint(_))
    }
}

const SIZE: u32 = 4001;

/// A scene in whose picture the middle column and row are those of the pixel 2000; `build` is given the probe.
fn scene(camera: &Camera, show: Show, build: impl Fn(&mut World, (Probe, Ambient))) -> Arc<Snapshot> {
    let mut renderer = Renderer::new().with_texture::<Probe>();
    *renderer.settings() = Settings { width: SIZE, height: SIZE, cutoff: 0.0, ..Settings::default() };
    renderer.world.spawn(camera.clone());
    renderer.world.spawn(AmbientLight::default());
    build(&mut renderer.world, (Probe(show), Ambient(Rgb::ONE)));
    renderer.snapshot().expect("a snapshot")
}

fn shown(snapshot: &Snapshot, x: u32, y: u32) -> DVec3 {
    pixel(snapshot, x, y, &Methods::default(), &mut snell::Counts::default())
}

/// Asserts that the footprints of some pixels are the differences between what their neighbours show.
#[track_caller]
fn assert_footprints(camera: &Camera, pixels: &[(u32, u32)], build: impl Fn(&mut World, (Probe, Ambient))) {
    let shows: [(Show, fn(usize) -> Show); 2] = [(Show::Uv, Show::UvFootprint), (Show::Point, Show::PointFootprint)];
    for (what, footprint) in shows {
        let values = scene(camera, what, &build);
        for (axis, (dx, dy)) in [(1, 0), (0, 1)].into_iter().enumerate() {
            let footprints = scene(camera, footprint(axis), &build);
            for &(x, y) in pixels {
                let apart = (shown(&values, x + dx, y + dy) - shown(&values, x - dx, y - dy)) * 0.5;
                let found = shown(&footprints, x, y);
                assert!(apart.length() > 0.0, "nothing to see at {x}, {y}");
                assert!(
                    (found - apart).length() <= 2e-3 * apart.length(),
                    "{what:?} along axis {axis} at {x}, {y}: {found}, neighbours are apart {apart}"
                );
            }
        }
    }
}

fn above() -> Camera {
    Camera { position: DVec3::new(0.3, 2.0, 5.0), target: Some(DVec3::ZERO), ..Camera::default() }
}

const MIDDLE: [(u32, u32); 4] = [(2000, 2000), (1800, 2100), (2150, 1850), (2040, 2200)];

#[test]
fn on_a_plane_from_above_it_is_the_height_times_the_angle_of_a_pixel() {
    let camera = Camera { position: DVec3::Y * 3.0, target: Some(DVec3::ZERO), up: DVec3::NEG_Z, ..Camera::default() };
    let build = |world: &mut World, probe: (Probe, Ambient)| {
        world.spawn((Plane {}, probe));
    };
    let side = 3.0 * 2.0 * math::tan_degrees(0.5 * camera.field_of_view) / f64::from(SIZE);
    for (axis, expected) in [DVec2::new(side, 0.0), DVec2::new(0.0, -side)].into_iter().enumerate() {
        let found = shown(&scene(&camera, Show::UvFootprint(axis), build), 2000, 2000);
        assert!((found.truncate() - expected).length() < 1e-9 * side, "{found}, expected {expected}");
    }
}

#[test]
fn four_rays_to_a_pixel_have_half_the_footprint_each_way() {
    let build = |world: &mut World, probe: (Probe, Ambient)| {
        world.spawn((Plane {}, probe));
    };
    let snapshot = scene(&above(), Show::UvFootprint(0), build);
    let settings = Settings { antialias: Antialias::Four, ..snapshot.settings.clone() };
    let four = Snapshot { settings, ..(*snapshot).clone() };
    let (one, four) = (shown(&snapshot, 2000, 2000), shown(&four, 2000, 2000));
    assert!((four - one * 0.5).length() < 1e-3 * one.length(), "{four} against {one}");
}

#[test]
fn on_every_shape_it_is_what_neighbours_see() {
    let turned = || Transform::new([Step::RotateX(20.0), Step::RotateY(35.0)]);
    let shapes: [&dyn Fn(&mut World) -> Entity; 6] = [
        &|world| world.spawn((Plane {}, turned())).id(),
        &|world| world.spawn((Sphere { radius: 1.0 }, turned())).id(),
        &|world| {
            let egg = Transform::new([Step::Scale(DVec3::new(2.0, 1.0, 1.3)), Step::RotateY(20.0)]);
            world.spawn((Sphere { radius: 1.0 }, egg)).id()
        },
        &|world| world.spawn((Cuboid { size: DVec3::splat(1.6) }, turned())).id(),
        &|world| {
            let (a, b, c) = (DVec3::new(-2.0, -1.0, 0.0), DVec3::new(2.0, -1.0, 0.3), DVec3::new(0.0, 2.0, 0.1));
            world.spawn(Triangle { a, b, c, ..Triangle::default() }).id()
        },
        &|world| world.spawn(Mesh::new(tetrahedron())).id(),
    ];
    for shape in shapes {
        assert_footprints(&above(), &MIDDLE, |world, probe| {
            let shape = shape(world);
            world.entity_mut(shape).insert(probe);
        });
    }
}

fn tetrahedron() -> TriangleMesh {
    let corners = vec![[0.0, 1.5, 0.2], [-1.4, -0.8, 1.0], [1.4, -0.8, 0.9], [0.0, -0.7, -1.5]];
    TriangleMesh::new(corners, vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]]).expect("a mesh")
}

/// The probe all around.
fn around(world: &mut World, probe: (Probe, Ambient)) {
    world.spawn((Sphere { radius: 30.0 }, probe));
}

/// A floor with the probe on it.
fn floor(world: &mut World, probe: (Probe, Ambient)) {
    world.spawn((Plane {}, Transform::at(DVec3::Y * -2.0), probe));
}

#[test]
fn mirrors_carry_it_on_and_curved_ones_spread_it() {
    let mirror = Mirror(Rgb::ONE);
    let mirrors: [&dyn Fn(&mut World) -> Entity; 4] = [
        &|world| world.spawn((Cuboid { size: DVec3::new(4.0, 4.0, 0.1) }, Transform::new([Step::RotateX(40.0)]))).id(),
        &|world| world.spawn(Sphere { radius: 1.0 }).id(),
        &|world| world.spawn((Sphere { radius: 1.0 }, Transform::new([Step::Scale(DVec3::new(2.0, 1.0, 1.3))]))).id(),
        &|world| world.spawn(Mesh::new(tetrahedron()).smooth()).id(),
    ];
    for shape in mirrors {
        assert_footprints(&above(), &MIDDLE, |world, probe| {
            let shape = shape(world);
            world.entity_mut(shape).insert(mirror);
            around(world, probe);
        });
    }
}

#[test]
fn glass_gathers_it() {
    let bodies: [&dyn Fn(&mut World) -> Entity; 3] = [
        &|world| world.spawn(Sphere { radius: 1.0 }).id(),
        &|world| world.spawn((Cuboid { size: DVec3::splat(1.5) }, Transform::new([Step::RotateY(30.0)]))).id(),
        &|world| world.spawn((Sphere { radius: 1.0 }, Transform::new([Step::Scale(DVec3::new(2.0, 1.0, 0.3))]))).id(),
    ];
    for shape in bodies {
        assert_footprints(&Camera { position: DVec3::new(0.3, 1.0, 5.0), ..above() }, &MIDDLE, |world, probe| {
            let shape = shape(world);
            world.entity_mut(shape).insert((Transmission(Rgb::ONE), Refraction { index: 1.5 }));
            around(world, probe);
        });
    }
}

#[test]
fn straight_through_clear_things_it_stays_what_it_was() {
    let behind = |pane: bool| {
        scene(&above(), Show::UvFootprint(0), move |world, probe| {
            floor(world, probe);
            if pane {
                let pane = (Sphere { radius: 1.0 }, Transform::at(DVec3::new(0.1, 0.0, 1.0)));
                world.spawn((pane, Transmission(Rgb::ONE)));
            }
        })
    };
    let [without, with] = [false, true].map(|pane| shown(&behind(pane), 2000, 2000));
    assert!((with - without).length() < 1e-6 * without.length(), "{with} against {without}");
}

#[test]
fn the_seam_of_a_sphere_is_crossed_as_if_it_were_not_there() {
    // Straight at −x, where u jumps from 1 to 0.
    let camera = Camera { position: DVec3::X * -4.0, target: Some(DVec3::ZERO), ..Camera::default() };
    let footprint = |turn: f64| {
        let snapshot = scene(&camera, Show::UvFootprint(0), |world, probe| {
            world.spawn((Sphere { radius: 1.0 }, Transform::new([Step::RotateY(turn)]), probe));
        });
        shown(&snapshot, 2000, 2000)
    };
    let (at_the_seam, elsewhere) = (footprint(1e-7), footprint(70.0));
    assert!((at_the_seam - elsewhere).length() < 1e-6 * elsewhere.length(), "{at_the_seam} against {elsewhere}");
}

#[test]
fn none_is_worked_out_where_no_texture_filters() {
    let image = Image::new(1, 1, vec![[0.5; 3]]).expect("an image");
    let plain = |world: &mut World, _: (Probe, Ambient)| {
        world.spawn((Plane {}, ImageTexture::from(image.clone())));
    };
    assert!(!scene(&above(), Show::Uv, plain).materials.any_filtered);
    assert!(!scene(&above(), Show::Uv, floor).materials.any_filtered);
    assert!(scene(&above(), Show::UvFootprint(0), floor).materials.any_filtered);
}
