// The trees of min-max: one row a slice, levels one after another, the finest first.

// Levels of a tree: nodes of the last one hold 512 leaves.
const MIN_MAX_LEVELS: u32 = 10u;

struct MinMax {
    epipolar: Epipolar,
}

// Where a node is stored; level k of n leaves starts at 2 n - (2 n >> k).
fn min_max_node(e: Epipolar, slice: u32, level: u32, index: u32) -> u32 {
    let row = 2u * e.samples;
    return (slice + 1u) * row - (row >> level) + index;
}
