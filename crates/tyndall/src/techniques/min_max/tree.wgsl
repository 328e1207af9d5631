// Trees of (minimum, maximum) over rows: one row a slice, levels one after another, the finest first. A node is two
// 16-bit numbers, rounded outwards: the minimum below, the maximum above.

// Levels of a tree: nodes of the last one hold 512 leaves.
const TREE_LEVELS: u32 = 10u;

// Where a node is stored, of rows of so many leaves; level k of n leaves starts at 2 n - (2 n >> k).
fn tree_node(leaves: u32, slice: u32, level: u32, index: u32) -> u32 {
    let row = 2u * leaves;
    return (slice + 1u) * row - (row >> level) + index;
}

fn tree_pack(range: vec2f) -> u32 {
    // In f32 a view ray's b and S err by less than an eighth of a step together.
    let q = clamp(vec2f(floor(range.x - 0.125), ceil(range.y + 0.125)), vec2f(0.0), vec2f(65535.0));
    return u32(q.x) | (u32(q.y) << 16u);
}

fn tree_unite(a: u32, b: u32) -> u32 {
    return min(a & 0xffffu, b & 0xffffu) | max(a & 0xffff0000u, b & 0xffff0000u);
}

fn tree_minimum(node: u32) -> f32 {
    return f32(node & 0xffffu);
}

fn tree_maximum(node: u32) -> f32 {
    return f32(node >> 16u);
}

// Level and index of the node after this one: up where a parent begins (Chen 2011, section 3.3).
fn tree_next(level: u32, index: u32) -> vec2u {
    let next = index + 1u;
    let up = u32((next & 1u) == 0u && level + 1u < TREE_LEVELS);
    return vec2u(level + up, next >> up);
}
