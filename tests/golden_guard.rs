//! The guard is guarded: what golden tests must notice, they notice.

#[path = "support/golden.rs"]
mod golden;

use golden::{Bless, Difference, Golden, MAX_BYTES, dead};
use snell::{Picture, systems::image};
use std::{fs, path::Path};
use tempfile::TempDir;

fn picture() -> Picture {
    let mut picture = Picture::black(8, 6);
    for (i, pixel) in picture.pixels.iter_mut().enumerate() {
        *pixel = [i as f32 / 48.0, 0.25, 0.5];
    }
    picture
}

/// A folder with the scene `area/case.ron` and its golden picture.
fn blessed() -> (TempDir, Golden) {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("area")).expect("created");
    fs::write(folder.path().join("area/case.ron"), "").expect("written");
    let golden = Golden::all(folder.path(), &folder.path().join("reports")).expect("read").remove(0);
    assert_eq!((golden.name.as_str(), &golden.scene), ("area/case", &folder.path().join("area/case.ron")));
    golden.check(&picture(), &Bless::Failing).expect("blessed");
    golden.check(&picture(), &Bless::Nothing).expect("equal");
    (folder, golden)
}

#[test]
fn one_bit_in_one_channel_is_noticed_though_no_level_shows_it() {
    let (_folder, golden) = blessed();
    let mut actual = picture();
    actual.pixels[17][1] = actual.pixels[17][1].next_up();
    let told = golden.check(&actual, &Bless::Nothing).expect_err("different");
    assert!(told.contains("all 8-bit levels are equal") && told.contains(&actual.hash()), "{told}");
}

#[test]
fn one_level_of_one_channel_is_noticed_and_shown() {
    let (_folder, golden) = blessed();
    let mut actual = picture();
    actual.pixels[17][1] += 0.003;
    let told = golden.check(&actual, &Bless::Nothing).expect_err("different");
    assert!(told.contains("1 pixels differ, by up to 1 of 255\nfirst at column 1, row 2: "), "{told}");
    assert!(told.contains("SNELL_BLESS=area/case cargo test --test golden"), "{told}");
    let (shown, _) = image::read(&golden.report).expect("a report");
    assert_eq!((shown.width, shown.height), (24, 6));
    let marked: Vec<_> = (0..48).filter(|i| shown.pixel(8 + i % 8, i / 8) != Some([0.0; 3])).collect();
    assert_eq!(marked, [17]);
    golden.check(&picture(), &Bless::Nothing).expect("equal");
    assert!(!golden.report.exists(), "a report outlived its failure");
}

#[test]
fn the_levels_are_compared_even_if_the_hash_is_right() {
    let mut expected = picture();
    expected.pixels[3][0] = 1.0;
    let difference = Difference::between(&expected, &picture().hash(), &picture()).expect("different");
    assert_eq!((difference.pixels, difference.sizes), (1, None));
    assert_eq!(difference.first.map(|(x, y, ..)| (x, y)), Some((3, 0)));
    assert!(difference.largest > 100 && difference.hashes[0] == difference.hashes[1]);
}

#[test]
fn another_size_is_noticed() {
    let (_folder, golden) = blessed();
    let told = golden.check(&Picture::black(6, 8), &Bless::Nothing).expect_err("different");
    assert!(told.contains("8x6 pixels were expected, 6x8 were rendered"), "{told}");
}

#[test]
fn a_missing_picture_fails_and_leaves_a_candidate() {
    let (_folder, golden) = blessed();
    fs::remove_file(&golden.expected).expect("removed");
    let told = golden.check(&picture(), &Bless::Nothing).expect_err("missing");
    assert!(told.contains("there is no golden picture"), "{told}");
    assert!(!golden.expected.exists());
    fs::copy(&golden.report, &golden.expected).expect("copied");
    golden.check(&picture(), &Bless::Nothing).expect("the candidate is what blessing writes");
}

#[test]
fn a_picture_without_hash_fails() {
    let (_folder, golden) = blessed();
    image::write(&golden.expected, image::Format::Png8, &picture(), &image::Metadata::default()).expect("written");
    let told = golden.check(&picture(), &Bless::Nothing).expect_err("no hash");
    assert!(told.contains("has no `snell:hash`"), "{told}");
}

#[test]
fn a_picture_that_is_too_large_fails_even_when_blessed() {
    let (_folder, golden) = blessed();
    let mut noise = Picture::black(128, 128);
    let mut state = 1u32;
    for channel in noise.pixels.iter_mut().flatten() {
        // Marsaglia's xorshift.
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        *channel = state as f32 / u32::MAX as f32;
    }
    let told = golden.check(&noise, &Bless::All).expect_err("too large");
    assert!(told.contains(&format!("at most {MAX_BYTES} are allowed")), "{told}");
}

#[test]
fn blessing_is_refused_under_ci() {
    for value in ["1", "all", "area/*"] {
        assert!(Bless::from_env(Some(value), true).is_err_and(|why| why.contains("CI is set")));
    }
    assert_eq!(Bless::from_env(None, true), Ok(Bless::Nothing));
    assert_eq!(Bless::from_env(Some(""), true), Ok(Bless::Nothing));
}

#[test]
fn only_what_was_named_is_blessed() {
    let (_folder, golden) = blessed();
    let other = Picture::black(8, 6);
    for (value, blessed) in [
        ("other", false),
        ("area", true),
        ("*/case", true),
        ("area/*", true),
        ("a*a/c*e", true),
        ("*/cas", false),
        ("rea/*", false),
        ("area/case*case", false),
        ("1", true),
        ("all", true),
    ] {
        golden.check(&picture(), &Bless::All).expect("reset");
        let bless = Bless::from_env(Some(value), false).expect("allowed");
        assert_eq!(golden.check(&other, &bless).is_ok(), blessed, "{value}");
    }
}

#[test]
fn a_picture_without_scene_is_found() {
    let (folder, golden) = blessed();
    assert_eq!(dead(folder.path()).expect("read"), Vec::<&Path>::new());
    fs::remove_file(&golden.scene).expect("removed");
    assert_eq!(dead(folder.path()).expect("read"), [golden.expected]);
}
