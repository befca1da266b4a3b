//! White light as a few wavelengths.

use crate::snapshot::Spectrum;
use snell_components::{color::Rgb, material::Dispersion, math};

/// Fraunhofer lines F, d and C in nanometres, by which Abbe's number is defined.
const LINES: [f64; 3] = [486.13, 587.56, 656.27];

/// The wavelengths that are seen, in nanometres.
const VISIBLE: (f64, f64) = (420.0, 680.0);

/// The spectrum of a body with an index at the line d.
pub(super) fn spectrum(index: f64, Dispersion { abbe, wavelengths }: Dispersion) -> Spectrum {
    let [f, d, c] = LINES.map(|line| 1.0 / (line * line));
    let b = (index - 1.0) / (abbe * (f - c));
    let step = (VISIBLE.1 - VISIBLE.0) / f64::from(wavelengths);
    let mut lines: Vec<(f64, Rgb)> = (0..wavelengths)
        .map(|i| VISIBLE.0 + step * (f64::from(i) + 0.5))
        .map(|wavelength| (wavelength, color_of(wavelength)))
        .collect();
    // Together white. A channel that no line carries would be lost: all lines share it then.
    let sum = lines.iter().fold(Rgb::ZERO, |sum, (_, color)| sum + *color);
    for (_, color) in &mut lines {
        for channel in 0..3 {
            color[channel] =
                if sum[channel] > 0.0 { color[channel] / sum[channel] } else { 1.0 / f64::from(wavelengths) };
        }
    }
    Spectrum { a: index - b * d, b, lines: lines.into() }
}

/// Linear RGB of light of one wavelength, up to a factor; what the primaries cannot show is cut off.
///
/// The eye's response after Wyman, Sloan, Shirley: Simple Analytic Approximations to the CIE XYZ Color Matching
/// Functions, JCGT 2(2), 2013.
fn color_of(wavelength: f64) -> Rgb {
    let lobe = |center: f64, below: f64, above: f64| {
        let x = (wavelength - center) * if wavelength < center { below } else { above };
        math::exp(-0.5 * x * x)
    };
    let x =
        0.362 * lobe(442.0, 0.0624, 0.0374) + 1.056 * lobe(599.8, 0.0264, 0.0323) - 0.065 * lobe(501.1, 0.0490, 0.0382);
    let y = 0.821 * lobe(568.8, 0.0213, 0.0247) + 0.286 * lobe(530.9, 0.0613, 0.0322);
    let z = 1.217 * lobe(437.0, 0.0845, 0.0278) + 0.681 * lobe(459.0, 0.0385, 0.0725);
    let rgb = Rgb::new(
        3.2406 * x - 1.5372 * y - 0.4986 * z,
        -0.9689 * x + 1.8758 * y + 0.0415 * z,
        0.0557 * x - 0.2040 * y + 1.0570 * z,
    );
    rgb.max(Rgb::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lines_make_white_and_the_index_is_the_one_given() {
        for wavelengths in [2, 3, 8, 64] {
            let spectrum = spectrum(1.6, Dispersion { abbe: 30.0, wavelengths });
            let white = spectrum.lines.iter().fold(Rgb::ZERO, |sum, (_, color)| sum + *color);
            assert!((white - Rgb::ONE).length() < 1e-14, "{wavelengths}: {white}");
            let [f, d, c] = LINES.map(|line| spectrum.index(line));
            assert!((d - 1.6).abs() < 1e-14 && ((d - 1.0) / (f - c) - 30.0).abs() < 1e-10);
        }
    }

    #[test]
    fn the_ends_of_the_spectrum_are_blue_and_red() {
        let (blue, green, red) = (color_of(450.0), color_of(540.0), color_of(640.0));
        assert!(blue.z > blue.x && blue.z > blue.y, "{blue}");
        assert!(green.y > green.x && green.y > green.z, "{green}");
        assert!(red.x > red.y && red.x > red.z, "{red}");
    }
}
