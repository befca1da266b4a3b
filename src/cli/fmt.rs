//! `snell fmt`.

use super::{Console, Failure, draw::of_scene};
use clap::Args;
use snell_systems::{image, load::format_scene};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Lay out scene files in one way
///
/// Values that fit stand in one line; a bracket behind which a line ends stays open. Comments stay, and nothing but
/// space and commas is changed.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  snell fmt scenes/*.ron
  snell fmt --check scenes/*.ron    change nothing; end with 1 if something would be")]
pub(super) struct FmtArguments {
    /// Scene files
    #[arg(required = true, value_name = "SCENE")]
    pub(super) scenes: Vec<PathBuf>,

    /// Only name the files that would be changed
    #[arg(long)]
    pub(super) check: bool,
}

/// Lays out scene files; those with faults are left alone and told.
pub(super) fn fmt(args: &FmtArguments, console: &mut Console<'_>) -> Result<(), Failure> {
    let (mut faults, mut changed) = (vec![], false);
    for scene in &args.scenes {
        match fmt_one(scene, args.check) {
            Ok(false) => {}
            Ok(true) => {
                changed = true;
                console.say(of_scene(scene, if args.check { "would be changed" } else { "changed" }));
            }
            Err(more) => faults.extend(more),
        }
    }
    match (faults.is_empty(), changed && args.check) {
        (false, _) => Err(Failure::Scene(faults)),
        (true, true) => Err(Failure::Different),
        (true, false) => Ok(()),
    }
}

/// Whether the layout is another.
fn fmt_one(scene: &Path, check: bool) -> Result<bool, Vec<String>> {
    let text = fs::read_to_string(scene).map_err(|why| vec![of_scene(scene, format!("cannot be read: {why}"))])?;
    let laid_out =
        format_scene(&text, scene).map_err(|faults| faults.0.iter().map(ToString::to_string).collect::<Vec<_>>())?;
    if laid_out == text {
        return Ok(false);
    }
    if !check {
        image::write_atomically(scene, laid_out.as_bytes()).map_err(|why| vec![why.to_string()])?;
    }
    Ok(true)
}
