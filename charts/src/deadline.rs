//! The best picture for a time.
//!
//! The picture is drawn again and again, each time within a smaller error, until the time is over; tiles of the last,
//! unfinished turn take the place of what they improve. Nothing has to be foreseen, so a machine that becomes slow while
//! it works only makes the picture coarser.

use snell_components::settings::{Antialias, MAX_SUBDIVISIONS};
use snell_systems::{
    render::{Frame, Options, Picture, Progress, Region, Stop, Tile, render},
    snapshot::Snapshot,
};
use std::{
    sync::{
        Mutex, PoisonError,
        atomic::{AtomicU64, Ordering},
        mpsc::{self, RecvTimeoutError},
    },
    thread,
    time::Duration,
};

/// Tells the time that has passed since some start.
pub type Clock<'a> = &'a (dyn Fn() -> Duration + Sync);

/// The error of the first turn, which has one ray to a pixel.
const FIRST: f64 = 0.25;

/// The error below which no turn goes.
const LEAST: f64 = 1.0 / 4096.0;

/// How often the user's stop is looked at.
const TICK: Duration = Duration::from_millis(20);

/// A picture that a time allowed for.
#[derive(Clone)]
pub struct Timed {
    /// The picture; it is complete unless the first turn was stopped. The counts are those of all turns.
    pub frame: Frame,
    /// The scene with the settings that give the picture, but for what is better.
    pub snapshot: Snapshot,
    /// The error that is kept in the whole picture; after one turn only by the rays that were cut.
    pub error: f64,
    /// The smaller error that is kept in a part of it, and the share of that part.
    pub better: Option<(f64, f64)>,
    /// Seconds that it took.
    pub seconds: f64,
    /// Turns that were finished.
    pub turns: u32,
    /// Whether it ended since nothing more was to be gained.
    pub exhausted: bool,
}

/// Renders until `clock` tells `end`.
///
/// The first turn is finished even if it takes longer, so that there is a picture; `stop` ends it all the same. `told`
/// hears of every tile. `snapshot` must have been extracted with an error above zero, so that rays can be cut.
#[must_use]
pub fn render_until(
    snapshot: &Snapshot,
    clock: Clock<'_>,
    end: Duration,
    region: Region,
    stop: &Stop,
    told: &(dyn Fn(Progress) + Sync),
) -> Timed {
    let start = clock();
    let mut snapshot = snapshot.clone();
    let settings = &mut snapshot.settings;
    // The cheapest picture there is.
    (settings.antialias, settings.subdivisions, settings.error) = (Antialias::Off, MAX_SUBDIVISIONS, FIRST);
    let on_tile = |_: &Tile, progress: Progress| told(progress);
    let options = Options { region: Some(region), stop: stop.clone(), on_tile: Some(&on_tile), ..Options::default() };
    let frame = render(&snapshot, &options);
    let picture = Mutex::new(frame.picture.clone());
    let mut timed = Timed {
        turns: u32::from(frame.is_complete()),
        frame,
        snapshot: snapshot.clone(),
        error: FIRST,
        better: None,
        seconds: 0.0,
        exhausted: false,
    };
    let mut longest = clock().saturating_sub(start);
    while timed.turns > 0 && !timed.exhausted && !stop.is_stopped() {
        let left = end.saturating_sub(clock());
        if left.is_zero() {
            break;
        }
        // While there is much time the error falls fast, so that little of it goes into turns that are not seen.
        let error = (timed.error / if left > longest * 12 { 4.0 } else { 2.0 }).max(LEAST);
        (snapshot.settings.antialias, snapshot.settings.error) = (Antialias::Adaptive, error);
        let turn = clock();
        let turn_stop = Stop::new();
        let improved = AtomicU64::new(0);
        let on_tile = |tile: &Tile, progress: Progress| {
            // A tile that was being drawn when the stop came may lack rows.
            if !turn_stop.is_stopped() {
                improved.fetch_add(tile.region.area() as u64, Ordering::Relaxed);
                paste(&picture, tile, region);
                told(progress);
            }
            if clock() >= end {
                turn_stop.stop();
            }
        };
        let options =
            Options { region: Some(region), stop: turn_stop.clone(), on_tile: Some(&on_tile), ..Options::default() };
        let frame = until(clock, end, stop, &turn_stop, || render(&snapshot, &options));
        timed.frame.counts += frame.counts;
        if turn_stop.is_stopped() {
            let share = improved.into_inner() as f64 / region.area() as f64;
            timed.better = (share > 0.0).then_some((error, share));
            break;
        }
        (timed.turns, timed.error, timed.exhausted) = (timed.turns + 1, error, error <= LEAST);
        timed.snapshot = snapshot.clone();
        longest = longest.max(clock().saturating_sub(turn));
    }
    timed.frame.picture = picture.into_inner().unwrap_or_else(PoisonError::into_inner);
    timed.snapshot.settings.error = timed.error;
    timed.seconds = clock().saturating_sub(start).as_secs_f64();
    timed
}

fn paste(picture: &Mutex<Picture>, tile: &Tile, region: Region) {
    let Region { x, y, width, height } = tile.region;
    let part = Picture { width, height, pixels: tile.pixels.clone() };
    picture.lock().unwrap_or_else(PoisonError::into_inner).paste(&part, x - region.x, y - region.y);
}

/// Does some work, and stops it at a time, or when the user wants it.
fn until<R>(clock: Clock<'_>, end: Duration, user: &Stop, stop: &Stop, work: impl FnOnce() -> R) -> R {
    let (done, is_done) = mpsc::channel::<()>();
    thread::scope(|scope| {
        scope.spawn(move || {
            while !user.is_stopped() && clock() < end {
                if is_done.recv_timeout(end.saturating_sub(clock()).min(TICK)) != Err(RecvTimeoutError::Timeout) {
                    return;
                }
            }
            stop.stop();
        });
        let result = work();
        drop(done);
        result
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use snell_components::{camera::Camera, material::Ambient, settings::Settings, shape::Sphere};
    use snell_systems::pipeline::Renderer;
    use std::sync::Arc;

    fn ball() -> Arc<Snapshot> {
        let mut renderer = Renderer::new();
        *renderer.settings() = Settings { width: 128, height: 96, error: 1.0, ..Settings::default() };
        renderer.world.spawn(Camera { position: glam::DVec3::new(0.0, 0.0, 5.0), ..Camera::default() });
        renderer.world.spawn((Sphere::default(), Ambient(snell_components::color::Rgb::ONE)));
        renderer.snapshot().expect("a snapshot")
    }

    /// Renders with a clock that a finished tile moves on by a second, so that twelve seconds are a turn.
    fn rendered(seconds: f64) -> (Timed, f64) {
        let tiles = AtomicU64::new(0);
        let clock = || Duration::from_secs(tiles.load(Ordering::Relaxed));
        let told = |_: Progress| {
            tiles.fetch_add(1, Ordering::Relaxed);
        };
        let end = Duration::from_secs_f64(seconds);
        let (ball, region) = (ball(), Region::whole(128, 96));
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
        let timed = pool.install(|| render_until(&ball, &clock, end, region, &Stop::new(), &told));
        (timed, clock().as_secs_f64())
    }

    #[test]
    fn a_time_is_used_up_and_not_exceeded_by_more_than_what_is_in_hand() {
        let mut errors = vec![];
        for seconds in [30.0, 42.0, 65.0] {
            let (timed, taken) = rendered(seconds);
            assert!(taken >= seconds && taken <= seconds + 1.0, "{taken} of {seconds}");
            assert_eq!(timed.turns, (seconds / 12.0) as u32);
            let (better, share) = timed.better.expect("a part of a turn");
            assert!((share - (seconds / 12.0).fract()).abs() < 0.1, "{share}");
            assert!(better < timed.error && !timed.exhausted);
            errors.push(timed.error);
        }
        assert!(errors.is_sorted_by(|a, b| a > b), "{errors:?}");
    }

    #[test]
    fn a_time_shorter_than_a_turn_and_one_longer_than_all_are_told_apart() {
        let (timed, taken) = rendered(5.0);
        assert_eq!((timed.turns, timed.better, taken), (1, None, 12.0));
        let (timed, taken) = rendered(1e6);
        assert!(timed.exhausted && timed.error <= LEAST && taken < 200.0);
    }
}
