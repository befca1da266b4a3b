//! How do I test what a scene shows, without a window? `cargo run --example headless_test`
//!
//! A pixel is a number: compare it with the formula. A whole picture has a hash; `snell::assert_golden!` keeps one that
//! was looked at.

use snell::{prelude::*, why};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut renderer = Renderer::new();
    let scene = r#"(version: 1, settings: (width: 9, height: 9), entities: {
        "camera": [Camera(position: (0, 0, 5))],
        "sun": [DirectionalLight(direction: (0, 0, -1), intensity: 0.5)],
        "ball": [Sphere(radius: 1), Color((0.8, 0.4, 0.2)), Diffuse(1)],
    })"#;
    renderer.load_text(scene, "headless_test.rs")?;
    let snapshot = renderer.snapshot()?;
    let picture = render(&snapshot, &Options::default()).picture;

    // Where the light falls straight on the ball Lambert's law gives colour times intensity.
    let middle = picture.pixel(4, 4).ok_or("nine by nine pixels")?;
    for (found, expected) in middle.into_iter().zip([0.4, 0.2, 0.1]) {
        assert!((found - expected).abs() < 1e-6, "{middle:?}");
    }
    // The tree of rays of the pixel adds up to it.
    assert_eq!(why(&snapshot, 4, 4).sum().as_vec3().to_array(), middle);
    // The same picture, to the last bit, with one thread and without the trees.
    let plain = Options { threads: Some(1), methods: Methods::BRUTE_FORCE, ..Options::default() };
    assert_eq!(render(&snapshot, &plain).picture.hash(), picture.hash());
    println!("{}", picture.hash());
    Ok(())
}
