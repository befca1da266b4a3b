//! Golden pictures: each in a PNG file beside its scene, compared to the last bit.
//!
//! The PNG shows people what is expected; the hash of the linear light in its metadata catches what 8 bits do not show.

use snell::{
    Picture,
    components::color::linear_from_srgb,
    systems::image::{self, Format, Metadata, key, srgb8},
};
use std::{
    fmt, fs, io,
    path::{Path, PathBuf},
};

/// The most a golden PNG may take: repositories keep every version for good.
pub(crate) const MAX_BYTES: u64 = 16 * 1024;

/// Which golden pictures are replaced by what is rendered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Bless {
    Nothing,
    Failing,
    All,
    /// Those whose name contains the text, or matches it as a whole if it has a `*`.
    Matching(String),
}

impl Bless {
    /// Reads the value of the environment variable `SNELL_BLESS`; nothing is blessed where `CI` is set.
    pub(crate) fn from_env(value: Option<&str>, ci: bool) -> Result<Self, String> {
        let bless = match value {
            None | Some("") => return Ok(Self::Nothing),
            Some("1") => Self::Failing,
            Some("all") => Self::All,
            Some(pattern) => Self::Matching(pattern.into()),
        };
        if ci {
            return Err(
                "SNELL_BLESS is refused because CI is set: golden pictures are blessed by who looks at them".into()
            );
        }
        Ok(bless)
    }

    fn wants(&self, name: &str, passes: bool) -> bool {
        match self {
            Self::Nothing => false,
            Self::Failing => !passes,
            Self::All => true,
            Self::Matching(pattern) => matches(pattern, name),
        }
    }
}

/// Whether a name contains a text, or matches it as a whole if it has a `*`, which stands for anything.
fn matches(pattern: &str, name: &str) -> bool {
    let Some((start, rest)) = pattern.split_once('*') else { return name.contains(pattern) };
    let Some(name) = name.strip_prefix(start) else { return false };
    // Every piece but the last takes its first place: that leaves the most for the others.
    let mut pieces: Vec<_> = rest.split('*').collect();
    let last = pieces.pop().unwrap_or_default();
    let found = pieces.iter().try_fold(name, |name, piece| name.split_once(piece).map(|(_, after)| after));
    found.is_some_and(|name| name.ends_with(last))
}

/// One golden picture.
#[derive(Clone, Debug)]
pub(crate) struct Golden {
    /// Path of the scene below the folder of goldens, without extension.
    pub(crate) name: String,
    /// The scene.
    pub(crate) scene: PathBuf,
    /// The expected picture.
    pub(crate) expected: PathBuf,
    /// Where a failure leaves pictures to look at.
    pub(crate) report: PathBuf,
}

impl Golden {
    /// Every scene below `root`, in the order of names.
    pub(crate) fn all(root: &Path, reports: &Path) -> io::Result<Vec<Self>> {
        let golden = |scene: PathBuf| {
            let path = scene.strip_prefix(root).unwrap_or(&scene).with_extension("");
            Self {
                name: path.to_string_lossy().replace('\\', "/"),
                expected: scene.with_extension("png"),
                report: reports.join(path).with_extension("png"),
                scene,
            }
        };
        Ok(files(root, "ron")?.into_iter().map(golden).collect())
    }

    /// Compares a picture with the expected one, or makes it the expected one.
    ///
    /// # Errors
    /// What is different, where to look and what to do.
    pub(crate) fn check(&self, actual: &Picture, bless: &Bless) -> Result<(), String> {
        let verdict = self.compare(actual);
        if bless.wants(&self.name, verdict.is_ok()) {
            write(&self.expected, actual)?;
        } else if let Err(failure) = verdict {
            return Err(self.report(actual, &failure));
        }
        // What an earlier failure left would mislead.
        let _ = fs::remove_file(&self.report);
        match fs::metadata(&self.expected).map_err(|why| why.to_string())?.len() {
            bytes if bytes > MAX_BYTES => {
                Err(format!("{} has {bytes} bytes; at most {MAX_BYTES} are allowed", self.expected.display()))
            }
            _ => Ok(()),
        }
    }

    fn compare(&self, actual: &Picture) -> Result<(), Failure> {
        if !self.expected.exists() {
            return Err(Failure::Missing);
        }
        let (expected, metadata) = image::read(&self.expected).map_err(|why| Failure::Unusable(why.to_string()))?;
        let Some(hash) = metadata.get(key::HASH) else {
            return Err(Failure::Unusable(format!("{} has no `{}`", self.expected.display(), key::HASH)));
        };
        Difference::between(&expected, hash, actual)
            .map_or(Ok(()), |difference| Err(Failure::Different(expected, Box::new(difference))))
    }

    /// Leaves pictures to look at and tells what happened.
    fn report(&self, actual: &Picture, failure: &Failure) -> String {
        let (what, shown, picture) = match failure {
            Failure::Missing => ("there is no golden picture".into(), "what was rendered", actual.clone()),
            Failure::Unusable(why) => (why.clone(), "what was rendered", actual.clone()),
            Failure::Different(expected, difference) => {
                (difference.to_string(), "expected | difference ×16 | actual", side_by_side(expected, actual))
            }
        };
        let written = match write(&self.report, &picture) {
            Ok(()) => format!("{shown}: {}", self.report.display()),
            Err(why) => why,
        };
        format!("{what}\n{written}\nif the new picture is right: SNELL_BLESS={} cargo test --test golden", self.name)
    }
}

/// Pictures below `root` that have no scene.
pub(crate) fn dead(root: &Path) -> io::Result<Vec<PathBuf>> {
    let mut pictures = files(root, "png")?;
    pictures.retain(|picture| !picture.with_extension("ron").exists());
    Ok(pictures)
}

/// Files with an extension in a folder and all below, in order.
fn files(folder: &Path, extension: &str) -> io::Result<Vec<PathBuf>> {
    let mut found = vec![];
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

/// Why a picture is not the expected one.
enum Failure {
    Missing,
    Unusable(String),
    Different(Picture, Box<Difference>),
}

/// How a picture differs from the expected one.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Difference {
    /// Columns and rows, if they differ: expected and actual.
    pub(crate) sizes: Option<[(u32, u32); 2]>,
    /// Pixels whose 8-bit levels differ.
    pub(crate) pixels: usize,
    /// Largest difference of an 8-bit level.
    pub(crate) largest: u8,
    /// The first of them, row by row: column, row, expected and actual levels.
    pub(crate) first: Option<(u32, u32, [u8; 3], [u8; 3])>,
    /// Of the linear light: expected and actual.
    pub(crate) hashes: [String; 2],
}

impl Difference {
    /// Compares a picture with what a golden file holds: 8-bit levels, and the hash of the linear light.
    pub(crate) fn between(expected: &Picture, expected_hash: &str, actual: &Picture) -> Option<Self> {
        let sizes = [expected, actual].map(|picture| (picture.width, picture.height));
        let sizes = (sizes[0] != sizes[1]).then_some(sizes);
        let levels = [expected, actual].map(srgb8);
        let mut different = levels[0].iter().zip(&levels[1]).enumerate().filter(|(_, (a, b))| a != b).peekable();
        let first = different.peek().map(|&(at, (a, b))| {
            let column = at as u32 % expected.width;
            (column, at as u32 / expected.width, *a, *b)
        });
        let (mut pixels, mut largest) = (0, 0);
        for (_, (a, b)) in different {
            pixels += 1;
            largest = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).fold(largest, u8::max);
        }
        let hashes = [expected_hash.into(), actual.hash()];
        let equal = sizes.is_none() && pixels == 0 && hashes[0] == hashes[1];
        (!equal).then_some(Self { sizes, pixels, largest, first, hashes })
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some([(w, h), (width, height)]) = self.sizes {
            return write!(f, "{w}x{h} pixels were expected, {width}x{height} were rendered");
        }
        match self.first {
            Some((x, y, expected, actual)) => {
                writeln!(f, "{} pixels differ, by up to {} of 255", self.pixels, self.largest)?;
                writeln!(f, "first at column {x}, row {y}: expected {expected:?}, actual {actual:?}")?;
            }
            None => writeln!(f, "all 8-bit levels are equal; the linear light differs by less than they show")?,
        }
        write!(f, "hash of the linear light: expected {}, actual {}", self.hashes[0], self.hashes[1])
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

/// Expected, sixteen times the difference of levels, and actual in one picture.
fn side_by_side(expected: &Picture, actual: &Picture) -> Picture {
    let (width, height) = (expected.width.max(actual.width), expected.height.max(actual.height));
    let framed = |picture: &Picture| {
        let mut framed = Picture::black(width, height);
        framed.paste(picture, 0, 0);
        framed
    };
    let levels = [expected, actual].map(|picture| srgb8(&framed(picture)));
    let shown = |a: u8, b: u8| linear_from_srgb(f64::from(a.abs_diff(b).saturating_mul(16)) / 255.0) as f32;
    let mut difference = Picture::black(width, height);
    for ((out, a), b) in difference.pixels.iter_mut().zip(&levels[0]).zip(&levels[1]) {
        *out = [0, 1, 2].map(|channel| shown(a[channel], b[channel]));
    }
    let mut all = Picture::black(3 * width, height);
    all.paste(expected, 0, 0);
    all.paste(&difference, width, 0);
    all.paste(actual, 2 * width, 0);
    all
}
