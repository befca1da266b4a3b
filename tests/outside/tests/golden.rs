//! The pictures of this crate's scenes are those that were looked at.

use snell::{assert_golden, assert_no_dead_golden};

#[test]
fn a_ring_in_a_beam_on_stripes() {
    let mut renderer = outside::renderer();
    renderer.load("scenes/beam.ron").expect("a sound scene");
    assert_golden!(renderer, "ring-in-a-beam", scene("scenes/beam.ron"), program("cargo run --"));
}

#[test]
fn a_ring_and_a_ball() {
    let mut renderer = outside::renderer();
    renderer.load("scenes/torus.ron").expect("a sound scene");
    assert_golden!(renderer, "ring-and-ball", scene("scenes/torus.ron"), program("cargo run --"));
}

#[test]
fn no_picture_is_left_without_its_test() {
    assert_no_dead_golden!();
}
