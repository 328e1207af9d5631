//! The shadow map rectified to slices (Chen 2011, section 3.2) on the CPU: the twin of `rectify.wesl`.
//!
//! A leaf is a cell of light rays, as wide as the slice: it holds the least and the greatest S of all of them, so that
//! a view ray anywhere in the slice that passes the test at a node is lit, or dark, all along it.

use rayon::prelude::*;

use super::{
    grid::EpipolarGrid,
    tree::{LIT, MinMaxTree, Node, UNKNOWN},
};
use crate::shadow::{ShadowLine, Shadows, depths::DepthRanges};

/// The tree of every slice of a grid.
pub(crate) fn trees(grid: &EpipolarGrid, shadows: &Shadows<'_>) -> Vec<MinMaxTree> {
    let cells = Cells {
        grid,
        size: shadows.size().map(f64::from),
        shadows,
        depths: DepthRanges::new(shadows),
    };
    let slices = (0..grid.slices.count).into_par_iter();
    slices
        .map(|slice| MinMaxTree::new(cells.row(slice)))
        .collect()
}

struct Cells<'a> {
    grid: &'a EpipolarGrid,
    shadows: &'a Shadows<'a>,
    /// Width and height of a face \[texels].
    size: [f64; 2],
    depths: DepthRanges<'a>,
}

/// The border between two cells: its light rays at either side of the slice; `None` behind the map's light.
#[derive(Clone, Copy)]
struct Side {
    gamma: f64,
    corners: [Option<Corner>; 2],
}

#[derive(Clone, Copy)]
struct Corner {
    line: ShadowLine,
    texel: [f64; 2],
}

impl Cells<'_> {
    fn row(&self, slice: usize) -> impl ExactSizeIterator<Item = Node> {
        let [start, step] = self.grid.slices.start_and_step();
        let alphas = [slice, slice + 1].map(|n| start + n as f64 * step);
        let mut side = self.side(alphas, 0);
        (0..self.grid.samples).map(move |sample| {
            let next = self.side(alphas, sample + 1);
            let node = self.cell(&side, &next, step);
            side = next;
            node
        })
    }

    fn side(&self, alphas: [f64; 2], sample: usize) -> Side {
        let gamma = self.grid.gamma(sample);
        let corner = |alpha| {
            let (origin, direction) = self.grid.light_ray(alpha, gamma);
            let line = self.shadows.line(origin, direction)?;
            let texel = [line.uv.x * self.size[0], line.uv.y * self.size[1]];
            Some(Corner { line, texel })
        };
        Side {
            gamma,
            corners: alphas.map(corner),
        }
    }

    fn cell(&self, a: &Side, b: &Side, width: f64) -> Node {
        let corners = match [a.corners, b.corners] {
            [[None, None], [None, None]] => return LIT,
            [[Some(a), Some(b)], [Some(c), Some(d)]] => [a, b, c, d],
            _ => return UNKNOWN,
        };
        let face = corners[0].line.face;
        if corners.iter().any(|c| c.line.face != face) {
            return UNKNOWN;
        }
        let Some((low, high)) = self.texels(&corners, width) else {
            return LIT;
        };
        let inside = |i: usize, x: f64| x.clamp(0.0, self.size[i] - 1.0) as u32;
        let first = [inside(0, low[0]), inside(1, low[1])];
        let last = [inside(0, high[0]), inside(1, high[1])];
        let [farthest, nearest] = self.depths.over(face, first, last);
        if nearest <= 0.0 {
            return LIT;
        }
        let ends = |depth: f64| corners.map(|c| c.line.end(depth));
        let mut near = ends(nearest).into_iter().fold(f64::INFINITY, f64::min);
        let mut far = f64::INFINITY;
        let beside_map = (0..2).any(|i| low[i] < 0.0 || high[i] >= self.size[i]);
        if farthest > 0.0 && !beside_map {
            far = ends(farthest).into_iter().fold(f64::NEG_INFINITY, f64::max);
        }
        if self.grid.is_local() {
            // Distance to a plane of constant depth is convex over the cell: its middle may be nearer than its corners.
            let width = (b.gamma - a.gamma) + width;
            near *= 1.0 - width * width;
            far *= 1.0 + width * width;
        }
        node(self.grid.shadow_range([a.gamma, b.gamma], [near, far]))
    }

    /// First and last column and row that a cell may touch; `None` where all of it lies beside the map.
    fn texels(&self, corners: &[Corner; 4], width: f64) -> Option<([f64; 2], [f64; 2])> {
        let over = |i: usize, unite: fn(f64, f64) -> f64| {
            corners
                .iter()
                .map(|c| c.texel[i])
                .reduce(unite)
                .unwrap_or(0.0)
        };
        // The cell's ends are arcs, which bulge beyond their chords.
        let chord =
            |a: &Corner, b: &Corner| (a.texel[0] - b.texel[0]).hypot(a.texel[1] - b.texel[1]);
        let [a, b, c, d] = corners;
        let margin = 0.02 + 0.25 * chord(a, b).max(chord(c, d)) * width.min(1.0);
        let low = [0, 1].map(|i| (over(i, f64::min) - margin).floor());
        let high = [0, 1].map(|i| (over(i, f64::max) + margin).floor());
        let beside = (0..2).any(|i| high[i] < 0.0 || low[i] >= self.size[i]);
        (!beside).then_some((low, high))
    }
}

/// A range of S on the grid's scale, rounded outwards.
fn node([least, greatest]: [f64; 2]) -> Node {
    // Above f64's own error, and next to nothing of a step.
    const SLACK: f64 = 1e-6;
    [
        (least - SLACK).floor() as u16,
        (greatest + SLACK).ceil() as u16,
    ]
}
