//! The error that a setting promises is kept: against the full tree of rays, and against ever more samples.

use snell::prelude::*;
use std::{fs, path::PathBuf, sync::Arc};

/// All scenes of the gallery.
fn gallery() -> Vec<PathBuf> {
    let files = fs::read_dir("scenes/gallery").expect("a folder").map(|file| file.expect("an entry").path());
    let mut scenes: Vec<_> =
        files.filter(|file| file.extension().is_some_and(|extension| extension == "ron")).collect();
    scenes.sort();
    scenes
}

fn snapshot(scene: &PathBuf, size: (u32, u32), change: impl FnOnce(&mut Settings)) -> Arc<Snapshot> {
    let mut renderer = Renderer::new();
    if let Err(faults) = renderer.load(scene) {
        panic!("{}: {faults}", scene.display());
    }
    let settings = &mut *renderer.settings();
    (settings.width, settings.height) = size;
    change(settings);
    renderer.snapshot().expect("a snapshot")
}

fn drawn(snapshot: &Snapshot) -> Frame {
    render(snapshot, &Options::default())
}

/// The largest difference of a channel, pixel by pixel.
fn differences(a: &Picture, b: &Picture) -> Vec<f64> {
    let largest = |(a, b): (&[f32; 3], &[f32; 3])| {
        let off = a.iter().zip(b).map(|(a, b)| (f64::from(*a) - f64::from(*b)).abs());
        off.fold(0.0, f64::max)
    };
    a.pixels.iter().zip(&b.pixels).map(largest).collect()
}

#[test]
fn rays_that_are_cut_never_cost_more_than_the_bound() {
    let mut saved = 0;
    for scene in gallery() {
        // The same rays through pixels and the same samples of lights: what differs is what was cut.
        let mut any = (*snapshot(&scene, (32, 22), |settings| {
            (settings.antialias, settings.error) = (Antialias::Four, 1.0);
        }))
        .clone();
        let mut full: Option<Frame> = None;
        for error in [1.0 / 255.0, 4.0 / 255.0, 0.1] {
            any.settings.error = error;
            let full = match &full {
                // The samples of lights depend on the error, nothing else does.
                Some(full) if any.lights.sampling.iter().all(Option::is_none) => full,
                _ => full.insert(drawn(&Snapshot { ceiling: None, ..any.clone() })),
            };
            let cut = drawn(&any);
            let worst = differences(&full.picture, &cut.picture).into_iter().fold(0.0, f64::max);
            assert_eq!(full.counts.cut, 0);
            let bound = cut.counts.cut_bound;
            let name = scene.display();
            assert!(bound <= 0.5 * error, "{name}: the bound {bound} exceeds what is allowed");
            // Pixels are f32.
            assert!(worst <= bound + 1e-6, "{name}: off by {worst}, bound {bound}, error {error}");
            assert!(cut.counts.rays() <= full.counts.rays(), "{name}");
            saved += full.counts.rays() - cut.counts.rays();
        }
    }
    assert!(saved > 10_000, "cutting saves {saved} rays only");
}

#[test]
fn a_ceiling_that_is_too_low_is_found_out() {
    let scene = PathBuf::from("tests/golden/optics/facing-mirrors.ron");
    let snapshot = snapshot(&scene, (24, 16), |settings| (settings.error, settings.depth) = (0.1, 60));
    let with = |ceiling| drawn(&Snapshot { ceiling, ..(*snapshot).clone() }).picture;
    let full = with(None);
    let off = |ceiling| differences(&with(ceiling), &full).into_iter().fold(0.0, f64::max);
    assert!(off(snapshot.ceiling.clone()) <= 0.05);
    // That of a scene in which nothing shines.
    let mut dark = Renderer::new();
    dark.settings().error = 0.1;
    dark.world.spawn(Camera::default());
    let dark = dark.snapshot().expect("a snapshot").ceiling.clone();
    assert!(dark.is_some() && off(dark) > 0.05);
}
