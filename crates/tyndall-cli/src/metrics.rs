//! How far one picture is from another that is taken for true.

use crate::picture::Picture;

/// Errors of a picture against the truth, over pixels and channels, of linear values.
///
/// All are relative to the truth's mean. A value that is not finite, in either picture, makes all of them infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureError {
    /// mean |a - b| / mean(b).
    pub rel_mae: f64,
    /// sqrt(mean (a - b)^2) / mean(b).
    pub rel_rmse: f64,
    /// 99th percentile of |a - b| / mean(b), linear between ranks.
    pub p99: f64,
    /// mean (a - b) / mean(b); positive where the picture is too bright.
    pub bias: f64,
}

impl PictureError {
    const INFINITE: Self = Self {
        rel_mae: f64::INFINITY,
        rel_rmse: f64::INFINITY,
        p99: f64::INFINITY,
        bias: f64::INFINITY,
    };
}

/// Why two pictures cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// The pictures have different sizes.
    #[error("expected {} x {} pixels, found {} x {}", expected[0], expected[1], found[0], found[1])]
    Size {
        /// The truth's width and height \[pixels].
        expected: [u32; 2],
        /// The picture's width and height \[pixels].
        found: [u32; 2],
    },
    /// A picture's pixels don't fill its size, or there are none, and nothing must not pass for equal.
    #[error("a picture of {} x {} must have as many pixels and more than 0, found {found}", size[0], size[1])]
    Pixels {
        /// Width and height \[pixels].
        size: [u32; 2],
        /// Number of pixels there are.
        found: usize,
    },
}

/// Measures `picture` against `truth`.
///
/// # Errors
/// Where the sizes differ or a picture is not whole.
pub fn compare(picture: &Picture, truth: &Picture) -> Result<PictureError, CompareError> {
    let (found, expected) = (values(picture)?, values(truth)?);
    if picture.size != truth.size {
        return Err(CompareError::Size {
            expected: truth.size,
            found: picture.size,
        });
    }
    if !found.iter().chain(&expected).all(|v| v.is_finite()) {
        return Ok(PictureError::INFINITE);
    }
    let differences: Vec<f64> = found.iter().zip(&expected).map(|(a, b)| a - b).collect();
    let mean_truth = mean(expected.iter().copied()).abs();
    let relative = |difference: f64| {
        if difference == 0.0 {
            0.0
        } else {
            difference / mean_truth
        }
    };
    Ok(PictureError {
        rel_mae: relative(mean(differences.iter().map(|d| d.abs()))),
        rel_rmse: relative(mean(differences.iter().map(|d| d * d)).sqrt()),
        p99: relative(percentile(&differences, 0.99)),
        bias: relative(mean(differences.iter().copied())),
    })
}

/// All channels of all pixels of a picture that is whole.
fn values(picture: &Picture) -> Result<Vec<f64>, CompareError> {
    let Picture { size, pixels } = picture;
    let area = size.iter().map(|&side| side as usize).product::<usize>();
    if pixels.is_empty() || pixels.len() != area {
        return Err(CompareError::Pixels {
            size: *size,
            found: pixels.len(),
        });
    }
    Ok(pixels
        .as_flattened()
        .iter()
        .copied()
        .map(f64::from)
        .collect())
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

/// The `fraction` quantile of the absolute values, linear between the two nearest ranks.
fn percentile(values: &[f64], fraction: f64) -> f64 {
    let mut sorted: Vec<f64> = values.iter().map(|v| v.abs()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let rank = fraction * (sorted.len() - 1) as f64;
    let (below, above) = (rank.floor() as usize, rank.ceil() as usize);
    sorted[below] + (sorted[above] - sorted[below]) * rank.fract()
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_testkit::{metrics, picture, samples};

    fn picture(values: &[f32]) -> Picture {
        Picture {
            size: [values.len() as u32, 1],
            pixels: values.iter().map(|&v| [v; 3]).collect(),
        }
    }

    #[test]
    fn errors_are_what_their_formulas_say() {
        // (picture, truth, rel_mae, rel_rmse, p99, bias), by hand.
        let eighth = 0.125_f64.sqrt();
        let cases: &[(&[f32], &[f32], [f64; 4])] = &[
            (&[1.0, 3.0], &[1.0, 3.0], [0.0; 4]),
            (&[2.0, 2.0], &[1.0, 3.0], [0.5, 0.5, 0.5, 0.0]),
            (&[2.0, 3.0], &[1.0, 3.0], [0.25, eighth, 0.5, 0.25]),
            (&[0.0, 3.0], &[1.0, 3.0], [0.25, eighth, 0.5, -0.25]),
            (&[0.0, 0.0], &[0.0, 0.0], [0.0; 4]),
        ];
        for (found, truth, expected) in cases {
            let error = compare(&picture(found), &picture(truth)).unwrap();
            let got = [error.rel_mae, error.rel_rmse, error.p99, error.bias];
            for (got, want) in got.iter().zip(expected) {
                assert!((got - want).abs() < 1e-15, "{found:?} {truth:?}: {error:?}");
            }
        }
    }

    #[test]
    fn the_percentile_is_linear_between_ranks() {
        // 101 values 0..=100: rank 99 is the value 99; of 0..=10, rank 9.9 lies between 9 and 10.
        let ramp = |n: u32| (0..=n).map(|i| -f64::from(i)).collect::<Vec<_>>();
        assert_eq!(percentile(&ramp(100), 0.99), 99.0);
        assert!((percentile(&ramp(10), 0.99) - 9.9).abs() < 1e-12);
        assert_eq!(percentile(&[7.0], 0.99), 7.0);
    }

    #[test]
    fn errors_are_those_of_the_tests_own_metrics() {
        let numbers = samples::in_box(5, 1000, [const { 0.0..=3.0 }; 6]);
        let halves = |from: usize| -> Vec<[f32; 3]> {
            let pixels = numbers.iter().map(|x| [x[from], x[from + 1], x[from + 2]]);
            pixels.collect()
        };
        let (found, truth) = (halves(0), halves(3));
        let kit = |pixels: &[[f32; 3]]| {
            let pixels = pixels.iter().map(|pixel| pixel.map(f64::from)).collect();
            picture::Picture::new([numbers.len(), 1], pixels).unwrap()
        };
        let expected = metrics::compare(&kit(&found), &kit(&truth)).unwrap();
        let picture = |pixels| Picture {
            size: [numbers.len() as u32, 1],
            pixels,
        };
        let error = compare(&picture(found), &picture(truth)).unwrap();
        assert_eq!(
            [error.rel_mae, error.rel_rmse, error.p99, error.bias],
            [
                expected.rel_mae,
                expected.rel_rmse,
                expected.p99,
                expected.bias
            ]
        );
    }

    #[test]
    fn values_that_are_not_finite_are_an_infinite_error() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for (a, b) in [
                ([bad, 1.0], [1.0, 1.0]),
                ([1.0, 1.0], [bad, 1.0]),
                ([bad; 2], [bad; 2]),
            ] {
                let error = compare(&picture(&a), &picture(&b)).unwrap();
                assert_eq!(error, PictureError::INFINITE, "{a:?} against {b:?}");
            }
        }
    }

    #[test]
    fn light_where_the_truth_is_black_is_an_infinite_error() {
        let error = compare(&picture(&[1e-9]), &picture(&[0.0])).unwrap();
        assert_eq!(error.rel_mae, f64::INFINITY);
    }

    #[test]
    fn pictures_that_are_not_whole_are_refused() {
        let whole = picture(&[1.0; 2]);
        for pixels in [vec![], vec![[1.0; 3]; 3]] {
            let found = pixels.len();
            let size = [2, 1];
            let broken = Picture { size, pixels };
            let refused = Err(CompareError::Pixels { size, found });
            assert_eq!(compare(&broken, &whole), refused);
            assert_eq!(compare(&whole, &broken), refused);
        }
    }
}
