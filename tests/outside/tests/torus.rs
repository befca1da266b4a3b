//! What a primitive from outside gets without a line of its own.

use outside::Torus;
use snell::{Faults, Picture, prelude::*};

const SCENE: &str = include_str!("../scenes/torus.ron");

fn draw(text: &str, methods: Methods) -> Result<Picture, Faults> {
    let mut renderer = Renderer::new().with_primitive::<Torus>();
    renderer.load_text(text, "torus.ron")?;
    let snapshot = renderer.snapshot().expect("a scene that can be drawn");
    let frame = render(&snapshot, &Options { methods, ..Options::default() });
    assert_eq!(frame.counts.not_finite, 0);
    Ok(frame.picture)
}

fn brightness(picture: &Picture, x: u32, y: u32) -> f32 {
    picture.pixel(x, y).expect("a pixel").iter().sum()
}

#[test]
fn it_is_drawn_from_a_scene_file_and_casts_a_shadow() {
    let with = draw(SCENE, Methods::default()).expect("a sound scene");
    let without = draw(&SCENE.replace("Torus(major: 1, minor: 0.35),", "Sphere(radius: 0.001),"), Methods::default())
        .expect("a sound scene");
    // The ring is orange where it is seen; red is the brightest channel.
    let [red, green, blue] = with.pixel(25, 40).expect("a pixel");
    assert!(red > 1.5 * green && green > 2.0 * blue, "{red} {green} {blue}");
    // The ground to the left of the ring lies in its shadow.
    let darker = |x, y| brightness(&with, x, y) < 0.5 * brightness(&without, x, y);
    assert!((0..96).any(|x| (0..72).any(|y| darker(x, y))));
}

#[test]
fn the_tree_and_brute_force_draw_the_same_bits() {
    let [tree, brute] = [Methods::default(), Methods::BRUTE_FORCE].map(|with| draw(SCENE, with).expect("sound"));
    assert_eq!(tree.hash(), brute.hash());
}

#[test]
fn its_fields_are_checked_like_those_of_the_built_in_shapes() {
    let faults =
        |from: &str, to: &str| draw(&SCENE.replace(from, to), Methods::default()).expect_err("a fault").to_string();
    let misspelt = faults("minor: 0.35", "minr: 0.35");
    assert!(misspelt.contains("torus.ron:8:29") && misspelt.contains("did you mean `minor`"), "{misspelt}");

    let negative = faults("minor: 0.35", "minor: -0.35");
    assert!(negative.contains("from 0.000000001"), "{negative}");
    let added = faults("minor: 0.35", "minor: 0.35, colour: 3");
    assert!(added.contains("torus.ron:8:42") && added.contains("`colour`"), "{added}");
    let tag = faults("Torus(", "Tours(");
    assert!(tag.contains("did you mean `Torus`"), "{tag}");
}

#[test]
fn no_ray_aimed_at_its_surface_from_inside_gets_out() {
    let (_, packed) =
        Torus { major: 1.0, minor: 0.35 }.pack(&DAffine3::from_scale(DVec3::new(2.0, 1.0, 0.5))).expect("a torus");
    for i in 0..20_000 {
        let turn = f64::from(i) * 2.399_963;
        let height = f64::from(i % 199) / 99.0 - 1.0;
        let ray = Ray { origin: DVec3::new(2.0, 0.0, 0.0), direction: DVec3::new(turn.cos(), height, turn.sin()) };
        assert!(Torus::hit(&packed, &ray, f64::INFINITY, &mut Cost::default()).is_some(), "{ray:?}");
    }
}
