//! What is shown, compared with pictures that were looked at: `SNELL_BLESS=1` accepts.

use crate::driver::Window;
use image::RgbImage;
use std::{env, fs, path::Path};

/// Of so many pixels one may differ: letters are drawn a hair otherwise on another machine.
const ONE_IN: usize = 200;

/// By how much a channel may differ without being counted.
const LEVELS: u8 = 24;

fn differing(a: &RgbImage, b: &RgbImage) -> usize {
    let differs = |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| (0..3).any(|i| a[i].abs_diff(b[i]) > LEVELS);
    a.pixels().zip(b.pixels()).filter(|pair| differs(*pair)).count()
}

#[track_caller]
fn check(window: &Window, name: &str) {
    let picture = window.shot();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/window/shown");
    let file = folder.join(format!("{name}.png"));
    if env::var_os("SNELL_BLESS").is_some() && env::var_os("CI").is_none() {
        fs::create_dir_all(&folder).expect("a folder");
        picture.save(&file).expect("saved");
    }
    let known = image::open(&file).unwrap_or_else(|why| panic!("{}: {why}", file.display())).to_rgb8();
    let is_same = known.dimensions() == picture.dimensions();
    let differing = if is_same { differing(&picture, &known) } else { usize::MAX };
    if differing > known.pixels().len() / ONE_IN {
        let seen = env::temp_dir().join(format!("{name}.new.png"));
        picture.save(&seen).expect("saved");
        panic!("{name}: {differing} pixels differ; see {}; SNELL_BLESS=1 accepts", seen.display());
    }
}

/// The pointer rests, the picture is exact, and nothing that differs from run to run is in sight.
fn rest(window: &mut Window) {
    window.release_focus();
    window.harness.remove_cursor();
    window.wait();
    for _ in 0..30 {
        window.step();
    }
}

#[test]
fn the_window_looks_as_it_did_when_it_was_looked_at() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut window = Window::open(folder.path(), None);
    while window.editor().is_busy() {
        window.step();
    }
    rest(&mut window);
    check(&window, "start");
    window.click("Glass");
    window.wait();
    window.menu(&["Globe"]);
    window.write("Radius", "-1");
    window.harness.remove_cursor();
    for _ in 0..30 {
        window.step();
    }
    check(&window, "wrong-number");
    let before = window.shot();
    window.menu(&["Cube"]);
    rest(&mut window);
    assert!(differing(&before, &window.shot()) > before.pixels().len() / ONE_IN, "the comparison sees nothing");
}
