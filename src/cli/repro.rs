//! `snell repro`.

use super::{
    Console, Failure,
    args::{Changes, Drawing, MethodArguments},
    diff::write,
    draw::{draw, of_scene},
};
use crate::{Picture, Region, Renderer};
use clap::Args;
use snell_components::{color::Encoding, method::Methods, settings::Settings};
use snell_systems::{
    compare::{self, Comparison},
    image::{self, Format, Metadata, key},
};
use std::path::{Path, PathBuf};

/// Draw a picture again from what its file tells, and compare
///
/// A picture of snell holds its scene, its settings, its methods and the hash of its linear light. Ends with 0 if the scene gives the
/// same picture to the last bit, with 1 if it gives another, and with 2 if the file does not tell enough.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  snell repro picture.png
  snell repro picture.png --scene moved/scene.ron
  snell repro picture.png -o diff.png                where the new picture differs")]
pub(super) struct ReproArguments {
    /// Picture file that snell made, .png or .exr
    pub(super) picture: PathBuf,

    /// Scene file, if it is not where the picture says
    #[arg(long, value_name = "FILE")]
    pub(super) scene: Option<PathBuf>,

    /// Write a picture of the difference, if there is one
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,

    /// Threads [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1024))]
    pub(super) threads: Option<u32>,

    /// Show no progress
    #[arg(short, long)]
    pub(super) quiet: bool,
}

/// Draws a picture again and compares.
pub(super) fn repro(renderer: &mut Renderer, args: &ReproArguments, console: &mut Console<'_>) -> Result<(), Failure> {
    let file = &args.picture;
    let (picture, told) = image::read(file).map_err(|why| Failure::Usage(why.to_string()))?;
    let Told { scene, settings, methods, region, hash } = Told::by(file, &told).map_err(Failure::Usage)?;
    let scene = args.scene.clone().unwrap_or(scene);
    if !scene.exists() {
        let message = format!("{}: the scene is not at `{}`: name it with --scene", file.display(), scene.display());
        return Err(Failure::Usage(message));
    }
    let changes = Changes { settings: Some(settings), ..Changes::default() };
    let methods = MethodArguments::from(methods);
    let how = Drawing { scene, changes, time: None, region, threads: args.threads, methods, quiet: args.quiet };
    let drawn = draw(renderer, &how, console)?;
    if !drawn.frame.is_complete() {
        return Err(Failure::Stopped(format!("stopped after {} % of the picture", drawn.percent())));
    }
    let same_light = drawn.frame.picture.hash() == hash;
    let encoding = told.encoding();
    let again = image::as_read(&drawn.frame.picture, format(file, &picture, encoding)?, encoding);
    let from = how.scene.display();
    if same_light && again == picture {
        console.say(of_scene(file, format!("drawn again from {from}: the same to the last bit")));
        return Ok(());
    }
    let what = match (same_light, again == picture) {
        (true, _) => "the scene gives the linear light that it tells, but its pixels were changed",
        (false, true) => "the scene gives linear light that differs by less than the file shows",
        (false, false) => "the scene gives another picture",
    };
    console.say(of_scene(file, format!("drawn again from {from}: {what}")));
    if let Some(software) = told.get(key::SOFTWARE).filter(|software| *software != Metadata::SOFTWARE) {
        console.say(format!("made by {software}, drawn again by {}", Metadata::SOFTWARE));
    }
    console.say(Comparison::between(&picture, &again));
    if let Some(output) = &args.output {
        write(output, &compare::shown(&picture, &again)).map_err(|why| Failure::Work(why.to_string()))?;
    }
    Err(Failure::Different)
}

/// What a picture's file tells of how it was made.
struct Told {
    scene: PathBuf,
    settings: Settings,
    methods: Methods,
    region: Option<Region>,
    hash: String,
}

impl Told {
    fn by(file: &Path, metadata: &Metadata) -> Result<Self, String> {
        let fault = |why: &str| of_scene(file, why);
        let told = |key: &str| {
            let missing = || fault(&format!("was not made by snell: it holds no `{key}`"));
            metadata.get(key).map(ToOwned::to_owned).ok_or_else(missing)
        };
        if let Some(drawn) = metadata.get(key::DRAWN) {
            return Err(fault(&format!("is a part of a picture: {drawn} pixels were drawn")));
        }
        let region = metadata.get(key::REGION).map(|text| {
            let numbers: Vec<u32> = text.split(',').filter_map(|number| number.parse().ok()).collect();
            match numbers.as_slice() {
                &[x, y, width, height] => Ok(Region { x, y, width, height }),
                _ => Err(fault("holds no sound region")),
            }
        });
        let methods = metadata.get(key::METHODS).map_or(Ok(Methods::default()), str::parse);
        let methods = methods.map_err(|why| fault(&format!("holds methods that are not known: {why}")))?;
        let text = told(key::SETTINGS)?;
        let mut reader = Renderer::new();
        let scene = format!("Scene(version: 1, settings: {text})");
        reader
            .load_text(&scene, key::SETTINGS)
            .map_err(|faults| fault(&format!("holds settings that are not known: {faults}")))?;
        let settings = reader.settings().clone();
        let (scene, region) = (told(key::SCENE)?.into(), region.transpose()?);
        Ok(Self { scene, settings, methods, region, hash: told(key::HASH)? })
    }
}

/// The kind of a file; PNG files of 16 bits show it by the levels of the picture that was read.
fn format(file: &Path, read: &Picture, encoding: Encoding) -> Result<Format, Failure> {
    match Format::of(file).map_err(|why| Failure::Usage(why.to_string()))? {
        Format::Png8 if image::as_read(read, Format::Png8, encoding) != *read => Ok(Format::Png16),
        format => Ok(format),
    }
}
