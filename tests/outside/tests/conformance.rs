//! The torus keeps the contract of shapes.

use outside::{Beam, Grain, Stripes, Torus};
use snell::{
    conformance::{Form, check, check_light, check_texture},
    prelude::*,
};

#[test]
fn rings_of_all_kinds_do() {
    let rings = [(1.0, 0.35), (1.0, 0.01), (2.0, 2.0), (1e-3, 5e-4), (400.0, 150.0)];
    check(&rings.map(|(major, minor)| Torus { major, minor }), Form::Closed).assert();
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

#[test]
fn what_is_no_ring_has_no_surface_and_the_reason_is_told() {
    for (major, minor) in [(1.0, 1e-9), (1.0, 1.1), (1.0, f64::NAN), (1e9, 1e-9), (0.0, 0.0), (-1.0, -1.0)] {
        let why = Torus { major, minor }.pack(&DAffine3::IDENTITY).err();
        let expected = "its minor: expected from a millionth of `major` to `major`";
        assert!(why.is_some_and(|why| why.0 == expected) || major <= 0.0, "{major} {minor}");
    }
}

#[test]
fn the_light_and_the_patterns_do() {
    for beam in ["Beam(radius: 3)", "Beam(position: (0, 5, 0), direction: (1, -2, 0), radius: 2.5, intensity: 0.6)"] {
        check_light(&[read::<Beam>(beam)]).assert();
    }
    check_texture(&[read::<Stripes>("Stripes"), read("Stripes(a: (1, 0.5, 0.25), b: 2, width: 0.3)")]).assert();
    check_texture(&[read::<Grain>("Grain(a: 0.25, b: (1, 0, 0), size: 0.7)")]).assert();
}

/// A component as a scene file has it.
fn read<C: Component + Clone>(text: &str) -> C {
    let mut renderer = outside::renderer();
    renderer.load_text(&format!("(version: 1, entities: {{\"it\": [{text}]}})"), "it.ron").expect("sound");
    let mut all = renderer.world.query::<&C>();
    all.single(&renderer.world).expect("one").clone()
}
