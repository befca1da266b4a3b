//! The tree as a drawing.

use super::{
    text::{hex, hex_of, short},
    tree::{RayTree, Sample, Thing, TracedRay},
};
use crate::render::{Added, Dropped, Way};
use core::fmt::{self, Write};
use snell_components::color::Encoding;

const ROW: usize = 46;
const STEP: usize = 34;
const SWATCH: usize = 26;
const LEFT: usize = 24;
const TOP: usize = 74;
const MOST_STEPS: usize = 24;
/// Widths of a character of the two sizes of text, about.
const WIDE: f64 = 7.6;
const NARROW: f64 = 6.4;

impl RayTree {
    /// Draws the tree: a row for every ray, its branches below it and to the right. A square has the colour of what the
    /// ray and all that it leads to bring to the pixel; lines are as wide as the light that goes along them weighs.
    #[must_use]
    pub fn svg(&self) -> String {
        let mut drawing = Drawing { encoding: self.encoding, ..Drawing::default() };
        for (number, sample) in self.samples.iter().enumerate() {
            // A string takes everything that is written to it.
            let _ = drawing.sample(sample, (self.samples.len() > 1).then_some(number + 1));
        }
        let (width, height) = (drawing.width.max(480.0).ceil(), TOP + drawing.row * ROW + 12);
        let (Self { x, y, .. }, color) = (self, hex(self));
        let light = self.light.map(|channel| format!("{channel:.4}")).join(", ");
        format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" font-family="system-ui, sans-serif">
<rect width="100%" height="100%" fill="#fbfbf9"/>
<rect x="{LEFT}" y="18" width="36" height="36" rx="4" fill="{color}" stroke="#00000040"/>
<text x="{}" y="33" font-size="15" font-weight="600" fill="#1b1b1a">Pixel {x}, {y}</text>
<text x="{}" y="51" font-size="12" fill="#63635e">{color} · linear light {light}</text>
{}{}</svg>
"##,
            LEFT + 48,
            LEFT + 48,
            drawing.lines,
            drawing.rows,
        )
    }
}

#[derive(Default)]
struct Drawing {
    encoding: Encoding,
    lines: String,
    rows: String,
    row: usize,
    width: f64,
}

impl Drawing {
    fn sample(&mut self, sample: &Sample, number: Option<usize>) -> fmt::Result {
        if let Some(number) = number {
            let y = TOP + self.row * ROW + 28;
            let light = short(&sample.light);
            let style = r##"font-size="13" font-weight="600" fill="#1b1b1a""##;
            writeln!(self.rows, r#"<text x="{LEFT}" y="{y}" {style}>Ray {number} through the pixel: {light}</text>"#)?;
            self.row += 1;
        }
        let whole = whole(sample);
        // Middles of the squares of the rays so far.
        let mut places: Vec<(usize, usize)> = vec![];
        for (i, ray) in sample.rays.iter().enumerate() {
            let (x, y) = self.place(ray.depth);
            if let Some((from_x, from_y)) = ray.start.parent.and_then(|parent| places.get(parent)) {
                self.line((*from_x, *from_y), (x, y), &ray.start.weight, false)?;
            }
            places.push((x, y));
            let own = sample.contributions.iter().filter(|part| part.ray == i && part.what != Added::BeyondDepth);
            let amount = own.fold([0.0; 3], |sum, part| [0, 1, 2].map(|c| sum[c] + part.amount[c]));
            let color = whole.get(i).map_or([0.0; 3], |light| light.map(|channel| channel as f32));
            self.swatch((x, y), &hex_of(color, self.encoding))?;
            let (title, detail) = told(ray);
            let own = if amount == [0.0; 3] { String::new() } else { format!("brings {}", short(&amount)) };
            let weight = format!("weight {}", short(&ray.weight_at_end));
            let mut details = vec![weight, own, detail];
            details.retain(|part| !part.is_empty());
            self.text((x, y), &title, &details.join(" · "))?;
            self.row += 1;
            for dropped in &ray.dropped {
                let at = self.place(ray.depth + 1);
                self.line((x, y), at, &dropped.start.weight, true)?;
                let (way, weight) = (way(dropped.start.way), short(&dropped.start.weight));
                let why = match dropped.why {
                    Dropped::Cut => "weighs less than the cut-off",
                    Dropped::TooDeep => "beyond the depth, taken as grey background",
                };
                let place = dropped.start.effect.as_ref().map_or(String::new(), line);
                self.text(at, &format!("{way}: not followed"), &format!("{why}: weight {weight}{place}"))?;
                self.row += 1;
            }
        }
        Ok(())
    }

    /// The middle of a square in the next row.
    fn place(&self, depth: usize) -> (usize, usize) {
        (LEFT + depth.min(MOST_STEPS) * STEP + SWATCH / 2, TOP + self.row * ROW + ROW / 2)
    }

    fn line(&mut self, from: (usize, usize), to: (usize, usize), weight: &[f64; 3], dashed: bool) -> fmt::Result {
        let width = 1.0 + 5.0 * weight.iter().fold(0.0f64, |most, channel| most.max(*channel)).min(1.0);
        let dashes = if dashed { r#" stroke-dasharray="4 3""# } else { "" };
        let ((x0, y0), (x1, y1)) = (from, to);
        writeln!(
            self.lines,
            r##"<path d="M{x0} {y0}V{y1}H{x1}" fill="none" stroke="#b9b8b0" stroke-width="{width:.1}" stroke-linejoin="round"{dashes}/>"##
        )
    }

    fn swatch(&mut self, (x, y): (usize, usize), color: &str) -> fmt::Result {
        let (x, y) = (x - SWATCH / 2, y - SWATCH / 2);
        writeln!(
            self.rows,
            r##"<rect x="{x}" y="{y}" width="{SWATCH}" height="{SWATCH}" rx="3" fill="{color}" stroke="#00000050"/>"##
        )
    }

    fn text(&mut self, (x, y): (usize, usize), title: &str, detail: &str) -> fmt::Result {
        let x = x + SWATCH / 2 + 10;
        for (text, y, size, color, wide) in
            [(title, y - 3, 13, "#1b1b1a", WIDE), (detail, y + 13, 11, "#63635e", NARROW)]
        {
            let shown = escaped(text);
            writeln!(self.rows, r#"<text x="{x}" y="{y}" font-size="{size}" fill="{color}">{shown}</text>"#)?;
            self.width = self.width.max(x as f64 + text.chars().count() as f64 * wide + 20.0);
        }
        Ok(())
    }
}

/// What every ray and all that it leads to bring; rounded otherwise than the pixel.
fn whole(sample: &Sample) -> Vec<[f64; 3]> {
    let mut whole = vec![[0.0; 3]; sample.rays.len()];
    let add = |whole: &mut Vec<[f64; 3]>, to: usize, light: [f64; 3]| {
        if let Some(sum) = whole.get_mut(to) {
            *sum = [0, 1, 2].map(|c| sum[c] + light[c]);
        }
    };
    for part in &sample.contributions {
        add(&mut whole, part.ray, part.amount);
    }
    // Whoever sends a ray stands before it.
    for (number, ray) in sample.rays.iter().enumerate().rev() {
        if let (Some(parent), Some(light)) = (ray.start.parent, whole.get(number).copied()) {
            add(&mut whole, parent, light);
        }
    }
    whole
}

fn way(way: Way) -> &'static str {
    match way {
        Way::Camera => "from the camera",
        Way::Mirrored => "mirrored",
        Way::Transmitted => "let through",
        Way::Onward => "onward",
    }
}

/// What a ray met, and what of it matters for what it brings.
fn told(ray: &TracedRay) -> (String, String) {
    let way = way(ray.start.way);
    let effect = ray.start.effect.as_ref().and_then(|effect| effect.component);
    let by = effect.map_or(String::new(), |tag| format!(" by {tag}"));
    let Some(met) = &ray.met else { return (format!("{way}{by}: meets nothing"), "shows the background".into()) };
    let name = met.object.name.as_deref().unwrap_or("nameless");
    let title = format!("{way}{by}: {name}{}", line(&met.object));
    // Every term looks at the same lamps.
    let lamps = ray.terms.iter().map(|term| &term.lamps).find(|lamps| !lamps.is_empty());
    let lamps = lamps.into_iter().flatten().map(|lamp| {
        let name = lamp.lamp.name.as_deref().unwrap_or("a lamp");
        match (lamp.visible, lamp.in_the_way.first()) {
            (None, _) => format!("{name} off this side"),
            (Some([0.0, 0.0, 0.0]), Some(thing)) => format!("{name} behind {}", thing.name.as_deref().unwrap_or("?")),
            (Some([0.0, 0.0, 0.0]), None) => format!("{name} hidden"),
            (Some([1.0, 1.0, 1.0]), _) => format!("{name} visible"),
            (Some(share), _) => format!("{name} {} visible", short(&share)),
        }
    });
    (title, lamps.collect::<Vec<_>>().join(" · "))
}

fn line(thing: &Thing) -> String {
    thing.line.as_ref().map_or(String::new(), |line| format!(" ({line})"))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
