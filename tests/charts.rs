//! `snell chart` and `snell render --time` from the command line.

use std::{fs, path::Path, process::Command};

fn snell(args: &[&str], folder: &Path) -> (bool, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_snell"));
    let done = command.args(args).current_dir(folder).output().expect("the program runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (done.status.success(), text(&done.stdout), text(&done.stderr))
}

fn scene(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name).display().to_string()
}

#[test]
fn a_chart_comes_with_its_numbers_and_a_page_that_needs_no_server() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene("scenes/gallery/behind-glass.ron");
    let (ok, out, err) = snell(
        &["chart", &scene, "-o", "charts", "--quick", "--width", "16", "--study", "settings", "depth"],
        folder.path(),
    );
    assert!(ok, "{out}{err}");
    assert!(out.contains("the cheapest setting is") && out.contains("the best setting is"), "{out}");
    let read = |name: &str| fs::read_to_string(folder.path().join("charts").join(name)).expect(name);
    let page = read("index.html");
    for text in ["src=\"settings-rmse.svg\"", "src=\"depth-rays.svg\"", "the reference", "charts.json"] {
        assert!(page.contains(text), "{text} is not on the page");
    }
    assert!(!page.contains("http") && !page.contains("<script"), "the page asks for something from elsewhere");
    let json: serde_json::Value = serde_json::from_str(&read("charts.json")).expect("JSON");
    for study in json["studies"].as_array().expect("studies") {
        let (name, rows) = (study["name"].as_str().expect("a name"), study["table"]["rows"].as_array().expect("rows"));
        assert_eq!(read(&format!("{name}.csv")).lines().count(), rows.len() + 1, "{name}");
        assert!(study["says"].as_array().is_some_and(|says| says.len() >= 2), "{name}");
    }
    for name in ["settings-rmse", "settings-flip", "settings-rays", "depth-rays", "depth-time"] {
        let svg = read(&format!("{name}.svg"));
        for text in ["RMSE", "FLIP"].iter().filter(|text| name.contains(&text.to_lowercase())) {
            assert!(svg.contains(text), "{name} does not say what is on its axis");
        }
        assert!(svg.contains("better") && svg.contains("Pareto front") && !svg.contains("NaN"), "{name}");
        let png = image::open(folder.path().join(format!("charts/{name}.png"))).expect("a picture");
        assert_eq!((png.width(), png.height()), (960, 600));
        // Letters need a font: there is ink where the title stands, as there would not be without.
        let title = png.to_luma8();
        let ink =
            (92..500).flat_map(|x| (14..44).map(move |y| (x, y))).filter(|(x, y)| title.get_pixel(*x, *y).0[0] < 128);
        assert!(ink.count() > 200, "{name} has no title");
    }
}

#[test]
fn several_scenes_share_a_page_and_their_errors_keep_the_bound() {
    let folder = tempfile::tempdir().expect("a folder");
    let scenes = ["tests/golden/optics/mirror-and-glass.ron", "tests/golden/texture/checkers.ron"].map(scene);
    let args =
        ["chart", &scenes[0], &scenes[1], "-o", "charts", "--quick", "--width", "12", "--study", "error", "lights"];
    let (ok, out, err) = snell(&args, folder.path());
    assert!(ok && err.contains("left out: no light has an area"), "{out}{err}");
    let json = fs::read_to_string(folder.path().join("charts/charts.json")).expect("numbers");
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let studies = json["studies"].as_array().expect("studies");
    let names: Vec<_> = studies.iter().filter_map(|study| study["name"].as_str()).collect();
    assert_eq!(names, ["mirror-and-glass-error", "checkers-error", "errors"]);
    let rows = studies[2]["table"]["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 4);
    for row in rows {
        // Toward the end bound and cost of cuts, in 255ths.
        let number = |at: usize| row[at].as_f64().expect("a number");
        let (bound, cost) = (number(9), number(10));
        assert!(cost <= bound + 1e-3, "{row}");
    }
    assert!(fs::read_to_string(folder.path().join("charts/charts.md")).is_ok_and(|text| text.contains("| scene |")));
}

#[test]
fn a_study_that_a_scene_has_nothing_for_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene("tests/golden/shape/triangles.ron");
    let (ok, _, err) = snell(&["chart", &scene, "--quick", "--study", "lights"], folder.path());
    assert!(!ok && err.contains("no light has an area"), "{err}");
    let (ok, _, err) = snell(&["chart", "--study", "antialias"], folder.path());
    assert!(!ok && err.contains("needs a scene"), "{err}");
    let (ok, _, err) = snell(&["chart", &scene, "--study", "antialiasing"], folder.path());
    assert!(!ok && err.contains("antialias"), "{err}");
}

#[test]
fn a_time_that_is_too_short_still_gives_a_picture_and_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene("tests/golden/optics/mirror-and-glass.ron");
    let (ok, out, err) = snell(&["render", &scene, "-o", "a.png", "--time", "0"], folder.path());
    assert!(ok && out.contains("the time is too short"), "{out}{err}");
    assert!(folder.path().join("a.png").exists());
    let (ok, out, err) = snell(&["render", &scene, "-o", "b.png", "--size", "4x3", "--time", "600"], folder.path());
    assert!(ok && out.contains("nothing more is to be gained"), "{out}{err}");
    let (ok, _, err) = snell(&["render", &scene, "--time", "1", "--error", "0.1"], folder.path());
    assert!(!ok && err.contains("cannot be used with"), "{err}");
}
