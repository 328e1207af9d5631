//! The 1-D min-max mipmap of one slice (Chen 2011, section 3.3): a complete binary tree of (min, max) over a row of S.

/// (min, max) of S on the grid's scale of 0 to 65535, rounded outwards.
pub(crate) type Node = [u16; 2];

/// The range that covers everything: no view ray passes the test.
pub(crate) const UNKNOWN: Node = [0, u16::MAX];
/// Lit for every view ray.
pub(crate) const LIT: Node = [u16::MAX; 2];

/// A row of S and its tree.
#[derive(Clone, Debug)]
pub(crate) struct MinMaxTree {
    /// Levels one after another, the finest first; level k starts at `2 n - (2 n >> k)` for n leaves.
    nodes: Vec<Node>,
    pub(super) leaves: usize,
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

    /// The range of S that a leaf holds.
    #[cfg(test)]
    pub(crate) fn leaf(&self, index: usize) -> Node {
        self.nodes[index]
    }

    /// A node of a level.
    pub(super) fn node(&self, level: u32, index: usize) -> Node {
        self.nodes[2 * self.leaves - ((2 * self.leaves) >> level) + index]
    }

    /// Level and index of the node after this one: up, one level at most, where a parent begins (Chen 2011, fig. 5 and
    /// section 3.5).
    pub(super) fn next(&self, level: u32, index: usize) -> (u32, usize) {
        let next = index + 1;
        let up = u32::from(next.is_multiple_of(2) && level + 1 < self.levels);
        (level + up, next >> up)
    }
}
