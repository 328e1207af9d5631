//! The rectangle of a light's plane that shadows need.

use glam::DVec2;

use super::{
    rectangle::Rectangle,
    seen::{Piece, Shadows},
};

/// Shadows at the rim that are left out, relative to the light that is seen or to all shadows.
const LOST: f64 = 1e-3;

/// Steps a side by which the rectangle moves: a whole number of texels of all usual maps.
const STEPS: f64 = 8.0;

/// Sizes of the rectangle from one power of two to the next.
const SIZES: f64 = 4.0;

/// The rectangle round all shadows that matter, within `whole` and turned as that is; `None` where there are none.
pub(super) fn rectangle(shadows: &Shadows, whole: &Rectangle) -> Option<Rectangle> {
    let all: f64 = shadows.pieces.iter().map(|piece| piece.worth).sum();
    // Also where one of them is NaN.
    let lost = LOST * all.min(shadows.lit).max(0.0) / 4.0;
    let axes = [whole.axis, whole.axis.perp()];
    let mut sides = [[0.0; 2]; 2];
    for (i, side) in sides.iter_mut().enumerate() {
        let center = whole.center.dot(axes[i]);
        let whole = [center - whole.half[i], center + whole.half[i]];
        *side = stepped(rim(&shadows.pieces, i, lost)?, whole);
    }
    let [x, y] = sides;
    Some(Rectangle {
        center: 0.5 * ((x[0] + x[1]) * axes[0] + (y[0] + y[1]) * axes[1]),
        axis: whole.axis,
        half: 0.5 * DVec2::new(x[1] - x[0], y[1] - y[0]),
    })
}

/// The range of a coordinate outside of which, at each end, no more than `lost` is.
fn rim(pieces: &[Piece], axis: usize, lost: f64) -> Option<[f64; 2]> {
    let end = |outwards: f64, reach: fn(&Piece) -> DVec2| {
        let mut ends: Vec<(f64, f64)> = pieces
            .iter()
            .filter(|piece| piece.worth > 0.0)
            .map(|piece| (outwards * reach(piece)[axis], piece.worth))
            .collect();
        ends.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
        let mut left_out = 0.0;
        let kept = ends.into_iter().find(|(_, worth)| {
            left_out += worth;
            left_out > lost
        });
        kept.map(|(end, _)| outwards * end)
    };
    Some([end(-1.0, |piece| piece.low)?, end(1.0, |piece| piece.high)?])
}

/// A range that holds this one, of few sizes and at few places; all of `whole` where that is no larger.
fn stepped([low, high]: [f64; 2], whole: [f64; 2]) -> [f64; 2] {
    let least = (high - low) * STEPS / (STEPS - 1.0);
    let size = ((least.log2() * SIZES).ceil() / SIZES).exp2();
    if !size.is_normal() || size >= whole[1] - whole[0] {
        return whole;
    }
    let step = size / STEPS;
    let low = (low / step).floor() * step;
    [low, low + size]
}
