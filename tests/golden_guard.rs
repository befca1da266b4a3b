//! The guard is guarded: what golden tests must notice, they notice.

mod support {
    #[expect(dead_code, reason = "golden pictures read themselves")]
    pub(crate) mod cases;
    pub(crate) mod dead;
}

use snell::{
    Picture, Renderer,
    golden::{Bless, Golden, MOST_BYTES},
    systems::image,
};
use std::{
    fs,
    path::{Path, PathBuf},
};
use support::{cases::Case, dead::dead};
use tempfile::TempDir;

fn picture() -> Picture {
    let mut picture = Picture::black(8, 6);
    for (i, pixel) in picture.pixels.iter_mut().enumerate() {
        *pixel = [i as f32 / 48.0, 0.25, 0.5];
    }
    picture
}

/// A folder with the scene `area/case.ron` and its golden picture.
struct Desk {
    folder: TempDir,
    golden: Golden,
}

impl Desk {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        fs::create_dir(folder.path().join("area")).expect("created");
        fs::write(folder.path().join("area/case.ron"), "").expect("written");
        let case = Case::all(folder.path()).expect("read").remove(0);
        assert_eq!((case.name.as_str(), &case.scene), ("area/case", &folder.path().join("area/case.ron")));
        let golden = Golden::at(&case.name, &case.expected, &folder.path().join("reports")).scene("area/case.ron");
        let desk = Self { folder, golden };
        desk.check(&picture(), &Bless::Failing).expect("blessed");
        desk.check(&picture(), &Bless::Nothing).expect("equal");
        desk
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn check(&self, picture: &Picture, bless: &Bless) -> Result<(), String> {
        self.golden.check(&mut picture.clone(), bless)
    }

    /// The picture with a change of one pixel.
    fn fails(&self, change: impl FnOnce(&mut [f32; 3])) -> String {
        let mut actual = picture();
        change(&mut actual.pixels[17]);
        self.check(&actual, &Bless::Nothing).expect_err("different")
    }

    fn page(&self) -> String {
        fs::read_to_string(self.path("reports/report.html")).expect("a report")
    }
}

#[test]
fn one_bit_in_one_channel_is_noticed_though_no_level_shows_it() {
    let desk = Desk::new();
    let told = desk.fails(|pixel| pixel[1] = pixel[1].next_up());
    assert!(told.contains("all 8-bit levels are equal") && told.contains(&picture().hash()), "{told}");
    let mut actual = picture();
    actual.pixels[17][1] = actual.pixels[17][1].next_up();
    desk.golden.clone().pixels(0).check(&mut actual, &Bless::Nothing).expect("the same on a screen");
    desk.golden.clone().flip(0.0).check(&mut actual, &Bless::Nothing).expect("the same to the eye");
}

#[test]
fn one_level_of_one_channel_is_noticed_and_shown() {
    let desk = Desk::new();
    let told = desk.fails(|pixel| pixel[1] += 0.003);
    assert!(told.contains("1 pixel differs, by up to 1 of 255"), "{told}");
    assert!(told.contains("first at column 1, row 2: "), "{told}");
    assert!(told.contains("SNELL_BLESS='area/case' cargo test"), "{told}");
    assert!(told.contains("snell why area/case.ron 1 2"), "{told}");
    let (shown, _) = image::read(&desk.path("reports/area/case.difference.png")).expect("a picture");
    let marked: Vec<_> = (0..48).filter(|i| shown.pixels[*i][0] > 0.9).collect();
    assert_eq!(marked, [17]);

    let page = desk.page();
    for part in ["area/case", "1 golden picture fails", "column 1, row 2", "snell why area/case.ron 1 2", "type=range"]
    {
        assert!(page.contains(part), "{part}");
    }
    // A ring about the middle of the pixel, and its colours.
    assert!(page.contains("left:18.750%;top:41.667%") && page.matches("class=level").count() == 2, "{page}");
    assert_eq!(page.matches("data:image/png;base64,").count(), 5, "three pictures, and two to slide between");
    desk.check(&picture(), &Bless::Nothing).expect("equal");
    assert!(!desk.path("reports/report.html").exists(), "a report outlived its failure");
    assert!(!desk.path("reports/area/case.actual.png").exists());
}

#[test]
fn levels_allow_what_they_name_and_no_more() {
    let desk = Desk::new();
    let mut actual = picture();
    actual.pixels[17][1] += 0.003;
    actual.pixels[20][1] += 0.003;
    let check = |golden: Golden| golden.check(&mut actual.clone(), &Bless::Nothing).is_ok();
    assert!(check(desk.golden.clone().pixels(1)) && !check(desk.golden.clone().pixels(0)));
    assert!(check(desk.golden.clone().at_most_pixels(2)) && !check(desk.golden.clone().at_most_pixels(1)));
    assert!(check(desk.golden.clone().flip(0.5)) && !check(desk.golden.clone().flip(1e-9)));
}

#[test]
fn the_levels_are_compared_even_if_the_hash_is_right() {
    let desk = Desk::new();
    let (mut painted, told) = image::read(&desk.path("area/case.png")).expect("a picture");
    painted.pixels[3][0] = 1.0;
    image::write(&desk.path("area/case.png"), image::Format::Png8, &painted, &told).expect("written");
    let told = desk.check(&picture(), &Bless::Nothing).expect_err("painted over");
    assert!(told.contains("first at column 3, row 0"), "{told}");
}

#[test]
fn a_region_is_compared_alone() {
    let desk = Desk::new();
    let golden = Golden::at("part", &desk.path("part.png"), &desk.path("reports")).region(1, 2, 4, 3);
    golden.check(&mut picture(), &Bless::All).expect("blessed");
    let (part, _) = image::read(&desk.path("part.png")).expect("a picture");
    assert_eq!((part.width, part.height), (4, 3));
    let mut actual = picture();
    actual.pixels[0] = [1.0; 3];
    golden.check(&mut actual, &Bless::Nothing).expect("it lies outside");
    actual.pixels[17] = [1.0; 3];
    let told = golden.check(&mut actual, &Bless::Nothing).expect_err("it lies inside");
    assert!(told.contains("first at column 0, row 0"), "{told}");
    let told = golden.region(5, 5, 4, 4).check(&mut picture(), &Bless::Nothing).expect_err("beyond the edge");
    assert!(told.contains("does not lie within the 8x6 pixels"), "{told}");
}

const BALL: &str = r#"Scene(version: 1, settings: (width: 16, height: 12), entities: {
    "camera": [Camera(position: (0, 0, 4))],
    "left": [DirectionalLight(direction: (1, -1, -1))],
    "right": [DirectionalLight(direction: (-1, -1, -1), intensity: 0.25)],
    "ball": [Sphere(radius: 1), Color((0.9, 0.4, 0.2))],
})"#;

fn renderer(scene: &str) -> Renderer {
    let mut renderer = Renderer::new();
    renderer.load_text(scene, "ball.ron").expect("a sound scene");
    renderer
}

#[test]
fn one_light_is_noticed_and_the_report_explains_the_pixel() {
    let desk = Desk::new();
    let golden = Golden::at("ball", &desk.path("ball.png"), &desk.path("reports"));
    golden.check(&mut renderer(BALL), &Bless::All).expect("blessed");
    golden.check(&mut renderer(BALL), &Bless::Nothing).expect("equal");
    let told = golden.check(&mut renderer(&BALL.replace("0.25", "0.26")), &Bless::Nothing).expect_err("a light");
    assert!(told.contains("pixels differ"), "{told}");
    let page = desk.page();
    assert!(page.contains("How the first pixel that differs comes about now"), "{page}");
    assert!(page.contains("`right` (ball.ron:4)") && page.contains("meets `ball` (ball.ron:5)"));
}

#[test]
fn the_worst_failure_comes_first_in_the_report() {
    let desk = Desk::new();
    for (name, light) in [("a little", 0.26), ("very", 0.9), ("some", 0.4)] {
        let golden = Golden::at(name, &desk.path(&format!("{name}.png")), &desk.path("reports"));
        golden.check(&mut renderer(BALL), &Bless::All).expect("blessed");
        let other = BALL.replace("0.25", &light.to_string());
        golden.check(&mut renderer(&other), &Bless::Nothing).expect_err("different");
    }
    let page = desk.page();
    let place = |name: &str| page.find(&format!("<h2>{name}</h2>")).expect("an article");
    assert!(place("very") < place("some") && place("some") < place("a little"));
    assert!(page.contains("3 golden pictures fail"));
}

#[test]
fn another_size_is_noticed() {
    let desk = Desk::new();
    let told = desk.check(&Picture::black(6, 8), &Bless::Nothing).expect_err("different");
    assert!(told.contains("8x6 pixels were expected, 6x8 were drawn"), "{told}");
}

#[test]
fn a_missing_picture_fails_and_leaves_a_candidate() {
    let desk = Desk::new();
    fs::remove_file(desk.path("area/case.png")).expect("removed");
    let told = desk.check(&picture(), &Bless::Nothing).expect_err("missing");
    assert!(told.contains("there is no golden picture"), "{told}");
    assert!(!desk.path("area/case.png").exists());
    fs::copy(desk.path("reports/area/case.actual.png"), desk.path("area/case.png")).expect("copied");
    desk.check(&picture(), &Bless::Nothing).expect("the candidate is what blessing writes");
}

#[test]
fn a_picture_without_hash_fails() {
    let desk = Desk::new();
    image::write(&desk.path("area/case.png"), image::Format::Png8, &picture(), &image::Metadata::default())
        .expect("written");
    let told = desk.check(&picture(), &Bless::Nothing).expect_err("no hash");
    assert!(told.contains("has no `snell:hash`"), "{told}");
}

#[test]
fn a_picture_that_is_too_large_fails_even_when_blessed() {
    let desk = Desk::new();
    let mut noise = Picture::black(128, 128);
    let mut state = 1u32;
    for channel in noise.pixels.iter_mut().flatten() {
        // Marsaglia's xorshift.
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        *channel = state as f32 / u32::MAX as f32;
    }
    let told = desk.check(&noise, &Bless::All).expect_err("too large");
    assert!(told.contains(&format!("at most {MOST_BYTES} are allowed")), "{told}");
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
    let desk = Desk::new();
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
        desk.check(&picture(), &Bless::All).expect("reset");
        let bless = Bless::from_env(Some(value), false).expect("allowed");
        assert_eq!(desk.check(&other, &bless).is_ok(), blessed, "{value}");
    }
}

#[test]
fn a_picture_without_scene_is_found() {
    let desk = Desk::new();
    assert_eq!(dead(desk.folder.path()).expect("read"), Vec::<&Path>::new());
    fs::remove_file(desk.path("area/case.ron")).expect("removed");
    assert_eq!(dead(desk.folder.path()).expect("read"), [desk.path("area/case.png")]);
}

#[test]
fn a_picture_that_no_test_names_is_dead_and_leaves_the_report() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let [here, target] = [folder.path().to_str().expect("text"), &format!("{}/target/tmp", folder.path().display())];
    fs::create_dir(path("tests")).expect("created");
    fs::write(path("tests/all.rs"), "assert_golden!(renderer, \"area/named\");").expect("written");
    for name in ["area/named", "area/unnamed"] {
        let golden = Golden::new(here, Some(target), name);
        golden.check(&mut picture(), &Bless::All).expect("blessed");
        golden.check(&mut Picture::black(8, 6), &Bless::Nothing).expect_err("different");
    }
    let page = || fs::read_to_string(path("target/golden/report.html")).expect("a report");
    assert!(page().contains("2 golden pictures fail") && page().contains("<a href=\"#1\">area/"));
    let dead = snell::golden::dead(here, Some(target)).expect("read");
    assert_eq!(dead, [path("tests/golden/area/unnamed.png")]);
    assert!(page().contains("1 golden picture fails") && !page().contains("unnamed"), "{}", page());
}

#[test]
fn what_scenes_are_made_of_is_no_case() {
    let desk = Desk::new();
    for parts in ["parts", "models", "area/textures"] {
        fs::create_dir(desk.folder.path().join(parts)).expect("created");
        fs::copy(desk.path("area/case.ron"), desk.folder.path().join(parts).join("part.ron")).expect("copied");
        fs::copy(desk.path("area/case.png"), desk.folder.path().join(parts).join("image.png")).expect("copied");
    }
    fs::write(desk.folder.path().join("area/notes.txt"), "").expect("written");
    let names: Vec<_> = Case::all(desk.folder.path()).expect("read").into_iter().map(|case| case.name).collect();
    assert_eq!(names, ["area/case"]);
    assert_eq!(dead(desk.folder.path()).expect("read"), Vec::<&Path>::new());
}
