//! The drawing of a chart.

use super::{Chart, Point, axis::Scale, front};
use crate::canvas::{self, Canvas, DrawingBackend, Figure, HPos, RGBColor, Refused, VPos, WHITE, width};

/// Width and height of a drawing in pixels.
pub const SIZE: (u32, u32) = (960, 600);

/// Where the plane lies: left, top, right, bottom. The legend stands to its right.
const PLANE: [i32; 4] = [92, 58, 706, 516];

const INK: RGBColor = RGBColor(34, 34, 34);
const GREY: RGBColor = RGBColor(120, 120, 120);
const PALE: RGBColor = RGBColor(226, 226, 226);
/// Colours that the colour-blind can tell apart (Okabe, Ito).
const COLORS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(190, 140, 0),
    RGBColor(86, 160, 213),
    RGBColor(60, 60, 60),
];

/// The chart as SVG.
///
/// # Errors
/// What the drawing library refuses.
pub fn svg(chart: &Chart) -> Result<String, Refused> {
    canvas::svg(chart)
}

/// The chart as a PNG file, 8 bits.
///
/// # Errors
/// What the drawing library refuses.
pub fn png(chart: &Chart) -> Result<Vec<u8>, Refused> {
    canvas::png(chart)
}

impl Figure for Chart {
    fn size(&self) -> (u32, u32) {
        SIZE
    }

    fn draw<B: DrawingBackend>(&self, canvas: &Canvas<'_, B>) -> Result<(), Refused>
    where
        B::ErrorType: 'static,
    {
        Drawing { canvas }.chart(self)
    }
}

/// A rectangle: left, top, right, bottom.
type Rect = [i32; 4];

fn overlap(a: &Rect, b: &Rect) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// The Pareto front of a chart.
#[derive(Default)]
struct Front {
    /// Of its points, from left to right.
    places: Vec<(i32, i32)>,
    /// The line that joins them.
    stairs: Vec<(i32, i32)>,
}

fn front_of(chart: &Chart, places: &[Vec<(i32, i32)>]) -> Front {
    if !chart.smaller_is_better {
        return Front::default();
    }
    let points = chart.series.iter().flat_map(|series| &series.points).map(|point| (point.x, point.y));
    let on_front = front(&points.collect::<Vec<_>>());
    let places = places.iter().flatten().zip(on_front);
    let mut places: Vec<_> = places.filter(|(_, on_front)| *on_front).map(|(place, _)| *place).collect();
    places.sort_unstable();
    let mut stairs = vec![];
    for pair in places.windows(2) {
        stairs.extend([pair[0], (pair[1].0, pair[0].1)]);
    }
    stairs.extend(places.last());
    Front { places, stairs }
}

struct Drawing<'a, B: DrawingBackend> {
    canvas: &'a Canvas<'a, B>,
}

impl<B: DrawingBackend> Drawing<'_, B>
where
    B::ErrorType: 'static,
{
    fn chart(&self, chart: &Chart) -> Result<(), Refused> {
        let points = || chart.series.iter().flat_map(|series| &series.points);
        let ends = || chart.guides.iter().flat_map(|guide| guide.ends);
        let spreads = || points().filter_map(|point| point.spread).flat_map(|(low, high)| [low, high]);
        let xs = points().map(|point| point.x).chain(spreads()).chain(ends().map(|end| end.0));
        let ys = points().map(|point| point.y).chain(ends().map(|end| end.1));
        let (x, y) = (Scale::over(&chart.x, xs), Scale::over(&chart.y, ys));
        let at = |px: f64, py: f64| {
            let [left, top, right, bottom] = PLANE;
            let across = f64::from(right - left) * x.place(px);
            let up = f64::from(bottom - top) * y.place(py);
            ((f64::from(left) + across).round() as i32, (f64::from(bottom) - up).round() as i32)
        };
        self.axes(chart, &x, &y)?;
        for (guide, n) in chart.guides.iter().zip(0..) {
            let [a, b] = guide.ends.map(|(x, y)| at(x, y));
            self.dashed(n, a, b)?;
        }
        let places: Vec<Vec<(i32, i32)>> = chart
            .series
            .iter()
            .map(|series| series.points.iter().map(|point| at(point.x, point.y)).collect())
            .collect();
        let Front { places: on_front, stairs } = front_of(chart, &places);
        self.canvas.line(&stairs, GREY, 2)?;
        for ((series, places), n) in chart.series.iter().zip(&places).zip(0..) {
            let color = COLORS[n % COLORS.len()];
            if series.joined {
                places.windows(2).try_for_each(|pair| self.canvas.line(pair, color, 2))?;
            }
            for (point, &place) in series.points.iter().zip(places) {
                if let Some((low, high)) = point.spread {
                    let ((low, y), (high, _)) = (at(low, point.y), at(high, point.y));
                    self.canvas.line(&[(low, y), (high, y)], color, 1)?;
                    self.canvas.line(&[(low, y - 3), (low, y + 3)], color, 1)?;
                    self.canvas.line(&[(high, y - 3), (high, y + 3)], color, 1)?;
                }
                let filled = !chart.smaller_is_better || on_front.contains(&place);
                self.marker(n, place, if point.marked { 8 } else { 5 }, color, filled)?;
            }
        }
        self.labels(chart, &places, &on_front, &stairs)?;
        self.legend(chart)
    }

    fn axes(&self, chart: &Chart, x: &Scale, y: &Scale) -> Result<(), Refused> {
        let [left, top, right, bottom] = PLANE;
        let across = |value: f64| left + (f64::from(right - left) * x.place(value)).round() as i32;
        let up = |value: f64| bottom - (f64::from(bottom - top) * y.place(value)).round() as i32;
        let (x_ticks, x_lines) = x.ticks();
        let (y_ticks, y_lines) = y.ticks();
        for value in x_lines {
            self.canvas.line(&[(across(value), top), (across(value), bottom)], RGBColor(243, 243, 243), 1)?;
        }
        for value in y_lines {
            self.canvas.line(&[(left, up(value)), (right, up(value))], RGBColor(243, 243, 243), 1)?;
        }
        for (value, label) in x_ticks {
            self.canvas.line(&[(across(value), top), (across(value), bottom + 5)], PALE, 1)?;
            self.canvas.text(&label, (across(value), bottom + 9), 15, INK, HPos::Center, VPos::Top)?;
        }
        for (value, label) in y_ticks {
            self.canvas.line(&[(left - 5, up(value)), (right, up(value))], PALE, 1)?;
            self.canvas.text(&label, (left - 9, up(value)), 15, INK, HPos::Right, VPos::Center)?;
        }
        self.canvas.line(&[(left, top), (left, bottom), (right, bottom)], INK, 1)?;
        self.canvas.text(&chart.title, (left, 18), 21, INK, HPos::Left, VPos::Top)?;
        self.canvas.text(&chart.x.label, ((left + right) / 2, bottom + 40), 16, INK, HPos::Center, VPos::Top)?;
        self.canvas.text_upward(&chart.y.label, (24, (top + bottom) / 2), 16, INK)
    }

    /// Names points where there is room.
    fn labels(
        &self,
        chart: &Chart,
        places: &[Vec<(i32, i32)>],
        on_front: &[(i32, i32)],
        stairs: &[(i32, i32)],
    ) -> Result<(), Refused> {
        let around = |(x, y): (i32, i32), r: i32| [x - r, y - r, x + r, y + r];
        let mut taken: Vec<Rect> = places.iter().flatten().map(|place| around(*place, 6)).collect();
        let along = |pair: &[(i32, i32)]| {
            let ((ax, ay), (bx, by)) = (pair[0], pair[1]);
            [ax.min(bx) - 1, ay.min(by) - 1, ax.max(bx) + 1, ay.max(by) + 1]
        };
        taken.extend(stairs.windows(2).map(along));
        let named = chart.series.iter().zip(places).flat_map(|(series, places)| series.points.iter().zip(places));
        let mut named: Vec<(&Point, (i32, i32))> = named
            .filter(|(point, place)| {
                !point.label.is_empty() && (on_front.is_empty() || point.marked || on_front.contains(place))
            })
            .map(|(point, place)| (point, *place))
            .collect();
        named.sort_by_key(|(point, place)| (!point.marked, *place));
        for (point, (x, y)) in named {
            let (width, height) = (width(&point.label, 13), 14);
            let right = [x + 10, y - height / 2];
            let left = [x - 10 - width, y - height / 2];
            let corners =
                [[x + 8, y - height - 6], [x + 8, y + 6], [x - 8 - width, y + 6], [x - 8 - width, y - height - 6]];
            let middles = [[x - width / 2, y - height - 9], [x - width / 2, y + 9]];
            let found = [right, corners[0], corners[1], left, middles[0], middles[1], corners[2], corners[3]]
                .into_iter()
                .map(|[left, top]| [left, top, left + width, top + height])
                .find(|rect| {
                    let inside = rect[0] > PLANE[0] && rect[1] > PLANE[1] && rect[2] < PLANE[2] && rect[3] < PLANE[3];
                    inside && !taken.iter().any(|other| overlap(rect, other))
                });
            if let Some(rect) = found {
                self.canvas.text(&point.label, (rect[0], rect[1] + height / 2), 13, INK, HPos::Left, VPos::Center)?;
                taken.push(rect);
            }
        }
        Ok(())
    }

    fn legend(&self, chart: &Chart) -> Result<(), Refused> {
        let left = PLANE[2] + 26;
        let mut y = PLANE[1] + 12;
        for (series, n) in chart.series.iter().zip(0..) {
            let color = COLORS[n % COLORS.len()];
            if series.joined {
                self.canvas.line(&[(left - 11, y), (left + 11, y)], color, 2)?;
            }
            self.marker(n, (left, y), 5, color, true)?;
            y += self.wrapped(&series.label, (left + 20, y))?;
        }
        for (guide, n) in chart.guides.iter().zip(0..) {
            self.dashed(n, (left - 11, y), (left + 11, y))?;
            y += self.wrapped(&guide.label, (left + 20, y))?;
        }
        if chart.smaller_is_better {
            y += 12;
            self.canvas.line(&[(left - 11, y + 4), (left, y + 4), (left, y - 4), (left + 11, y - 4)], GREY, 2)?;
            y += self.wrapped("Pareto front: nothing is better in both", (left + 20, y))?;
            self.marker(0, (left, y), 5, GREY, false)?;
            y += self.wrapped("hollow: something is better in both", (left + 20, y))?;
            y += 8;
            let (tip, end) = ((left - 8, y + 8), (left + 8, y - 8));
            self.canvas.line(&[end, tip], INK, 2)?;
            self.canvas.line(&[(tip.0, tip.1 - 7), tip, (tip.0 + 7, tip.1)], INK, 2)?;
            self.canvas.text("better", (left + 20, y), 15, INK, HPos::Left, VPos::Center)?;
        }
        Ok(())
    }

    /// Words in as many lines as they need in the legend; gives the height.
    fn wrapped(&self, words: &str, (x, mut y): (i32, i32)) -> Result<i32, Refused> {
        let start = y;
        let room = SIZE.0 as i32 - x - 8;
        let mut line = String::new();
        for word in words.split(' ') {
            if !line.is_empty() && width(&line, 14) + width(word, 14) + 6 > room {
                self.canvas.text(&line, (x, y), 14, INK, HPos::Left, VPos::Center)?;
                line.clear();
                y += 17;
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        self.canvas.text(&line, (x, y), 14, INK, HPos::Left, VPos::Center)?;
        Ok(y - start + 24)
    }

    /// The first guide has long dashes, the next ones dots.
    fn dashed(&self, n: usize, a: (i32, i32), b: (i32, i32)) -> Result<(), Refused> {
        let (step, share) = if n == 0 { (11.0, 0.7) } else { (6.0, 0.35) };
        let (dx, dy) = (f64::from(b.0 - a.0), f64::from(b.1 - a.1));
        let dashes = ((dx * dx + dy * dy).sqrt() / step).ceil().max(1.0);
        let at =
            |share: f64| ((f64::from(a.0) + dx * share).round() as i32, (f64::from(a.1) + dy * share).round() as i32);
        for n in 0..dashes as u32 {
            let start = f64::from(n) / dashes;
            self.canvas.line(&[at(start), at(start + share / dashes)], GREY, 1)?;
        }
        Ok(())
    }

    fn marker(&self, kind: usize, at: (i32, i32), r: i32, color: RGBColor, filled: bool) -> Result<(), Refused> {
        let (x, y) = at;
        let corners: &[(i32, i32)] = match kind % 5 {
            0 => &[],
            1 => &[(-1, -1), (1, -1), (1, 1), (-1, 1)],
            2 => &[(0, -1), (1, 1), (-1, 1)],
            3 => &[(0, -1), (1, 0), (0, 1), (-1, 0)],
            _ => &[(-1, -1), (1, -1), (0, 1)],
        };
        let inside = if filled { color } else { WHITE };
        if corners.is_empty() {
            return self.canvas.circle(at, r, inside, color);
        }
        let r = if kind % 5 == 3 { r + 2 } else { r };
        let mut outline: Vec<(i32, i32)> = corners.iter().map(|(dx, dy)| (x + dx * r, y + dy * r)).collect();
        self.canvas.filled(&outline, inside)?;
        outline.push(outline[0]);
        self.canvas.line(&outline, color, 2)
    }
}
