//! `snell render` and `snell hash`.

use super::{
    Console, Failure,
    args::{Bits, HashArguments, RenderArguments},
    draw::{Drawn, draw},
    machine,
    stats::Stats,
    watch::watch,
};
use crate::Renderer;
use snell_systems::image::{self, FileError, Format, Metadata, key};
use std::path::{Path, PathBuf};

/// Draws a scene to a file.
pub(super) fn render(
    renderer: &mut Renderer,
    args: &RenderArguments,
    console: &mut Console<'_>,
) -> Result<(), Failure> {
    if args.watch { watch(renderer, args, console) } else { render_once(renderer, args, console) }
}

/// Draws a scene to a file, once.
pub(super) fn render_once(
    renderer: &mut Renderer,
    args: &RenderArguments,
    console: &mut Console<'_>,
) -> Result<(), Failure> {
    let scene = &args.drawing.scene;
    let output = args.output.clone().unwrap_or_else(|| default_output(scene));
    let format = format(&output, args.bits)?;
    // Before the work, not after it.
    for file in [Some(&output), args.stats.as_ref()].into_iter().flatten() {
        image::check_writable(file).map_err(work)?;
    }

    let drawn = draw(renderer, &args.drawing, console)?;
    let picture = (drawn.frame.done > 0).then_some(&output);
    let mut metadata = Metadata::of(&drawn.frame, &drawn.snapshot.settings, scene);
    if let Some(told) = &drawn.timed {
        metadata.insert(key::TIME, told);
    }
    let methods = args.drawing.methods.methods();
    if !methods.is_default() {
        metadata.insert(key::METHODS, methods.to_string());
    }
    if let Some(file) = picture {
        image::write(file, format, &drawn.frame.picture, &metadata).map_err(work)?;
    }
    let stats = stats(&drawn, &metadata, picture);
    if let Some(file) = &args.stats {
        let json = serde_json::to_vec_pretty(&stats).map_err(|why| Failure::Work(why.to_string()))?;
        image::write_atomically(file, &json).map_err(work)?;
    }
    if !args.drawing.quiet {
        console.say(&stats);
    }
    if drawn.frame.is_complete() {
        return Ok(());
    }
    Err(Failure::Stopped(match picture {
        Some(file) => {
            format!("stopped after {} % of the picture; the partial picture is in {}", drawn.percent(), file.display())
        }
        None => "stopped before anything was drawn; no picture is written".into(),
    }))
}

/// Prints the hash of a scene's picture.
pub(super) fn hash(renderer: &mut Renderer, args: &HashArguments, console: &mut Console<'_>) -> Result<(), Failure> {
    let drawn = draw(renderer, &args.drawing, console)?;
    if !drawn.frame.is_complete() {
        return Err(Failure::Stopped(format!("stopped after {} % of the picture", drawn.percent())));
    }
    console.say(format!("{}  {}", drawn.frame.picture.hash(), args.drawing.scene.display()));
    Ok(())
}

/// The scene's name with `.png`, in the current folder.
fn default_output(scene: &Path) -> PathBuf {
    let mut name = scene.file_stem().unwrap_or("picture".as_ref()).to_os_string();
    name.push(".png");
    name.into()
}

fn format(output: &Path, bits: Option<Bits>) -> Result<Format, Failure> {
    match (Format::of(output).map_err(|why| Failure::Usage(why.to_string()))?, bits) {
        (Format::Exr, Some(_)) => {
            Err(Failure::Usage("--bits is for PNG files; an EXR file always holds 32-bit floats".into()))
        }
        (Format::Png8, Some(Bits::Sixteen)) => Ok(Format::Png16),
        (format, _) => Ok(format),
    }
}

fn work(why: FileError) -> Failure {
    Failure::Work(why.to_string())
}

fn stats(drawn: &Drawn, metadata: &Metadata, picture: Option<&PathBuf>) -> Stats {
    let Drawn { snapshot, frame, seconds, threads, timed } = drawn;
    let told = |key| metadata.get(key).unwrap_or_default().to_string();
    let rays = frame.counts.rays();
    Stats {
        version: Stats::VERSION,
        software: told(key::SOFTWARE),
        scene: told(key::SCENE),
        picture: picture.map(|file| file.display().to_string()),
        width: snapshot.settings.width,
        height: snapshot.settings.height,
        region: frame.region,
        drawn: frame.done,
        hash: told(key::HASH),
        objects: snapshot.names.len(),
        lights: snapshot.lights.lamps.len(),
        rays,
        counts: frame.counts,
        threads: *threads,
        time: timed.clone(),
        seconds: *seconds,
        // A trace that is too short to be measured took a nanosecond.
        rays_per_second: rays as f64 / seconds.trace.max(1e-9),
        peak_memory_bytes: machine::peak_memory(),
    }
}
