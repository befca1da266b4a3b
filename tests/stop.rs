//! A render that is stopped from another thread gives what it has.

use snell::prelude::*;
use snell::{Progress, Region};
use std::{sync::Arc, thread};

const TILE: u32 = 16;

fn snapshot() -> Arc<Snapshot> {
    let mut renderer = Renderer::new();
    let world = &mut renderer.world;
    world.spawn(Camera { position: DVec3::new(0.0, 1.0, 5.0), ..Camera::default() });
    world.spawn(DirectionalLight { direction: DVec3::new(-1.0, -2.0, -1.0), ..DirectionalLight::default() });
    world.spawn(AmbientLight::default());
    world.spawn((Sphere { radius: 1.0 }, Ambient(Rgb::splat(0.1)), Diffuse(Rgb::splat(0.5)), Mirror(Rgb::splat(0.4))));
    let settings = &mut *renderer.settings();
    (settings.width, settings.height) = (320, 240);
    // No drawn pixel is black, so black ones are known to be left out.
    settings.background = Rgb::splat(0.25);
    renderer.snapshot().expect("a snapshot")
}

/// The rows of the tiles of a picture, each as a region of one row.
fn rows_of_tiles(whole: Region) -> impl Iterator<Item = Region> {
    let columns = move || (0..whole.width).step_by(TILE as usize);
    (0..whole.height)
        .flat_map(move |y| columns().map(move |x| Region { x, y, width: TILE.min(whole.width - x), height: 1 }))
}

#[test]
fn a_stopped_render_gives_the_rows_it_drew_and_draws_no_more() {
    let snapshot = snapshot();
    let full = render(&snapshot, &Options::default());
    assert!(full.is_complete());

    const THREADS: usize = 3;
    let stop = Stop::new();
    let (tell, told) = std::sync::mpsc::sync_channel(THREADS);
    let frame = thread::scope(|scope| {
        let render = scope.spawn(|| {
            // Each thread tells of its first tile and goes on only once the render is stopped.
            let on_tile = |_: &_, _: Progress| {
                let _ = tell.try_send(());
                while !stop.is_stopped() {
                    thread::yield_now();
                }
            };
            let options = Options {
                threads: Some(THREADS),
                tile: Some(TILE),
                stop: stop.clone(),
                on_tile: Some(&on_tile),
                ..Options::default()
            };
            render(&snapshot, &options)
        });
        told.recv().expect("a first tile");
        stop.stop();
        render.join().expect("a frame")
    });

    assert!(!frame.is_complete());
    let mut drawn = 0;
    for row in rows_of_tiles(frame.region) {
        let part = frame.picture.crop(row).expect("a row");
        if part == Picture::black(row.width, row.height) {
            continue;
        }
        assert_eq!(Some(part), full.picture.crop(row), "{row:?}");
        drawn += row.area() as u64;
    }
    assert_eq!(drawn, frame.done);
    // A tile was whole when the render was stopped, and no thread began another.
    let tile = u64::from(TILE * TILE);
    assert!((tile..=THREADS as u64 * tile).contains(&drawn), "{drawn}");
    // Rows in which a thread stopped are left undrawn, eight at most; the rays of their first pixels were traced.
    let row = 8 * u64::from(TILE);
    assert!((drawn..drawn + THREADS as u64 * row).contains(&frame.counts.primary), "{}", frame.counts.primary);
}

#[test]
fn a_render_that_is_stopped_before_it_begins_draws_nothing() {
    let options = Options::default();
    options.stop.stop();
    let frame = render(&snapshot(), &options);
    assert_eq!((frame.done, frame.counts.rays(), frame.is_complete()), (0, 0, false));
    assert_eq!(frame.picture, Picture::black(320, 240));
}
