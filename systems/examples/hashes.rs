//! The hash of every scene that is named, drawn small: `hashes scene.ron other.ron`.

use snell_systems::{
    pipeline::Renderer,
    render::{Options, render},
};
use std::{env, error::Error};

/// Most columns or rows: golden scenes are smaller, others are drawn small.
const MOST: u32 = 96;

fn main() -> Result<(), Box<dyn Error>> {
    for scene in env::args().skip(1) {
        let mut renderer = Renderer::new();
        renderer.load(&scene)?;
        let mut settings = renderer.settings();
        settings.width = settings.width.min(MOST);
        settings.height = settings.height.min(MOST);
        let picture = render(&*renderer.snapshot()?, &Options::default()).picture;
        println!("{scene} {}", picture.hash());
    }
    Ok(())
}
