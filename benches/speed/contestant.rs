//! Snell as one of the programs that `benches/peers/compare.py` sets side by side; the README there tells the rules.

use crate::{
    clock::{Spent, spent},
    rays::{Kind, Rays, Search},
    subject::{Subject, build, snapshot},
};
use clap::ValueEnum;
use snell::{
    Options, Picture, Renderer,
    components::primitive::Degenerate,
    prelude::{DAffine3, Primitive},
    render,
    systems::image::srgb8,
};
use std::{
    error::Error,
    fs,
    io::{self, BufRead, Write},
    path::Path,
};

/// How much is to be found out for each ray; shadow rays only ask whether anything is met.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Goal {
    /// Distance and triangle, in the mesh alone.
    Search,
    /// Distance, object, triangle and its normal, in a scene: what a call of Embree tells.
    Nearest,
    /// The same, with rays in packets.
    Packets,
    /// The whole surface at the hit, in a scene.
    Surface,
}

/// Writes the sets of rays about a mesh.
pub(crate) fn write_rays(mesh: &Path, rays: &Path) -> Result<(), Box<dyn Error>> {
    let subject = Subject::read_tri(mesh)?;
    let (min, max) = subject.bounds();
    for set in Rays::about(&snapshot(subject.mesh()).geometry, min, max) {
        set.write(rays)?;
    }
    Ok(())
}

/// Answers commands until there are no more.
pub(crate) fn answer(mesh: &Path, rays: &Path, goal: Goal) -> Result<(), Box<dyn Error>> {
    let subject = Subject::read_tri(mesh)?;
    let mesh = subject.mesh();
    let snapshot = snapshot(mesh.clone());
    let geometry = &snapshot.geometry;
    let (_, packed) = mesh.pack(&DAffine3::IDENTITY).map_err(|Degenerate(why)| why)?;
    let triangles = mesh.model.data.as_deref().ok_or("a mesh without triangles")?;
    let search = match goal {
        Goal::Search => Search::Mesh { packed: &packed },
        Goal::Nearest => Search::Nearest { geometry, mesh: triangles },
        Goal::Packets => Search::Packets { geometry, mesh: triangles },
        Goal::Surface => Search::Surface { geometry },
    };
    let mut sets = vec![];
    for kind in Kind::ALL {
        sets.push(Rays::read(rays, kind)?);
    }
    tell(format_args!(r#"{{"name": "Snell {}"}}"#, env!("CARGO_PKG_VERSION")))?;
    for line in io::stdin().lock().lines() {
        let line = line?;
        let words: Vec<_> = line.split_whitespace().collect();
        match *words {
            ["build", threads] => answer_build(&subject, threads.parse()?)?,
            ["trace", kind, threads] => {
                let set = sets.iter().find(|set| set.kind.name() == kind).ok_or("no such kind of rays")?;
                answer_trace(set, &search, threads.parse()?)?;
            }
            _ => return Err(format!("not understood: {line}").into()),
        }
    }
    Ok(())
}

/// Loads a scene, draws it on some threads and writes the picture as PPM; tells what that took.
pub(crate) fn draw(scene: &Path, threads: usize, picture: &Path) -> Result<(), Box<dyn Error>> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let mut renderer = Renderer::new();
    let (snapshot, load) = spent(|| {
        pool.install(|| {
            renderer.load(scene).map_err(|faults| faults.to_string())?;
            renderer.snapshot().map_err(|why| why.to_string())
        })
    });
    let snapshot = snapshot?;
    let (frame, trace) = spent(|| pool.install(|| render(&snapshot, &Options::default())));
    fs::write(picture, ppm(&frame.picture))?;
    let counts = frame.counts;
    let (rays, primary, shadow) = (counts.rays(), counts.primary, counts.shadow);
    let bounced = counts.mirror + counts.transmitted;
    let (nodes, tests) = (counts.nodes, counts.primitives);
    tell(format_args!(
        r#"{{"load_wall": {:.6}, "load_cpu": {:.6}, "trace_wall": {:.6}, "trace_cpu": {:.6}, "rays": {rays}, "primary": {primary}, "bounced": {bounced}, "shadow": {shadow}, "nodes": {nodes}, "tests": {tests}}}"#,
        load.wall, load.cpu, trace.wall, trace.cpu
    ))?;
    Ok(())
}

/// A picture of 8 bits a channel, sRGB.
fn ppm(picture: &Picture) -> Vec<u8> {
    let mut bytes = format!("P6\n{} {}\n255\n", picture.width, picture.height).into_bytes();
    bytes.extend(srgb8(picture).as_flattened());
    bytes
}

fn answer_build(subject: &Subject, threads: usize) -> Result<(), Box<dyn Error>> {
    let mesh = subject.mesh();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let ((), Spent { wall, cpu }) = spent(|| pool.install(|| build(&mesh)));
    let model = mesh.model.data.as_deref().ok_or("a mesh without triangles")?;
    let (items, bytes) = (model.len(), model.bytes());
    tell(format_args!(r#"{{"items": {items}, "bytes": {bytes}, "wall": {wall:.6}, "cpu": {cpu:.6}}}"#))?;
    Ok(())
}

fn answer_trace(set: &Rays, search: &Search<'_>, threads: usize) -> io::Result<()> {
    let (met, Spent { wall, cpu }) = spent(|| set.trace(search, threads));
    let (items, hits, t) = (set.rays.len(), met.hits, met.t);
    tell(format_args!(r#"{{"items": {items}, "hits": {hits}, "t": {t:e}, "wall": {wall:.6}, "cpu": {cpu:.6}}}"#))
}

fn tell(line: core::fmt::Arguments<'_>) -> io::Result<()> {
    let mut out = io::stdout().lock();
    writeln!(out, "{line}")?;
    out.flush()
}
