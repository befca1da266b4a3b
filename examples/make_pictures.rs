//! Makes the pictures of the documents from the scenes of the gallery.
//!
//! `cargo run --release --example make_pictures [FOLDER]` writes them below `docs`, or below FOLDER.

use snell::{
    Options, Picture,
    prelude::*,
    systems::image::{self, Format, Metadata},
};
use std::{error::Error, fs, path::Path};

/// Pictures in a row of the sheet, and the size of each.
const COLUMNS: u32 = 5;
const CELL: (u32, u32) = (252, 180);
/// Between pictures, and around them.
const GAP: u32 = 4;

/// Opacities of the ball in the strip, from left to right.
pub(crate) const OPACITIES: [f64; 6] = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "docs".into());
    let folder = Path::new(&folder);
    fs::create_dir_all(folder)?;
    write(&folder.join("gallery.png"), &sheet(Path::new("scenes/gallery"))?)?;
    write(&folder.join("transparency.png"), &strip(Path::new("scenes/gallery/transparency.ron"))?)
}

fn write(path: &Path, picture: &Picture) -> Result<(), Box<dyn Error>> {
    Ok(image::write(path, Format::Png8, picture, &Metadata::default())?)
}

/// Every scene of a folder, in the order of names, row by row.
fn sheet(folder: &Path) -> Result<Picture, Box<dyn Error>> {
    let mut scenes: Vec<_> =
        fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path())).collect::<Result<_, _>>()?;
    scenes.retain(|path| path.extension().is_some_and(|extension| extension == "ron"));
    scenes.sort();
    let rows = (scenes.len() as u32).div_ceil(COLUMNS);
    let mut sheet = Picture::black(GAP + COLUMNS * (CELL.0 + GAP), GAP + rows * (CELL.1 + GAP));
    for (n, scene) in (0..).zip(&scenes) {
        let mut renderer = Renderer::new();
        renderer.load(scene)?;
        let settings = renderer.settings();
        // As large as fits the cell.
        let (width, height) = (f64::from(settings.width), f64::from(settings.height));
        let scale = (f64::from(CELL.0) / width).min(f64::from(CELL.1) / height);
        let picture = draw(renderer, [width, height].map(|side| (side * scale).round() as u32))?;
        let left = GAP + n % COLUMNS * (CELL.0 + GAP) + (CELL.0 - picture.width) / 2;
        let top = GAP + n / COLUMNS * (CELL.1 + GAP) + (CELL.1 - picture.height) / 2;
        sheet.paste(&picture, left, top);
    }
    Ok(sheet)
}

/// The scene with the ball at each of [`OPACITIES`], side by side.
fn strip(scene: &Path) -> Result<Picture, Box<dyn Error>> {
    let (width, height) = (216, 180);
    let mut strip = Picture::black(OPACITIES.len() as u32 * (width + GAP) - GAP, height);
    for (n, alpha) in (0..).zip(OPACITIES) {
        let mut renderer = Renderer::new();
        renderer.load(scene)?;
        let world = &mut renderer.world;
        world.query::<&mut Opacity>().iter_mut(world).for_each(|mut opacity| opacity.alpha = alpha);
        strip.paste(&draw(renderer, [width, height])?, n * (width + GAP), 0);
    }
    Ok(strip)
}

/// A picture of that size, four rays to a pixel at least.
fn draw(mut renderer: Renderer, [width, height]: [u32; 2]) -> Result<Picture, Box<dyn Error>> {
    let mut settings = renderer.settings();
    (settings.width, settings.height) = (width, height);
    if settings.antialias == Antialias::Off {
        settings.antialias = Antialias::Four;
    }
    let snapshot = renderer.snapshot()?;
    Ok(render(&snapshot, &Options::default()).picture)
}
