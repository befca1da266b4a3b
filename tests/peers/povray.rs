//! Scenes of the gallery beside POV-Ray, an independent renderer with the same model of light: linear pictures, pixel by
//! pixel.
//!
//! Each scene is written in POV-Ray's language, term by term: no fall-off, Phong's highlight, linear colours, the same
//! camera, one ray through the middle of every pixel. Where POV-Ray is not installed nothing is compared, and the test says
//! so: `bash tests/peers/povray.sh`.

mod export;

use snell::prelude::*;
use std::{fs, path::Path, process::Command};

/// Scenes, and the share of pixels that may differ by more than 1/255: what edges cost, where a ray of one renderer hits
/// and that of the other does not, and squares of the ground too small for a pixel.
const SCENES: [(&str, f64); 6] = [
    ("coloured-lights", 0.001),
    ("highlights", 0.001),
    ("many-balls", 0.001),
    ("mirror-balls", 0.001),
    ("opacity", 0.004),
    ("transparency", 0.001),
];

/// Median difference of a pixel's channel that farthest differs; POV-Ray's file has 16 bits a channel.
const MEDIAN: f64 = 2e-5;

const SIZE: (u32, u32) = (240, 160);

fn is_installed() -> bool {
    Command::new("povray").arg("--version").output().is_ok_and(|output| output.status.success())
}

/// A scene at the size of the comparison, without anything that cuts rays short.
fn load(scene: &str) -> Renderer {
    let mut renderer = Renderer::new();
    let path = Path::new("scenes/gallery").join(scene).with_extension("ron");
    renderer.load(path).unwrap_or_else(|faults| panic!("{faults}"));
    let mut settings = renderer.settings();
    (settings.width, settings.height) = SIZE;
    (settings.depth, settings.cutoff, settings.antialias) = (30, 0.0, Antialias::Off);
    renderer
}

/// The picture that POV-Ray draws from a text: channels in rows, 0 to 1.
fn povray(text: &str) -> Vec<f64> {
    let folder = tempfile::tempdir().expect("a folder");
    let (scene, picture) = (folder.path().join("scene.pov"), folder.path().join("picture.ppm"));
    fs::write(&scene, text).expect("written");
    let output = Command::new("povray")
        .arg(format!("+I{}", scene.display()))
        .arg(format!("+O{}", picture.display()))
        .args([format!("+W{}", SIZE.0), format!("+H{}", SIZE.1)])
        .args(["+FP16", "File_Gamma=1.0", "-D", "-GA", "-A", "+WT1"])
        .output()
        .expect("POV-Ray runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    samples(&fs::read(&picture).expect("a picture"))
}

/// The channels of a PPM file of 16 bits.
fn samples(ppm: &[u8]) -> Vec<f64> {
    let count = 3 * (SIZE.0 * SIZE.1) as usize;
    let (head, body) = ppm.split_at(ppm.len() - 2 * count);
    assert!(head.starts_with(b"P6") && head.trim_ascii_end().ends_with(b"65535"), "not a PPM file of 16 bits");
    body.chunks(2).map(|bytes| f64::from(u16::from_be_bytes([bytes[0], bytes[1]])) / 65_535.0).collect()
}

/// Share of the pixels that differ by more than 1/255 in some channel, and the median of all pixels.
fn compare(ours: &Picture, theirs: &[f64]) -> (f64, f64) {
    let ours = ours.pixels.iter().flatten().map(|channel| f64::from(*channel).clamp(0.0, 1.0));
    let channels: Vec<f64> = ours.zip(theirs).map(|(a, b)| (a - b).abs()).collect();
    let mut pixels: Vec<f64> = channels.chunks(3).map(|c| c.iter().copied().fold(0.0, f64::max)).collect();
    pixels.sort_by(f64::total_cmp);
    let beyond = pixels.iter().filter(|difference| **difference > 1.0 / 255.0).count();
    (beyond as f64 / pixels.len() as f64, pixels[pixels.len() / 2])
}

#[test]
fn scenes_of_the_gallery_are_those_of_povray() {
    if !is_installed() {
        println!("skipped: POV-Ray is not installed (apt-get install povray)");
        return;
    }
    let mut faults = vec![];
    println!("{:16} {:>14} {:>10}", "scene", "beyond 1/255", "median");
    for (scene, bound) in SCENES {
        let mut renderer = load(scene);
        let snapshot = renderer.snapshot().expect("a snapshot");
        let theirs = povray(&export::scene(&mut renderer, &snapshot));
        let (beyond, median) = compare(&render(&snapshot, &Options::default()).picture, &theirs);
        println!("{scene:16} {:>12.3} % {median:>10.1e}", 100.0 * beyond);
        if beyond > bound || median > MEDIAN {
            faults.push(format!("{scene}: {beyond} beyond 1/255, median {median}"));
        }
    }
    assert!(faults.is_empty(), "{faults:?}");
    println!("passed: {} scenes agree with POV-Ray", SCENES.len());
}

#[test]
fn another_model_is_noticed() {
    if !is_installed() {
        println!("skipped: POV-Ray is not installed (apt-get install povray)");
        return;
    }
    let mut renderer = load("highlights");
    let snapshot = renderer.snapshot().expect("a snapshot");
    let theirs = povray(&export::scene(&mut renderer, &snapshot));
    let world = &mut renderer.world;
    world.query::<&mut Highlight>().iter_mut(world).for_each(|mut highlight| highlight.exponent *= 1.2);
    let (beyond, _) = compare(&render(&renderer.snapshot().expect("a snapshot"), &Options::default()).picture, &theirs);
    let (_, bound) = SCENES[1];
    assert!(beyond > 2.0 * bound, "exponents of a fifth more leave {beyond}");
}
