//! Nearest and farthest depth over rectangles of a shadow map's texels, on the CPU.

use rayon::prelude::*;

use super::map::Shadows;

/// Squares of a level that a rectangle may span a side before a coarser level is read.
const SQUARES: u32 = 2;

/// A min-max pyramid of every face of a shadow map; the map itself is its level 0.
pub(crate) struct DepthRanges<'a> {
    shadows: &'a Shadows<'a>,
    /// From level 1 on: squares of 2^level texels a side.
    levels: Vec<Level>,
}

/// `(least, greatest)` value of the map's own convention, face by face, row by row.
struct Level {
    size: [usize; 2],
    ranges: Vec<[f32; 2]>,
}

impl<'a> DepthRanges<'a> {
    pub(crate) fn new(shadows: &'a Shadows<'a>) -> Self {
        let size = shadows.map.size.map(|n| n as usize);
        let depth = &shadows.map.depth;
        let mut levels = vec![Level::halved(size, depth, |d| [*d, *d])];
        while let Some(last) = levels.last().filter(|l| l.size != [1, 1]) {
            let next = Level::halved(last.size, &last.ranges, |r| *r);
            levels.push(next);
        }
        Self { shadows, levels }
    }

    /// `[farthest, nearest]`, 1 nearest to the light, of at least the texels `first..=last` of a face.
    pub(crate) fn over(&self, face: usize, first: [u32; 2], last: [u32; 2]) -> [f64; 2] {
        let texels = (last[0] - first[0]).max(last[1] - first[1]);
        let level = (texels / SQUARES)
            .checked_ilog2()
            .map_or(0, |l| l as usize + 1);
        let level = level.min(self.levels.len());
        let range = match level.checked_sub(1).map(|l| &self.levels[l]) {
            None => {
                let map = &self.shadows.map;
                let size = map.size.map(|n| n as usize);
                united(size, &map.depth, face, [first, last].map(usizes), |d| {
                    [*d, *d]
                })
            }
            Some(Level { size, ranges }) => {
                let corners = [first, last].map(|c| usizes(c).map(|n| n >> level));
                united(*size, ranges, face, corners, |r| *r)
            }
        };
        let [a, b] = range.map(|d| self.shadows.near_is_one(d));
        [a.min(b), a.max(b)]
    }
}

fn usizes(texel: [u32; 2]) -> [usize; 2] {
    texel.map(|n| n as usize)
}

fn unite(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// The range of a face's squares from one corner to the other, both of them included.
fn united<T>(
    [width, height]: [usize; 2],
    squares: &[T],
    face: usize,
    [first, last]: [[usize; 2]; 2],
    range: impl Fn(&T) -> [f32; 2],
) -> [f32; 2] {
    let mut all = [f32::INFINITY, f32::NEG_INFINITY];
    for y in first[1]..=last[1] {
        let row = (face * height + y) * width;
        for square in &squares[row + first[0]..=row + last[0]] {
            all = unite(all, range(square));
        }
    }
    all
}

impl Level {
    /// Squares twice as wide as those of `above`; the last of an odd number stands alone.
    fn halved<T: Sync>(
        [width, height]: [usize; 2],
        above: &[T],
        range: impl Fn(&T) -> [f32; 2] + Sync,
    ) -> Self {
        let size = [width.div_ceil(2), height.div_ceil(2)];
        let faces = above.len() / (width * height);
        let mut ranges = vec![[0.0; 2]; faces * size[0] * size[1]];
        let row = |(i, row): (usize, &mut [[f32; 2]])| {
            let (face, y) = (i / size[1], i % size[1]);
            let line = |y: usize| {
                let first = (face * height + y.min(height - 1)) * width;
                &above[first..first + width]
            };
            let pairs = line(2 * y).chunks(2).zip(line(2 * y + 1).chunks(2));
            for (square, (top, bottom)) in row.iter_mut().zip(pairs) {
                let four = top.iter().chain(bottom).map(&range);
                *square = four.fold([f32::INFINITY, f32::NEG_INFINITY], unite);
            }
        };
        ranges.par_chunks_mut(size[0]).enumerate().for_each(row);
        Self { size, ranges }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        frame::{Emitter, ShadowProjection},
        inputs::{CpuLightInputs, ShadowMap},
    };
    use tyndall_testkit::samples::in_box;

    /// Odd sizes and every face of a cube included: no texel of a rectangle lies beyond its range, and no range is wider
    /// than that of the rectangle with one square of its level more at each side.
    #[test]
    fn ranges_hold_their_texels_and_few_others() {
        let emitter = Emitter::Point {
            position: [0.0; 3],
            intensity: [1.0; 3],
            radius: 0.0,
        };
        for (size, reversed_depth) in [([37, 21], true), ([64, 64], false), ([1, 1], true)] {
            let count = 6 * size[0] as usize * size[1] as usize;
            let depth = in_box(1, count, [0.0..=1.0]).into_iter().skip(2);
            let map = ShadowMap {
                size,
                depth: depth.map(|x| x[0]).collect(),
            };
            let inputs = CpuLightInputs {
                shadow_map: Some(&map),
                ..Default::default()
            };
            let projection = ShadowProjection::Cube {
                near: 0.1,
                far: 9.0,
                reversed_depth,
            };
            let shadows = Shadows::new(&emitter, Some(&projection), &inputs).expect("shadows");
            let ranges = DepthRanges::new(&shadows);
            for x in in_box(2, 500, [const { 0.0..=0.999 }; 5]) {
                let face = (6.0 * x[0]) as usize;
                let place = |x: f32, n: u32| (x * n as f32) as u32;
                let a = [place(x[1], size[0]), place(x[2], size[1])];
                let b = [place(x[3], size[0]), place(x[4], size[1])];
                let first = [a[0].min(b[0]), a[1].min(b[1])];
                let last = [a[0].max(b[0]), a[1].max(b[1])];
                let exact = |more: u32| {
                    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
                    for y in first[1].saturating_sub(more)..=(last[1] + more).min(size[1] - 1) {
                        for x in first[0].saturating_sub(more)..=(last[0] + more).min(size[0] - 1) {
                            let d = shadows.stored_depth(face, (y * size[0] + x) as usize);
                            range = [range[0].min(d), range[1].max(d)];
                        }
                    }
                    range
                };
                let found = ranges.over(face, first, last);
                let side = (last[0] - first[0]).max(last[1] - first[1]);
                let (least, most) = (exact(0), exact(side));
                assert!(
                    found[0] <= least[0] && found[1] >= least[1],
                    "{first:?} {last:?}"
                );
                assert!(
                    found[0] >= most[0] && found[1] <= most[1],
                    "{first:?} {last:?}"
                );
            }
        }
    }
}
