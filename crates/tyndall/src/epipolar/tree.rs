//! The 1-D min-max mipmap of one slice (Chen 2011, section 3.3): a complete binary tree of (min, max) over a row of S.

/// (min, max) of S on the grid's scale of 0 to 65535, rounded outwards.
pub(crate) type Node = [u16; 2];

/// What covers everything: no view ray passes the test.
pub(crate) const UNKNOWN: Node = [0, u16::MAX];
/// Lit for every view ray.
pub(crate) const LIT: Node = [u16::MAX; 2];

/// A run of leaves that are not lit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Run {
    /// In shadow.
    Dark,
    /// Of light and shadow both.
    Mixed,
}

/// A row of S and its tree.
#[derive(Clone, Debug)]
pub(crate) struct MinMaxTree {
    /// Levels one after another, the finest first; level k starts at `2 n - (2 n >> k)` for n leaves.
    nodes: Vec<Node>,
    leaves: usize,
    levels: u32,
}

impl MinMaxTree {
    /// Over a power of two of leaves.
    pub(crate) fn new(row: impl ExactSizeIterator<Item = Node>) -> Self {
        let leaves = row.len();
        debug_assert!(leaves.is_power_of_two());
        let mut nodes = Vec::with_capacity(2 * leaves);
        nodes.extend(row);
        for i in 0..leaves - 1 {
            let [a, b]: [Node; 2] = [nodes[2 * i], nodes[2 * i + 1]];
            nodes.push([a[0].min(b[0]), a[1].max(b[1])]);
        }
        Self {
            nodes,
            leaves,
            levels: leaves.ilog2() + 1,
        }
    }

    /// Calls `visit` with every run of leaves within `[from, to)` that a view ray at `b` does not find lit, in order;
    /// runs are maximal. Returns the number of nodes visited.
    ///
    /// The traversal of Chen 2011, fig. 5: without recursion, up at most one level a step.
    pub(crate) fn unlit_runs(
        &self,
        b: f64,
        [from, to]: [usize; 2],
        mut visit: impl FnMut(Run, [usize; 2]),
    ) -> u32 {
        // b < n iff its whole part is.
        let b = b as u16;
        let to = to.min(self.leaves);
        let (mut visited, mut level, mut index) = (0, 0, from);
        let mut run: Option<(Run, usize)> = None;
        while index << level < to {
            visited += 1;
            let [min, max] = self.node(level, index);
            let found = if b < min {
                None
            } else if b >= max {
                Some(Run::Dark)
            } else if level > 0 {
                level -= 1;
                index *= 2;
                continue;
            } else {
                Some(Run::Mixed)
            };
            if found != run.map(|(run, _)| run) {
                let start = index << level;
                if let Some((ended, begun)) = run {
                    visit(ended, [begun, start]);
                }
                run = found.map(|found| (found, start));
            }
            index += 1;
            if index % 2 == 0 && level + 1 < self.levels {
                level += 1;
                index /= 2;
            }
        }
        if let Some((last, begun)) = run {
            visit(last, [begun, to]);
        }
        visited
    }

    /// The range of S that a leaf holds.
    #[cfg(test)]
    pub(crate) fn leaf(&self, index: usize) -> Node {
        self.nodes[index]
    }

    fn node(&self, level: u32, index: usize) -> Node {
        self.nodes[2 * self.leaves - ((2 * self.leaves) >> level) + index]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tyndall_testkit::samples::in_box;

    /// Rows of few values and of many, ranges narrow and wide, and stretches of leaves that repeat.
    #[test]
    fn runs_are_those_of_a_scan() {
        for leaves in [1, 2, 8, 64, 1024] {
            for (steps, width) in [(3.0, 1.0), (8.0, 0.0), (60000.0, 500.0), (60000.0, 20000.0)] {
                let unit = 65535.0_f32 / steps;
                let row: Vec<Node> = in_box(leaves as u64, leaves, [const { 0.0..=1.0 }; 3])[8..]
                    .iter()
                    .map(|x| match (x[2] * 8.0) as u32 {
                        0 => UNKNOWN,
                        1 => LIT,
                        _ => {
                            let min = (x[0] * steps).floor() * unit;
                            let max = min + (x[1] * width).floor() * unit.min(1.0);
                            [min as u16, max.min(65535.0) as u16]
                        }
                    })
                    .collect();
                let tree = MinMaxTree::new(row.iter().copied());
                for x in in_box(9, 200, [0.0..=65534.0, 0.0..=1.0, 0.0..=1.0]) {
                    let b = f64::from(x[0]);
                    let ends = [x[1], x[2]].map(|e| (e * leaves as f32) as usize);
                    let (from, to) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
                    let mut found = vec![None; to - from];
                    let mut last = None;
                    tree.unlit_runs(b, [from, to], |run, [a, b]| {
                        assert!(a < b, "runs are not empty");
                        assert!(last.is_none_or(|(r, end)| end < a || end == a && r != run));
                        last = Some((run, b));
                        found[a - from..b - from].fill(Some(run));
                    });
                    let state = |[min, max]: &Node| {
                        if b < f64::from(*min) {
                            None
                        } else if b >= f64::from(*max) {
                            Some(Run::Dark)
                        } else {
                            Some(Run::Mixed)
                        }
                    };
                    let scan: Vec<_> = row[from..to].iter().map(state).collect();
                    assert_eq!(found, scan, "{leaves} {steps} {x:?}");
                }
            }
        }
    }

    #[test]
    fn plain_rows_take_few_nodes() {
        let tree = MinMaxTree::new(std::iter::repeat_n([30000; 2], 4096));
        // Up one level a step: one node a level.
        assert!(tree.unlit_runs(40000.0, [0, 4096], |_, _| {}) <= 13);
    }
}
