//! Tints of a textured surface along a straight line on it.
//!
//! Between the lines through texel centres a bilinear texture is smooth: along a line across such a cell its alpha is a
//! quadratic polynomial. So the borders of an alpha-tested surface's holes are found exactly, and glass gets a constant
//! tint a cell, that of the middle of the line's part in it.

use glam::{DVec2, DVec3};

use super::surface::Surface;
use crate::texture::MipTexture;

/// Most texels that a line may cross in either direction; longer ones use a coarser level of the texture.
const MOST_CELLS: f64 = 4096.0;

/// Calls `emit` with the pieces of the line between two texture coordinates, as shares `[from, to]` of its length, on which
/// the surface changes light, and with its tint there.
pub(super) fn pieces(
    surface: &Surface,
    textures: &[MipTexture],
    uv: [DVec2; 2],
    mut emit: impl FnMut([f64; 2], DVec3),
) {
    let Some(texture) = surface.texture(textures) else {
        return;
    };
    let level = level(texture, uv[1] - uv[0]);
    let color = |t: f64| surface.color_at_level(textures, uv[0].lerp(uv[1], t), level);
    let size = DVec2::from(texture.levels()[level].size.map(f64::from));
    match surface.cutoff() {
        Some(cutoff) => {
            let mut blocked = Runs::default();
            for_each_cell(uv.map(|uv| uv * size - 0.5), |[from, to]| {
                let above = [from, 0.5 * (from + to), to].map(|t| color(t).w - cutoff);
                for_each_positive(above, |a, b| {
                    let piece = [from + a * (to - from), from + b * (to - from)];
                    blocked.push(piece, &mut |run| emit(run, DVec3::ZERO));
                });
            });
            blocked.finish(&mut |run| emit(run, DVec3::ZERO));
        }
        None => for_each_cell(uv.map(|uv| uv * size - 0.5), |[from, to]| {
            let tint = surface.tint(color(0.5 * (from + to)));
            if tint != DVec3::ONE {
                emit([from, to], tint);
            }
        }),
    }
}

/// The finest level on which a line with this offset between its ends crosses no more than [`MOST_CELLS`] texels.
fn level(texture: &MipTexture, offset: DVec2) -> usize {
    let fits = |size: [u32; 2]| {
        (offset * DVec2::from(size.map(f64::from)))
            .abs()
            .max_element()
            <= MOST_CELLS
    };
    let levels = texture.levels();
    levels
        .iter()
        .position(|level| fits(level.size))
        .unwrap_or(levels.len() - 1)
}

/// Cuts the line between two points where either coordinate is whole; pieces are shares of its length. A line that crosses
/// absurdly many cells stays in one piece.
fn for_each_cell([from, to]: [DVec2; 2], mut visit: impl FnMut([f64; 2])) {
    let offset = to - from;
    if !offset.is_finite() || offset.abs().max_element() > 2.0 * MOST_CELLS {
        visit([0.0, 1.0]);
        return;
    }
    let mut lines = [0, 1].map(|axis| Crossings::new(from[axis], offset[axis]));
    let mut start = 0.0;
    while start < 1.0 {
        let end = lines[0].at().min(lines[1].at()).min(1.0);
        if end > start {
            visit([start, end]);
        }
        for line in &mut lines {
            if line.at() <= end {
                line.whole += line.step;
            }
        }
        start = end;
    }
}

/// The shares of a line at which one of its coordinates is whole.
struct Crossings {
    from: f64,
    offset: f64,
    /// The next whole number.
    whole: f64,
    step: f64,
}

impl Crossings {
    fn new(from: f64, offset: f64) -> Self {
        let step = offset.signum();
        Self {
            from,
            offset,
            whole: if step > 0.0 {
                from.floor()
            } else {
                from.ceil()
            } + step,
            step,
        }
    }

    /// Share of the line at which the next whole number is reached.
    fn at(&self) -> f64 {
        if self.offset == 0.0 {
            f64::INFINITY
        } else {
            (self.whole - self.from) / self.offset
        }
    }
}

/// Calls `emit` with the parts of [0, 1] where the quadratic polynomial with these values at 0, 1/2 and 1 is at least zero.
fn for_each_positive([at0, at_half, at1]: [f64; 3], mut emit: impl FnMut(f64, f64)) {
    let a = 2.0 * (at0 - 2.0 * at_half + at1);
    let b = -3.0 * at0 + 4.0 * at_half - at1;
    let value = |t: f64| (a * t + b) * t + at0;
    let [r0, r1] = roots(a, b, at0);
    let mut start = 0.0;
    for end in [r0, r1, 1.0] {
        if end > start && end <= 1.0 {
            if value(0.5 * (start + end)) >= 0.0 {
                emit(start, end);
            }
            start = end;
        }
    }
}

/// The roots of `a t^2 + b t + c`, smaller first; infinity in place of a root there is not.
fn roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return [f64::INFINITY; 2];
    }
    // Citardauq's form keeps both roots exact where a is near zero.
    let q = -0.5 * (b + b.signum() * discriminant.sqrt());
    let [x, y] = [q / a, c / q].map(|t| if t.is_nan() { f64::INFINITY } else { t });
    [x.min(y), x.max(y)]
}

/// Joins pieces that touch.
#[derive(Default)]
struct Runs {
    open: Option<[f64; 2]>,
}

impl Runs {
    fn push(&mut self, piece: [f64; 2], emit: &mut impl FnMut([f64; 2])) {
        match &mut self.open {
            Some(run) if run[1] == piece[0] => run[1] = piece[1],
            _ => {
                self.finish(emit);
                self.open = Some(piece);
            }
        }
    }

    fn finish(&mut self, emit: &mut impl FnMut([f64; 2])) {
        if let Some(run) = self.open.take() {
            emit(run);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_end_where_a_coordinate_is_whole() {
        for ([from, to], expected) in [
            (
                [DVec2::new(0.5, 0.5), DVec2::new(2.5, 0.5)],
                vec![0.25, 0.75, 1.0],
            ),
            ([DVec2::new(0.0, 3.0), DVec2::new(0.0, 1.0)], vec![0.5, 1.0]),
            (
                [DVec2::new(0.25, -0.5), DVec2::new(1.25, 0.5)],
                vec![0.5, 0.75, 1.0],
            ),
            ([DVec2::ONE, DVec2::ONE], vec![1.0]),
        ] {
            let mut ends = Vec::new();
            for_each_cell([from, to], |[_, end]| ends.push(end));
            assert_eq!(ends, expected, "{from} to {to}");
        }
        let mut cells = 0;
        for_each_cell([DVec2::ZERO, DVec2::splat(f64::INFINITY)], |_| cells += 1);
        assert_eq!(cells, 1);
    }

    #[test]
    fn positive_parts_of_polynomials() {
        let polynomial = |a: f64, b: f64, c: f64| [0.0, 0.5, 1.0].map(|t| (a * t + b) * t + c);
        for (values, expected) in [
            (polynomial(0.0, 0.0, 1.0), vec![[0.0, 1.0]]),
            (polynomial(0.0, 0.0, -1.0), vec![]),
            (polynomial(0.0, 0.0, 0.0), vec![[0.0, 1.0]]),
            (polynomial(0.0, 4.0, -1.0), vec![[0.25, 1.0]]),
            (polynomial(0.0, -4.0, 1.0), vec![[0.0, 0.25]]),
            (polynomial(16.0, -16.0, 3.0), vec![[0.0, 0.25], [0.75, 1.0]]),
            (polynomial(-16.0, 16.0, -3.0), vec![[0.25, 0.75]]),
        ] {
            let mut found = Vec::new();
            for_each_positive(values, |a, b| found.push([a, b]));
            assert_eq!(found, expected, "{values:?}");
        }
    }
}
