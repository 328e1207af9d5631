//! The 1-D min-max mipmap of one slice (Chen 2011, section 3.3): a complete binary tree of (min, max) over a row of S.

/// A row of S and its tree. Level 0 is the row itself, padded to a power of two with values that are always lit.
#[derive(Clone, Debug)]
pub(crate) struct MinMaxTree {
    /// Levels one after another, the finest first; level k starts at `2 n - (2 n >> k)` for n leaves.
    nodes: Vec<[f32; 2]>,
    leaves: usize,
    levels: u32,
}

impl MinMaxTree {
    pub(crate) fn new(row: &[f32]) -> Self {
        let leaves = row.len().max(1).next_power_of_two();
        let mut nodes = Vec::with_capacity(2 * leaves);
        nodes.extend(row.iter().map(|s| [*s; 2]));
        nodes.resize(leaves, [f32::INFINITY; 2]);
        let mut start = 0;
        let mut count = leaves;
        while count > 1 {
            for i in (start..start + count).step_by(2) {
                let [a, b]: [[f32; 2]; 2] = [nodes[i], nodes[i + 1]];
                nodes.push([a[0].min(b[0]), a[1].max(b[1])]);
            }
            start += count;
            count /= 2;
        }
        Self {
            nodes,
            leaves,
            levels: leaves.ilog2() + 1,
        }
    }

    /// Calls `dark` with every run of leaves within `[from, to)` that a view ray at `beta` finds in shadow, in order;
    /// runs are maximal. Returns the number of nodes visited.
    ///
    /// The traversal of Chen 2011, fig. 5: without recursion, up at most one level a step.
    pub(crate) fn dark_runs(
        &self,
        beta: f32,
        [from, to]: [usize; 2],
        mut dark: impl FnMut([usize; 2]),
    ) -> u32 {
        let to = to.min(self.leaves);
        let mut visited = 0;
        let mut level = 0;
        let mut index = from;
        let mut run: Option<usize> = None;
        while index << level < to {
            visited += 1;
            let [min, max] = self.node(level, index);
            if level > 0 && beta >= min && beta < max {
                level -= 1;
                index *= 2;
                continue;
            }
            let start = (index << level).max(from);
            if beta >= max {
                run.get_or_insert(start);
            } else if let Some(begun) = run.take() {
                dark([begun, start]);
            }
            index += 1;
            if index % 2 == 0 && level + 1 < self.levels {
                level += 1;
                index /= 2;
            }
        }
        if let Some(begun) = run {
            dark([begun, to]);
        }
        visited
    }

    fn node(&self, level: u32, index: usize) -> [f32; 2] {
        self.nodes[2 * self.leaves - ((2 * self.leaves) >> level) + index]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_testkit::samples::in_box;

    #[test]
    fn runs_are_those_of_a_scan() {
        for length in [1, 2, 3, 7, 64, 100, 1000] {
            let row: Vec<f32> = in_box(length as u64, length, [0.0..=1.0])[2..]
                .iter()
                .map(|x| (x[0] * 8.0).floor() / 8.0)
                .collect();
            let tree = MinMaxTree::new(&row);
            for x in in_box(9, 200, [0.0..=1.0, 0.0..=1.0, 0.0..=1.0]) {
                let ends = [x[1], x[2]].map(|e| (e * length as f32) as usize);
                let (from, to) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
                let mut found = vec![false; to.saturating_sub(from)];
                let mut last = None;
                tree.dark_runs(x[0], [from, to], |[a, b]| {
                    assert!(a < b && last.is_none_or(|l| l < a), "runs are apart");
                    last = Some(b);
                    found[a - from..b - from].fill(true);
                });
                let scan: Vec<bool> = row[from..to].iter().map(|s| x[0] >= *s).collect();
                assert_eq!(found, scan, "{length} {x:?}");
            }
        }
    }

    #[test]
    fn plain_rows_take_few_nodes() {
        let tree = MinMaxTree::new(&[0.5; 4096]);
        // Up one level a step: one node a level.
        assert!(tree.dark_runs(0.7, [0, 4096], |_| {}) <= 13);
    }
}
