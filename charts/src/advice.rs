//! Which setting to take for a given error or time.

use crate::{
    measure::{Measured, in_short},
    table::short,
};

/// The cheapest of the settings whose RMSE is at most `error`.
#[must_use]
pub fn within_error(measured: &[Measured], error: f64) -> Option<&Measured> {
    let good = measured.iter().filter(|m| m.difference.rmse <= error);
    good.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
}

/// The best of the settings that take at most `seconds` of one thread.
#[must_use]
pub fn within_time(measured: &[Measured], seconds: f64) -> Option<&Measured> {
    let quick = measured.iter().filter(|m| m.seconds <= seconds);
    quick.min_by(|a, b| a.difference.rmse.total_cmp(&b.difference.rmse))
}

/// Advice in sentences, for a few errors and a few times.
#[must_use]
pub fn sentences(measured: &[Measured]) -> Vec<String> {
    let mut sentences = vec![];
    let errors = [("16/255", 16.0), ("8/255", 8.0), ("4/255", 4.0), ("2/255", 2.0), ("1/255", 1.0)];
    for (name, error) in errors {
        sentences.push(match within_error(measured, error / 255.0) {
            Some(m) => {
                format!("Within an error (RMSE) of {name} the cheapest setting is {}: {}.", m.label, in_short(m))
            }
            None => format!("Nothing tried here is within an error (RMSE) of {name}."),
        });
    }
    let fastest = measured.iter().map(|m| m.seconds).fold(f64::INFINITY, f64::min);
    let slowest = measured.iter().map(|m| m.seconds).fold(0.0, f64::max);
    // Times that differ by equal factors between the fastest and the slowest.
    for share in [0.25, 0.5, 0.75, 1.0] {
        let seconds = fastest * snell_components::math::pow(slowest / fastest, share);
        if let Some(m) = within_time(measured, seconds) {
            sentences.push(format!("Within {} s the best setting is {}: {}.", short(seconds), m.label, in_short(m)));
        }
    }
    sentences.dedup();
    sentences.push(
        "`snell render --error E` and `--time T` choose by themselves: the first keeps an error with the least work, the second \
         lowers the error until the time is over."
            .into(),
    );
    sentences
}

#[cfg(test)]
mod tests {
    use super::*;
    use snell_systems::{
        compare::Difference,
        render::{Counts, Picture},
    };

    fn measured(label: &str, seconds: f64, rmse: f64) -> Measured {
        Measured {
            group: String::new(),
            label: label.into(),
            default: false,
            seconds,
            spread: (seconds, seconds),
            counts: Counts::default(),
            difference: Difference { rmse, ..Difference::default() },
            picture: Picture::black(1, 1),
        }
    }

    #[test]
    fn advice_takes_the_cheapest_and_the_best() {
        let all = [
            measured("quick", 1.0, 0.1),
            measured("middle", 3.0, 0.01),
            measured("waste", 4.0, 0.05),
            measured("slow", 9.0, 0.001),
        ];
        let label = |m: Option<&Measured>| m.map(|m| m.label.clone());
        assert_eq!(label(within_error(&all, 0.05)), Some("middle".into()));
        assert_eq!(label(within_error(&all, 0.0001)), None);
        assert_eq!(label(within_time(&all, 5.0)), Some("middle".into()));
        assert_eq!(label(within_time(&all, 0.5)), None);
        let told = sentences(&all).join(" ");
        assert!(told.contains("Within an error (RMSE) of 4/255 the cheapest setting is middle"), "{told}");
        assert!(told.contains("Within 9.00 s the best setting is slow"), "{told}");
    }
}
