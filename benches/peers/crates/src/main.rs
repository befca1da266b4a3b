//! The crates `obvhs` and `bvh` as contestants: see `../README.md` for what a contestant reads and answers.
//!
//! ```text
//! crates MESH.tri RAYS CONFIGURATION
//! ```
//!
//! Configurations: `cwbvh` and `bvh2` of `obvhs`, with its medium build and its triangles; `bvh`, with Möller and
//! Trumbore's test, as that crate leaves triangles to its user.

mod bvh_crate;
mod obvhs_crate;

use std::{
    io::BufRead,
    sync::atomic::{AtomicUsize, Ordering},
    time::Instant,
};

/// Rays a thread takes at a time.
const CHUNK: usize = 4096;

const KINDS: [&str; 4] = ["primary", "shadow", "mirror", "diffuse"];

#[derive(Clone, Copy)]
pub struct Ray {
    pub origin: [f32; 3],
    pub t_min: f32,
    pub direction: [f32; 3],
    pub t_max: f32,
}

pub struct Mesh {
    pub positions: Vec<[f32; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

/// A tree over a mesh, as one of the crates makes it.
pub trait Tree: Send + Sync {
    /// Distance to the nearest hit.
    fn closest(&self, ray: &Ray) -> Option<f32>;
    /// Whether anything is hit.
    fn blocked(&self, ray: &Ray) -> bool;
}

/// Builds the tree of a configuration, in parallel if asked to.
pub type Build = fn(&Mesh, parallel: bool) -> Box<dyn Tree>;

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, mesh, rays, configuration] = &arguments[..] else { panic!("usage: crates MESH.tri RAYS CONFIGURATION") };
    let (build, name): (Build, _) = match configuration.as_str() {
        "cwbvh" => (obvhs_crate::build_wide, "obvhs CWBVH"),
        "bvh2" => (obvhs_crate::build_binary, "obvhs BVH2"),
        "bvh" => (bvh_crate::build, "bvh"),
        _ => panic!("there is no configuration {configuration}"),
    };
    let mesh = read_mesh(mesh);
    let rays = KINDS.map(|kind| read_rays(&format!("{rays}.{kind}.rays")));
    let tree = build(&mesh, false);
    println!("{{\"name\": \"{name}\"}}");
    for line in std::io::stdin().lock().lines() {
        let line = line.expect("a line");
        match line.split_whitespace().collect::<Vec<_>>()[..] {
            ["build", threads] => {
                let threads: usize = threads.parse().expect("a number of threads");
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
                let (built, wall, cpu) = timed(|| pool.install(|| build(&mesh, threads > 1)));
                drop(built);
                println!("{{\"items\": {}, \"wall\": {wall:.6}, \"cpu\": {cpu:.6}}}", mesh.triangles.len());
            }
            ["trace", kind, threads] => {
                let set = KINDS.iter().position(|known| *known == kind).expect("a kind of rays");
                let threads = threads.parse().expect("a number of threads");
                let ((hits, t), wall, cpu) = timed(|| trace(&*tree, &rays[set], kind == "shadow", threads));
                let items = rays[set].len();
                println!(
                    "{{\"items\": {items}, \"hits\": {hits}, \"t\": {t:e}, \"wall\": {wall:.6}, \"cpu\": {cpu:.6}}}"
                );
            }
            _ => panic!("not understood: {line}"),
        }
    }
}

/// Count of hits and sum of their distances.
fn trace(tree: &dyn Tree, rays: &[Ray], shadow: bool, threads: usize) -> (u64, f64) {
    let next = AtomicUsize::new(0);
    let work = || {
        let (mut hits, mut sum) = (0, 0.0);
        while let Some(rays) = rays.get(next.fetch_add(CHUNK, Ordering::Relaxed)..) {
            for ray in &rays[..rays.len().min(CHUNK)] {
                if shadow {
                    hits += u64::from(tree.blocked(ray));
                } else if let Some(t) = tree.closest(ray) {
                    hits += 1;
                    sum += f64::from(t);
                }
            }
        }
        (hits, sum)
    };
    std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(work)).collect();
        let mine = work();
        others.into_iter().map(|other| other.join().expect("no panic")).fold(mine, |a, b| (a.0 + b.0, a.1 + b.1))
    })
}

/// What some work gives, with seconds on the wall and of the processor.
fn timed<R>(work: impl FnOnce() -> R) -> (R, f64, f64) {
    let (wall, cpu) = (Instant::now(), cpu_time::ProcessTime::now());
    let result = work();
    (result, wall.elapsed().as_secs_f64(), cpu.elapsed().as_secs_f64())
}

fn words(path: &str) -> Vec<[u8; 4]> {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{path}: {error}"));
    bytes.as_chunks().0.to_vec()
}

fn read_mesh(path: &str) -> Mesh {
    let words = words(path);
    let vertices = u32::from_le_bytes(words[0]) as usize;
    let (positions, corners) = words[2..].split_at(3 * vertices);
    Mesh {
        positions: positions.as_chunks().0.iter().map(|p| p.map(f32::from_le_bytes)).collect(),
        triangles: corners.as_chunks().0.iter().map(|c| c.map(u32::from_le_bytes)).collect(),
    }
}

fn read_rays(path: &str) -> Vec<Ray> {
    let numbers: Vec<f32> = words(path).into_iter().map(f32::from_le_bytes).collect();
    let ray = |&[ox, oy, oz, t_min, dx, dy, dz, t_max]: &[f32; 8]| Ray {
        origin: [ox, oy, oz],
        t_min,
        direction: [dx, dy, dz],
        t_max,
    };
    numbers.as_chunks().0.iter().map(ray).collect()
}
