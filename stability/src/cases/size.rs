//! F12: size and place change the picture. Oracle: the picture at size one about the origin.

use crate::{
    meshes::bumpy,
    suite::{Bench, Case, Expected::*, Size, Tally, Trial},
};
use glam::DVec3;
use snell_components::{
    camera::Camera,
    light::PointLight,
    material,
    method::{Methods, Precision, SphereTest, TriangleTest},
    name::Name,
    settings::Settings,
    shape::{Cuboid, Mesh, Sphere},
    transform::{Step, Transform},
};
use snell_systems::{
    pipeline::Renderer,
    render::{Options, Picture, render},
    snapshot::Snapshot,
};
use std::sync::Arc;

pub(super) const CASES: &[Case] = &[Case {
    id: "F12",
    name: "size and place change the picture",
    about: "all scaled by 2^k: the same bits; in any place: pixels that differ by 1/255, but for those at edges of the picture",
    run: sizes,
}];

/// A scene of three shapes with shadows and mirrors, seen full-frame, all of it scaled and moved.
fn view(scale: f64, offset: DVec3, size: Size) -> Option<Arc<Snapshot>> {
    let place = |p: DVec3| p * scale + offset;
    let mut renderer = Renderer::new();
    let (width, height) = if size == Size::Fast { (160, 120) } else { (480, 360) };
    *renderer.settings() = Settings { width, height, depth: 3, ..Settings::default() };
    let world = &mut renderer.world;
    let camera =
        Camera { position: place(DVec3::new(1.5, 2.5, 6.0)), target: Some(place(DVec3::ZERO)), ..Camera::default() };
    world.spawn((Name::new("camera"), camera));
    world
        .spawn((Name::new("lamp"), PointLight { position: place(DVec3::new(3.0, 6.0, 4.0)), ..PointLight::default() }));
    let placed =
        |at: DVec3| Transform::new([Step::Translate(at), Step::Scale(DVec3::splat(scale)), Step::Translate(offset)]);
    let shine = (material::Diffuse(DVec3::splat(0.6)), material::Mirror(DVec3::splat(0.3)));
    world.spawn((Name::new("mesh"), Mesh::new(bumpy(12, 10, 0.3, 5)), placed(DVec3::X * -1.2), shine));
    world.spawn((Name::new("ball"), Sphere { radius: 1.0 }, placed(DVec3::X * 1.2), shine));
    world.spawn((Name::new("floor"), Cuboid { size: DVec3::new(8.0, 0.5, 8.0) }, placed(DVec3::Y * -1.6), shine));
    renderer.snapshot().ok()
}

fn off(a: [f32; 3], b: [f32; 3]) -> bool {
    a.iter().zip(b).any(|(a, b)| f64::from((a - b).abs()) > 1.0 / 255.0)
}

/// For each pixel, whether one of the eight about it differs.
fn edges(picture: &Picture) -> Vec<bool> {
    let (width, height) = (picture.width as usize, picture.height as usize);
    let at_edge = |i: usize| {
        let (x, y) = (i % width, i / width);
        let near = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
        near(y, height).any(|v| near(x, width).any(|u| off(picture.pixels[v * width + u], picture.pixels[i])))
    };
    (0..width * height).map(at_edge).collect()
}

fn sizes(bench: &mut Bench) {
    let size = bench.size;
    let picture = |scale: f64, offset: DVec3, methods: Methods| {
        view(scale, offset, size).map(|view| render(&view, &Options { methods, ..Options::default() }).picture)
    };
    let ours = Methods::default();
    let Some(original) = picture(1.0, DVec3::ZERO, ours) else { return };
    let mut tally = Tally::default();
    for k in [-40, -20, -3, 1, 10, 40] {
        let scale = if k < 0 { 1.0 / (1u64 << -k) as f64 } else { (1u64 << k) as f64 };
        tally.add(Trial::of(picture(scale, DVec3::ZERO, ours).as_ref() == Some(&original)));
    }
    bench.add(Sound, "Snell, the same bits at 2^k (tries are pictures)", "", tally);
    // Elsewhere, other digits are rounded away.
    let mut tally = Tally::default();
    for offset in [1e2, 1e4, 1e6] {
        tally.add(Trial::of(picture(1.0, DVec3::new(1.0, 0.25, -0.5) * offset, ours).as_ref() == Some(&original)));
    }
    bench.add(Failing, "Snell, the same bits in other places: no promise", "", tally);

    let edges = edges(&original);
    let usual = Methods {
        triangle: TriangleTest::MollerTrumbore,
        sphere: SphereTest::Naive,
        precision: Precision::F32,
        ..Methods::default()
    };
    for scale in [1e-6, 1e-3, 1.0, 1e3, 1e6] {
        for offset in [0.0, 1e2, 1e4, 1e6] {
            let at = DVec3::new(1.0, 0.25, -0.5) * (offset * scale);
            for (name, methods) in [("Snell", ours), ("usual tests in f32", usual)] {
                let Some(moved) = picture(scale, at, methods) else { return };
                let (mut plain, mut at_edges) = (Tally::default(), 0u32);
                for ((a, b), edge) in moved.pixels.iter().zip(&original.pixels).zip(&edges) {
                    if *edge {
                        at_edges += u32::from(off(*a, *b));
                    } else {
                        plain.add(Trial::of(!off(*a, *b)));
                    }
                }
                let sound = name == "Snell";
                // With f32 the scene is gone at a million sizes from the origin.
                let expected = if sound {
                    Sound
                } else if offset >= 1e6 {
                    Failing
                } else {
                    Shown
                };
                bench.add_at(expected, name, scale, offset * scale, plain);
                if sound {
                    // Edges may fall on the other side: for one pixel in five hundred of all, no more.
                    let mut share = Tally::default();
                    share.add(Trial::within(f64::from(at_edges) / moved.pixels.len() as f64, 0.002));
                    let cell = format!("scale {scale:e}, offset {:e}", offset * scale);
                    bench.add(Sound, "Snell, share of pixels at edges that are off, one picture", cell, share);
                }
            }
        }
    }
}
