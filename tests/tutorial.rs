//! `docs/extending.md` shows the very code of the outside crate.

#[test]
fn the_tutorial_shows_the_code_of_the_outside_crate() {
    let tutorial = include_str!("../docs/extending.md");
    let files = [
        include_str!("outside/src/torus.rs"),
        include_str!("outside/src/beam.rs"),
        include_str!("outside/src/stripes.rs"),
    ];
    for file in files {
        let (heading, code) = file.split_once("\n\n").expect("a heading and code");
        assert!(tutorial.contains(code), "{heading} is not in docs/extending.md as it is");
    }
    let lines = files[0].lines().count();
    assert!(lines < 80, "a shape takes less than 80 lines, not {lines}");
}
