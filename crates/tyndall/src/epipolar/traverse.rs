//! A view ray through its slice's tree (Chen 2011, fig. 5): the twin of `traverse_nodes` in `traverse.wesl`.

use super::tree::MinMaxTree;

/// A run of leaves that are not lit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Run {
    /// In shadow.
    Dark,
    /// With light and shadow both.
    Mixed,
}

impl MinMaxTree {
    /// Calls `visit` with every run of leaves within `[from, to)` that a view ray at `b` does not find lit, in order;
    /// runs are maximal. Returns the number of nodes visited.
    ///
    /// Without recursion, up at most one level a step (section 3.5). The shader stops at each border and goes on later.
    pub(crate) fn traverse_nodes(
        &self,
        b: f64,
        [from, to]: [usize; 2],
        mut visit: impl FnMut(Run, [usize; 2]),
    ) -> u32 {
        // b is less than an integer iff its integral part is.
        let b = b as u16;
        let to = to.min(self.leaves);
        let (mut nodes, mut level, mut index) = (0, 0, from);
        let mut run: Option<(Run, usize)> = None;
        while index << level < to {
            nodes += 1;
            let [minimum, maximum] = self.node(level, index);
            let bright = b < minimum;
            let dark = b >= maximum;
            let both = !(dark || bright);
            if both && level > 0 {
                level -= 1;
                index *= 2;
                continue;
            }
            let found = match (bright, dark) {
                (true, _) => None,
                (_, true) => Some(Run::Dark),
                _ => Some(Run::Mixed),
            };
            if found != run.map(|(run, _)| run) {
                let start = index << level;
                if let Some((ended, begun)) = run {
                    visit(ended, [begun, start]);
                }
                run = found.map(|found| (found, start));
            }
            (level, index) = self.next(level, index);
        }
        if let Some((last, begun)) = run {
            visit(last, [begun, to]);
        }
        nodes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::epipolar::tree::{LIT, Node, UNKNOWN};
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
                    tree.traverse_nodes(b, [from, to], |run, [a, b]| {
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
        assert!(tree.traverse_nodes(40000.0, [0, 4096], |_, _| {}) <= 13);
    }
}
