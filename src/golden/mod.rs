//! Golden pictures: what is drawn today is what was looked at and accepted.
//!
//! ```no_run
//! use snell::{assert_golden, prelude::*};
//!
//! // #[test]
//! fn a_ball_on_the_ground() {
//!     let mut renderer = Renderer::new();
//!     renderer.load("scenes/ball.ron").unwrap();
//!     assert_golden!(renderer, "ball");
//!     // Weaker, where bits may change, and only a part.
//!     assert_golden!(renderer, "ball", pixels(1));
//!     assert_golden!(renderer, "ball-edge", flip(0.01), region(10, 10, 32, 32));
//! }
//! ```
//!
//! The picture `tests/golden/<name>.png` of the crate shows people what is expected; the hash of the linear light in it
//! catches what 8 bits do not show. A picture that is missing fails, too. What fails leaves the pictures in
//! `target/golden`, and a report of all failures in `target/golden/report.html`, which opens without a server.
//!
//! | `SNELL_BLESS` | accepts |
//! |---|---|
//! | `1` | what fails |
//! | `all` | everything |
//! | another text | names that contain it or, with a `*` in it, match it |
//!
//! Look before you bless; where `CI` is set blessing is refused.

mod bless;
mod html;
mod report;
mod source;

pub use bless::Bless;
pub use source::Source;

use crate::{
    Picture, Region,
    systems::{
        compare::{Comparison, Level},
        image::{self, Format, Metadata, key},
    },
};
use report::{Entry, First};
use std::{
    env, fs, io,
    path::{Path, PathBuf},
};

/// The most a golden file may take unless a test says otherwise: repositories keep every version for good.
pub const MOST_BYTES: u64 = 16 * 1024;

/// Compares what is drawn with the golden picture of a name.
///
/// The first argument is a [`Source`]: a `Renderer`, a snapshot or a picture. Options are the methods of [`Golden`].
///
/// # Panics
/// If the picture is not as like as it should be, with what is different and what to do.
#[macro_export]
macro_rules! assert_golden {
    ($source:expr, $name:expr $(, $option:ident($($value:expr),* $(,)?))* $(,)?) => {
        $crate::golden::Golden::new(env!("CARGO_MANIFEST_DIR"), option_env!("CARGO_TARGET_TMPDIR"), $name)
            $(.$option($($value),*))*
            .assert(&mut $source)
    };
}

/// Fails if the crate has golden pictures that no test names: see [`dead`].
///
/// # Panics
/// If there are such pictures, with their paths.
#[macro_export]
macro_rules! assert_no_dead_golden {
    () => {
        let dead = $crate::golden::dead(env!("CARGO_MANIFEST_DIR"), option_env!("CARGO_TARGET_TMPDIR"))
            .expect("the crate's tests can be read");
        assert!(dead.is_empty(), "golden pictures that no test names: {dead:?}");
    };
}

/// A golden picture and how like it a picture must be.
#[derive(Clone, Debug)]
pub struct Golden {
    name: String,
    /// The golden file.
    expected: PathBuf,
    /// Where failures leave what is to be looked at.
    reports: PathBuf,
    level: Level,
    region: Option<Region>,
    most_bytes: u64,
    /// The scene file it is of, for the command that explains a pixel.
    scene: Option<PathBuf>,
    /// How to run the tests.
    command: String,
    /// How to run the command line that knows the scene's components.
    program: String,
}

impl Golden {
    /// The golden picture of a name in a crate: what [`assert_golden!`] makes.
    #[must_use]
    pub fn new(crate_folder: &str, tests_folder: Option<&str>, name: &str) -> Self {
        let expected = Path::new(crate_folder).join("tests/golden").join(format!("{name}.png"));
        Self::at(name, &expected, &reports(crate_folder, tests_folder))
    }

    /// A golden picture in a file, with the folder for reports.
    #[must_use]
    pub fn at(name: &str, expected: &Path, reports: &Path) -> Self {
        Self {
            name: name.into(),
            expected: expected.into(),
            reports: reports.into(),
            level: Level::Exact,
            region: None,
            most_bytes: MOST_BYTES,
            scene: None,
            command: "cargo test".into(),
            program: "snell".into(),
        }
    }

    /// Takes pictures for alike whose 8-bit levels differ by no more than this.
    #[must_use]
    pub fn pixels(self, by: u8) -> Self {
        Self { level: Level::Pixels { by, most: usize::MAX }, ..self }
    }

    /// Takes pictures for alike of which at most so many pixels differ.
    #[must_use]
    pub fn at_most_pixels(self, most: usize) -> Self {
        let by = if let Level::Pixels { by, .. } = self.level { by } else { u8::MAX };
        Self { level: Level::Pixels { by, most }, ..self }
    }

    /// Takes pictures for alike whose mean FLIP error is no more than this, 0 to 1.
    #[must_use]
    pub fn flip(self, mean: f64) -> Self {
        Self { level: Level::Flip(mean), ..self }
    }

    /// Draws and compares only a part: left column, upper row, width and height.
    #[must_use]
    pub fn region(self, x: u32, y: u32, width: u32, height: u32) -> Self {
        Self { region: Some(Region { x, y, width, height }), ..self }
    }

    /// Allows the golden file more, or fewer, bytes than [`MOST_BYTES`].
    #[must_use]
    pub fn at_most_bytes(self, bytes: u64) -> Self {
        Self { most_bytes: bytes, ..self }
    }

    /// Names the scene file that is drawn, so that a failure can tell how to explain a pixel.
    #[must_use]
    pub fn scene(self, file: impl Into<PathBuf>) -> Self {
        Self { scene: Some(file.into()), ..self }
    }

    /// Names the command that runs the test, if it is not `cargo test`.
    #[must_use]
    pub fn command(self, command: &str) -> Self {
        Self { command: command.into(), ..self }
    }

    /// Names the program whose command line explains a pixel, if it is not `snell`: a crate with components of its own has
    /// one of its own, and `cargo run --` runs it.
    #[must_use]
    pub fn program(self, program: &str) -> Self {
        Self { program: program.into(), ..self }
    }

    /// Compares, and blesses if the environment says so.
    ///
    /// # Panics
    /// If the picture is not as like as it should be, with what is different and what to do.
    #[track_caller]
    pub fn assert(&self, source: &mut (impl Source + ?Sized)) {
        let bless = Bless::from_env(env::var("SNELL_BLESS").ok().as_deref(), env::var_os("CI").is_some());
        if let Err(why) = bless.and_then(|bless| self.check(source, &bless)) {
            panic!("golden picture `{}`: {why}", self.name);
        }
    }

    /// [`Golden::assert`] without a panic.
    ///
    /// # Errors
    /// What is different, where to look and what to do.
    pub fn check(&self, source: &mut (impl Source + ?Sized), bless: &Bless) -> Result<(), String> {
        let actual = source.picture(self.region)?;
        let verdict = self.compare(&actual);
        if bless.wants(&self.name, verdict.is_ok()) {
            write(&self.expected, &actual)?;
        } else if let Err(failure) = verdict {
            return Err(self.tell(source, &actual, &failure));
        }
        // What an earlier failure left would mislead.
        report::remove(&self.reports, &self.name);
        match fs::metadata(&self.expected).map_err(|why| why.to_string())?.len() {
            bytes if bytes > self.most_bytes => {
                let (file, most) = (self.expected.display(), self.most_bytes);
                Err(format!(
                    "{file} has {bytes} bytes; at most {most} are allowed: draw fewer pixels, or allow more with `at_most_bytes`"
                ))
            }
            _ => Ok(()),
        }
    }

    /// Whether a picture is as like as it should be.
    fn compare(&self, actual: &Picture) -> Result<(), Failure> {
        if !self.expected.exists() {
            return Err(Failure::Missing);
        }
        let (expected, metadata) = image::read(&self.expected).map_err(|why| Failure::Unusable(why.to_string()))?;
        let missing = || Failure::Unusable(format!("{} has no `{}`", self.expected.display(), key::HASH));
        let hash = metadata.get(key::HASH).ok_or_else(missing)?;
        // As the file would show it: what 8 bits do not show is for the hash.
        let comparison = Comparison::between(
            &expected,
            &image::as_read(actual, Format::Png8, crate::components::color::Encoding::Srgb),
        );
        let alike = match self.level {
            Level::Exact => comparison.is_within(Level::Exact) && actual.hash() == hash,
            level => comparison.is_within(level),
        };
        if alike {
            return Ok(());
        }
        Err(Failure::Different(Box::new(Different { expected, expected_hash: hash.into(), comparison })))
    }

    /// Leaves pictures and the report, and says what to do.
    fn tell(&self, source: &mut (impl Source + ?Sized), actual: &Picture, failure: &Failure) -> String {
        let what = match failure {
            Failure::Missing => "there is no golden picture".into(),
            Failure::Unusable(why) => why.clone(),
            Failure::Different(different) => different.to_string(),
        };
        let first = failure.first_shown().map(|First { x, y, .. }| {
            let corner = self.region.map_or((0, 0), |region| (region.x, region.y));
            (x + corner.0, y + corner.1)
        });
        let explain = first
            .zip(self.scene.as_ref())
            .map(|((x, y), scene)| format!("{} why {} {x} {y}", self.program, scene.display()));
        let entry = Entry {
            name: self.name.clone(),
            what: what.clone(),
            level: self.level.to_string(),
            flip: failure.flip(),
            bits: failure.bits(),
            bless: format!("SNELL_BLESS='{}' {}", self.name, self.command),
            expected: self.expected.clone(),
            first: failure.first_shown(),
            explain: explain.clone(),
            why: first.and_then(|(x, y)| source.why(x, y)),
        };
        let expected = if let Failure::Different(different) = failure { Some(&different.expected) } else { None };
        let written = match report::add(&self.reports, &entry, expected, actual) {
            Ok(report) => format!("look: {}", report.display()),
            Err(why) => format!("no report could be written: {why}"),
        };
        let explain = explain.map_or(String::new(), |command| format!("\nexplain the first pixel: {command}"));
        format!("{what}\n{written}{explain}\nif the new picture is right: {}", entry.bless)
    }
}

/// Why a picture is not the expected one.
enum Failure {
    Missing,
    Unusable(String),
    Different(Box<Different>),
}

struct Different {
    expected: Picture,
    expected_hash: String,
    comparison: Comparison,
}

impl Failure {
    /// The first pixel whose levels differ.
    fn first_shown(&self) -> Option<First> {
        let Self::Different(different) = self else { return None };
        different.comparison.first_shown.map(|pixel| First { x: pixel.x, y: pixel.y, levels: pixel.levels })
    }

    /// The mean FLIP error; 1 where nothing can be compared.
    fn flip(&self) -> f64 {
        if let Self::Different(different) = self { different.comparison.flip } else { 1.0 }
    }

    fn bits(&self) -> usize {
        if let Self::Different(different) = self { different.comparison.bits } else { 0 }
    }
}

impl std::fmt::Display for Different {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let comparison = &self.comparison;
        if let Some([(w, h), (width, height)]) = comparison.sizes {
            return write!(f, "{w}x{h} pixels were expected, {width}x{height} were drawn");
        }
        match comparison.first_shown {
            Some(pixel) => {
                let [expected, actual] = pixel.levels;
                let (pixels, largest, flip) = (comparison.pixels, comparison.largest, comparison.flip);
                let differ = if pixels == 1 { "1 pixel differs".into() } else { format!("{pixels} pixels differ") };
                writeln!(f, "{differ}, by up to {largest} of 255; mean FLIP error {flip:.6}")?;
                write!(f, "first at column {}, row {}: expected {expected:?}, actual {actual:?}", pixel.x, pixel.y)
            }
            None => write!(
                f,
                "all 8-bit levels are equal; the linear light differs by less than they show (hash expected: {})",
                self.expected_hash
            ),
        }
    }
}

/// Writes a picture as golden files are: with its hash and nothing that may change without it.
fn write(path: &Path, picture: &Picture) -> Result<(), String> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|why| format!("{}: {why}", folder.display()))?;
    }
    let mut metadata = Metadata::default();
    metadata.insert(key::HASH, picture.hash());
    image::write(path, Format::Png8, picture, &metadata).map_err(|why| why.to_string())
}

/// Golden pictures of a crate that no test names: their names stand in quotes in no Rust file of its `tests`, `src`,
/// `examples` and `benches`, and they have no scene of their name beside them. What earlier failures of such pictures left
/// is taken out of the report. The folders are those of [`Golden::new`].
///
/// # Errors
/// A folder or file that cannot be read.
pub fn dead(crate_folder: &str, tests_folder: Option<&str>) -> io::Result<Vec<PathBuf>> {
    let folder = Path::new(crate_folder);
    let root = folder.join("tests/golden");
    let mut code = String::new();
    for part in ["tests", "src", "examples", "benches"] {
        for file in files(&folder.join(part), "rs")? {
            code.push_str(&fs::read_to_string(file)?);
        }
    }
    let is_named = |name: &str| code.contains(&format!("\"{name}\"")) || root.join(format!("{name}.ron")).exists();
    report::forget(&reports(crate_folder, tests_folder), &root, is_named)?;
    let mut dead = files(&root, "png")?;
    dead.retain(|picture| {
        let name = picture.strip_prefix(&root).unwrap_or(picture).with_extension("");
        !is_named(&name.to_string_lossy().replace('\\', "/"))
    });
    Ok(dead)
}

/// The folder for reports: beside Cargo's folder for tests, which lies in the target folder.
fn reports(crate_folder: &str, tests_folder: Option<&str>) -> PathBuf {
    tests_folder
        .map_or(Path::new(crate_folder).join("target/golden"), |tests| Path::new(tests).with_file_name("golden"))
}

/// Files with an extension in a folder and all below it, in order; none if there is no such folder.
fn files(folder: &Path, extension: &str) -> io::Result<Vec<PathBuf>> {
    let mut found = vec![];
    if !folder.is_dir() {
        return Ok(found);
    }
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            found.extend(files(&path, extension)?);
        } else if path.extension().is_some_and(|is| is == extension) {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}
