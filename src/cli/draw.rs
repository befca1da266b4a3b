//! Scene file → frame, for every command that draws.

use super::{
    Console, Failure,
    args::{Changes, Drawing, Sampling},
    machine,
    progress::Progress,
    stats::Seconds,
};
use crate::{Frame, Options, Region, Renderer, Snapshot, Stop, render};
use snell_charts::deadline::{Timed, render_until};
use snell_components::settings::{Antialias, Settings};
use std::{
    path::Path,
    process,
    sync::Arc,
    time::{Duration, Instant},
};

/// A frame and how it came about.
pub(super) struct Drawn {
    pub(super) snapshot: Arc<Snapshot>,
    pub(super) frame: Frame,
    pub(super) seconds: Seconds,
    pub(super) threads: usize,
    /// What a time allowed for, if there was one.
    pub(super) timed: Option<String>,
}

impl Drawn {
    /// The share that was drawn, in whole percent, rounded down.
    pub(super) fn percent(&self) -> u64 {
        100 * self.frame.done / (self.frame.region.area() as u64).max(1)
    }
}

/// Loads a scene and draws it as the options say.
pub(super) fn draw(renderer: &mut Renderer, how: &Drawing, console: &mut Console<'_>) -> Result<Drawn, Failure> {
    let start = Instant::now();
    let pool = Pool::new(how.threads)?;
    let progress = Progress::new(how.quiet);

    progress.begin("loading");
    let (loaded, load) = timed(|| pool.run(|| renderer.load(&how.scene)));
    let notices = loaded.map_err(|faults| Failure::Scene(faults.0.iter().map(ToString::to_string).collect()))?;
    // Before the long wait: the user may want to stop and put things right.
    progress.aside(|| notices.iter().for_each(|notice| console.warn(notice)));

    let settings = &mut *renderer.settings();
    apply(&how.changes, settings);
    if how.time.is_some() {
        // Any error will do: the snapshot then knows what is needed to cut rays.
        settings.error = 1.0;
    }
    let region = region(how, settings)?;
    check_memory(region, machine::available_memory())?;

    progress.begin("building");
    let (snapshot, build) = timed(|| pool.run(|| renderer.snapshot()));
    let snapshot = snapshot.map_err(|why| Failure::Scene(vec![of_scene(&how.scene, why)]))?;
    progress.aside(|| warn_of_left_out(&how.scene, &snapshot, console));

    progress.begin_pixels("tracing", region.area() as u64);
    let on_tile = |_: &_, so_far: crate::Progress| progress.set(so_far.done);
    let options =
        Options { region: Some(region), methods: how.methods.methods(), on_tile: Some(&on_tile), ..Options::default() };
    stop_on_interrupt(&options.stop);
    let ((frame, snapshot, told), trace) = timed(|| match how.time {
        None => (pool.run(|| render(&snapshot, &options)), snapshot, None),
        Some(time) => {
            let (clock, end) = (|| start.elapsed(), Duration::from_secs_f64(time));
            let told = |so_far: crate::Progress| progress.set(so_far.done);
            let timed = pool.run(|| render_until(&snapshot, &clock, end, region, &options.stop, &told));
            let words = told_of_time(time, start.elapsed().as_secs_f64(), &timed);
            // As if the scene had asked for what was reached.
            (timed.frame, Arc::new(timed.snapshot), Some(words))
        }
    });
    drop(progress);

    if frame.counts.not_finite > 0 {
        let what = format!("{} pixels are not finite numbers and shown black", frame.counts.not_finite);
        console.warn(of_scene(&how.scene, what));
    }
    if snapshot.settings.error > 0.0 && snapshot.ceiling.is_none() {
        let what = "no ray is cut, since a light or a texture does not tell how bright it can be, or nothing limits it";
        console.warn(of_scene(&how.scene, what));
    }
    let threads = pool.run(rayon::current_num_threads);
    Ok(Drawn { snapshot, frame, seconds: Seconds { load, build, trace }, threads, timed: told })
}

/// What became of a time that was given.
fn told_of_time(time: f64, taken: f64, timed: &Timed) -> String {
    let in_255ths = |error: f64| format!("{:.2}/255", 255.0 * error);
    let kept = if timed.turns > 1 { format!("error {}", in_255ths(timed.error)) } else { "one ray to a pixel".into() };
    let mut told = format!("{taken:.2} s of {time} s; {kept}");
    if timed.turns == 0 {
        return format!("{taken:.2} s of {time} s; stopped before the first turn was done");
    }
    if let Some((error, share)) = timed.better {
        told += &format!(", {} in {:.0} % of the picture", in_255ths(error), 100.0 * share);
    }
    if taken > 1.1 * time {
        told += &format!(
            "; the time is too short: loading, building and one turn with error {} take as long",
            in_255ths(timed.error)
        );
    } else if timed.exhausted {
        told += "; nothing more is to be gained";
    }
    told
}

/// A message that concerns a scene as a whole.
pub(super) fn of_scene(scene: &Path, message: impl core::fmt::Display) -> String {
    format!("{}: {message}", scene.display())
}

/// Tells of objects that are not in the picture.
pub(super) fn warn_of_left_out(scene: &Path, snapshot: &Snapshot, console: &mut Console<'_>) {
    for (name, why) in snapshot.left_out.iter() {
        console.warn(of_scene(scene, format!("`{name}` is left out: {why}")));
    }
}

/// The threads that everything runs in.
struct Pool(Option<rayon::ThreadPool>);

impl Pool {
    fn new(threads: Option<u32>) -> Result<Self, Failure> {
        let build = |threads: u32| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads as usize).build();
            pool.map_err(|why| Failure::Work(format!("{threads} threads cannot be started: {why}")))
        };
        threads.map(build).transpose().map(Self)
    }

    fn run<R: Send>(&self, work: impl FnOnce() -> R + Send) -> R {
        match &self.0 {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }
}

/// What some work gives, and the seconds it took.
fn timed<R>(work: impl FnOnce() -> R) -> (R, f64) {
    let start = Instant::now();
    let result = work();
    (result, start.elapsed().as_secs_f64())
}

/// What the command line gives takes the place of what the scene gives.
pub(super) fn apply(changes: &Changes, settings: &mut Settings) {
    if let Some(all) = &changes.settings {
        *settings = all.clone();
    }
    if let Some(size) = changes.size {
        (settings.width, settings.height) = (size.width, size.height);
    }
    settings.depth = changes.depth.unwrap_or(settings.depth);
    let finely = Sampling { antialias: Antialias::Adaptive, subdivisions: Some(6), ..Sampling::default() };
    if let Some(sampling) = changes.antialias.or(changes.error.map(|_| finely)) {
        settings.antialias = sampling.antialias;
        settings.grid = sampling.grid.unwrap_or(settings.grid);
        settings.subdivisions = sampling.subdivisions.unwrap_or(settings.subdivisions);
        settings.contrast = sampling.contrast.unwrap_or(settings.contrast);
    }
    settings.error = changes.error.unwrap_or(settings.error);
}

/// The region to draw.
fn region(how: &Drawing, settings: &Settings) -> Result<Region, Failure> {
    let (width, height) = (settings.width, settings.height);
    let Some(region) = how.region else { return Ok(Region::whole(width, height)) };
    if region.fits(width, height) {
        return Ok(region);
    }
    let Region { x, y, width: w, height: h } = region;
    Err(Failure::Usage(format!(
        "--region {x},{y},{w},{h} reaches beyond the picture, which has {width}x{height} pixels"
    )))
}

/// Bytes that a pixel takes: 12 in its tile, 12 in the picture, 12 encoded and up to 12 compressed.
const BYTES_PER_PIXEL: u64 = 48;

/// Refuses a picture that would not fit into memory.
fn check_memory(region: Region, available: Option<u64>) -> Result<(), Failure> {
    let needed = region.area() as u64 * BYTES_PER_PIXEL;
    match available {
        Some(available) if needed > available => Err(Failure::Work(format!(
            "a picture of {}x{} pixels takes {:.1} GB of memory, and {:.1} GB are free; draw it in parts with --region",
            region.width,
            region.height,
            needed as f64 / 1e9,
            available as f64 / 1e9,
        ))),
        _ => Ok(()),
    }
}

/// Lets the first Ctrl-C stop the render and the second end the process.
fn stop_on_interrupt(stop: &Stop) {
    let stop = stop.clone();
    let on_interrupt = move || {
        if stop.is_stopped() {
            process::exit(i32::from(super::STOPPED));
        }
        stop.stop();
    };
    // A program that has a handler already keeps it; Ctrl-C then does what that program wants.
    let _ = ctrlc::set_handler(on_interrupt);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_larger_than_memory_is_refused_with_numbers() {
        let told = check_memory(Region::whole(65_536, 65_536), Some(8_000_000_000)).expect_err("too large");
        let Failure::Work(told) = told else { panic!("{told:?}") };
        assert!(told.contains("takes 206.2 GB of memory, and 8.0 GB are free"), "{told}");
        assert!(check_memory(Region::whole(800, 600), Some(8_000_000_000)).is_ok());
        assert!(check_memory(Region::whole(65_536, 65_536), None).is_ok());
    }
}
