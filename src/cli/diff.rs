//! `snell diff`.

use super::{Console, Failure};
use clap::Args;
use serde::Serialize;
use snell_systems::{
    compare::{self, Comparison, Level, Pixel},
    image::{self, FileError, Format, Metadata, key},
    render::Picture,
};
use std::path::{Path, PathBuf};

/// Compare two pictures
///
/// Ends with 0 if they are as like as they are asked to be, with 1 if not, and with 2 if they cannot be compared.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  snell diff a.png b.png                 to the last bit
  snell diff a.png b.png --pixels 1      no 8-bit level differs by more than 1
  snell diff a.exr b.png --flip 0.01     the same to the eye: the mean FLIP error is at most 0.01
  snell diff a.png b.png -o diff.png     where they differ, and how much")]
pub(super) struct DiffArguments {
    /// Picture file, .png or .exr: what is expected
    pub(super) a: PathBuf,

    /// Picture file, .png or .exr
    pub(super) b: PathBuf,

    /// Take pictures for alike whose 8-bit levels differ by no more than this
    #[arg(long, value_name = "LEVELS", conflicts_with = "flip")]
    pub(super) pixels: Option<u8>,

    /// Take pictures for alike whose mean FLIP error is no more than this, 0 to 1
    #[arg(long, value_name = "MEAN")]
    pub(super) flip: Option<f64>,

    /// Write a picture of the difference: blue where less than an 8-bit level differs, else yellow, a little, to red
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,

    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,

    /// Print nothing
    #[arg(short, long, conflicts_with = "json")]
    pub(super) quiet: bool,
}

/// Compares two picture files.
pub(super) fn diff(args: &DiffArguments, console: &mut Console<'_>) -> Result<(), Failure> {
    let [a, b] = [&args.a, &args.b].map(|file| image::read(file).map_err(trouble));
    let ((a, told_a), (b, told_b)) = (a?, b?);
    let level = match (args.pixels, args.flip) {
        (Some(by), _) => Level::Pixels { by, most: usize::MAX },
        (None, Some(mean)) => Level::Flip(mean),
        (None, None) => Level::Exact,
    };
    let difference = Comparison::between(&a, &b);
    // What 8 bits do not show, the hashes of what they were made of tell.
    let hidden = difference.bits == 0 && difference.sizes.is_none() && hashes_differ(&told_a, &told_b);
    let alike = difference.is_within(level) && !(hidden && level == Level::Exact);
    if let Some(file) = &args.output {
        write(file, &compare::shown(&a, &b)).map_err(trouble)?;
    }
    if args.json {
        let report = Report::new(args, &difference, hidden, alike);
        console.say(serde_json::to_string_pretty(&report).map_err(|why| Failure::Work(why.to_string()))?);
    } else if !args.quiet {
        console.say(&difference);
        if hidden {
            console.say("hashes   they were made of linear light that differs by less than the files show");
        }
        console.say(format!("{} for {level}", if alike { "alike" } else { "different" }));
    }
    if alike { Ok(()) } else { Err(Failure::Different) }
}

fn hashes_differ(a: &Metadata, b: &Metadata) -> bool {
    a.get(key::HASH).zip(b.get(key::HASH)).is_some_and(|(a, b)| a != b)
}

/// Writes a picture that tells nothing of how it was made.
pub(super) fn write(file: &Path, picture: &Picture) -> Result<(), FileError> {
    image::write(file, Format::of(file)?, picture, &Metadata::default())
}

fn trouble(why: FileError) -> Failure {
    Failure::Usage(why.to_string())
}

/// What `--json` prints.
#[derive(Serialize)]
struct Report<'a> {
    files: [&'a Path; 2],
    alike: bool,
    /// Columns and rows of both, if they differ.
    sizes: Option<[(u32, u32); 2]>,
    /// Pixels that differ in any bit.
    bits: usize,
    first: Option<Pixel>,
    /// The hashes of what they were made of differ, though the files show no difference.
    hidden: bool,
    /// Root mean square of linear light.
    rms: f64,
    /// Pixels whose 8-bit levels differ.
    pixels: usize,
    /// Largest difference of an 8-bit level.
    largest: u8,
    /// Mean FLIP error.
    flip: f64,
}

impl<'a> Report<'a> {
    fn new(args: &'a DiffArguments, difference: &Comparison, hidden: bool, alike: bool) -> Self {
        let &Comparison { sizes, bits, first, rms, pixels, largest, flip, .. } = difference;
        let files = [args.a.as_path(), &args.b];
        Self { files, alike, sizes, bits, first, hidden, rms, pixels, largest, flip }
    }
}
