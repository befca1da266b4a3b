//! The program on scene files: what it prints and writes, and how it ends.

mod support {
    pub(crate) mod desk;
}

use snell::{
    Region,
    cli::Stats,
    systems::image::{self, key},
};
use std::{fs, process::Command};
use support::desk::{BALL, Desk, ended};

#[test]
fn a_scene_becomes_a_picture_of_its_name() {
    let desk = Desk::new();
    let (code, out, err) = desk.run("render ball.ron");
    assert_eq!((code, err.as_str()), (0, ""));
    assert!(out.starts_with("picture  ball.png, 64x48\nrays ") && out.contains(": 3,072 primary, "), "{out}");
    let (picture, metadata) = image::read(&desk.path("ball.png")).expect("a picture");
    assert_eq!((picture.width, picture.height), (64, 48));
    assert_eq!(metadata.get(key::SCENE), Some("ball.ron"));
    // The ball is red in the middle, and the corner sees nothing.
    let [red, green, blue] = picture.pixel(32, 24).expect("a pixel");
    assert!(red > 3.0 * green && green > blue && blue > 0.0);
    assert_eq!(picture.pixel(0, 0), Some([0.0; 3]));

    assert_eq!(desk.run("render ball.ron -o quiet.png --quiet"), (0, String::new(), String::new()));
    let [loud, quiet] = ["ball.png", "quiet.png"].map(|name| fs::read(desk.path(name)).expect("read"));
    assert_eq!(loud, quiet);
}

#[test]
fn settings_of_the_scene_give_way_to_options() {
    let desk = Desk::new();
    let (code, _, err) = desk.run(
        "render ball.ron -o a.exr --size 32x24 --antialias four --depth 2 --region 8,6,10,5 --threads 2 --stats a.json",
    );
    assert_eq!((code, err.as_str()), (0, ""));
    let json = fs::read_to_string(desk.path("a.json")).expect("read");
    let stats: Stats = serde_json::from_str(&json).expect("stats");
    assert_eq!((stats.width, stats.height, stats.threads), (32, 24, 2));
    assert_eq!((stats.objects, stats.lights), (1, 1));
    assert_eq!(stats.region, Region { x: 8, y: 6, width: 10, height: 5 });
    assert_eq!((stats.drawn, stats.counts.primary), (50, 200));
    let (picture, metadata) = image::read(&desk.path("a.exr")).expect("a picture");
    assert_eq!(picture.hash(), stats.hash);
    let settings = metadata.get(key::SETTINGS).unwrap_or_default();
    assert!(settings.contains("depth: 2, antialias: Four"), "{settings}");
}

#[test]
fn the_hash_does_not_depend_on_threads() {
    let desk = Desk::new();
    let [one, three] = [1, 3].map(|threads| desk.run(&format!("hash ball.ron --threads {threads}")));
    assert_eq!(one, three);
    let (code, out, _) = one;
    assert_eq!(code, 0);
    let (hash, rest) = out.split_at(64);
    assert!(hash.chars().all(|digit| digit.is_ascii_hexdigit()) && rest == "  ball.ron\n", "{out}");
}

#[test]
fn all_faults_of_all_files_are_told_and_good_ones_are_named() {
    let desk = Desk::new();
    desk.put("bad.ron", &BALL.replace("radius: 1", "radius: -1").replace("Camera(position", "Camera(postion"));
    desk.put("torn.ron", &BALL[..100]);
    let (code, out, err) = desk.run("check bad.ron ball.ron missing.ron torn.ron");
    assert_eq!((code, out.as_str()), (1, "ball.ron: ok\n"));
    for start in ["error: bad.ron:2:", "error: bad.ron:4:", "error: missing.ron: ", "error: torn.ron:"] {
        assert!(err.lines().any(|line| line.starts_with(start)), "{start} in {err}");
    }
    let faults = err.lines().filter(|line| line.starts_with("error: ")).count();
    assert!(err.ends_with(&format!("\n{faults} faults\n")), "{err}");

    let (code, out, err) = desk.run("render bad.ron");
    assert_eq!((code, out.as_str()), (1, ""));
    assert!(err.contains("error: bad.ron:2:") && !desk.path("bad.png").exists(), "{err}");
}

#[test]
fn scenes_that_are_checked_do_not_see_each_other() {
    let desk = Desk::new();
    let (code, out, err) = desk.run("check ball.ron ball.ron");
    assert_eq!((code, out.as_str(), err.as_str()), (0, "ball.ron: ok\nball.ron: ok\n", ""));
}

#[test]
fn a_failed_render_leaves_the_last_picture_as_it_was() {
    let desk = Desk::new();
    desk.put("ball.png", "precious");
    assert_eq!(desk.run("render ball.ron --region 60,0,5,1").0, 2);
    assert_eq!(fs::read_to_string(desk.path("ball.png")).expect("read"), "precious");
    assert_eq!(fs::read_dir(desk.path("")).expect("a folder").count(), 2);
}

/// Ctrl-C once the program listens to it and has worked since; where that can be seen.
#[cfg(target_os = "linux")]
#[test]
fn an_interrupted_render_keeps_what_was_drawn() {
    use std::{process::Stdio, thread, time::Duration};

    let desk = Desk::new();
    let mut command = desk.command("render ball.ron -o part.png --size 3000x2000 --antialias four --quiet");
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("started");
    let status = format!("/proc/{}/status", child.id());
    let listens = || {
        let status = fs::read_to_string(&status).unwrap_or_default();
        let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap_or_default();
        // Bit 1 of the mask is signal 2, SIGINT. A program that has ended catches nothing any more.
        status.contains("State:\tZ") || u64::from_str_radix(caught.trim(), 16).is_ok_and(|mask| mask & 2 != 0)
    };
    // Processor time in ticks: user and system, the 14th and 15th field of the line.
    let stat = format!("/proc/{}/stat", child.id());
    let worked = || {
        let stat = fs::read_to_string(&stat).unwrap_or_default();
        stat.split(' ').skip(13).take(2).filter_map(|ticks| ticks.parse::<u64>().ok()).sum::<u64>()
    };
    while !listens() {
        thread::sleep(Duration::from_millis(5));
    }
    // A few rows are drawn within a tick; the whole takes hundreds.
    let before = worked();
    while worked() < before + 10 && !fs::read_to_string(&status).unwrap_or_default().contains("State:\tZ") {
        thread::sleep(Duration::from_millis(5));
    }
    let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(kill.success());

    let (code, out, err) = ended(child.wait_with_output().expect("ended"));
    assert_eq!((code, out.as_str()), (130, ""));
    assert!(err.starts_with("stopped after ") && err.ends_with("the partial picture is in part.png\n"), "{err}");
    let (picture, metadata) = image::read(&desk.path("part.png")).expect("a picture");
    assert_eq!((picture.width, picture.height), (3000, 2000));
    assert!(metadata.get(key::DRAWN).is_some_and(|drawn| drawn.ends_with("/6000000")));
}
