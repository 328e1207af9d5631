//! Equal quality and equal time: what brute force would have needed, or would have got ([`Marches`]).
//!
//! The *equal-quality* step count is the smallest whose error is at most the technique's. Marching's error falls like
//! 1 / N, but with noise: a step more can hit or miss a thin shaft. So the search is defined by what it does: steps are
//! doubled from 1 until the error is small enough, and between the last two counts bisected until they are within 3 %.
//! The count that is reported meets the target; one 3 % smaller was seen not to.
//!
//! The *equal-time* step count is where the line through two timed counts meets the technique's time: marching takes a
//! fixed time and the same again for every step.

use std::collections::BTreeMap;

use tyndall::techniques::{Technique, ray_march};

use super::{DrawnFrame, error_of};
use crate::{failure::Failure, metrics::PictureError, picture::Picture};

/// The most steps that are tried. Of a local light a software driver may not take so many, which then are never good
/// enough; see `ray-march`.
pub const MAX_STEPS: u32 = 32768;

/// Bisection ends where the counts on either side of the target differ by this share.
const RESOLUTION: f64 = 0.03;

/// Step counts through which the line of marching's time is drawn.
const TIMED_STEPS: [u32; 2] = [8, 64];

/// The steps of brute force for equal quality.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EqualQuality {
    /// The step count; [`MAX_STEPS`] where even that is not good enough.
    pub steps: u32,
    /// Errors at that count.
    pub error: PictureError,
    /// Whether they meet the target.
    pub reached: bool,
}

/// Ray marching in equal steps.
pub fn ray_march(steps: u32) -> Technique {
    Technique::RayMarch(ray_march::Params {
        steps,
        ..Default::default()
    })
}

/// Marching's errors on one drawn frame, each step count's measured once.
pub struct Marches<'a> {
    drawn: &'a DrawnFrame<'a>,
    /// The converged picture of the frame's shadow maps.
    truth: &'a Picture,
    known: BTreeMap<u32, PictureError>,
}

impl<'a> Marches<'a> {
    /// Nothing measured yet; `truth` is the converged picture of the frame's shadow maps.
    pub fn new(drawn: &'a DrawnFrame<'a>, truth: &'a Picture) -> Self {
        Self {
            drawn,
            truth,
            known: BTreeMap::new(),
        }
    }

    /// Searches for the fewest steps whose relMAE is at most `target`.
    ///
    /// # Errors
    /// [`Failure`] where the shot can't be marched.
    pub fn equal_quality(&mut self, target: f64) -> Result<EqualQuality, Failure> {
        let search = fewest_steps(|steps| {
            let error = self.error_at(steps)?;
            Ok((error, error.rel_mae <= target))
        });
        search.map(|(steps, error, reached)| EqualQuality {
            steps,
            error,
            reached,
        })
    }

    /// Marching's errors at a step count.
    ///
    /// # Errors
    /// [`Failure`] where the shot can't be marched.
    pub fn error_at(&mut self, steps: u32) -> Result<PictureError, Failure> {
        if let Some(known) = self.known.get(&steps) {
            return Ok(*known);
        }
        let error = error_of(&self.drawn.in_scatter(&ray_march(steps))?, self.truth)?;
        self.known.insert(steps, error);
        Ok(error)
    }
}

/// The two marches whose times say what a step takes.
pub fn timed_marches() -> [Technique; 2] {
    TIMED_STEPS.map(ray_march)
}

/// The time of a march \[ms], where the [`timed_marches`] took `few` and `many` \[ms].
pub fn time_of_steps(steps: u32, [few, many]: [f64; 2]) -> f64 {
    let [n_few, n_many] = TIMED_STEPS.map(f64::from);
    few + (many - few) / (n_many - n_few) * (f64::from(steps) - n_few)
}

/// The step count that takes `milliseconds`, where the [`timed_marches`] took `few` and `many` \[ms].
pub fn steps_in_time(milliseconds: f64, [few, many]: [f64; 2]) -> u32 {
    let [n_few, n_many] = TIMED_STEPS.map(f64::from);
    let slope = (many - few) / (n_many - n_few);
    let steps = n_few + (milliseconds - few) / slope;
    // Times too short to be told apart have no slope, and may give no number at all.
    (steps.clamp(1.0, MAX_STEPS.into()) as u32).max(1)
}

/// Doubling, then bisection. `measure` gives what was measured at a count, and whether it is good enough; so does the
/// result, with the count itself.
fn fewest_steps<T: Copy, E>(
    mut measure: impl FnMut(u32) -> Result<(T, bool), E>,
) -> Result<(u32, T, bool), E> {
    let (mut too_few, mut steps) = (0, 1);
    let (mut best, mut enough) = measure(steps)?;
    while !enough && steps < MAX_STEPS {
        too_few = steps;
        steps *= 2;
        (best, enough) = measure(steps)?;
    }
    if !enough {
        return Ok((steps, best, false));
    }
    while steps - too_few > 1 && f64::from(steps - too_few) > RESOLUTION * f64::from(steps) {
        let middle = too_few + (steps - too_few) / 2;
        match measure(middle)? {
            (found, true) => (steps, best) = (middle, found),
            (_, false) => too_few = middle,
        }
    }
    Ok((steps, best, true))
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::*;

    fn search(good_enough: impl Fn(u32) -> bool) -> (u32, bool, u32) {
        let mut evaluations = 0;
        let (steps, found, reached) = fewest_steps(|steps| {
            evaluations += 1;
            Ok::<_, Infallible>((steps, good_enough(steps)))
        })
        .unwrap();
        assert_eq!(found, steps, "the errors belong to the count");
        (steps, reached, evaluations)
    }

    #[test]
    fn the_search_finds_the_threshold_within_3_percent() {
        for threshold in [
            1, 2, 3, 5, 31, 32, 33, 100, 257, 511, 512, 3000, 5000, MAX_STEPS,
        ] {
            let (steps, reached, evaluations) = search(|steps| steps >= threshold);
            assert!(reached && steps >= threshold, "{threshold}: {steps}");
            let excess = f64::from(steps - threshold) / f64::from(threshold);
            assert!(excess <= RESOLUTION, "{threshold}: {steps}");
            assert!(evaluations <= 25, "{threshold}: {evaluations}");
        }
    }

    #[test]
    fn what_no_count_reaches_is_said() {
        assert_eq!(search(|_| false), (MAX_STEPS, false, 16));
    }

    #[test]
    fn time_is_a_line_in_the_steps() {
        let time = |steps: f64| 2.0 + 0.25 * steps;
        let points = TIMED_STEPS.map(|steps| time(steps.into()));
        for steps in [1, 8, 40, 64, 1000] {
            // Half a step more, so that rounding cannot take one away.
            assert_eq!(steps_in_time(time(f64::from(steps) + 0.5), points), steps);
            assert!((time_of_steps(steps, points) - time(f64::from(steps))).abs() < 1e-9);
        }
        assert_eq!(steps_in_time(0.0, points), 1);
        assert_eq!(steps_in_time(1e9, points), MAX_STEPS);
        assert_eq!(steps_in_time(5.0, [1.0, 1.0]), MAX_STEPS, "no slope");
        assert_eq!(steps_in_time(1.0, [1.0, 1.0]), 1, "no number");
    }
}
