//! The light and the patterns from outside, against their formulas, through the whole of Snell.

use snell::{Snapshot, prelude::*};
use std::sync::Arc;

/// A ground seen from above by a camera that looks straight down, one unit to a pixel about its middle.
fn ground(components: &str, lights: &str) -> Arc<Snapshot> {
    let scene = format!(
        "(version: 1, settings: (width: 41, height: 41), entities: {{
            \"camera\": [Camera(position: (0, 1000, 0), direction: (0, -1, 0), up: (0, 0, -1), screen_distance: 24.390243902439025)],
            {lights}
            \"ground\": [Plane(), {components}],
        }})"
    );
    let mut renderer = outside::renderer();
    renderer.load_text(&scene, "ground.ron").expect("sound");
    renderer.snapshot().expect("a scene")
}

/// Every pixel's point of the ground and its light.
fn pixels(snapshot: &Snapshot) -> Vec<(DVec3, Rgb)> {
    let picture = render(snapshot, &Options::default()).picture;
    let pixel = |n: u32| {
        let (x, y) = (n % 41, n / 41);
        let ray = snapshot.view.ray(f64::from(x) + 0.5, f64::from(y) + 0.5, 41, 41);
        let light = picture.pixel(x, y).expect("a pixel").map(f64::from);
        (ray.at(-ray.origin.y / ray.direction.y), Rgb::from_array(light))
    };
    (0..41 * 41).map(pixel).collect()
}

#[test]
fn the_beam_lights_what_lies_in_its_cylinder_and_nothing_else() {
    let beam = "\"beam\": [Beam(position: (3, 20, 0), direction: (1, -2, 0), radius: 8, intensity: 0.6)],";
    let way = DVec3::new(1.0, -2.0, 0.0).normalize();
    let mut counts = [0, 0];
    for (point, light) in pixels(&ground("Diffuse(1)", beam)) {
        let off = (point - DVec3::new(3.0, 20.0, 0.0)).cross(way).length();
        if (off - 8.0).abs() < 1e-6 {
            continue;
        }
        let expected = if off < 8.0 { -0.6 * way.y } else { 0.0 };
        assert!((light - expected).abs().max_element() < 1e-6, "{point}: {light}, expected {expected}");
        counts[usize::from(off < 8.0)] += 1;
    }
    assert!(counts.iter().all(|count| *count > 200), "{counts:?}");
}

#[test]
fn what_stands_in_the_beam_casts_a_shadow() {
    // Above the camera, which sees the ground alone.
    let beam = "\"beam\": [Beam(position: (0, 2000, 0), direction: (0, -1, 0), radius: 15)],
        \"ring\": [Torus(major: 6, minor: 2), Transform([Translate((0, 1500, 0))])],";
    let mut dark = 0;
    for (point, light) in pixels(&ground("Diffuse(1)", beam)) {
        let from_axis = DVec2::new(point.x, point.z).length();
        let gaps = [4.0, 8.0, 15.0].map(|edge: f64| (from_axis - edge).abs());
        if gaps.iter().any(|gap| *gap < 1e-6) {
            continue;
        }
        let lit = from_axis < 15.0 && !(4.0..8.0).contains(&from_axis);
        assert!((light.x - f64::from(u8::from(lit))).abs() < 1e-6, "{point}: {light}");
        dark += u32::from((4.0..8.0).contains(&from_axis));
    }
    assert!(dark > 100, "{dark}");
}

const SKY: &str = "\"sky\": [AmbientLight(1)],";

#[test]
fn stripes_take_turns_along_u() {
    let stripes = "Stripes(a: (1, 0.5, 0.25), b: 0.125, width: 2.5), Ambient(1)";
    let mut counts = [0, 0];
    for (point, light) in pixels(&ground(stripes, SKY)) {
        // The u of a plane is its x.
        let stripe = point.x / 2.5;
        if (stripe - stripe.round()).abs() < 1e-6 {
            continue;
        }
        let second = stripe.floor().rem_euclid(2.0) == 1.0;
        assert_eq!(light, if second { Rgb::splat(0.125) } else { Rgb::new(1.0, 0.5, 0.25) }, "{point}");
        counts[usize::from(second)] += 1;
    }
    assert!(counts.iter().all(|count| *count > 500), "{counts:?}");
}

#[test]
fn grains_are_smooth_and_between_their_colours() {
    let mut all = vec![];
    for (point, light) in pixels(&ground("Grain(a: 0.25, b: 0.75, size: 9), Ambient(1)", SKY)) {
        assert!((0.25..=0.75).contains(&light.x), "{point}: {light}");
        all.push(light.x);
    }
    // The slope of the noise is at most 1.5 times the difference of two values, for each of three ways.
    for row in all.chunks(41) {
        let steepest = row.windows(2).map(|pair| (pair[0] - pair[1]).abs()).fold(0.0, f64::max);
        assert!(steepest < 0.5 * 1.5 * 2.0 / 9.0, "{steepest}");
    }
    let (least, most) = all.iter().fold((1.0_f64, 0.0_f64), |(least, most), x| (least.min(*x), most.max(*x)));
    assert!(most - least > 0.2, "{least} {most}");
}
