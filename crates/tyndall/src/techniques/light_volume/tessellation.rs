//! The adaptive mesh of a face: bintrees of right triangles over the grid of its vertices.
//!
//! A square of a power of two cells a side is cut along a diagonal, and a triangle into two by the middle of its
//! longest edge, again and again (Lindstrom et al. 1996; Evans, Kirkpatrick & Townsend 2001). So every vertex halves one
//! edge, of the two triangles beside it: one more bit a vertex, *split*, says all. The mesh has no cracks iff a split
//! vertex's own edge is one of the mesh, that is, iff the two vertices whose triangles it halves are split as well.
//!
//! 1. `split.wesl`: a vertex is split where the surface there lies farther than the tolerance from the edge it halves.
//!    The whole border is, so that the sides of a single map and the edges of a cube meet the mesh at every vertex.
//! 2. `grow.wesl`, from the smallest edges to the largest: a vertex is split if any of the four is whose edges hang on it.
//! 3. `list.wesl`: of the four triangles round a split vertex, those are listed whose own longest edge is not halved.
//!
//! The grid has one cell more than the map has texels; it takes the top left part of the square. No triangle lies across
//! its border, for all of that is split, and those beyond it are left out.

use crate::shader::{block, constant};

/// Vertices that one word of the bits stands for.
pub(super) fn word() -> u32 {
    constant("LIGHT_VOLUME_WORD")
}

block! {
    /// The shaders' `LightVolumeStep`.
    #[derive(PartialEq, Eq)]
    pub(super) struct Step = "LightVolumeStep" in "tyndall::techniques::light_volume::grow", checked by light_volume_step_is_laid_out_as_in_wgsl {
        /// Distance of the vertices that are looked at: odd multiples of it in one direction or both.
        pub(super) spacing: u32,
        /// 1: in one direction.
        pub(super) is_edge: u32,
    }
}

/// The square of a face and its bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Square {
    /// Cells of the face.
    cells: [u32; 2],
    /// Cells a side of the square, a power of two.
    side: u32,
}

impl Square {
    pub(super) fn new(cells: [u32; 2]) -> Self {
        let side = cells[0].max(cells[1]).next_power_of_two();
        Self { cells, side }
    }

    /// The square of a map of this size \[texels].
    pub(super) fn of_map(size: [u32; 2]) -> Self {
        Self::new(size.map(|n| n + 1))
    }

    /// Bytes of the bits.
    pub(super) fn splits_bytes(&self, faces: u32) -> u64 {
        4 * u64::from(self.pitch()) * u64::from(self.rows()) * u64::from(faces)
    }

    /// Words a row of the bits.
    pub(super) fn pitch(&self) -> u32 {
        (self.side + 1).div_ceil(word())
    }

    /// Rows of a face's bits.
    pub(super) fn rows(&self) -> u32 {
        self.side + 1
    }

    /// The steps of `grow.wesl` in order, each with how many vertices a side are looked at.
    pub(super) fn steps(&self) -> Vec<(Step, [u32; 2])> {
        let mut steps = Vec::new();
        let mut spacing = 1;
        while spacing < self.side {
            // Vertices beyond the border are needed where those inside hang on them.
            let count = self.cells.map(|n| n / (2 * spacing) + 2);
            let step = |is_edge| Step { spacing, is_edge };
            if spacing > 1 {
                steps.push((step(1), count));
            }
            steps.push((step(0), count));
            spacing *= 2;
        }
        steps
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::super::twin::Face;

    /// Column and row, or any point of a cube's surface.
    type Point = [i32; 3];

    /// `light_volume_strip`: two triangles a cell, the second turned round.
    fn strips([columns, rows]: [u32; 2]) -> Vec<[[i32; 2]; 3]> {
        let mut triangles = Vec::new();
        for j in 0..rows as i32 {
            let at = |i: i32| [i >> 1, j + (i & 1)];
            for i in 0..2 * columns as i32 {
                let [a, b, c] = [at(i), at(i + 1), at(i + 2)];
                triangles.push(if i % 2 == 0 { [a, b, c] } else { [b, a, c] });
            }
        }
        triangles
    }

    /// `light_volume_side`: the sides and the far cap of a single map; the third number tells far points.
    fn sides([columns, rows]: [u32; 2]) -> Vec<[Point; 3]> {
        let (x, y) = (columns as i32, rows as i32);
        let border = |i: i32| match i % (2 * (x + y)) {
            k if k < y => [0, k],
            k if k < y + x => [k - y, y],
            k if k < 2 * y + x => [x, 2 * y + x - k],
            k => [2 * (x + y) - k, 0],
        };
        let point = |[x, y]: [i32; 2], far| [x, y, far];
        let middle = [x / 2, y / 2, 1];
        let cell = |i| {
            let (a, b) = (border(i), border(i + 1));
            [
                [point(b, 0), point(a, 0), point(a, 1)],
                [point(b, 0), point(a, 1), point(b, 1)],
                [point(b, 1), point(a, 1), middle],
            ]
        };
        (0..2 * (x + y)).flat_map(cell).collect()
    }

    /// `light_volume_cube_direction` of a vertex, times the face's texels: whole numbers.
    fn on_cube(face: usize, [x, y]: [i32; 2], cells: i32) -> Point {
        let one = cells - 1;
        let [u, v] = [x, y].map(|n| (2 * n - cells).clamp(-one, one));
        match face {
            0 => [one, -v, -u],
            1 => [-one, -v, u],
            2 => [u, one, v],
            3 => [u, -one, -v],
            4 => [u, -v, one],
            _ => [-u, -v, -one],
        }
    }

    /// Every edge is passed once in each direction.
    fn assert_closed(triangles: impl IntoIterator<Item = [Point; 3]>, what: &str) {
        let mut passed: HashMap<[Point; 2], [u32; 2]> = HashMap::new();
        for [a, b, c] in triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                assert_ne!(from, to, "{what}");
                let direction = usize::from(from > to);
                passed.entry([from.min(to), from.max(to)]).or_default()[direction] += 1;
            }
        }
        let open = passed.iter().find(|(_, counts)| **counts != [1, 1]);
        assert_eq!(open, None, "{what}");
    }

    #[test]
    fn single_maps_are_closed_and_turned_one_way() {
        let near = |t: [[i32; 2]; 3]| t.map(|[x, y]| [x, y, 0]);
        for texels in [[16, 16], [15, 15], [33, 20], [1, 1], [7, 40]] {
            let cells = texels.map(|n| n + 1);
            let full = strips(cells).into_iter().map(near).chain(sides(cells));
            assert_closed(full, &format!("{texels:?}, full"));
            for (i, share) in [0.0, 0.003, 0.03, 0.3, 1.0].into_iter().enumerate() {
                let face = Face::new(cells, share, 77 * i as u32);
                let triangles = face.triangles();
                let what = format!("{texels:?}, {share}");
                assert_closed(
                    triangles.iter().copied().map(near).chain(sides(cells)),
                    &what,
                );
                let full = 2 * cells[0] * cells[1];
                assert!(triangles.len() <= full as usize, "{what}");
                assert_eq!(
                    triangles.len() == full as usize,
                    share == 1.0 || full <= 8,
                    "{what}"
                );
            }
        }
    }

    #[test]
    fn cube_maps_are_closed_without_doubled_walls() {
        for texels in [1, 6, 16, 31] {
            let cells = [texels + 1; 2];
            let place = |f: usize, t: [[i32; 2]; 3]| t.map(|v| on_cube(f, v, cells[0] as i32));
            let full = (0..6).flat_map(|f| strips(cells).into_iter().map(move |t| place(f, t)));
            assert_closed(full, &format!("{texels}, full"));
            for share in [0.0, 0.02, 0.3] {
                let face = |f: usize| {
                    let face = Face::new(cells, share, 1000 * f as u32);
                    let triangles = face.triangles().into_iter();
                    triangles.map(move |t| place(f, t)).collect::<Vec<_>>()
                };
                assert_closed((0..6).flat_map(face), &format!("{texels}, {share}"));
            }
        }
    }
}
