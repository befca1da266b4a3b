//! `snell why`.

use super::{
    Console, Failure,
    args::WhyArguments,
    draw::{apply, of_scene, warn_of_left_out},
};
use crate::{Renderer, why as tree_of};
use snell_systems::image;

/// Shows the tree of rays of a pixel.
pub(super) fn why(renderer: &mut Renderer, args: &WhyArguments, console: &mut Console<'_>) -> Result<(), Failure> {
    let scene = &args.scene;
    if let Some(file) = &args.svg {
        image::check_writable(file).map_err(|why| Failure::Work(why.to_string()))?;
    }
    let notices =
        renderer.load(scene).map_err(|faults| Failure::Scene(faults.0.iter().map(ToString::to_string).collect()))?;
    notices.iter().for_each(|notice| console.warn(notice));
    let settings = &mut *renderer.settings();
    apply(&args.changes, settings);
    let (width, height) = (settings.width, settings.height);
    if args.x >= width || args.y >= height {
        let (x, y) = (args.x, args.y);
        return Err(Failure::Usage(format!(
            "the pixel {x}, {y} lies outside the picture of {width}x{height} pixels: columns are 0 to {}, rows 0 to {}",
            width - 1,
            height - 1
        )));
    }
    let snapshot = renderer.snapshot().map_err(|why| Failure::Scene(vec![of_scene(scene, why)]))?;
    warn_of_left_out(scene, &snapshot, console);

    let mut tree = tree_of(&snapshot, args.x, args.y);
    tree.locate(&mut renderer.world);
    if let Some(file) = &args.svg {
        image::write_atomically(file, tree.svg().as_bytes()).map_err(|why| Failure::Work(why.to_string()))?;
    }
    if args.json {
        console.say(serde_json::to_string_pretty(&tree).map_err(|why| Failure::Work(why.to_string()))?);
    } else {
        console.say(&tree);
    }
    Ok(())
}
