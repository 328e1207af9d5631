//! The shaders' twins, bit by bit.

/// Bits of a grid of side^3.
pub(crate) struct Grid {
    pub(crate) side: usize,
    /// `[slice][row][column]`.
    pub(crate) is_dark: Vec<bool>,
}

impl Grid {
    /// The grids in words as the shaders hold them.
    pub(crate) fn all_from_words(side: usize, words: &[u32]) -> Vec<Self> {
        let bits: Vec<bool> = words
            .iter()
            .flat_map(|word| (0..32).map(move |i| word >> i & 1 == 1))
            .collect();
        bits.chunks(side.pow(3))
            .map(|bits| Self {
                side,
                is_dark: bits.to_vec(),
            })
            .collect()
    }

    /// Every voxel behind one that is set, in its slice and column, is set.
    pub(crate) fn scan(&mut self) {
        let side = self.side;
        for slice in self.is_dark.chunks_mut(side * side) {
            for i in side..side * side {
                slice[i] |= slice[i - side];
            }
        }
    }

    pub(crate) fn row(&self, slice: usize, row: usize) -> &[bool] {
        let first = (slice * self.side + row) * self.side;
        &self.is_dark[first..first + self.side]
    }
}

/// The first column from `first` on in this state; as many as there are where there is none.
pub(crate) fn next(row: &[bool], first: usize, is_dark: bool) -> usize {
    (first..row.len())
        .find(|i| row[*i] == is_dark)
        .unwrap_or(row.len())
}

/// The dark part of the row's first `place` voxels [voxels].
pub(crate) fn dark(row: &[bool], place: f64) -> f64 {
    let share = |i: usize| (place - i as f64).clamp(0.0, 1.0);
    (0..row.len()).filter(|i| row[*i]).map(share).sum()
}

/// The first row whose middle is behind a light ray's end.
pub(crate) fn end(side: usize, end: f64) -> usize {
    (0..side)
        .find(|row| *row as f64 + 0.5 >= end)
        .unwrap_or(side)
}
