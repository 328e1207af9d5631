//! The adaptive mesh of a face on the CPU, for tests: `split.wesl`, `grow.wesl` and `list.wesl` in f64.

use super::tessellation::{Square, Step, word};

/// The three passes on the CPU, of one face.
pub(super) struct Face {
    cells: [u32; 2],
    square: Square,
    splits: Vec<bool>,
}

/// A number in [0, 1) that looks random.
fn noise(seed: u32) -> f64 {
    let mut x = seed.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    x = ((x >> ((x >> 28) + 4)) ^ x).wrapping_mul(277_803_737);
    f64::from((x >> 22) ^ x) / 4_294_967_296.0
}

fn spacing([x, y]: [u32; 2]) -> u32 {
    (x | y) & (x | y).wrapping_neg()
}

fn is_edge([x, y]: [u32; 2]) -> bool {
    (x ^ y) & spacing([x, y]) != 0
}

fn neighbor(v: [u32; 2], k: usize) -> [i32; 2] {
    let offsets = if is_edge(v) {
        [[1, 0], [0, -1], [-1, 0], [0, 1]]
    } else {
        [[1, -1], [-1, -1], [-1, 1], [1, 1]]
    };
    [0, 1].map(|i| v[i] as i32 + spacing(v) as i32 * offsets[k % 4][i])
}

impl Face {
    /// `standing_out`: the share of vertices that stand out.
    pub(super) fn new(cells: [u32; 2], standing_out: f64, seed: u32) -> Self {
        let square = Square::new(cells);
        let mut face = Self {
            cells,
            square,
            splits: vec![false; (square.rows() * square.pitch() * word()) as usize],
        };
        for y in 0..=cells[1] {
            for x in 0..=cells[0] {
                let on_border = x == 0 || y == 0 || x == cells[0] || y == cells[1];
                let slot = face.slot([x as i32, y as i32]).expect("inside");
                face.splits[slot] = on_border || noise(seed + 10_000 * y + x) < standing_out;
            }
        }
        for (step, [columns, rows]) in square.steps() {
            for j in 0..rows {
                for i in 0..columns {
                    face.grow(step, [i, j]);
                }
            }
        }
        face
    }

    fn slot(&self, [x, y]: [i32; 2]) -> Option<usize> {
        let row = (self.square.pitch() * word()) as i32;
        let inside = x >= 0 && y >= 0 && x < row && y < self.square.rows() as i32;
        inside.then(|| (y * row + x) as usize)
    }

    fn is_split(&self, place: [i32; 2]) -> bool {
        self.slot(place).is_some_and(|slot| self.splits[slot])
    }

    fn grow(&mut self, step: Step, [i, j]: [u32; 2]) {
        let s = step.spacing;
        let vertices = if step.is_edge == 1 {
            vec![[s * (2 * i + 1), s * 2 * j], [s * 2 * i, s * (2 * j + 1)]]
        } else {
            vec![[s * (2 * i + 1), s * (2 * j + 1)]]
        };
        for v in vertices {
            let hangs = (0..4).any(|k| self.is_split(self.halves(v, k)));
            let slot = self.slot(v.map(|n| n as i32)).filter(|_| hangs);
            if let Some(slot) = slot {
                self.splits[slot] = true;
            }
        }
    }

    /// The vertex that halves the longest edge of the triangle between neighbours k and k + 1.
    fn halves(&self, v: [u32; 2], k: usize) -> [i32; 2] {
        let (a, b) = (neighbor(v, k), neighbor(v, k + 1));
        [0, 1].map(|i| (a[i] + b[i]).div_euclid(2))
    }

    pub(super) fn triangles(&self) -> Vec<[[i32; 2]; 3]> {
        let mut triangles = Vec::new();
        for y in 0..=self.cells[1] {
            for x in 0..=self.cells[0] {
                let v = [x, y];
                let own = v.map(|n| n as i32);
                for k in (0..4).filter(|_| self.is_split(own)) {
                    let (a, b) = (neighbor(v, k), neighbor(v, k + 1));
                    let inside = [a, b]
                        .iter()
                        .all(|p| (0..2).all(|i| (0..=self.cells[i] as i32).contains(&p[i])));
                    let smallest = is_edge(v) && spacing(v) == 1;
                    if inside && (smallest || !self.is_split(self.halves(v, k))) {
                        triangles.push([own, a, b]);
                    }
                }
            }
        }
        triangles
    }
}
