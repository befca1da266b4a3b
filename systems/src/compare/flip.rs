//! FLIP: how different two pictures look when one is shown in place of the other.
//!
//! After Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild: FLIP: A Difference Evaluator for Alternating
//! Images (2020), for pictures as a screen shows them. Own code, since the crate that there is needs a C++ compiler.

use crate::render::Picture;
use snell_components::{color::Rgb, math};

/// Pixels in a degree of the field of view: a screen 0.7 m wide with 3840 pixels, seen from 0.7 m.
pub const PIXELS_PER_DEGREE: f64 = 67.020_643;

/// The FLIP error of each pixel, 0, no difference, to 1; nothing if the sizes differ.
#[must_use]
pub fn flip(reference: &Picture, test: &Picture) -> Option<Vec<f64>> {
    let size = (reference.width as usize, reference.height as usize);
    if size != (test.width as usize, test.height as usize) {
        return None;
    }
    let [reference, test] = [reference, test].map(|picture| Seen::new(picture, size));
    let largest = hyab(hunt(lab(Rgb::Y)), hunt(lab(Rgb::Z)));
    let largest = math::pow(largest, COLOR_EXPONENT);
    let colors = reference.colors.iter().zip(&test.colors);
    let features = reference.features.iter().zip(&test.features);
    let error = |((a, b), (fa, fb)): ((&Rgb, &Rgb), (&[f64; 2], &[f64; 2]))| {
        let color = spread(math::pow(hyab(*a, *b), COLOR_EXPONENT), largest);
        let feature = (fa[0] - fb[0]).abs().max((fa[1] - fb[1]).abs());
        let feature = (feature / core::f64::consts::SQRT_2).sqrt();
        math::pow(color, 1.0 - feature)
    };
    Some(colors.zip(features).map(error).collect())
}

const COLOR_EXPONENT: f64 = 0.7;

/// Differences below 0.4 of the largest get 0.95 of the scale.
fn spread(difference: f64, largest: f64) -> f64 {
    let knee = 0.4 * largest;
    if difference < knee { 0.95 / knee * difference } else { 0.95 + (difference - knee) / (largest - knee) * 0.05 }
}

/// A picture as it is seen.
struct Seen {
    /// Filtered by the eye's sensitivity to contrast, in L\*a\*b\* with the chroma of dark colours reduced.
    colors: Vec<Rgb>,
    /// Strength of edges and of points.
    features: Vec<[f64; 2]>,
}

impl Seen {
    fn new(picture: &Picture, size: (usize, usize)) -> Self {
        // What a screen shows of it.
        let shown = |light: &[f32; 3]| Rgb::from_array(light.map(|light| f64::from(light).clamp(0.0, 1.0)));
        let opponent: Vec<Rgb> = picture.pixels.iter().map(|light| ycxcz(xyz(shown(light)))).collect();
        let channel = |i: usize| opponent.iter().map(|color| color[i]).collect::<Vec<f64>>();
        let [y, cx, cz] = SENSITIVITY.map(sensitivity_filter);
        let [y, cx, cz] =
            [blurred(&channel(0), size, &y), blurred(&channel(1), size, &cx), blurred(&channel(2), size, &cz)];
        let color = |i: usize| {
            let light = linear(xyz_of_ycxcz(Rgb::new(y[i], cx[i], cz[i])));
            hunt(lab(light.clamp(Rgb::ZERO, Rgb::ONE)))
        };
        let grey: Vec<f64> = opponent.iter().map(|color| (color.x + 16.0) / 116.0).collect();
        Self { colors: (0..opponent.len()).map(color).collect(), features: features(&grey, size) }
    }
}

/// Amplitudes and widths of the Gaussians that make up the sensitivity to contrast in luminance, red–green and
/// blue–yellow.
const SENSITIVITY: [[(f64, f64); 2]; 3] =
    [[(1.0, 0.0047), (0.0, 1e-5)], [(1.0, 0.0053), (0.0, 1e-5)], [(34.1, 0.04), (13.5, 0.025)]];

/// Weights of pixels about the middle one, row by row, with the radius in pixels.
struct Kernel {
    radius: usize,
    /// Each a product of a row's and a column's, summed up.
    parts: Vec<(f64, Vec<f64>)>,
}

fn sensitivity_filter(gaussians: [(f64, f64); 2]) -> Kernel {
    let pi = core::f64::consts::PI;
    let radius = (3.0 * (0.04 / (2.0 * pi * pi)).sqrt() * PIXELS_PER_DEGREE).ceil() as usize;
    let mut parts: Vec<(f64, Vec<f64>)> = vec![];
    for (amplitude, width) in gaussians {
        let degrees = |i: usize| (i as f64 - radius as f64) / PIXELS_PER_DEGREE;
        let weight = |i: usize| math::exp(-pi * pi * degrees(i) * degrees(i) / width);
        parts.push((amplitude * pi / width, (0..=2 * radius).map(weight).collect()));
    }
    let sum: f64 =
        parts.iter().map(|(amplitude, row)| amplitude * row.iter().sum::<f64>() * row.iter().sum::<f64>()).sum();
    parts.iter_mut().for_each(|(amplitude, _)| *amplitude /= sum);
    parts.retain(|(amplitude, _)| *amplitude != 0.0);
    Kernel { radius, parts }
}

fn blurred(values: &[f64], size: (usize, usize), kernel: &Kernel) -> Vec<f64> {
    let mut sum = vec![0.0; values.len()];
    for (amplitude, row) in &kernel.parts {
        let across = along_rows(values, size, kernel.radius, row);
        let both = along_columns(&across, size, kernel.radius, row);
        sum.iter_mut().zip(both).for_each(|(sum, value)| *sum += amplitude * value);
    }
    sum
}

/// Each value with its neighbours in the row, weighed; beyond the border its values go on.
fn along_rows(values: &[f64], (width, _): (usize, usize), radius: usize, weights: &[f64]) -> Vec<f64> {
    let at = |row: &[f64], x: usize, i: usize| row[(x + i).saturating_sub(radius).min(width - 1)];
    let weighed = |row: &[f64], x: usize| weights.iter().enumerate().map(|(i, weight)| weight * at(row, x, i)).sum();
    values.chunks(width.max(1)).flat_map(|row| (0..width).map(move |x| weighed(row, x))).collect()
}

fn along_columns(values: &[f64], (width, height): (usize, usize), radius: usize, weights: &[f64]) -> Vec<f64> {
    let row_at = |y: usize, i: usize| (y + i).saturating_sub(radius).min(height - 1) * width;
    let weighed =
        |x: usize, y: usize| weights.iter().enumerate().map(|(i, weight)| weight * values[row_at(y, i) + x]).sum();
    (0..width * height).map(|n| weighed(n % width, n / width)).collect()
}

/// Edges and points, by the first and second derivative of a Gaussian as wide as the detectors of the eye.
fn features(grey: &[f64], size: (usize, usize)) -> Vec<[f64; 2]> {
    let deviation = 0.5 * 0.082 * PIXELS_PER_DEGREE;
    let radius = (3.0 * deviation).ceil() as usize;
    let offset = |i: usize| i as f64 - radius as f64;
    let gaussian: Vec<f64> =
        (0..=2 * radius).map(|i| math::exp(-offset(i) * offset(i) / (2.0 * deviation * deviation))).collect();
    let first = gaussian.iter().enumerate().map(|(i, g)| -offset(i) * g).collect();
    let square = deviation * deviation;
    let second = gaussian.iter().enumerate().map(|(i, g)| (offset(i) * offset(i) / square - 1.0) * g).collect();
    let [edges, points] = [first, second].map(|derivative| slopes(grey, size, radius, balanced(derivative), &gaussian));
    edges.into_iter().zip(points).map(|(edge, point)| [edge, point]).collect()
}

/// Positive weights add up to 1, negative ones to −1.
fn balanced(weights: Vec<f64>) -> Vec<f64> {
    let sum = |sign: f64| weights.iter().filter(|weight| **weight * sign > 0.0).map(|weight| weight.abs()).sum::<f64>();
    let (positive, negative) = (sum(1.0), sum(-1.0));
    weights.iter().map(|weight| weight / if *weight > 0.0 { positive } else { negative }).collect()
}

/// Length of the vector of a derivative along rows and along columns.
fn slopes(grey: &[f64], size: (usize, usize), radius: usize, derivative: Vec<f64>, gaussian: &[f64]) -> Vec<f64> {
    let sum: f64 = gaussian.iter().sum();
    let smooth: Vec<f64> = gaussian.iter().map(|weight| weight / sum).collect();
    let across = along_columns(&along_rows(grey, size, radius, &derivative), size, radius, &smooth);
    let down = along_columns(&along_rows(grey, size, radius, &smooth), size, radius, &derivative);
    across.into_iter().zip(down).map(|(x, y)| (x * x + y * y).sqrt()).collect()
}

/// White of the screen, in CIE XYZ.
const WHITE: Rgb = Rgb::new(0.950_428_545, 1.0, 1.088_900_371);

fn xyz(light: Rgb) -> Rgb {
    Rgb::new(
        light.dot(Rgb::new(10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0)),
        light.dot(Rgb::new(2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0)),
        light.dot(Rgb::new(1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0)),
    )
}

/// The inverse of [`xyz`].
fn linear(xyz: Rgb) -> Rgb {
    Rgb::new(
        xyz.dot(Rgb::new(3.241_003_275, -1.537_398_934, -0.498_615_861)),
        xyz.dot(Rgb::new(-0.969_224_334, 1.875_930_071, 0.041_554_224)),
        xyz.dot(Rgb::new(0.055_639_423, -0.204_011_202, 1.057_148_933)),
    )
}

/// L\*a\*b\* without its cube roots: linear, so that it may be filtered.
fn ycxcz(xyz: Rgb) -> Rgb {
    let Rgb { x, y, z } = xyz / WHITE;
    Rgb::new(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z))
}

fn xyz_of_ycxcz(color: Rgb) -> Rgb {
    let y = (color.x + 16.0) / 116.0;
    Rgb::new(color.y / 500.0 + y, y, y - color.z / 200.0) * WHITE
}

fn lab(light: Rgb) -> Rgb {
    let root = |t: f64| {
        const DELTA: f64 = 6.0 / 29.0;
        if t > DELTA * DELTA * DELTA { math::pow(t, 1.0 / 3.0) } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
    };
    let Rgb { x, y, z } = xyz(light) / WHITE;
    let (x, y, z) = (root(x), root(y), root(z));
    Rgb::new(116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z))
}

/// Colours look less colourful where it is dark (Hunt).
fn hunt(lab: Rgb) -> Rgb {
    Rgb::new(lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z)
}

/// Distance for large differences of colour (Abasi, Amani Tehran, Fairchild 2020).
fn hyab(a: Rgb, b: Rgb) -> f64 {
    let Rgb { x, y, z } = a - b;
    x.abs() + (y * y + z * z).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Stripes and slopes of colour, and the same with a change.
    fn picture(change: f32) -> Picture {
        let (width, height) = (48, 32);
        let pixel = |i: u32| {
            let (x, y) = (i % width, i / width);
            let stripe = if (x / 5 + y / 7) % 2 == 0 { 0.75f32 } else { 0.125 };
            let slope = x as f32 / 64.0;
            let spot = if (20..26).contains(&x) && (10..14).contains(&y) { change } else { 0.0 };
            [stripe, slope + spot, y as f32 / 32.0 * (1.0 - change)]
        };
        Picture { width, height, pixels: (0..width * height).map(pixel).collect() }
    }

    fn mean(a: &Picture, b: &Picture) -> f64 {
        let map = flip(a, b).expect("of one size");
        map.iter().sum::<f64>() / map.len() as f64
    }

    #[test]
    fn agrees_with_the_authors_program() {
        // Of flip-evaluator 1.7 on these pictures, encoded as sRGB.
        for (change, expected) in [(0.02, 0.045_023), (0.1, 0.142_784), (0.25, 0.278_141)] {
            let found = mean(&picture(0.0), &picture(change));
            assert!((found - expected).abs() < 1e-4, "{change}: {found}, expected {expected}");
        }
    }

    #[test]
    fn equal_pictures_differ_by_nothing_and_black_from_white_by_all() {
        assert_eq!(mean(&picture(0.3), &picture(0.3)), 0.0);
        let black = Picture::black(8, 8);
        let white = Picture { pixels: vec![[1.0; 3]; 64], ..black.clone() };
        assert!((mean(&black, &white) - 0.97).abs() < 0.03, "{}", mean(&black, &white));
        assert!(flip(&black, &Picture::black(8, 9)).is_none());
    }
}
