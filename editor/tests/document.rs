//! Edits, undoing, saving and the worker: without a window.

use snell::{
    Options, Renderer,
    components::{
        camera::Camera,
        light::PointLight,
        material::{Color, Diffuse},
        name::Name,
        settings::{Antialias, Settings},
        shape::Sphere,
        transform::Transform,
    },
    prelude::{DVec3, Rgb},
    render,
    systems::{
        registry::Registry,
        scene::{Scene, Thing},
    },
};
use snell_editor::{
    autosave::{self, Autosave},
    document::{Document, Edit},
    worker::{How, Phase, Worker},
};
use std::{
    env, fs,
    path::Path,
    process::Command,
    time::{Duration, Instant},
};

fn registry() -> Registry {
    Renderer::new().world.resource::<Registry>().clone()
}

fn name(name: &str) -> Name {
    Name::new(name)
}

fn empty() -> Document {
    Document::new(registry(), Scene::default(), None)
}

fn ball(radius: f64) -> Thing {
    Thing::default().with(Sphere { radius }).with(Diffuse(Rgb::ONE))
}

/// splitmix64
fn random(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// Some edit of a scene of a few things.
fn any_edit(document: &Document, state: &mut u64) -> Edit {
    let names: Vec<Name> = document.things().map(|(name, _)| name.clone()).collect();
    let roll = random(state);
    let some = |state: &mut u64| names.get(random(state) as usize % names.len().max(1)).cloned();
    let edit = Edit::new("any").during(roll.is_multiple_of(3).then_some(roll >> 8 & 1));
    match (roll % 6, some(state)) {
        (0, Some(one)) => edit.take(&one),
        (1, Some(one)) => {
            let new = document.free_name("renamed");
            Edit { renames: vec![(one, new)], ..edit }
        }
        (2, _) => Edit { settings: Some(Settings { width: roll as u32 % 1000 + 1, ..Settings::default() }), ..edit },
        (3, Some(one)) => match document.get(&one) {
            Some(thing) => {
                edit.put(&one, Thing { made_of: some(state).filter(|other| *other != one), ..(**thing).clone() })
            }
            None => edit,
        },
        (4, Some(one)) => edit.put(&one, ball((roll % 97 + 1) as f64 * 0.1)),
        _ => edit.put(&document.free_name("ball"), ball((roll % 89 + 1) as f64)),
    }
}

#[test]
fn undoing_everything_gives_back_the_first_text_and_redoing_the_last() {
    for seed in 0..20 {
        let mut state = seed;
        let mut document = empty();
        let mut texts = vec![document.text().expect("a text")];
        for _ in 0..200 {
            document.apply(any_edit(&document, &mut state));
        }
        let last = document.text().expect("a text");
        while document.undo_label().is_some() {
            document.undo();
        }
        assert_eq!(document.text().as_ref(), Ok(&texts[0]), "seed {seed}");
        assert!(!document.is_changed());
        while document.redo_label().is_some() {
            document.redo();
        }
        assert_eq!(document.text(), Ok(last), "seed {seed}");
        texts.clear();
    }
}

#[test]
fn one_drag_is_one_step() {
    let mut document = empty();
    document.apply(Edit::of("Add ball", &name("ball"), ball(1.0)));
    for step in 1..50 {
        let thing = ball(1.0).with(Transform::at(DVec3::X * f64::from(step)));
        document.apply(Edit::of("Move ball", &name("ball"), thing).during(Some(7)));
    }
    document.end_gesture();
    document.apply(Edit::of("Move ball", &name("ball"), ball(2.0)).during(Some(7)));
    assert_eq!(document.undo_label(), Some("Move ball"));
    document.undo();
    assert!(document.text().expect("a text").contains("Translate((49, 0, 0))"));
    document.undo();
    assert!(!document.text().expect("a text").contains("Translate"));
    document.undo();
    assert_eq!((document.undo_label(), document.redo_label()), (None, Some("Add ball")));
}

#[test]
fn an_edit_that_changes_nothing_is_no_step() {
    let mut document = empty();
    document.apply(Edit::of("Add ball", &name("ball"), ball(1.0)));
    document.apply(Edit::of("Nothing", &name("ball"), ball(1.0)));
    assert_eq!(document.undo_label(), Some("Add ball"));
}

#[test]
fn a_renamed_thing_keeps_its_place_and_those_who_refer_to_it() {
    let mut document = empty();
    let object = Thing {
        made_of: Some(name("red")),
        parent: Some(name("red")),
        ..Thing::default().with(Sphere { radius: 1.0 })
    };
    document.apply(Edit::new("Add").put(&name("red"), Thing::default().with(Color(Rgb::X))).put(&name("z"), object));
    let before = document.text().expect("a text");
    document.apply(Edit { renames: vec![(name("red"), name("rouge"))], ..Edit::new("Rename") });
    let after = document.text().expect("a text");
    assert_eq!(after, before.replace("\"red\"", "\"rouge\""));
    document.undo();
    assert_eq!(document.text(), Ok(before));
}

#[test]
fn names_are_made_free_and_checked() {
    let mut document = empty();
    for expected in ["ball", "ball 2", "ball 3"] {
        let free = document.free_name("ball");
        assert_eq!(free.as_str(), expected);
        document.apply(Edit::of("Add", &free, ball(1.0)));
    }
    assert_eq!(document.free_name("ball 2").as_str(), "ball 4");
    assert!(document.name_fault("ball").is_some() && document.name_fault("").is_some());
    assert!(document.name_fault("a#b").is_some() && document.name_fault("b").is_none());
}

/// A scene with a bit of everything, small enough to be drawn in an instant.
fn scene() -> Edit {
    let camera = Camera { position: DVec3::new(0.0, 1.0, 5.0), target: Some(DVec3::ZERO), ..Camera::default() };
    let red = Thing::default().with(Color(Rgb::new(0.8, 0.1, 0.1))).with(Diffuse(Rgb::ONE));
    let ball = Thing { made_of: Some(name("red")), ..Thing::default().with(Sphere { radius: 1.0 }) };
    let lamp = PointLight { position: DVec3::new(3.0, 5.0, 4.0), ..PointLight::default() };
    let settings = Settings { width: 96, height: 64, antialias: Antialias::Four, ..Settings::default() };
    let edit = Edit::new("Build").put(&name("camera"), Thing::default().with(camera));
    let edit = edit.put(&name("red"), red).put(&name("ball"), ball).put(&name("lamp"), Thing::default().with(lamp));
    Edit { settings: Some(settings), ..edit }
}

fn wait(worker: &Worker, state: u64) {
    let begun = Instant::now();
    while worker.is_busy() || worker.view().state != state {
        assert!(begun.elapsed() < Duration::from_secs(120), "the worker does not come to an end");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// The picture that the command line would make of the text.
fn rendered(text: &str) -> String {
    let mut renderer = Renderer::new();
    if let Err(faults) = renderer.load_text(text, "scene.ron") {
        panic!("{faults}\n{text}");
    }
    render(&renderer.snapshot().expect("a snapshot"), &Options::default()).picture.hash()
}

#[test]
fn after_any_edits_the_picture_is_that_of_the_saved_file() {
    let worker = Worker::new(|| {});
    let mut document = empty();
    worker.open(Renderer::new(), Scene::default(), document.state());
    document.apply(scene());
    let mut state = 5;
    for _ in 0..12 {
        for _ in 0..random(&mut state) % 4 {
            match random(&mut state) % 4 {
                0 => document.undo(),
                1 => document.redo(),
                _ => {
                    let edit = any_edit(&document, &mut state);
                    let touches_camera = edit.things.contains_key(&name("camera")) || !edit.renames.is_empty();
                    if !touches_camera && edit.settings.is_none() {
                        document.apply(edit);
                    }
                }
            }
            let changes = document.take_changes();
            worker.change(changes, document.state());
        }
        let (changes, number) = (document.take_changes(), document.state());
        worker.change(changes, number);
        wait(&worker, number);
        let view = worker.view();
        if view.error.is_some() {
            continue;
        }
        assert_eq!(view.phase, Phase::Done);
        let frame = view.frame.clone().expect("a frame");
        assert_eq!(frame.picture.hash(), rendered(&document.text().expect("a text")));
        // What the screen shows is what a PNG file holds.
        assert_eq!(view.screen.pixels, snell::systems::image::srgb8(&frame.picture));
    }
}

#[test]
fn a_picture_that_is_stopped_keeps_what_was_drawn_and_can_be_begun_again() {
    let worker = Worker::new(|| {});
    worker.set_how(How { threads: Some(1), live: false, region: None });
    let mut document = empty();
    worker.open(Renderer::new(), Scene::default(), 0);
    document.apply(scene());
    document.apply(Edit {
        settings: Some(Settings { width: 1600, height: 1200, antialias: Antialias::Four, ..Settings::default() }),
        ..Edit::new("Large")
    });
    worker.change(document.take_changes(), document.state());
    wait(&worker, document.state());
    assert!(worker.view().frame.is_none(), "nothing is drawn unasked");
    worker.start();
    while worker.view().done == 0 {
        std::thread::yield_now();
    }
    worker.stop();
    wait(&worker, document.state());
    {
        let view = worker.view();
        let frame = view.frame.clone().expect("the partial picture");
        assert_eq!(view.phase, Phase::Stopped);
        assert!(frame.done > 0 && !frame.is_complete(), "{}", frame.done);
    }
    document.apply(Edit {
        settings: Some(Settings { width: 60, height: 40, ..Settings::default() }),
        ..Edit::new("Small")
    });
    worker.change(document.take_changes(), document.state());
    worker.start();
    wait(&worker, document.state());
    assert_eq!(worker.view().phase, Phase::Done);
    assert!(worker.view().frame.clone().is_some_and(|frame| frame.is_complete() && frame.picture.width == 60));
}

#[test]
fn a_scene_without_a_camera_is_told_and_the_last_picture_stays() {
    let worker = Worker::new(|| {});
    let mut document = empty();
    worker.open(Renderer::new(), Scene::default(), 0);
    document.apply(scene());
    worker.change(document.take_changes(), document.state());
    wait(&worker, document.state());
    document.apply(Edit::new("Delete camera").take(&name("camera")));
    worker.change(document.take_changes(), document.state());
    wait(&worker, document.state());
    let view = worker.view();
    assert!(view.error.as_ref().is_some_and(|error| error.contains("camera")), "{:?}", view.error);
    assert_eq!(view.screen.pixels.len(), 96 * 64);
}

/// Edits without end, as the process that is killed does them; each is told once it is asked for.
fn edit_without_end(place: &Path) {
    let autosave = Autosave::new(registry());
    let mut document = empty();
    for number in 1.. {
        document.apply(Edit::of("Grow", &name("ball"), ball(f64::from(number))));
        autosave.keep(place.into(), document.scene());
        autosave.flush();
        fs::write(place.with_extension("count"), number.to_string()).expect("written");
    }
}

#[test]
fn killed_at_any_moment_it_loses_the_last_edit_at_most() {
    if let Some(place) = env::var_os("SNELL_EDITOR_TEST_CHILD") {
        return edit_without_end(Path::new(&place));
    }
    let mut kept = 0;
    for round in 0..8u64 {
        let folder = tempfile::tempdir().expect("a folder");
        let place = autosave::place(None, folder.path());
        let mut child = Command::new(env::current_exe().expect("this test"))
            .args(["--exact", "killed_at_any_moment_it_loses_the_last_edit_at_most"])
            .env("SNELL_EDITOR_TEST_CHILD", &place)
            .stdout(std::process::Stdio::null())
            .spawn()
            .expect("a child");
        let begun = Instant::now();
        while !place.with_extension("count").exists() {
            assert!(begun.elapsed() < Duration::from_secs(60), "the child does nothing");
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(Duration::from_millis(7 * round));
        child.kill().expect("killed");
        child.wait().expect("ended");
        // The count may have been cut short while it was written; the scene must not be.
        let told: u32 =
            fs::read_to_string(place.with_extension("count")).ok().and_then(|text| text.parse().ok()).unwrap_or(0);
        let mut renderer = Renderer::new();
        renderer.load(&place).expect("a whole scene");
        let scene = Scene::of(&renderer.world);
        let text = scene.to_text(&registry()).expect("a text");
        let radius: u32 =
            text.split("Sphere(").nth(1).and_then(|rest| rest.split(')').next()?.parse().ok()).expect("a radius");
        assert!(radius >= told && radius <= told + 1 || told == 0, "told {told}, kept {radius}");
        kept += radius;
    }
    assert!(kept > 8, "hardly anything was edited");
}
