//! Errors of a technique's pixels: counted as they come, for there are too many to be kept.

use crate::{measure::Sparse, picture::Picture};

/// Bins of a power of ten of errors.
const BINS: usize = 40;
/// The exponents of ten of the smallest error that is told from 0, and of the largest of a finite one's bin.
const EXPONENTS: [i32; 2] = [-9, 9];
/// Pixels and pictures that have a smaller share than this of what they would have if nothing blocked the light count as dark.
const DARK: f64 = 0.01;

/// Errors of a technique's pixels.
#[derive(Clone, Debug, Default)]
pub(super) struct Errors {
    /// Pixels by their errors, the logarithms of which are evenly spaced.
    bins: Vec<u64>,
    /// Pixels with a value that is not finite, compared or not.
    pub(super) not_finite: u64,
    /// The largest error.
    pub(super) largest: Located,
}

/// An error and where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Located {
    pub(super) error: f64,
    /// Number of the camera.
    pub(super) pose: usize,
    /// Column and row.
    pub(super) pixel: [u32; 2],
}

impl Errors {
    /// Counts a picture's pixels: those that are compared, and values that are not finite among all.
    pub(super) fn add(&mut self, pose: usize, picture: &Picture, truth: &Truth) {
        let is_broken = |pixel: &&[f32; 3]| !pixel.iter().all(|x| x.is_finite());
        self.not_finite += picture.pixels.iter().filter(is_broken).count() as u64;
        let found = truth.sparse.of_picture(picture);
        for (index, (found, truth_there)) in found.pixels.iter().zip(&truth.pixels).enumerate() {
            let error = truth_there.error_of(found);
            if error > self.largest.error {
                let pixel = truth.sparse.place(index, picture.size[0]);
                self.largest = Located { error, pose, pixel };
            }
            let bin = bin_of(error);
            self.bins.resize(self.bins.len().max(bin + 1), 0);
            self.bins[bin] += 1;
        }
    }

    /// Pixels that were compared.
    pub(super) fn pixels(&self) -> u64 {
        self.bins.iter().sum()
    }

    /// Pixels of more than this error, rounded to the next border of bins upwards.
    pub(super) fn past(&self, error: f64) -> u64 {
        self.bins.iter().skip(bin_of(error) + 1).sum()
    }

    /// The error that all but this share of pixels are below, rounded upwards.
    pub(super) fn all_but(&self, share: f64) -> f64 {
        let allowed = (share * self.pixels() as f64) as u64;
        let mut past = 0;
        for (bin, count) in self.bins.iter().enumerate().rev() {
            past += count;
            if past > allowed {
                return if bin == 0 {
                    0.0
                } else {
                    end_of(bin).min(self.largest.error)
                };
            }
        }
        0.0
    }
}

/// The bin of an error; 0 where it is too small to be told from none, the last where it is infinite.
fn bin_of(error: f64) -> usize {
    let [low, high] = EXPONENTS.map(f64::from);
    let exponent = if error.is_finite() {
        error.log10().min(high)
    } else {
        high + 1.0
    };
    ((exponent.max(low) - low) * BINS as f64).ceil() as usize
}

/// The largest error of a bin.
fn end_of(bin: usize) -> f64 {
    10.0_f64.powf(f64::from(EXPONENTS[0]) + bin as f64 / BINS as f64)
}

/// Some pixels of a picture that are taken for true, and the light that their errors are relative to.
pub(super) struct Truth {
    pixels: Vec<TruePixel>,
    sparse: Sparse,
}

/// A pixel of the truth.
struct TruePixel {
    light: [f32; 3],
    scale: f64,
}

impl Truth {
    /// Errors are relative to the pixel's own light, to the picture's mean, or to a hundredth of what both would be if nothing
    /// blocked the light, whichever is most. So a dark pixel that is taken for lit is 100 wrong at most.
    pub(super) fn new(picture: &Picture, unshadowed: &Picture, sparse: Sparse) -> Self {
        let least = mean(picture).max(DARK * mean(unshadowed));
        let brightest = |light: &[f32; 3]| light.map(f64::from).into_iter().fold(0.0, f64::max);
        let pixels = picture.pixels.iter().zip(&unshadowed.pixels);
        Self {
            pixels: pixels
                .map(|(light, lit)| TruePixel {
                    light: *light,
                    scale: least.max(brightest(light)).max(DARK * brightest(lit)),
                })
                .collect(),
            sparse,
        }
    }
}

impl TruePixel {
    /// The largest error of a channel; infinite where a value is not finite.
    fn error_of(&self, found: &[f32; 3]) -> f64 {
        let channels = found.iter().zip(self.light);
        let differences = channels.map(|(a, b)| (f64::from(*a) - f64::from(b)).abs());
        differences.fold(0.0, |worst: f64, difference| match difference {
            0.0 => worst,
            _ if difference.is_finite() => worst.max(difference / self.scale),
            _ => f64::INFINITY,
        })
    }
}

/// The mean of a picture's pixels and channels.
fn mean(picture: &Picture) -> f64 {
    let values = picture.pixels.as_flattened();
    values.iter().map(|x| f64::from(*x)).sum::<f64>() / values.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPARSE: Sparse = Sparse {
        step: 2,
        first: [1, 0],
    };

    fn picture(size: [u32; 2], pixels: &[f32]) -> Picture {
        Picture {
            size,
            pixels: pixels.iter().map(|&x| [x, 0.0, 0.0]).collect(),
        }
    }

    #[test]
    fn errors_are_found_placed_and_counted() {
        // The mean of pixels and channels is 1.
        let truth = Truth::new(
            &picture([2, 1], &[2.0, 4.0]),
            &picture([2, 1], &[2.0, 4.0]),
            SPARSE,
        );
        let found = [f32::NAN, 2.1, f32::INFINITY, 3.0, 0.0, 0.0, 0.0, 0.0];
        let mut errors = Errors::default();
        errors.add(7, &picture([4, 2], &found), &truth);
        assert_eq!((errors.pixels(), errors.not_finite), (2, 2));
        let Located { error, pose, pixel } = errors.largest;
        assert!((error - 0.25).abs() < 1e-6, "{error}");
        assert_eq!((pose, pixel), (7, [3, 0]));
        assert_eq!([0.04, 0.1, 0.3].map(|e| errors.past(e)), [2, 1, 0]);
        let half = errors.all_but(0.5);
        assert!((0.05..0.06).contains(&half), "{half}");
    }

    #[test]
    fn a_compared_pixel_that_is_not_finite_is_past_every_error() {
        let truth = Truth::new(&picture([1, 1], &[1.0]), &picture([1, 1], &[1.0]), SPARSE);
        for wrong in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let mut errors = Errors::default();
            errors.add(0, &picture([2, 2], &[0.0, wrong, 0.0, 0.0]), &truth);
            assert_eq!(
                (errors.past(1e300), errors.largest.error),
                (1, f64::INFINITY)
            );
        }
    }

    #[test]
    fn a_dark_picture_is_measured_by_what_nothing_would_block() {
        let truth = Truth::new(&picture([1, 1], &[0.0]), &picture([1, 1], &[300.0]), SPARSE);
        let mut errors = Errors::default();
        errors.add(0, &picture([2, 2], &[0.0, 300.0, 0.0, 0.0]), &truth);
        assert!((errors.largest.error - 100.0).abs() < 1e-3);
    }
}
