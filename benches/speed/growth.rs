//! How time grows: with the logarithm of the number of triangles, and with the number of pixels.

use crate::{
    frame::{self, draw},
    measure::{Case, Row, interleave},
    subject::sparse,
};
use serde::Serialize;
use snell::{Snapshot, components::math};
use std::sync::Arc;

/// A straight line through measurements.
#[derive(Clone, Serialize)]
pub(crate) struct Fit {
    pub(crate) what: &'static str,
    /// CPU seconds at zero, and per unit.
    pub(crate) at_zero: f64,
    pub(crate) per_unit: f64,
    /// The largest distance of a measurement from the line, as a share of the line's value there.
    pub(crate) residual: f64,
}

/// Frames of the same 640×480 pixels of sparse fields, from a thousand to eight million triangles, near the most that a
/// figure makes.
pub(crate) fn with_triangles(rounds: usize) -> (Vec<Row>, Fit) {
    let counts = [1_000, 10_000, 100_000, 1_000_000, 8_000_000];
    let snapshots: Vec<_> = counts.iter().map(|&count| frame::of_field(&sparse(count), (640, 480))).collect();
    let named = counts.iter().map(|count| format!("sparse, {count} triangles")).zip(&snapshots);
    let rows = interleave(named.map(case).collect(), rounds);
    let points = counts.iter().zip(&rows).map(|(&count, row)| (math::log2(f64::from(count)), row.cpu_seconds));
    let fit = line("CPU seconds against log2 of triangles", points.collect());
    (rows, fit)
}

/// Frames of 40 000 triangles in pictures of more and more pixels.
pub(crate) fn with_pixels(rounds: usize) -> (Vec<Row>, Fit) {
    let sizes = [(200, 150), (400, 300), (600, 450), (800, 600), (1200, 900)];
    let mesh = sparse(40_000);
    let snapshots = sizes.map(|size| frame::of_field(&mesh, size));
    let named = sizes.iter().map(|(width, height)| format!("sparse, {width}x{height}")).zip(&snapshots);
    let rows = interleave(named.map(case).collect(), rounds);
    let points = sizes.iter().zip(&rows).map(|((w, h), row)| (f64::from(w * h) / 1e6, row.cpu_seconds));
    let fit = line("CPU seconds against millions of pixels", points.collect());
    (rows, fit)
}

fn case((subject, snapshot): (String, &Arc<Snapshot>)) -> Case<'_> {
    Case { bench: "growth", subject, item: "rays", threads: 1, run: Box::new(|| draw(snapshot, 1)) }
}

/// The line of least squares, with its largest relative residual.
fn line(what: &'static str, points: Vec<(f64, f64)>) -> Fit {
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let covariance: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let per_unit = covariance / points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum::<f64>();
    let at_zero = y - per_unit * x;
    let apart = |p: &(f64, f64)| ((p.1 - (at_zero + per_unit * p.0)) / (at_zero + per_unit * p.0)).abs();
    Fit { what, at_zero, per_unit, residual: points.iter().map(apart).fold(0.0, f64::max) }
}
