//! How far one picture, or one list of numbers, is from another that is taken for true.

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

/// Why two things cannot be compared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CompareError {
    /// The pictures have different sizes.
    #[error("expected {} x {} pixels, found {} x {}", expected[0], expected[1], found[0], found[1])]
    Size {
        /// The truth's width and height \[pixels].
        expected: [usize; 2],
        /// The picture's width and height \[pixels].
        found: [usize; 2],
    },
    /// The lists have different lengths.
    #[error("expected {expected} values, found {found}")]
    Length {
        /// The truth's length.
        expected: usize,
        /// The other list's length.
        found: usize,
    },
    /// There is nothing to compare, and nothing must not pass for equal.
    #[error("expected values to compare, found none")]
    Empty,
}

/// Measures `picture` against `truth`.
///
/// # Errors
/// Where the sizes differ.
pub fn compare(picture: &Picture, truth: &Picture) -> Result<PictureError, CompareError> {
    if picture.size() != truth.size() {
        return Err(CompareError::Size {
            expected: truth.size(),
            found: picture.size(),
        });
    }
    let found = picture.pixels().as_flattened();
    let expected = truth.pixels().as_flattened();
    if !found.iter().chain(expected).all(|v| v.is_finite()) {
        return Ok(PictureError::INFINITE);
    }
    let differences: Vec<f64> = found.iter().zip(expected).map(|(a, b)| a - b).collect();
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

/// Where two lists of vectors differ most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// |found - expected| / max(|expected|, floor); infinite where either value is not finite.
    pub error: f64,
    /// Index into the lists.
    pub index: usize,
    /// Component of the vectors.
    pub component: usize,
    /// The value that is taken for true.
    pub expected: f64,
    /// The value that was measured.
    pub found: f64,
}

/// Finds the largest relative difference of two lists, e.g. of a WGSL function's results and its Rust twin's.
/// `floor` (> 0) is the magnitude below which differences count in proportion to `floor` itself.
///
/// # Errors
/// Where the lists' lengths differ or there is nothing in them.
pub fn worst<const C: usize>(
    found: &[[f32; C]],
    expected: &[[f64; C]],
    floor: f64,
) -> Result<Worst, CompareError> {
    if found.len() != expected.len() {
        return Err(CompareError::Length {
            expected: expected.len(),
            found: found.len(),
        });
    }
    let pairs = found.as_flattened().iter().zip(expected.as_flattened());
    pairs
        .enumerate()
        .map(|(i, (&found, &expected))| Worst {
            error: relative_difference(f64::from(found), expected, floor),
            index: i / C,
            component: i % C,
            expected,
            found: f64::from(found),
        })
        .max_by(|a, b| a.error.total_cmp(&b.error))
        .ok_or(CompareError::Empty)
}

fn relative_difference(found: f64, expected: f64, floor: f64) -> f64 {
    if found.is_finite() && expected.is_finite() {
        (found - expected).abs() / expected.abs().max(floor)
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(values: &[f64]) -> Picture {
        let pixels: Vec<_> = values.iter().map(|&v| [v; 3]).collect();
        Picture::new([values.len(), 1], pixels).unwrap()
    }

    #[test]
    fn errors_are_what_their_formulas_say() {
        // (picture, truth, rel_mae, rel_rmse, p99, bias), by hand.
        let cases: &[(&[f64], &[f64], [f64; 4])] = &[
            (&[1.0, 3.0], &[1.0, 3.0], [0.0; 4]),
            (&[2.0, 2.0], &[1.0, 3.0], [0.5, 0.5, 0.5, 0.0]),
            (
                &[2.0, 3.0],
                &[1.0, 3.0],
                [0.25, 0.125_f64.sqrt(), 0.5, 0.25],
            ),
            (
                &[0.0, 3.0],
                &[1.0, 3.0],
                [0.25, 0.125_f64.sqrt(), 0.5, -0.25],
            ),
            (&[0.0, 0.0], &[0.0, 0.0], [0.0; 4]),
        ];
        for (found, truth, [rel_mae, rel_rmse, p99, bias]) in cases {
            let error = compare(&picture(found), &picture(truth)).unwrap();
            for (got, want) in [
                (error.rel_mae, rel_mae),
                (error.rel_rmse, rel_rmse),
                (error.p99, p99),
                (error.bias, bias),
            ] {
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
    fn values_that_are_not_finite_are_an_infinite_error() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
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
    fn other_sizes_are_refused() {
        let (row, column) = (
            picture(&[1.0; 2]),
            Picture::new([1, 2], vec![[1.0; 3]; 2]).unwrap(),
        );
        assert_eq!(
            compare(&row, &column),
            Err(CompareError::Size {
                expected: [1, 2],
                found: [2, 1]
            })
        );
    }

    #[test]
    fn the_worst_value_is_found_where_it_is() {
        let worst = worst(&[[1.0, 2.0], [3.0, 4.5]], &[[1.0, 2.0], [3.0, 4.0]], 1.0).unwrap();
        assert_eq!((worst.index, worst.component, worst.error), (1, 1, 0.125));
        assert_eq!((worst.expected, worst.found), (4.0, 4.5));
    }

    #[test]
    fn worst_is_relative_above_the_floor_and_absolute_below() {
        for (found, expected, floor, error) in [
            (3.0, 2.0, 1.0, 0.5),
            (0.5, 0.0, 2.0, 0.25),
            (f32::NAN, 0.0, 1.0, f64::INFINITY),
            (1.0, f64::NAN, 1.0, f64::INFINITY),
            (f32::INFINITY, f64::INFINITY, 1.0, f64::INFINITY),
        ] {
            assert_eq!(
                worst(&[[found]], &[[expected]], floor).unwrap().error,
                error
            );
        }
    }

    #[test]
    fn lists_that_do_not_match_are_refused() {
        assert_eq!(worst::<1>(&[], &[], 1.0), Err(CompareError::Empty));
        assert_eq!(
            worst(&[[1.0]], &[[1.0], [2.0]], 1.0),
            Err(CompareError::Length {
                expected: 2,
                found: 1
            })
        );
    }
}
