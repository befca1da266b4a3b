//! Studies: what is measured, one file each.

mod accelerators;
mod antialias;
mod area;
mod depth;
mod error;
mod lights;
mod methods;
mod scene;
mod settings;
mod textures;
mod threads;
mod triangles;

pub use scene::Scene;

use crate::{
    chart::{Axis, Chart, Point, Series},
    clock,
    measure::{Effort, Measured},
    table::Table,
};
use snell_systems::{extract::SceneError, render::Picture};

/// Something that can be measured.
#[derive(Clone, Copy)]
pub struct Study {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it shows, a short phrase.
    pub about: &'static str,
    /// How it is done.
    pub kind: Kind,
}

/// Where the things measured come from.
#[derive(Clone, Copy)]
pub enum Kind {
    /// The user's scene.
    OfScene(fn(&mut Scene, Effort) -> Result<Found, Hindrance>),
    /// Scenes of the study's own.
    Ready(fn(Effort) -> Result<Found, Hindrance>),
}

/// All studies: first those of the user's scene.
pub const ALL: &[Study] = &[
    Study { name: "settings", about: "all settings side by side, with advice", kind: Kind::OfScene(settings::study) },
    Study { name: "error", about: "whether the error promised by --error is kept", kind: Kind::OfScene(error::study) },
    Study { name: "antialias", about: "rays in a pixel", kind: Kind::OfScene(antialias::study) },
    Study { name: "lights", about: "samples of lights with an area", kind: Kind::OfScene(lights::study) },
    Study { name: "depth", about: "depth of reflections and cut-off", kind: Kind::OfScene(depth::study) },
    Study { name: "textures", about: "filters of textures", kind: Kind::OfScene(textures::study) },
    Study {
        name: "methods",
        about: "tests of triangles and spheres, and their precision",
        kind: Kind::OfScene(methods::study),
    },
    Study { name: "threads", about: "time against threads", kind: Kind::OfScene(threads::study) },
    Study { name: "triangles", about: "time against the number of triangles", kind: Kind::Ready(triangles::study) },
    Study { name: "area", about: "time against the area on the screen", kind: Kind::Ready(area::study) },
    Study {
        name: "accelerators",
        about: "no tree, tree of spheres and tree of boxes",
        kind: Kind::Ready(accelerators::study),
    },
];

/// What a study found.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// The study's name.
    pub name: String,
    /// What it is about.
    pub title: String,
    /// The scene, where there are several.
    pub about: Option<String>,
    /// What the charts say, a sentence each.
    pub says: Vec<String>,
    /// Drawings.
    pub charts: Vec<Chart>,
    /// All numbers.
    pub table: Table,
    /// Pictures with what they show.
    pub pictures: Vec<(String, Picture)>,
}

impl Found {
    /// Puts the name of a scene before those of the files, where several scenes share a folder.
    pub fn belongs_to(&mut self, scene: &str) {
        self.name = format!("{scene}-{}", self.name);
        self.charts.iter_mut().for_each(|chart| chart.file = format!("{scene}-{}", chart.file));
        self.about = Some(scene.into());
    }
}

/// What studies found in several scenes, in one table each: whether errors are kept, and whether the defaults lie on the
/// Pareto front.
#[must_use]
pub fn side_by_side(found: &[Found]) -> Vec<Found> {
    let of = |end: &str| found.iter().filter(|found| found.about.is_some() && found.name.ends_with(end)).collect();
    let (errors, settings): (Vec<&Found>, Vec<&Found>) = (of("-error"), of("-settings"));
    let mut all = vec![];
    if errors.len() > 1 {
        all.push(error::kept_in_all(&errors));
    }
    if settings.len() > 1 {
        all.push(settings::defaults_of_all(&settings));
    }
    all
}

/// Why a study cannot be done.
#[derive(Clone, Debug, PartialEq)]
pub enum Hindrance {
    /// The scene has nothing that the study is about.
    Nothing(String),
    /// The scene cannot be rendered.
    Scene(String),
}

impl From<SceneError> for Hindrance {
    fn from(why: SceneError) -> Self {
        Self::Scene(why.to_string())
    }
}

impl core::fmt::Display for Hindrance {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Nothing(why) | Self::Scene(why) => f.write_str(why),
        }
    }
}

/// What is on the vertical axis of a chart of errors.
#[derive(Clone, Copy)]
enum Error {
    Rmse,
    Flip,
}

impl Error {
    fn of(self, measured: &Measured) -> f64 {
        match self {
            Self::Rmse => measured.difference.rmse,
            Self::Flip => measured.difference.flip,
        }
    }

    fn label(self) -> &'static str {
        match self {
            Self::Rmse => "RMSE against the reference, linear light",
            Self::Flip => "mean FLIP against the reference, 0 to 1",
        }
    }
}

/// A chart of time against error, with a series for each kind of setting.
fn time_against_error(file: &str, title: &str, measured: &[Measured], error: Error) -> Chart {
    let point = |m: &Measured| Point { x: m.seconds, spread: Some(m.spread), ..point(m, error) };
    against_error(file, title, clock_label(), measured, error, point)
}

/// A chart of rays against error: the same on every machine.
fn rays_against_error(file: &str, title: &str, measured: &[Measured], error: Error) -> Chart {
    let per_pixel = |m: &Measured| m.counts.rays() as f64 / m.picture.pixels.len().max(1) as f64;
    let point = |m: &Measured| Point { x: per_pixel(m), ..point(m, error) };
    against_error(file, title, "rays per pixel, of all kinds".into(), measured, error, point)
}

fn clock_label() -> String {
    format!("{} of one thread, median of the runs; bars: fastest to slowest", clock::UNIT)
}

fn point(m: &Measured, error: Error) -> Point {
    Point { y: error.of(m), label: m.label.clone(), marked: m.default, ..Point::default() }
}

fn against_error(
    file: &str,
    title: &str,
    x: String,
    measured: &[Measured],
    error: Error,
    point: impl Fn(&Measured) -> Point,
) -> Chart {
    let mut series: Vec<Series> = vec![];
    for m in measured {
        let at = series.iter().position(|series| series.label == m.group).unwrap_or_else(|| {
            series.push(Series { label: m.group.clone(), ..Series::default() });
            series.len() - 1
        });
        series[at].points.push(point(m));
    }
    Chart {
        file: file.into(),
        title: title.into(),
        x: Axis::log(x),
        y: Axis::log(error.label()),
        series,
        smaller_is_better: true,
        ..Chart::default()
    }
}

/// The factor between two numbers, in words.
fn times(larger: f64, smaller: f64) -> String {
    let factor = larger / smaller.max(f64::MIN_POSITIVE);
    if factor >= 9.95 { format!("{factor:.0} times") } else { format!("{factor:.1} times") }
}
