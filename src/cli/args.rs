//! What may be written on the command line.

use crate::Region;
use clap::{
    Args, Parser, Subcommand,
    builder::{PossibleValuesParser, TypedValueParser},
};
use snell_components::settings::{ANTIALIAS, MAX_SIZE};
use std::path::PathBuf;

/// A Whitted ray tracer whose pictures are the same to the last bit on every machine.
#[derive(Parser, Debug)]
#[command(name = "snell", version, after_help = "`snell COMMAND --help` shows the options of a command.")]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Command,
}

#[derive(Subcommand, Debug)]
pub(super) enum Command {
    Render(RenderArguments),
    Hash(HashArguments),
    Check(CheckArguments),
}

/// Render a scene to a PNG or OpenEXR file
///
/// Ctrl-C stops the render and keeps what was drawn.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  snell render scene.ron                              draws scene.png
  snell render scene.ron -o out.exr                   linear light, 32-bit floats
  snell render scene.ron --size 320x240               a quick look
  snell render scene.ron --region 100,80,64,64        these pixels only
  snell render scene.ron --stats stats.json --quiet   for programs")]
pub(super) struct RenderArguments {
    /// Picture file, .png or .exr [default: the scene's name with .png, in this folder]
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,

    #[command(flatten)]
    pub(super) drawing: Drawing,

    /// Bits of a channel of a PNG file [default: 8]
    #[arg(long, value_name = "8|16", value_parser = bits)]
    pub(super) bits: Option<Bits>,

    /// Write what the render did to a JSON file
    #[arg(long, value_name = "FILE")]
    pub(super) stats: Option<PathBuf>,
}

/// Print the SHA-256 of a scene's picture in linear light
///
/// Equal hashes mean pictures that are equal to the last bit.
#[derive(Args, Debug)]
#[command(after_help = "\
Example:
  snell hash scene.ron --threads 1")]
pub(super) struct HashArguments {
    #[command(flatten)]
    pub(super) drawing: Drawing,
}

/// Check scenes without rendering them
///
/// Tells all faults of all files.
#[derive(Args, Debug)]
#[command(after_help = "\
Example:
  snell check scenes/*.ron")]
pub(super) struct CheckArguments {
    /// Scene files
    #[arg(required = true, value_name = "SCENE")]
    pub(super) scenes: Vec<PathBuf>,
}

/// How a scene is drawn.
#[derive(Args, Debug)]
pub(super) struct Drawing {
    /// Scene file
    pub(super) scene: PathBuf,

    /// Width and height in pixels, in place of the scene's
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(super) size: Option<Size>,

    /// How many times a ray may be mirrored or let through, in place of the scene's
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..=100_000))]
    pub(super) depth: Option<u32>,

    /// Rays in a pixel, in place of the scene's
    #[arg(long, value_name = "WAY", ignore_case = true, value_parser = antialias())]
    pub(super) antialias: Option<usize>,

    /// Draw a part of the picture; the file is a crop of the whole, with the size of the part
    #[arg(long, value_name = "X,Y,W,H", value_parser = region)]
    pub(super) region: Option<Region>,

    /// Threads [default: one for each core]; the picture is the same for any number
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub(super) threads: Option<u32>,

    /// Show neither progress nor summary
    #[arg(short, long)]
    pub(super) quiet: bool,
}

/// Width and height, each 1 to [`MAX_SIZE`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Size {
    pub(super) width: u32,
    pub(super) height: u32,
}

fn size(text: &str) -> Result<Size, String> {
    let parsed = text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.trim().parse().ok()?, h.trim().parse().ok()?)));
    match parsed {
        Some((width, height)) if (1..=MAX_SIZE).contains(&width) && (1..=MAX_SIZE).contains(&height) => {
            Ok(Size { width, height })
        }
        Some(_) => Err(format!("width and height are 1 to {MAX_SIZE} pixels")),
        None => Err("expected width and height in pixels, such as 800x600".into()),
    }
}

fn region(text: &str) -> Result<Region, String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some([_, _, 0, _] | [_, _, _, 0]) => Err("a region has at least one pixel".into()),
        Some(&[x, y, width, height]) => Ok(Region { x, y, width, height }),
        _ => Err("expected left column, top row, width and height in pixels, such as 100,80,64,64".into()),
    }
}

/// Bits of a channel of a PNG file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bits {
    Eight,
    Sixteen,
}

fn bits(text: &str) -> Result<Bits, String> {
    match text {
        "8" => Ok(Bits::Eight),
        "16" => Ok(Bits::Sixteen),
        _ => Err("expected 8 or 16".into()),
    }
}

/// Parses a word of [`ANTIALIAS`] to its position.
fn antialias() -> impl TypedValueParser<Value = usize> {
    PossibleValuesParser::new(ANTIALIAS).try_map(|word| {
        ANTIALIAS.iter().position(|known| known.eq_ignore_ascii_case(&word)).ok_or("expected one of the words above")
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_description_of_arguments_is_sound() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn sizes_and_regions_are_read_or_refused() {
        assert_eq!(size("64x48"), Ok(Size { width: 64, height: 48 }));
        for wrong in ["64", "64x", "0x48", "64x70000", "-1x3", "64x48x2", "99999999999x1"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
        assert_eq!(region("1,2,3,4"), Ok(Region { x: 1, y: 2, width: 3, height: 4 }));
        for wrong in ["1,2,3", "1,2,3,0", "1,2,0,4", "1,2,3,4,5", "-1,2,3,4", ""] {
            assert!(region(wrong).is_err(), "{wrong}");
        }
    }
}
