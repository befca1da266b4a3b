//! The picture of a run: how often each method fails, over the size of things and their distance from the origin.

use crate::suite::{Outcome, Row, cases};
use snell_charts::canvas::{self, Canvas, DrawingBackend, Figure, HPos, RGBColor, Refused, VPos};

const INK: RGBColor = RGBColor(34, 34, 34);
const GREY: RGBColor = RGBColor(110, 110, 110);
/// Width and height of a cell.
const CELL: (i32, i32) = (54, 26);
/// Where the fields begin; to the left stand the sizes.
const LEFT: i32 = 96;
/// From the left edge of a field to that of the next.
const FIELD: i32 = 4 * CELL.0 + 22;
/// Above the first case.
const HEAD: i32 = 118;
/// Above the cells of a case: its name, the names of the methods, the distances.
const TITLES: i32 = 78;
/// Below the cells of a case.
const GAP: i32 = 52;

/// From never to nearly always: least rate, colour, colour of letters on it, words.
const STEPS: [(f64, RGBColor, RGBColor, &str); 6] = [
    (0.0, RGBColor(216, 240, 221), INK, "none"),
    (f64::MIN_POSITIVE, RGBColor(253, 236, 200), INK, "below 0.01 %"),
    (1e-4, RGBColor(249, 199, 132), INK, "below 1 %"),
    (1e-2, RGBColor(238, 138, 74), INK, "below 20 %"),
    (0.2, RGBColor(207, 74, 44), RGBColor(255, 255, 255), "below 60 %"),
    (0.6, RGBColor(125, 26, 26), RGBColor(255, 255, 255), "60 % and more"),
];

/// The picture as SVG.
///
/// # Errors
/// What the drawing library refuses.
pub fn svg(outcome: &Outcome) -> Result<String, Refused> {
    canvas::svg(&Fields::of(outcome))
}

/// The picture as a PNG file.
///
/// # Errors
/// What the drawing library refuses.
pub fn png(outcome: &Outcome) -> Result<Vec<u8>, Refused> {
    canvas::png(&Fields::of(outcome))
}

/// What one method did in a case that was tried over sizes and distances.
struct Field<'a> {
    method: &'a str,
    rows: Vec<&'a Row>,
}

/// A case with its methods, ours first.
struct Group<'a> {
    title: String,
    about: &'static str,
    fields: Vec<Field<'a>>,
}

struct Fields<'a> {
    groups: Vec<Group<'a>>,
    /// Tries behind a cell, least and most.
    tries: (u64, u64),
}

impl<'a> Fields<'a> {
    fn of(outcome: &'a Outcome) -> Self {
        let mut groups: Vec<Group<'a>> = vec![];
        let mut tries = (u64::MAX, 0);
        for row in outcome.rows.iter().filter(|row| row.at.is_some()) {
            tries = (tries.0.min(row.tries), tries.1.max(row.tries));
            let title = format!("{} {}", row.id, row.case);
            if groups.last().is_none_or(|group| group.title != title) {
                let about = cases().iter().find(|case| case.id == row.id).map_or("", |case| case.about);
                groups.push(Group { title, about, fields: vec![] });
            }
            let Some(Group { fields, .. }) = groups.last_mut() else { continue };
            match fields.iter_mut().find(|field| field.method == row.method) {
                Some(field) => field.rows.push(row),
                None => fields.push(Field { method: &row.method, rows: vec![row] }),
            }
        }
        for group in &mut groups {
            group.fields.sort_by_key(|field| !field.method.starts_with("Snell"));
        }
        Self { groups, tries }
    }
}

/// Values of a coordinate of the rows, each once, least first.
fn values(rows: &[&Row], of: impl Fn((f64, f64)) -> f64) -> Vec<f64> {
    let mut values: Vec<f64> = rows.iter().filter_map(|row| row.at).map(of).collect();
    values.sort_by(f64::total_cmp);
    values.dedup_by(|a, b| (*a - *b).abs() <= 1e-9 * b.abs());
    values
}

impl Field<'_> {
    fn sizes(&self) -> Vec<f64> {
        values(&self.rows, |(scale, _)| scale)
    }

    /// Distances from the origin, and whether they are in sizes of the thing rather than in units of the scene.
    fn distances(&self) -> (Vec<f64>, bool) {
        let absolute = values(&self.rows, |(_, offset)| offset);
        let relative = values(&self.rows, |(scale, offset)| offset / scale);
        if relative.len() < absolute.len() { (relative, true) } else { (absolute, false) }
    }

    fn rows_of_cells(&self) -> i32 {
        self.sizes().len() as i32
    }
}

impl Group<'_> {
    fn rows_of_cells(&self) -> i32 {
        self.fields.iter().map(Field::rows_of_cells).max().unwrap_or(0)
    }
}

impl Figure for Fields<'_> {
    fn size(&self) -> (u32, u32) {
        let widest = self.groups.iter().map(|group| group.fields.len()).max().unwrap_or(0).max(3) as i32;
        let tall: i32 = self.groups.iter().map(|group| TITLES + group.rows_of_cells() * CELL.1 + GAP).sum();
        ((LEFT + widest * FIELD + 10) as u32, (HEAD + tall) as u32)
    }

    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<'_, B>) -> Result<(), Refused>
    where
        B::ErrorType: 'static,
    {
        let text = |words: &str, at, size, color| canvas.text(words, at, size, color, HPos::Left, VPos::Center);
        text("How often rays go wrong, by the size of a thing and its distance from the origin", (16, 24), 20, INK)?;
        let (least, most) = self.tries;
        let tries = if least == most { format!("{least}") } else { format!("{least} to {most}") };
        text(
            &format!("Each square: the share of {tries} tries that fail. Paler is better; 0 means not one."),
            (16, 50),
            14,
            GREY,
        )?;
        let mut x = 16;
        for (_, color, _, words) in STEPS {
            canvas.rectangle((x, 70), (x + 22, 90), color)?;
            text(words, (x + 28, 80), 13, INK)?;
            x += 44 + canvas::width(words, 13);
        }
        let mut y = HEAD;
        for group in &self.groups {
            text(&group.title, (16, y), 17, INK)?;
            text(group.about, (16, y + 20), 13, GREY)?;
            for (n, field) in group.fields.iter().enumerate() {
                field.draw(canvas, (LEFT + n as i32 * FIELD, y + TITLES), n == 0)?;
            }
            y += TITLES + group.rows_of_cells() * CELL.1 + GAP;
        }
        Ok(())
    }
}

impl Field<'_> {
    /// Its cells from `(left, top)` on; sizes are written beside the first field alone.
    fn draw<B: DrawingBackend>(
        &self,
        canvas: &Canvas<'_, B>,
        (left, top): (i32, i32),
        first: bool,
    ) -> Result<(), Refused>
    where
        B::ErrorType: 'static,
    {
        let (sizes, (distances, relative)) = (self.sizes(), self.distances());
        canvas.text(self.method, (left, top - 30), 14, INK, HPos::Left, VPos::Center)?;
        for (column, distance) in (0..).zip(&distances) {
            let at = (left + column * CELL.0 + CELL.0 / 2, top - 10);
            canvas.text(&number(*distance), at, 12, GREY, HPos::Center, VPos::Center)?;
        }
        let bottom = top + sizes.len() as i32 * CELL.1;
        let unit = if relative { "distance from the origin, in sizes" } else { "distance from the origin, units" };
        canvas.text(unit, (left, bottom + 13), 12, GREY, HPos::Left, VPos::Center)?;
        for (line, size) in (0..).zip(&sizes) {
            let middle = top + line * CELL.1 + CELL.1 / 2 - 1;
            if first {
                let words = if line == 0 { format!("size {}", number(*size)) } else { number(*size) };
                canvas.text(&words, (left - 10, middle), 13, INK, HPos::Right, VPos::Center)?;
            }
            for (column, distance) in (0..).zip(&distances) {
                let here = |(scale, offset): (f64, f64)| {
                    let offset = if relative { offset / scale } else { offset };
                    scale == *size && (offset - distance).abs() <= 1e-9 * distance.abs()
                };
                let Some(row) = self.rows.iter().find(|row| row.at.is_some_and(here)) else { continue };
                let (x, y) = (left + column * CELL.0, top + line * CELL.1);
                let (color, ink) = colors(row.rate());
                canvas.rectangle((x, y), (x + CELL.0 - 2, y + CELL.1 - 2), color)?;
                canvas.text(&rate(row), (x + CELL.0 / 2 - 1, middle), 13, ink, HPos::Center, VPos::Center)?;
            }
        }
        Ok(())
    }
}

/// A number as people write it.
fn number(value: f64) -> String {
    if value == 0.0 || (0.1..1000.0).contains(&value) {
        return format!("{value}");
    }
    let exact = format!("{value:e}");
    if exact.len() <= 5 { exact } else { format!("{value:.1e}") }
}

fn rate(row: &Row) -> String {
    let percent = 100.0 * row.rate();
    match row.failures {
        0 => "0".into(),
        _ if percent >= 10.0 => format!("{percent:.0} %"),
        _ if percent >= 0.01 => format!("{percent:.2} %"),
        _ => format!("{percent:.0e} %"),
    }
}

/// The colour of a rate, and that of letters on it.
fn colors(rate: f64) -> (RGBColor, RGBColor) {
    let step = STEPS.iter().rfind(|(least, ..)| rate >= *least).unwrap_or(&STEPS[0]);
    (step.1, step.2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn darker_is_worse() {
        let blue = |rate| colors(rate).0.2;
        let rates = [0.0, 1e-7, 1e-3, 0.05, 0.5, 1.0];
        assert_eq!(colors(0.0).0, STEPS[0].1);
        assert!(rates.windows(2).all(|pair| blue(pair[0]) > blue(pair[1])));
        assert_eq!([0.0, 1.0, 1e-6, 1e4, 223_423.0].map(number), ["0", "1", "1e-6", "1e4", "2.2e5"]);
    }
}
