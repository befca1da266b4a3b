//! Where the ticks of an axis stand.

use super::Axis;
use snell_components::math;

/// An axis over a range of values.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    log: bool,
    min: f64,
    max: f64,
    /// Where zero is drawn on a logarithmic axis, if it is.
    pub(super) zero: Option<f64>,
}

impl Scale {
    /// A scale that holds all values, with some room; on a logarithmic axis the positive ones, and zero below them.
    pub(super) fn over(axis: &Axis, values: impl Iterator<Item = f64>) -> Self {
        let all: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        if !axis.log {
            let max = all.iter().copied().fold(0.0, f64::max);
            let step = step(if max > 0.0 { max } else { 1.0 });
            return Self { log: false, min: 0.0, max: (1.04 * max / step).ceil().max(1.0) * step, zero: None };
        }
        let positive = || all.iter().copied().filter(|value| *value > 0.0);
        let (least, most) = (positive().fold(f64::INFINITY, f64::min), positive().fold(0.0, f64::max));
        let (least, most) = if least <= most { (least, most) } else { (0.1, 1.0) };
        let has_zero = all.contains(&0.0);
        // A little beyond the outermost values, and at least one factor of ten.
        let room = math::pow(most / least, 0.06).max(1.25);
        let (mut min, mut max) = (least / room, most * room);
        if max / min < 10.0 {
            let middle = (max * min).sqrt();
            (min, max) = (middle / 3.3, middle * 3.3);
        }
        if has_zero {
            min /= math::pow(max / min, 0.1).max(2.0);
        }
        Self { log: true, min, max, zero: has_zero.then_some(min * math::pow(max / min, 0.03)) }
    }

    /// 0 at the least value, 1 at the largest.
    pub(super) fn place(&self, value: f64) -> f64 {
        if self.log {
            let value = if value > 0.0 { value } else { self.zero.unwrap_or(self.min) };
            math::log2(value / self.min) / math::log2(self.max / self.min)
        } else {
            (value - self.min) / (self.max - self.min)
        }
    }

    /// Values with a label, and values with a line only.
    pub(super) fn ticks(&self) -> (Vec<(f64, String)>, Vec<f64>) {
        if !self.log {
            let step = step(self.max);
            let count = (self.max / step).round() as u32;
            return ((0..=count).map(|i| f64::from(i) * step).map(|value| (value, label(value))).collect(), vec![]);
        }
        let decades = (math::floor(log10(self.min)) as i32..=log10(self.max).ceil() as i32).map(power_of_ten);
        let within =
            |value: &f64| *value >= self.min && *value <= self.max && self.zero.is_none_or(|zero| *value > zero * 1.5);
        let decades: Vec<f64> = decades.collect();
        let count = decades.iter().filter(|value| within(value)).count();
        let factors: &[f64] = if count < 2 {
            &[1.0, 2.0, 5.0]
        } else if count < 3 {
            &[1.0, 3.0]
        } else {
            &[1.0]
        };
        // Far-reaching axes tell every other factor of ten.
        let every = count.div_ceil(9).max(1) as i32;
        let told = |value: &f64| (log10(*value).round() as i32).rem_euclid(every) == 0 || factors.len() > 1;
        let mut labelled: Vec<f64> = decades
            .iter()
            .flat_map(|decade| factors.iter().map(move |factor| decade * factor))
            .filter(within)
            .collect();
        labelled.retain(told);
        let lines =
            decades.iter().flat_map(|decade| (1..10).map(move |n| decade * f64::from(n))).filter(within).collect();
        let mut labelled: Vec<_> = labelled.into_iter().map(|value| (value, label(value))).collect();
        labelled.extend(self.zero.map(|zero| (zero, "0".into())));
        (labelled, lines)
    }
}

fn log10(value: f64) -> f64 {
    math::log2(value) / math::log2(10.0)
}

/// As near as a number can be.
fn power_of_ten(n: i32) -> f64 {
    format!("1e{n}").parse().unwrap_or(f64::NAN)
}

/// A round step for about six ticks up to a value.
fn step(max: f64) -> f64 {
    let rough = max / 6.0;
    let decade = power_of_ten(log10(rough).floor() as i32);
    let factor =
        [1.0, 2.0, 5.0, 10.0].into_iter().find(|factor| factor * decade >= rough * (1.0 - 1e-9)).unwrap_or(10.0);
    factor * decade
}

/// A number as people write it.
fn label(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if (1e-3..1e5).contains(&value.abs()) {
        let text = format!("{value:.4}");
        let text = text.trim_end_matches('0').trim_end_matches('.');
        return text.into();
    }
    let exponent = (log10(value.abs()) + 1e-9).floor();
    let mantissa = value / power_of_ten(exponent as i32);
    format!("{}e{exponent:.0}", mantissa.round())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn linear_axes_start_at_zero_and_have_round_ticks() {
        let scale = Scale::over(&Axis::linear(""), [3.0, 47.0].into_iter());
        let (ticks, _) = scale.ticks();
        assert_eq!(ticks.iter().map(|tick| tick.1.as_str()).collect::<Vec<_>>(), ["0", "10", "20", "30", "40", "50"]);
        assert_eq!((scale.place(0.0), scale.place(50.0)), (0.0, 1.0));
    }

    #[test]
    fn logarithmic_axes_have_powers_of_ten_and_a_place_for_zero() {
        let scale = Scale::over(&Axis::log(""), [0.0, 1e-6, 0.2].into_iter());
        let (ticks, lines) = scale.ticks();
        let labels: Vec<_> = ticks.iter().map(|tick| tick.1.as_str()).collect();
        assert!(
            ["1e-6", "1e-5", "1e-4", "0.001", "0.01", "0.1", "0"].iter().all(|label| labels.contains(label)),
            "{labels:?}"
        );
        assert!(scale.place(0.0) > 0.0 && scale.place(0.0) < scale.place(1e-6) && scale.place(0.2) < 1.0);
        assert!(lines.len() > 30);
        let narrow = Scale::over(&Axis::log(""), [2.0, 3.0].into_iter()).ticks().0;
        assert!(narrow.len() >= 3, "{narrow:?}");
        assert!(Scale::over(&Axis::log(""), core::iter::empty()).place(0.5).is_finite());
    }
}
