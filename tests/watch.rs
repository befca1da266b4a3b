//! `snell render --watch` as a user runs it.

mod support {
    pub(crate) mod desk;
}

use snell::systems::image::{self, Metadata, key};
use std::{
    process::Stdio,
    thread,
    time::{Duration, Instant},
};
use support::desk::{BALL, Desk};

/// Waits for the picture to hold something; long, for machines that are busy.
fn wait_for(desk: &Desk, what: &str, holds: impl Fn(&Metadata) -> bool) -> String {
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(120) {
        if let Ok((_, told)) = image::read(&desk.path("ball.png"))
            && holds(&told)
        {
            return told.get(key::HASH).unwrap_or_default().into();
        }
        thread::sleep(Duration::from_millis(50));
    }
    panic!("{what} is not drawn");
}

#[test]
fn changes_of_the_scene_and_of_what_it_uses_are_drawn_and_faults_waited_out() {
    let desk = Desk::new();
    let including = BALL.replace("version: 1,", "version: 1, include: [\"part.ron\"],");
    let part = |radius: &str| {
        format!(
            "Scene(version: 1, entities: {{\"small\": [Sphere(radius: {radius}), Transform([Translate((1, 1, 1))])]}})"
        )
    };
    desk.put("part.ron", &part("0.2"));
    desk.put("ball.ron", &including);
    let mut child = desk
        .command("render ball.ron --watch -q")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("started");
    let first = wait_for(&desk, "the scene", |_| true);
    let other = |hash: String| move |told: &Metadata| told.get(key::HASH).is_some_and(|now| now != hash);

    desk.put("part.ron", &part("0.4"));
    let second = wait_for(&desk, "a change of an included file", other(first));
    desk.put("ball.ron", "Scene(version: 1, entities: {");
    thread::sleep(Duration::from_millis(600));
    assert!(child.try_wait().expect("asked").is_none(), "a fault ends it");
    desk.put("ball.ron", &including.replace("0.8, 0.2, 0.1", "0.1, 0.2, 0.8"));
    let last = wait_for(&desk, "the scene after a fault", other(second));
    child.kill().expect("ended");
    let _ = child.wait();
    let (code, out, _) = desk.run("hash ball.ron --quiet");
    assert_eq!(
        (code, out.split_whitespace().next()),
        (0, Some(last.as_str())),
        "what was drawn last is the scene as it is"
    );
}
