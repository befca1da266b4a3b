//! `snell diff`, `snell repro` and `snell fmt` as a user runs them.

mod support {
    pub(crate) mod desk;
}

use snell::{
    Picture,
    systems::image::{self, Format, Metadata},
};
use std::fs;
use support::desk::{BALL, Desk};

/// Changes a pixel of a picture file, and nothing else of it.
fn touch(desk: &Desk, from: &str, to: &str, format: Format, change: impl FnOnce(&mut Picture)) {
    let (mut picture, told) = image::read(&desk.path(from)).expect("a picture");
    change(&mut picture);
    image::write(&desk.path(to), format, &picture, &told).expect("written");
}

/// The next number that has other bits.
fn next(light: &mut f32) {
    *light = f32::from_bits(light.to_bits() + 1);
}

#[test]
fn one_bit_is_a_difference_and_the_exit_code_says_so() {
    let desk = Desk::new();
    assert_eq!(desk.run("render ball.ron -o a.exr -q").0, 0);
    let (code, out, err) = desk.run("diff a.exr a.exr");
    assert_eq!((code, out.as_str(), err.as_str()), (0, "bits     no pixel differs\nalike for exact bits\n", ""));

    touch(&desk, "a.exr", "b.exr", Format::Exr, |picture| next(&mut picture.pixels[24 * 64 + 32][1]));
    let (code, out, _) = desk.run("diff a.exr b.exr -o seen.png");
    assert_eq!(code, 1, "{out}");
    assert!(
        out.contains("bits     1 pixel differs, first 32,24: ") && out.ends_with("different for exact bits\n"),
        "{out}"
    );
    let (seen, _) = image::read(&desk.path("seen.png")).expect("a picture");
    let [red, _, blue] = seen.pixels[24 * 64 + 32];
    assert!(blue > 0.9 && red < 0.2, "the pixel is blue");
    assert!(seen.pixels.iter().filter(|[red, green, _]| red != green).count() == 1, "all others are grey");
    for alike in ["--pixels 0", "--flip 0"] {
        assert_eq!(desk.run(&format!("diff a.exr b.exr {alike} -q")), (0, String::new(), String::new()));
    }
}

#[test]
fn pixels_and_flip_have_limits() {
    let desk = Desk::new();
    assert_eq!(desk.run("render ball.ron -o a.png -q").0, 0);
    touch(&desk, "a.png", "b.png", Format::Png8, |picture| picture.pixels[700] = [1.0, 0.0, 0.0]);
    let (code, out, _) = desk.run("diff a.png b.png --pixels 254 --json");
    let report: serde_json::Value = serde_json::from_str(&out).expect("JSON");
    assert_eq!(
        (code, &report["alike"], &report["pixels"], &report["largest"]),
        (1, &false.into(), &1.into(), &255.into())
    );
    let flip = report["flip"].as_f64().expect("a number");
    assert!(flip > 0.0 && flip < 0.01, "{flip}");
    assert_eq!(desk.run("diff a.png b.png --pixels 255").0, 0);
    assert_eq!(desk.run(&format!("diff a.png b.png --flip {}", flip * 1.01)).0, 0);
    assert_eq!(desk.run(&format!("diff a.png b.png --flip {}", flip * 0.99)).0, 1);
}

#[test]
fn light_that_8_bits_do_not_show_is_told_by_the_hashes() {
    let desk = Desk::new();
    assert_eq!(desk.run("render ball.ron -o a.png -q").0, 0);
    // So little light that no level changes.
    desk.put("ball.ron", &BALL.replace("width: 64", "background: 0.00001, width: 64"));
    assert_eq!(desk.run("render ball.ron -o b.png -q").0, 0);
    let (code, out, _) = desk.run("diff a.png b.png");
    assert_eq!(code, 1);
    assert!(out.contains("linear light that differs by less than the files show"), "{out}");
    assert_eq!(desk.run("diff a.png b.png --pixels 0").0, 0);
}

#[test]
fn what_cannot_be_compared_is_trouble() {
    let desk = Desk::new();
    assert_eq!(desk.run("render ball.ron -o a.png -q").0, 0);
    for words in ["diff a.png no.png", "diff a.png ball.ron", "diff a.png a.png --flip 0.1 --pixels 1"] {
        let (code, out, err) = desk.run(words);
        assert_eq!((code, out.as_str()), (2, ""), "{words}");
        assert!(err.contains("error: "), "{words}: {err}");
    }
    assert_eq!(desk.run("render ball.ron -o small.png --size 32x24 -q").0, 0);
    let (code, out, _) = desk.run("diff a.png small.png --flip 1");
    assert_eq!(code, 1);
    assert!(out.starts_with("sizes    64x48 and 32x24 pixels"), "{out}");
}

#[test]
fn a_picture_is_drawn_again_from_what_its_file_tells() {
    let desk = Desk::new();
    let changes = "--size 48x36 --depth 3 --antialias four --region 8,4,32,16";
    for (file, bits) in [("a.png", ""), ("b.png", "--bits 16"), ("c.exr", "")] {
        assert_eq!(desk.run(&format!("render ball.ron -o {file} -q {bits} {changes}")).0, 0);
        let (code, out, err) = desk.run(&format!("repro {file}"));
        assert_eq!((code, err.as_str()), (0, ""), "{out}");
        assert_eq!(out, format!("{file}: drawn again from ball.ron: the same to the last bit\n"));
    }
    let (code, _, err) = desk.run("repro ball.ron");
    assert_eq!(code, 2, "{err}");

    // Pixels that were painted over.
    touch(&desk, "a.png", "painted.png", Format::Png8, |picture| picture.pixels[3] = [1.0, 0.0, 1.0]);
    let (code, out, _) = desk.run("repro painted.png");
    assert_eq!(code, 1);
    assert!(out.contains("its pixels were changed") && out.contains("1 pixel differs"), "{out}");

    // Another scene in the same place.
    desk.put("ball.ron", &BALL.replace("radius: 1", "radius: 0.9"));
    let (code, out, _) = desk.run("repro c.exr -o difference.png");
    assert_eq!(code, 1);
    assert!(out.contains("the scene gives another picture") && out.contains("FLIP"), "{out}");
    assert!(desk.path("difference.png").exists());

    // The scene elsewhere.
    fs::create_dir(desk.path("moved")).expect("a folder");
    fs::remove_file(desk.path("ball.ron")).expect("removed");
    desk.put("moved/ball.ron", BALL);
    let (code, _, err) = desk.run("repro a.png");
    assert_eq!(code, 2);
    assert!(err.contains("the scene is not at `ball.ron`: name it with --scene"), "{err}");
    assert_eq!(desk.run("repro a.png --scene moved/ball.ron").0, 0);
    image::write(&desk.path("plain.png"), Format::Png8, &Picture::black(2, 2), &Metadata::default()).expect("written");
    let (code, _, err) = desk.run("repro plain.png");
    assert_eq!(code, 2);
    assert!(err.contains("was not made by snell"), "{err}");
}

#[test]
fn a_picture_made_by_other_methods_is_drawn_again_by_them() {
    let desk = Desk::new();
    let draw = |file: &str, how: &str| desk.run(&format!("render ball.ron -o {file} -q {how}")).0;
    assert_eq!((draw("plain.exr", ""), draw("single.exr", "--precision f32 --sphere-test naive")), (0, 0));
    assert_eq!(desk.run("diff plain.exr single.exr").0, 1, "the methods show");
    for file in ["plain.exr", "single.exr"] {
        let told = format!("{file}: drawn again from ball.ron: the same to the last bit\n");
        assert_eq!(desk.run(&format!("repro {file}")), (0, told, String::new()));
    }
    let (picture, mut told) = image::read(&desk.path("plain.exr")).expect("a picture");
    told.insert(image::key::METHODS, "precision F16");
    image::write(&desk.path("odd.exr"), Format::Exr, &picture, &told).expect("written");
    let (code, _, err) = desk.run("repro odd.exr");
    assert_eq!(code, 2);
    assert!(err.contains("holds methods that are not known: `F16` is none of"), "{err}");
}

#[test]
fn a_picture_of_raw_numbers_of_a_scene_placed_as_a_whole_is_drawn_again() {
    let desk = Desk::new();
    let settings =
        "encoding: Raw, transform: [Rotate(axis: (1, 2, 3), degrees: 0.1), Scale(1.5)], transform_lights: false, ";
    desk.put("raw.ron", &BALL.replace("width: 64", &format!("{settings}width: 64")));
    for (file, bits) in [("a.png", ""), ("b.png", "--bits 16"), ("c.exr", "")] {
        assert_eq!(desk.run(&format!("render raw.ron -o {file} -q {bits}")).0, 0);
        let told = format!("{file}: drawn again from raw.ron: the same to the last bit\n");
        assert_eq!(desk.run(&format!("repro {file}")), (0, told, String::new()));
    }
}

#[test]
fn scenes_are_laid_out_in_place_and_checked() {
    let desk = Desk::new();
    desk.put("ugly.ron", "Scene(version:1,entities:{\"a\":[Sphere(radius :1,) ] , // one\n})");
    let (code, out, _) = desk.run("fmt --check ball.ron ugly.ron");
    assert_eq!((code, out.as_str()), (1, "ball.ron: would be changed\nugly.ron: would be changed\n"));
    assert_eq!(fs::read_to_string(desk.path("ball.ron")).expect("a file"), BALL);
    let (code, out, _) = desk.run("fmt ugly.ron");
    assert_eq!((code, out.as_str()), (0, "ugly.ron: changed\n"));
    let laid_out = fs::read_to_string(desk.path("ugly.ron")).expect("a file");
    assert!(laid_out.contains("        \"a\": [Sphere(radius: 1)], // one\n"), "{laid_out}");
    assert_eq!(desk.run("fmt --check ugly.ron"), (0, String::new(), String::new()));

    desk.put("broken.ron", "Scene(version: 1,\n  entities: {)");
    let (code, _, err) = desk.run("fmt broken.ron ball.ron");
    assert_eq!(code, 1);
    assert!(err.contains("broken.ron:2:"), "{err}");
    assert_eq!(desk.run("fmt --check ball.ron").0, 0, "sound files are laid out all the same");
}
