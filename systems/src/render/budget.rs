//! Which rays are not followed, and what that may cost.

use crate::{extract::Ceiling, snapshot::Snapshot};
use snell_components::color::Rgb;

/// Decides which rays are not followed, for the tree of one ray through a pixel.
#[derive(Clone, Copy)]
pub(super) enum Cut<'a> {
    /// Those that weigh less than this.
    Weight(f64),
    /// None: an error is promised, but the scene tells no limit of what a ray brings.
    Never,
    /// Those that can bring no more than a part of what is left of the error.
    Bound {
        ceiling: &'a Ceiling,
        /// What the rays not followed could have added, per channel.
        spent: Rgb,
        /// What all rays not followed may add.
        allowed: f64,
    },
}

/// The part of what is left of the error that one ray may use up: without a limit the first ray would take all, and the
/// many small ones behind it would have to be followed.
const PART: f64 = 0.25;

/// The share of the error of a setting that is for rays not followed.
const SHARE: f64 = 0.5;

impl<'a> Cut<'a> {
    pub(super) fn of(snapshot: &'a Snapshot) -> Self {
        let settings = &snapshot.settings;
        if settings.error <= 0.0 {
            return Self::Weight(settings.cutoff);
        }
        match snapshot.ceiling.as_deref() {
            Some(ceiling) => Self::Bound { ceiling, spent: Rgb::ZERO, allowed: SHARE * settings.error },
            None => Self::Never,
        }
    }

    /// Whether a ray of this weight, behind which so many more may follow one another, is dropped.
    ///
    /// It could have added up to `weight` times the ceiling; all that is dropped never exceeds what is allowed.
    #[inline]
    pub(super) fn drops(&mut self, weight: Rgb, followers: u32) -> bool {
        match self {
            Self::Weight(least) => weight.max_element() < *least,
            Self::Never => false,
            Self::Bound { ceiling, spent, allowed } => {
                let most = weight * ceiling.of_ray(followers);
                let dropped = most.cmple((Rgb::splat(*allowed) - *spent) * PART).all();
                if dropped {
                    *spent += most;
                }
                dropped
            }
        }
    }

    /// The most that the rays dropped could have added to a channel; 0 without an error.
    pub(super) fn bound(&self) -> f64 {
        match self {
            Self::Bound { spent, .. } => spent.max_element(),
            Self::Weight(_) | Self::Never => 0.0,
        }
    }
}

/// The variance of a pixel's light that its sampling may leave, if what was cut behind its rays could have added so much
/// at most: two standard errors are what is left of the error. Where lights are sampled as well, half of it is theirs.
pub(super) fn variance_for_pixels(snapshot: &Snapshot, cut_bound: f64) -> f64 {
    let sigma = 0.5 * (snapshot.settings.error - cut_bound);
    sigma * sigma * if sampled_lamps(snapshot) > 0 { 0.5 } else { 1.0 }
}

/// The standard error at which the sampling of a lamp ends, for light that is multiplied by `weight` in the pixel;
/// none if no error is promised.
///
/// Two standard errors, and what may be cut, are the error for the pixel; a pixel is the mean of two rays at the least,
/// so that half of its variance is left for the places of rays. The weights of the points of a tree add up to one or
/// less, so their variances may go by the inverse of the weight: bright reflections of a penumbra are sampled more
/// finely than faint ones.
pub(super) fn lamp_error(snapshot: &Snapshot, weight: Rgb) -> Option<f64> {
    let error = snapshot.settings.error;
    let for_cuts = snapshot.ceiling.as_ref().filter(|ceiling| ceiling.rays_go_on()).map_or(0.0, |_| SHARE);
    (error > 0.0)
        .then(|| 0.5 * (1.0 - for_cuts) * error / (sampled_lamps(snapshot) as f64 * weight.max_element()).sqrt())
}

fn sampled_lamps(snapshot: &Snapshot) -> usize {
    snapshot.lights.sampling.iter().flatten().count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_dropped_never_exceeds_what_is_allowed() {
        let ceiling = Ceiling::flat(Rgb::new(2.0, 1.0, 0.5));
        let mut cut = Cut::Bound { ceiling: &ceiling, spent: Rgb::ZERO, allowed: 0.01 };
        let mut sum = Rgb::ZERO;
        let mut dropped = 0;
        for n in 0..10_000u32 {
            let weight = Rgb::new(1.0, 0.5, 0.25) / f64::from(1 + n * n % 9973);
            if cut.drops(weight, 3) {
                sum += weight * ceiling.of_ray(3);
                dropped += 1;
            }
        }
        assert!(dropped >= 10 && sum.max_element() <= 0.01 && sum.max_element() > 0.009, "{dropped}: {sum}");
        assert_eq!(cut.bound(), sum.max_element());
    }

    #[test]
    fn without_a_ceiling_nothing_is_dropped() {
        assert!(!Cut::Never.drops(Rgb::ZERO, 0));
        let (mut above, mut below) = (Cut::Weight(0.1), Cut::Weight(0.3));
        assert!(!above.drops(Rgb::splat(0.2), 0) && below.drops(Rgb::splat(0.2), 0));
    }
}
