//! A chart: what it shows, and the drawing of it as SVG and PNG.

mod axis;
mod draw;

pub use draw::{SIZE, png, svg};

/// Points in a plane, with all that a reader needs to understand them.
#[derive(Clone, Debug, Default)]
pub struct Chart {
    /// The name of its files, without ending.
    pub file: String,
    /// What it shows.
    pub title: String,
    /// To the right.
    pub x: Axis,
    /// Up.
    pub y: Axis,
    /// What is shown.
    pub series: Vec<Series>,
    /// Straight lines to compare with.
    pub guides: Vec<Guide>,
    /// Whether smaller is better on both axes: then the Pareto front is drawn, and which corner is better is said.
    pub smaller_is_better: bool,
}

/// An axis.
#[derive(Clone, Debug, Default)]
pub struct Axis {
    /// What and in which unit.
    pub label: String,
    /// Whether equal steps are equal factors.
    pub log: bool,
}

impl Axis {
    /// A logarithmic axis.
    #[must_use]
    pub fn log(label: impl Into<String>) -> Self {
        Self { label: label.into(), log: true }
    }

    /// A linear axis, from zero.
    #[must_use]
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), log: false }
    }
}

/// Points of one kind.
#[derive(Clone, Debug, Default)]
pub struct Series {
    /// Its name in the legend.
    pub label: String,
    /// The points.
    pub points: Vec<Point>,
    /// Whether they are joined, in their order.
    pub joined: bool,
}

/// A point.
#[derive(Clone, Debug, Default)]
pub struct Point {
    /// To the right; more than zero on a logarithmic axis, or it is left out.
    pub x: f64,
    /// Up; zero on a logarithmic axis is drawn on the axis and called 0.
    pub y: f64,
    /// Where most of the runs lie in x.
    pub spread: Option<(f64, f64)>,
    /// What the point is; told where it lies on the front, and where there is no front.
    pub label: String,
    /// Whether it is drawn larger: the default.
    pub marked: bool,
}

/// A straight line, on logarithmic axes a power law.
#[derive(Clone, Debug)]
pub struct Guide {
    /// Its name in the legend.
    pub label: String,
    /// Two points that it joins, within the chart.
    pub ends: [(f64, f64); 2],
}

/// Which of some points are not beaten: no other is as good in both and better in one.
#[must_use]
pub fn front(points: &[(f64, f64)]) -> Vec<bool> {
    let beats = |a: &(f64, f64), b: &(f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
    points.iter().map(|point| !points.iter().any(|other| beats(other, point))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_is_what_nothing_beats() {
        let points = [(1.0, 5.0), (2.0, 3.0), (2.0, 4.0), (3.0, 3.0), (4.0, 1.0), (4.0, 1.0), (9.0, 9.0)];
        assert_eq!(front(&points), [true, true, false, false, true, true, false]);
        assert!(front(&[]).is_empty());
    }
}
