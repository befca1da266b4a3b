//! The tree as text for people.

use super::tree::{DroppedRay, LampLight, Met, RayTree, Sample, Start, Term, Thing, TracedRay};
use crate::{
    image::levels8,
    render::{Added, Dropped, Picture, Way},
};
use core::fmt::{self, Display, Formatter};
use snell_components::color::Encoding;

/// Columns by which what a ray leads to is indented, and the most there are.
const INDENT: usize = 2;
const MOST_INDENT: usize = 40;

impl Display for RayTree {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { x, y, width, height, light, samples, .. } = self;
        writeln!(f, "pixel {x},{y} of {width}x{height}: linear light {}, shown as {}", exact(light), hex(self))?;
        for (number, sample) in samples.iter().enumerate() {
            if samples.len() > 1 {
                let share = match self.share_of(number) {
                    0.0 => ", only looked at".into(),
                    share => format!(", of which the pixel has {} %", short(&[100.0 * share; 3])),
                };
                let (number, count) = (number + 1, samples.len());
                writeln!(f, "\nray {number} of {count} through the pixel: {}{share}", exact(&sample.light))?;
            }
            write_sample(f, sample)?;
        }
        let count: usize = samples.iter().map(|sample| sample.contributions.len()).sum();
        let mean = if samples.len() > 1 { format!(" of {} rays", samples.len()) } else { String::new() };
        write!(f, "\n= {}: {count} {}{mean}", exact(light), plural(count, "contribution"))
    }
}

fn write_sample(f: &mut Formatter<'_>, sample: &Sample) -> fmt::Result {
    for (number, ray) in sample.rays.iter().enumerate() {
        let margin = " ".repeat((ray.depth * INDENT).min(MOST_INDENT));
        writeln!(f, "\n{margin}{} {}", number + 1, sent(&ray.start))?;
        let margin = format!("{margin}  ");
        write_ray(f, ray, &margin)?;
        // What is taken for rays beyond the depth stands with those rays.
        let brought = sample.contributions.iter().filter(|part| part.ray == number && part.what != Added::BeyondDepth);
        // A surface without a term of light brings nothing.
        let brought = brought.filter(|part| part.what != Added::Surface || !ray.terms.is_empty());
        for part in brought {
            let of = match part.what {
                Added::Background => "background",
                _ => "surface",
            };
            let (amount, weight, light) = (short(&part.amount), short(&part.weight), short(&part.light));
            writeln!(f, "{margin}+ {amount}  = weight {weight} × {of} {light}")?;
        }
        let mut beyond =
            sample.contributions.iter().filter(|part| part.ray == number && part.what == Added::BeyondDepth);
        for DroppedRay { start, why } in &ray.dropped {
            match why {
                Dropped::Cut => {
                    writeln!(f, "{margin}not followed: {}, less than the cut-off", sent(start))?;
                }
                Dropped::TooDeep => {
                    writeln!(f, "{margin}not followed: {}, beyond the depth", sent(start))?;
                    if let Some(part) = beyond.next() {
                        writeln!(f, "{margin}+ {}  = weight × mean of the background", short(&part.amount))?;
                    }
                }
            }
        }
    }
    Ok(())
}

fn write_ray(f: &mut Formatter<'_>, ray: &TracedRay, margin: &str) -> fmt::Result {
    if ray.weight_at_end != ray.start.weight {
        writeln!(f, "{margin}weight {} after what was swallowed on the way", short(&ray.weight_at_end))?;
    }
    let Some(Met { object, material, distance, point, normal, from_outside, .. }) = &ray.met else {
        return writeln!(f, "{margin}meets nothing");
    };
    let side = if *from_outside { "outside" } else { "inside" };
    let distance = number(*distance);
    writeln!(f, "{margin}meets {object} from {side} at distance {distance}, {}, normal {}", at(point), at(normal))?;
    if material.name.is_some() && material != object {
        writeln!(f, "{margin}material {material}")?;
    }
    for Term { effect, factor, light, amount, lamps } in &ray.terms {
        let tag = effect.component.unwrap_or_default();
        let place = place(effect);
        if tag == "Ambient" {
            let (factor, light) = (short(factor), short(light));
            writeln!(f, "{margin}{tag} {}  = {factor} × ambient light {light}{place}", short(amount))?;
            continue;
        }
        let factor = if factor == &[1.0; 3] { String::new() } else { format!("{} × ", short(factor)) };
        let sum = if lamps.is_empty() { "no lamps".into() } else { format!("lamps {}", short(light)) };
        writeln!(f, "{margin}{tag} {}  = {factor}{sum}{place}", short(amount))?;
        for lamp in lamps {
            writeln!(f, "{margin}  {}: {}", lamp.lamp, seen(lamp))?;
        }
    }
    Ok(())
}

/// How a ray came about.
fn sent(start: &Start) -> String {
    let (origin, direction, weight) = (at(&start.origin), at(&start.direction), short(&start.weight));
    let way = match start.way {
        Way::Camera => return format!("from the camera {origin} toward {direction}"),
        Way::Onward => return format!("goes on through this surface, which lies inside another body, from {origin}"),
        Way::Mirrored => "mirrored",
        Way::Transmitted => "let through",
    };
    let effect = start.effect.as_ref();
    let by = effect.and_then(|effect| effect.component).map_or(String::new(), |tag| format!(" by {tag}"));
    let color = start.wavelength.map_or(String::new(), |length| format!(", {} nm", number(length)));
    let place = effect.map_or(String::new(), place);
    format!("{way}{by} toward {direction}{color}, share {}, weight {weight}{place}", short(&start.share))
}

/// How a lamp is seen from a point, and what it adds.
fn seen(lamp: &LampLight) -> String {
    let names: Vec<_> = lamp.in_the_way.iter().map(Thing::to_string).collect();
    let behind = if names.is_empty() { String::new() } else { format!(" behind {}", names.join(", ")) };
    let parts = if lamp.looks == 1 { String::new() } else { format!(" ({} looks)", lamp.looks) };
    let state = match lamp.visible {
        None if lamp.unlit == lamp.looks => "does not shine here".into(),
        None => "lies behind the surface".into(),
        Some([0.0, 0.0, 0.0]) => format!("hidden{behind}"),
        Some([1.0, 1.0, 1.0]) => "visible".into(),
        Some(share) => format!("{} of it visible{behind}", short(&share)),
    };
    if lamp.light == [0.0; 3] { format!("{state}{parts}") } else { format!("{}, {state}{parts}", short(&lamp.light)) }
}

impl Display for Thing {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match &self.name {
            Some(name) => write!(f, "`{name}`")?,
            None => write!(f, "a nameless entity")?,
        }
        write!(f, "{}", place(self))
    }
}

/// ` (file:line)`, if it is known.
fn place(thing: &Thing) -> String {
    thing.line.as_ref().map_or(String::new(), |line| format!(" ({line})"))
}

/// The colour that is shown, as in `#rrggbb`.
pub(super) fn hex(tree: &RayTree) -> String {
    hex_of(tree.pixel, tree.encoding)
}

/// Light as the colour that shows it.
pub(super) fn hex_of(light: [f32; 3], encoding: Encoding) -> String {
    let levels = levels8(&Picture { width: 1, height: 1, pixels: vec![light] }, encoding);
    let [r, g, b] = levels.first().copied().unwrap_or_default();
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Light by channel, with all its digits.
fn exact([r, g, b]: &[f64; 3]) -> String {
    format!("({r:?}, {g:?}, {b:?})")
}

/// Light by channel, or one number where the channels are equal.
pub(super) fn short(light: &[f64; 3]) -> String {
    match light {
        [r, g, b] if r == g && g == b => number(*r),
        light => at(light),
    }
}

fn at([x, y, z]: &[f64; 3]) -> String {
    format!("({}, {}, {})", number(*x), number(*y), number(*z))
}

/// A number with four digits that count.
fn number(x: f64) -> String {
    if x == 0.0 {
        return "0".into();
    }
    let size = x.abs();
    if !(1e-4..1e7).contains(&size) {
        return format!("{x:.3e}");
    }
    let before = size.to_string().split('.').next().map_or(0, |digits| if digits == "0" { 0 } else { digits.len() });
    let text = format!("{x:.*}", 4usize.saturating_sub(before));
    let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
    if text == "-0" { "0".into() } else { text.into() }
}

fn plural(count: usize, noun: &str) -> String {
    if count == 1 { noun.into() } else { format!("{noun}s") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let shown = [0.0, 1.0, -0.25, 0.123_456, 12.345_67, 12_345.6, 1e-9, 2.5e12, -0.000_04].map(number);
        assert_eq!(shown, ["0", "1", "-0.25", "0.1235", "12.35", "12346", "1.000e-9", "2.500e12", "-4.000e-5"]);
        assert_eq!(short(&[0.5; 3]), "0.5");
    }
}
