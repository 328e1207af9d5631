//! The rectified shadow map S[alpha, gamma] (Chen 2011, section 3.2): where on each light ray of a slice the light ends,
//! as the angle beta of the view ray that meets it there.

use rayon::prelude::*;

use super::{EpipolarFrame, slices::Slices, tree::MinMaxTree};
use crate::{cpu::Shade, shadow::Shadows};

/// A shadow map rectified to slices, each with its min-max tree.
pub(crate) struct Rectified {
    frame: EpipolarFrame,
    rows: Vec<Row>,
}

/// One slice: samples of gamma over the range that is looked at.
struct Row {
    start: f64,
    step: f64,
    tree: MinMaxTree,
}

impl Rectified {
    /// `ranges` is the range of gamma that each slice's view rays cover (dynamic range selection); each is sampled
    /// `samples` times, as finely as the shadow map's texels where that is as many as a side has.
    pub(crate) fn new(
        frame: EpipolarFrame,
        slices: &Slices,
        ranges: &[[f64; 2]],
        samples: usize,
        shadows: &Shadows<'_>,
    ) -> Self {
        let row = |(slice, [start, end]): (usize, &[f64; 2])| {
            // A slice that no view ray looks at keeps one sample that nobody asks for.
            let count = if end > start { samples } else { 1 };
            let step = (end - start).max(0.0) / count as f64;
            let alpha = slices.alpha(slice);
            let angle = |i: usize| {
                let gamma = start + (i as f64 + 0.5) * step;
                let (origin, way) = frame.light_ray(alpha, gamma);
                frame.shadow_angle(gamma, shadows.light_end(origin, way)) as f32
            };
            let angles: Vec<f32> = (0..count).map(angle).collect();
            Row {
                start: *start,
                step,
                tree: MinMaxTree::new(&angles),
            }
        };
        Self {
            frame,
            rows: ranges.par_iter().enumerate().map(row).collect(),
        }
    }

    /// Appends the stretches of a view ray within `span` [m] that are in shadow.
    pub(crate) fn shades(&self, slice: usize, beta: f64, span: [f64; 2], shades: &mut Vec<Shade>) {
        let row = &self.rows[slice];
        let [from, to] = span.map(|s| (self.frame.gamma(beta, s) - row.start) / row.step);
        let distance = |leaf: usize| {
            let gamma = row.start + leaf as f64 * row.step;
            self.frame.crossing(beta, gamma).clamp(span[0], span[1])
        };
        let leaves = [from.max(0.0).floor() as usize, to.max(0.0).ceil() as usize];
        row.tree.dark_runs(beta as f32, leaves, |[a, b]| {
            shades.push(Shade {
                start: distance(a),
                end: distance(b),
                tint: [0.0; 3],
            });
        });
    }
}
