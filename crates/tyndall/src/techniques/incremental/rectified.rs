//! The rectified shadow map S[alpha, gamma] (Chen 2011, section 3.2): where on each light ray of a slice the light ends,
//! as the angle beta of the view ray that meets it there.

use rayon::prelude::*;

use crate::{
    epipolar::{EpipolarFrame, slices::Slices},
    shadow::Shadows,
};

/// A shadow map rectified to slices.
pub(crate) struct Rectified {
    /// One row a slice.
    pub(crate) rows: Vec<Row>,
}

/// One slice: S at evenly spaced light rays over the range that is looked at.
pub(crate) struct Row {
    start: f64,
    step: f64,
    /// S \[rad]; sample i stands for gamma from `self.gamma(i)` to `self.gamma(i + 1)`.
    pub(crate) angles: Vec<f32>,
}

impl Row {
    /// gamma at the border before sample `i`; fractions are within a sample.
    pub(crate) fn gamma(&self, i: f64) -> f64 {
        self.start + i * self.step
    }

    /// Place of a gamma among the samples, from 0 to their number.
    pub(crate) fn place(&self, gamma: f64) -> f64 {
        ((gamma - self.start) / self.step).clamp(0.0, self.angles.len() as f64)
    }
}

impl Rectified {
    /// `ranges` is the range of gamma that each slice's view rays cover (dynamic range selection); each is sampled
    /// `samples` times, as finely as the shadow map's texels where that is as many as a side has.
    pub(crate) fn new(
        frame: &EpipolarFrame,
        slices: &Slices,
        ranges: &[[f64; 2]],
        samples: usize,
        shadows: &Shadows<'_>,
    ) -> Self {
        let row = |(slice, [start, end]): (usize, &[f64; 2])| {
            let looked_at = end > start;
            let mut row = Row {
                start: if looked_at { *start } else { 0.0 },
                step: if looked_at {
                    (end - start) / samples as f64
                } else {
                    1.0
                },
                angles: Vec::new(),
            };
            let alpha = slices.alpha(slice);
            let angle = |i: usize| {
                let gamma = row.gamma(i as f64 + 0.5);
                let (origin, direction) = frame.light_ray(alpha, gamma);
                frame.shadow_angle(gamma, shadows.light_end(origin, direction)) as f32
            };
            row.angles = (0..if looked_at { samples } else { 0 })
                .map(angle)
                .collect();
            row
        };
        Self {
            rows: ranges.par_iter().enumerate().map(row).collect(),
        }
    }
}
