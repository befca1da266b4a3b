//! Coarse meshes with interpolated normals: no facet shades another that the same light reaches, and nothing is mirrored
//! below the surface.

use snell::prelude::*;
use snell::systems::render::{Forward, Look, Observer, Traced, Way, pixel_observed};
use snell::{Counts, components::math};
use std::sync::Arc;

/// A sphere of radius one as triangles with shared vertices: columns around, rows from pole to pole.
fn globe(columns: usize, rows: usize) -> TriangleMesh {
    let point = |row: usize, column: usize| {
        let (st, ct) = math::sin_cos_degrees(180.0 * row as f64 / rows as f64);
        let (sp, cp) = math::sin_cos_degrees(360.0 * column as f64 / columns as f64);
        DVec3::new(st * cp, ct, st * sp).as_vec3().to_array()
    };
    let mut positions = vec![point(0, 0), point(rows, 0)];
    (1..rows).for_each(|row| positions.extend((0..columns).map(|column| point(row, column))));
    let at = |row: usize, column: usize| (2 + (row - 1) * columns + column % columns) as u32;
    let mut triangles = vec![];
    for column in 0..columns {
        triangles.push([0, at(1, column + 1), at(1, column)]);
        triangles.push([1, at(rows - 1, column), at(rows - 1, column + 1)]);
        for row in 1..rows - 1 {
            triangles.push([at(row, column), at(row, column + 1), at(row + 1, column + 1)]);
            triangles.push([at(row, column), at(row + 1, column + 1), at(row + 1, column)]);
        }
    }
    TriangleMesh::new(positions, triangles).expect("a mesh")
}

/// The globe alone, turned so that no edge lies along a pixel, lit from the side.
fn scene(columns: usize, rows: usize, material: impl Bundle, smooth: bool) -> Arc<Snapshot> {
    let mut renderer = Renderer::new();
    *renderer.settings() = Settings { width: 96, height: 96, depth: 1, ..Settings::default() };
    let world = &mut renderer.world;
    world.spawn(Camera { position: DVec3::Z * 4.0, ..Camera::default() });
    world.spawn(DirectionalLight { direction: DVec3::new(-1.0, -0.4, -0.3), ..DirectionalLight::default() });
    let mesh = Mesh::new(globe(columns, rows));
    let placed = Transform::new([Step::RotateX(23.0), Step::RotateZ(11.0)]);
    world.spawn((if smooth { mesh.smooth() } else { mesh }, placed, material));
    renderer.snapshot().expect("a snapshot")
}

/// What is told of every pixel of a picture.
fn watched<O: Observer>(snapshot: &Snapshot, mut observer: O) -> O {
    for (x, y) in (0..96 * 96).map(|i| (i % 96, i / 96)) {
        let _ = pixel_observed(snapshot, x, y, &Methods::default(), &mut Counts::default(), &mut observer);
    }
    observer
}

const GLOBES: [(usize, usize); 4] = [(8, 6), (16, 12), (32, 24), (64, 48)];

/// Looks at the lamp by points that its light falls on by their shading normals, and those that end in the dark.
#[derive(Default)]
struct Looks {
    lit: u32,
    dark: u32,
    /// Points that a ray from the surface itself would find dark: how it is without the mend.
    dark_from_facet: u32,
    toward: Option<(DVec3, DVec3)>,
}

impl Observer for Looks {
    fn traced(&mut self, traced: &Traced<'_>) {
        self.toward = traced.met.map(|met| (met.surface.normal, met.surface.shading_normal));
    }

    fn looked(&mut self, look: &Look<'_>) {
        let (Some(visible), Some(light), Some((normal, _))) = (look.visible, look.light, self.toward) else { return };
        self.lit += 1;
        self.dark += u32::from(visible == Rgb::ZERO);
        // The mesh is convex: from the facet, the light is hidden exactly where it stands below it.
        self.dark_from_facet += u32::from(normal.dot(light.to_light) < 0.0);
    }
}

/// F54. Oracle: the globe stands alone and is convex, so whatever its own normals say is lit must be lit.
#[test]
fn facets_of_smooth_meshes_cast_no_shadow_on_their_neighbours() {
    for (columns, rows) in GLOBES {
        let looks = watched(&scene(columns, rows, Diffuse(Rgb::ONE), true), Looks::default());
        assert!(looks.lit > 1000, "{} looks", looks.lit);
        let share = |count: u32| f64::from(count) / f64::from(looks.lit);
        assert!(share(looks.dark) <= 0.001, "{columns} × {rows}: {} of {} in the dark", looks.dark, looks.lit);
        // The check can fail: from the facets themselves, 7 % of the coarsest globe is dark, and some of the finest.
        assert!(share(looks.dark_from_facet) > 0.3 / columns as f64, "{columns} × {rows}: {}", looks.dark_from_facet);
    }
}

/// Where nothing is smoothed, rays to lights start where they did.
#[test]
fn flat_meshes_are_lifted_nowhere() {
    let snapshot = scene(16, 12, Diffuse(Rgb::ONE), false);
    let looks = watched(&snapshot, Looks::default());
    assert!(looks.lit > 1000);
    assert_eq!((looks.dark, looks.dark_from_facet), (0, 0));
}

/// An occluder nearer to a smooth mesh than its facets are to the sphere still casts its shadow on most of what it covers.
#[test]
fn what_stands_over_a_smooth_mesh_still_shades_it() {
    let mut renderer = Renderer::new();
    *renderer.settings() = Settings { width: 96, height: 96, depth: 1, ..Settings::default() };
    let world = &mut renderer.world;
    world.spawn(Camera { position: DVec3::new(0.0, 0.5, 4.0), ..Camera::default() });
    world.spawn(DirectionalLight { direction: DVec3::NEG_Y, ..DirectionalLight::default() });
    world.spawn((Mesh::new(globe(32, 24)).smooth(), Diffuse(Rgb::ONE)));
    world.spawn((Cuboid { size: DVec3::new(4.0, 0.1, 4.0) }, Transform::at(DVec3::Y * 1.06), Diffuse(Rgb::ZERO)));
    let looks = watched(&renderer.snapshot().expect("a snapshot"), Looks::default());
    assert!(looks.lit > 500);
    // A hundredth above the pole: all is in its shadow.
    assert!(looks.lit - looks.dark <= looks.lit / 200, "{} of {} lit under a roof", looks.lit - looks.dark, looks.lit);
}

/// Mirrored rays, and those that go below the surface they come from.
#[derive(Default)]
struct MirroredRays {
    all: u32,
    below: u32,
    /// Those that would, were they mirrored at the interpolated normal.
    below_by_shading: u32,
    met: Option<(DVec3, DVec3)>,
    came: Option<DVec3>,
}

impl Observer for MirroredRays {
    fn sample(&mut self) {
        self.met = None;
    }

    fn traced(&mut self, traced: &Traced<'_>) {
        self.met = traced.met.map(|met| (met.surface.normal, met.surface.shading_normal));
    }

    fn put_forward(&mut self, ray: &Forward<'_>) {
        match (ray.way, self.met, self.came) {
            (Way::Camera, ..) => self.came = Some(ray.ray.direction),
            (Way::Mirrored, Some((normal, shading)), Some(came)) => {
                self.all += 1;
                self.below += u32::from(ray.ray.direction.dot(normal) <= 0.0);
                let by_shading = came - shading * (2.0 * came.dot(shading));
                self.below_by_shading += u32::from(by_shading.dot(normal) <= 0.0);
            }
            _ => {}
        }
    }
}

/// F55. Oracle: the sign of the angle to the true surface.
#[test]
fn nothing_is_mirrored_below_the_surface() {
    for (columns, rows) in GLOBES {
        let rays = watched(&scene(columns, rows, Mirror(Rgb::ONE), true), MirroredRays::default());
        assert!(rays.all > 1000, "{} rays", rays.all);
        assert_eq!(rays.below, 0, "{columns} × {rows}: of {}", rays.all);
        // The check can fail: at the interpolated normal, some of every globe would.
        assert!(rays.below_by_shading > 0, "{columns} × {rows}");
    }
}
