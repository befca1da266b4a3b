//! Build and trace on a height field of the bench's own: `cargo bench`.
//!
//! Prints medians of interleaved runs and the counts behind them. Times are of this machine and this moment: compare
//! ratios within one run, and counts across machines.

use snell::prelude::*;
use std::time::Instant;

/// Runs of each measurement; the median is told.
const RUNS: usize = 7;

/// Quads along one edge of each height field.
const SIZES: [u32; 3] = [50, 224, 708];

fn main() {
    println!(
        "{:>10}  {:>12}  {:>12}  {:>12}  {:>10}  {:>10}",
        "triangles", "build Mtri/s", "frame ms", "Mray/s", "nodes/ray", "tests/ray"
    );
    let mut rows: Vec<Vec<(f64, f64, Frame)>> = vec![vec![]; SIZES.len()];
    // Interleaved, so that a change of the machine's speed meets all sizes alike.
    for _ in 0..RUNS {
        for (size, row) in SIZES.iter().zip(&mut rows) {
            row.push(run(*size));
        }
    }
    for (size, row) in SIZES.iter().zip(&mut rows) {
        let triangles = 2 * size * size;
        let build = median(row.iter().map(|run| run.0));
        let trace = median(row.iter().map(|run| run.1));
        let counts = row[0].2.counts;
        let rays = counts.rays() as f64;
        println!(
            "{triangles:>10}  {:>12.2}  {:>12.1}  {:>12.2}  {:>10.2}  {:>10.2}",
            f64::from(triangles) / build / 1e6,
            trace * 1e3,
            rays / trace / 1e6,
            counts.nodes as f64 / rays,
            counts.primitives as f64 / rays,
        );
    }
}

/// Seconds to build, seconds to trace on one thread, and the frame.
fn run(size: u32) -> (f64, f64, Frame) {
    let mut renderer = Renderer::new();
    renderer.settings().width = 400;
    renderer.settings().height = 300;
    let world = &mut renderer.world;
    let camera =
        Camera { position: DVec3::new(0.5, 0.6, 1.6), target: Some(DVec3::new(0.5, 0.0, 0.5)), ..Camera::default() };
    world.spawn((Name::new("camera"), camera));
    world.spawn((Name::new("lamp"), PointLight { position: DVec3::new(2.0, 3.0, 1.0), ..PointLight::default() }));
    world.spawn((
        Name::new("field"),
        Mesh::new(height_field(size)).smooth(),
        Diffuse(Rgb::splat(0.8)),
        Mirror(Rgb::splat(0.2)),
    ));
    let start = Instant::now();
    let snapshot = renderer.snapshot().expect("a scene that can be drawn");
    let build = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let frame = render(&snapshot, &Options { threads: Some(1), ..Options::default() });
    (build, start.elapsed().as_secs_f64(), frame)
}

/// Waves over the unit square.
fn height_field(size: u32) -> TriangleMesh {
    let edge = size + 1;
    let wave = |x: f64| snell::components::math::sin_cos_degrees(x * 1080.0).0;
    let positions = (0..edge * edge)
        .map(|i| [i % edge, i / edge].map(|k| f64::from(k) / f64::from(size)))
        .map(|[x, z]| [x as f32, (0.04 * (wave(x) + wave(z + 0.3 * x))) as f32, z as f32])
        .collect();
    let triangles = (0..size * size)
        .map(|i| (i / size) * edge + i % size)
        .flat_map(|a| [[a, a + edge, a + 1], [a + 1, a + edge, a + edge + 1]])
        .collect();
    TriangleMesh::new(positions, triangles).expect("a mesh")
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
