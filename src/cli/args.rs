//! What may be written on the command line.

use super::{diff::DiffArguments, edit::EditArguments, fmt::FmtArguments, repro::ReproArguments};
use crate::Region;
use clap::{
    Args, Parser, Subcommand,
    builder::{PossibleValuesParser, TypedValueParser},
};
use snell_charts::study::{ALL as STUDIES, Kind, Study};
use snell_components::{
    describe::Choice,
    method::{Accelerator, Methods, Precision, SphereTest, TriangleTest},
    settings::{Antialias, MAX_GRID, MAX_SIZE, MAX_SUBDIVISIONS, Settings},
};
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
    Edit(EditArguments),
    Hash(HashArguments),
    Check(CheckArguments),
    Why(WhyArguments),
    Diff(DiffArguments),
    Repro(ReproArguments),
    Fmt(FmtArguments),
    Chart(ChartArguments),
    Stability(StabilityArguments),
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
  snell render scene.ron --error 1/255                as exact as eight bits show, with the fewest rays
  snell render scene.ron --time 10                    as exact as ten seconds allow
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

    /// Draw again whenever the scene or a file that it uses changes; faults are told and waited out
    #[arg(long)]
    pub(super) watch: bool,
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

/// Show how a pixel comes about: its tree of rays
///
/// Tells of every ray what it meets, what the lights do there, what it weighs and brings, and where that is written; the
/// contributions add up to the pixel to the last bit.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  snell why scene.ron 320 240                the pixel in column 320 and row 240
  snell why scene.ron 320 240 --svg why.svg  drawn as a tree
  snell why scene.ron 320 240 --json         for programs")]
pub(super) struct WhyArguments {
    /// Scene file
    pub(super) scene: PathBuf,

    /// Column, from 0 at the left
    pub(super) x: u32,

    /// Row, from 0 at the top
    pub(super) y: u32,

    #[command(flatten)]
    pub(super) changes: Changes,

    /// Print JSON, with all digits
    #[arg(long)]
    pub(super) json: bool,

    /// Draw the tree to an SVG file, too
    #[arg(long, value_name = "FILE")]
    pub(super) svg: Option<PathBuf>,
}

/// Chart speed against accuracy for scenes
///
/// Measures settings against a converged picture and draws time against error: SVG, PNG, tables as CSV and JSON, and a page
/// that puts them together. Ends with advice.
#[derive(Args, Debug)]
#[command(after_help = studies())]
pub(super) struct ChartArguments {
    /// Scene files; ready studies need none
    #[arg(value_name = "SCENE")]
    pub(super) scenes: Vec<PathBuf>,

    /// Folder for the files [default: the scene's name with -charts]
    #[arg(short, long, value_name = "DIR")]
    pub(super) output: Option<PathBuf>,

    /// What to study [default: all that the scene has something for; without a scene the ready ones]
    #[arg(long, value_name = "NAME", num_args = 1.., value_parser = PossibleValuesParser::new(STUDIES.iter().map(|study| study.name)))]
    pub(super) study: Vec<String>,

    /// Smaller pictures, fewer settings, one run
    #[arg(long)]
    pub(super) quick: bool,

    /// Width of the pictures in pixels [default: 200, quick 80]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(8..=4096))]
    pub(super) width: Option<u32>,

    /// Runs of each setting [default: 5, quick 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(super) runs: Option<u32>,
}

/// The names of the studies and what they are about.
fn studies() -> String {
    let line = |study: &Study| {
        let ready = if matches!(study.kind, Kind::Ready(_)) { " (ready)" } else { "" };
        format!("  {:<14}{}{ready}", study.name, study.about)
    };
    let studies: Vec<_> = STUDIES.iter().map(line).collect();
    format!("Studies:\n{}\n\nExample:\n  snell chart scene.ron -o charts --quick", studies.join("\n"))
}

/// Show where the usual methods fail, and that Snell does not
///
/// Runs every case against its oracle with fixed seeds and prints the table.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  snell stability --case F01 --case F50      two cases, a hundred thousand tries a cell
  snell stability --deep -o accuracy         all, ten million tries a cell; table, JSON and picture")]
pub(super) struct StabilityArguments {
    /// A hundred times as many tries
    #[arg(long)]
    pub(super) deep: bool,

    /// Folder for stability.md, .json, .svg and .png
    #[arg(short, long, value_name = "DIR")]
    pub(super) output: Option<PathBuf>,

    /// Only the case of this number, such as F04; may be given again
    #[arg(long, value_name = "ID")]
    pub(super) case: Vec<String>,
}

/// How a scene is drawn.
#[derive(Args, Debug)]
pub(super) struct Drawing {
    /// Scene file
    pub(super) scene: PathBuf,

    #[command(flatten)]
    pub(super) changes: Changes,

    /// Seconds, from the start of the command, for a picture as exact as they allow
    ///
    /// The error falls until the time is over, so the picture depends on the machine; the report tells which error was
    /// reached.
    #[arg(long, value_name = "T", value_parser = time, conflicts_with_all = ["antialias", "error"])]
    pub(super) time: Option<f64>,

    /// Draw a part of the picture; the file is a crop of the whole, with the size of the part
    #[arg(long, value_name = "X,Y,W,H", value_parser = region)]
    pub(super) region: Option<Region>,

    /// Threads [default: one for each core]; the picture is the same for any number
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub(super) threads: Option<u32>,

    #[command(flatten)]
    pub(super) methods: MethodArguments,

    /// Show neither progress nor summary
    #[arg(short, long)]
    pub(super) quiet: bool,
}

/// What takes the place of settings of the scene.
#[derive(Args, Debug, Default)]
pub(super) struct Changes {
    /// All settings.
    #[arg(skip)]
    pub(super) settings: Option<Settings>,

    /// Width and height in pixels, in place of the scene's
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(super) size: Option<Size>,

    /// How many times a ray may be mirrored or let through, in place of the scene's
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..=100_000))]
    pub(super) depth: Option<u32>,

    /// Rays in a pixel, in place of the scene's
    ///
    /// off, four, grid, grid:ACROSS, adaptive, adaptive:SUBDIVISIONS or adaptive:SUBDIVISIONS:CONTRAST
    #[arg(long, value_name = "WAY", value_parser = antialias)]
    pub(super) antialias: Option<Sampling>,

    /// Error that a pixel's channels may have, such as 1/255: rays, samples and pixels are saved where it allows
    ///
    /// In linear light, 0 to 1. Without --antialias, pixels are drawn by adaptive:6. What is proved and what is
    /// statistical stands in docs/error-budget.md.
    #[arg(long, value_name = "E", value_parser = error)]
    pub(super) error: Option<f64>,
}

/// How rays find what they meet; other than the defaults are for comparison.
#[derive(Args, Debug, Default)]
#[command(next_help_heading = "Methods, to compare")]
pub(super) struct MethodArguments {
    /// How things along a ray are found; all give the same picture [default: Tree]
    #[arg(long, value_name = "WAY", ignore_case = true, value_parser = word::<Accelerator>())]
    accelerator: Option<Accelerator>,

    /// How triangles are tested [default: Sheared]
    #[arg(long, value_name = "WAY", ignore_case = true, value_parser = word::<TriangleTest>())]
    triangle_test: Option<TriangleTest>,

    /// How spheres are tested [default: Robust]
    #[arg(long, value_name = "WAY", ignore_case = true, value_parser = word::<SphereTest>())]
    sphere_test: Option<SphereTest>,

    /// Numbers in which triangles and spheres are tested [default: F64]
    #[arg(long, value_name = "WAY", ignore_case = true, value_parser = word::<Precision>())]
    precision: Option<Precision>,
}

impl From<Methods> for MethodArguments {
    fn from(Methods { accelerator, triangle, sphere, precision }: Methods) -> Self {
        Self {
            accelerator: Some(accelerator),
            triangle_test: Some(triangle),
            sphere_test: Some(sphere),
            precision: Some(precision),
        }
    }
}

impl MethodArguments {
    pub(super) fn methods(&self) -> Methods {
        Methods {
            accelerator: self.accelerator.unwrap_or_default(),
            triangle: self.triangle_test.unwrap_or_default(),
            sphere: self.sphere_test.unwrap_or_default(),
            precision: self.precision.unwrap_or_default(),
        }
    }
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

/// How rays are placed in a pixel; numbers that are not given are the scene's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sampling {
    pub(super) antialias: Antialias,
    pub(super) grid: Option<u32>,
    pub(super) subdivisions: Option<u32>,
    pub(super) contrast: Option<f64>,
}

fn antialias(text: &str) -> Result<Sampling, String> {
    let mut parts = text.split(':').map(str::trim);
    let word = parts.next().unwrap_or_default();
    let Some(position) = Antialias::WORDS.iter().position(|known| known.eq_ignore_ascii_case(word)) else {
        return Err(format!("expected one of {}", Antialias::WORDS.join(", ").to_lowercase()));
    };
    let mut sampling = Sampling::default();
    sampling.antialias.choose(position);
    let whole = |text: &str, least: u32, most: u32, what: &str| match text.parse() {
        Ok(n) if (least..=most).contains(&n) => Ok(n),
        _ => Err(format!("{what} are {least} to {most}")),
    };
    match sampling.antialias {
        Antialias::Off | Antialias::Four => {}
        Antialias::Grid => {
            sampling.grid = parts.next().map(|text| whole(text, 1, MAX_GRID, "rays across a pixel")).transpose()?;
        }
        Antialias::Adaptive => {
            let subdivisions = |text| whole(text, 0, MAX_SUBDIVISIONS, "subdivisions");
            sampling.subdivisions = parts.next().map(subdivisions).transpose()?;
            let contrast = |text: &str| match text.parse() {
                Ok(contrast) if contrast >= 0.0 && f64::is_finite(contrast) => Ok(contrast),
                _ => Err("the contrast is a number of at least 0".to_string()),
            };
            sampling.contrast = parts.next().map(contrast).transpose()?;
        }
    }
    match parts.next() {
        None => Ok(sampling),
        Some(more) => Err(format!("nothing is known of `{more}`")),
    }
}

fn error(text: &str) -> Result<f64, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let error = match text.split_once('/') {
        Some((part, whole)) => number(part).zip(number(whole)).map(|(part, whole)| part / whole),
        None => number(text),
    };
    match error {
        Some(error) if (0.0..=1.0).contains(&error) => Ok(error),
        _ => Err("expected a number from 0 to 1, such as 0.004 or 1/255".into()),
    }
}

fn time(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(time) if (0.0..=1e6).contains(&time) => Ok(time),
        _ => Err("expected seconds, 0 to 1000000".into()),
    }
}

/// Parses a word of a choice.
fn word<C: Choice + Clone + Default + Send + Sync + 'static>() -> impl TypedValueParser<Value = C> {
    PossibleValuesParser::new(C::default().words()).map(|word| {
        let mut choice = C::default();
        let position = choice.words().iter().position(|known| known.eq_ignore_ascii_case(&word));
        choice.choose(position.unwrap_or_default());
        choice
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

    #[test]
    fn ways_of_sampling_are_read_or_refused() {
        let adaptive = Sampling { antialias: Antialias::Adaptive, ..Sampling::default() };
        let grid = Sampling { antialias: Antialias::Grid, ..Sampling::default() };
        for (text, expected) in [
            ("Off", Sampling::default()),
            ("grid", grid),
            ("GRID:8", Sampling { grid: Some(8), ..grid }),
            ("adaptive:3", Sampling { subdivisions: Some(3), ..adaptive }),
            ("adaptive:0:0.1", Sampling { subdivisions: Some(0), contrast: Some(0.1), ..adaptive }),
        ] {
            assert_eq!(antialias(text), Ok(expected), "{text}");
        }
        for wrong in
            ["", "on", "four:2", "grid:0", "grid:65", "adaptive:8", "adaptive:2:-1", "adaptive:2:inf", "grid:4:4"]
        {
            assert!(antialias(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn errors_are_numbers_or_fractions() {
        assert_eq!([error("1/255"), error("0.5"), error("0")], [Ok(1.0 / 255.0), Ok(0.5), Ok(0.0)]);
        for wrong in ["", "1/0", "2", "-0.1", "1/2/3", "nan", "x"] {
            assert!(error(wrong).is_err(), "{wrong}");
        }
    }
}
