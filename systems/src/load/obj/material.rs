//! From MTL to the terms of the shading equation.

use super::log::Log;
use super::mtl::Entry;
use super::word::quoted;
use snell_components::{color::Rgb, material::Highlight, texture::Image, written::Line};
use std::sync::Arc;

/// Largest exponent a highlight may have.
const MOST_EXPONENT: f64 = 1e6;

/// A material of a model, in the terms of the shading equation.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelMaterial {
    /// Its name; empty for the one that stands in where faces have none.
    pub name: String,
    /// Surface colour, linear RGB.
    pub color: Rgb,
    /// Share of the light scattered evenly.
    pub diffuse: Rgb,
    /// Share of the ambient light returned.
    pub ambient: Rgb,
    /// The highlight, if there is one.
    pub highlight: Option<Highlight>,
    /// Share of the mirrored light, if any is mirrored.
    pub mirror: Option<Rgb>,
    /// 0, nothing to see, to 1, nothing shows through.
    pub opacity: f64,
    /// Refractive index, if what shows through is bent.
    pub index: Option<f64>,
    /// The path as found from the model's, and the image, which multiplies the colour.
    pub texture: Option<(String, Arc<Image>)>,
    /// Where it is written.
    pub line: Option<Line>,
}

impl Default for ModelMaterial {
    fn default() -> Self {
        Self {
            name: String::new(),
            color: Rgb::ONE,
            diffuse: Rgb::ONE,
            ambient: Rgb::ONE,
            highlight: None,
            mirror: None,
            opacity: 1.0,
            index: None,
            texture: None,
            line: None,
        }
    }
}

impl ModelMaterial {
    /// A material without properties of its own.
    pub(super) fn named(name: &str) -> Self {
        Self { name: name.to_owned(), ..Self::default() }
    }

    /// What an entry of a library says, but for its texture. Values out of range are brought into it, with a notice.
    pub(super) fn of(entry: &Entry, log: &mut Log) -> Self {
        let parsed = &entry.parsed;
        let name = quoted(entry.name.as_bytes());
        let mut limit = |what: &str, value: f64, least: f64, most: f64| {
            let limited = value.clamp(least, most);
            if limited != value {
                let text = format!("material {name}: `{what}` of {value} is taken as {limited}");
                log.notice(Some(entry.at), &text);
            }
            limited
        };
        let mut color = |what: &str, value: Option<[f32; 3]>| {
            value.map(|rgb| Rgb::from_array(rgb.map(|x| limit(what, f64::from(x), 0.0, f64::MAX))))
        };
        let diffuse = color("Kd", parsed.diffuse);
        let ambient = color("Ka", parsed.ambient);
        let specular = color("Ks", parsed.specular).filter(|&ks| ks != Rgb::ZERO);
        let illum = match parsed.illumination_model {
            Some(illum @ 0..=10) => Some(illum),
            Some(illum) => Some(limit("illum", f64::from(illum), 2.0, 2.0) as u8),
            None => None,
        };
        let exponent = limit("Ns", parsed.shininess.map_or(0.0, f64::from), 0.0, MOST_EXPONENT);
        let opacity = limit("d", parsed.dissolve.map_or(1.0, f64::from), 0.0, 1.0);
        let index = parsed.optical_density.map(f64::from);
        if opacity == 0.0 {
            let text = format!("material {name} has no opacity: its faces do not show");
            log.notice(Some(entry.at), &text);
        }
        if let Some(index) = index.filter(|&index| index <= 0.0) {
            log.notice(Some(entry.at), &format!("material {name}: `Ni` of {index} is no refractive index"));
        }
        let color = diffuse.unwrap_or(Rgb::ONE);
        Self {
            name: entry.name.clone(),
            color,
            diffuse: Rgb::ONE,
            ambient: if illum == Some(0) { Rgb::ZERO } else { ambient.map_or(Rgb::ONE, |ka| share(ka, color)) },
            highlight: specular
                .filter(|_| exponent > 0.0 && illum.is_none_or(|illum| illum >= 2))
                .map(|strength| Highlight { strength, exponent }),
            mirror: specular.filter(|_| matches!(illum, Some(3..=7))).map(|ks| ks.min(Rgb::ONE)),
            opacity,
            index: index.filter(|&index| {
                let bends = matches!(illum, None | Some(4 | 6 | 7 | 9));
                bends && opacity < 1.0 && index > 0.0 && index != 1.0
            }),
            texture: None,
            line: Some(Line { file: log.file().into(), number: entry.at.line }),
        }
    }
}

/// `a / b` by channel, at most 1; 1 where there is nothing to have a share of.
fn share(a: Rgb, b: Rgb) -> Rgb {
    let channel = |a: f64, b: f64| if a < b { a / b } else { 1.0 };
    Rgb::new(channel(a.x, b.x), channel(a.y, b.y), channel(a.z, b.z))
}
