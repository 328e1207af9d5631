// Stage 7: the 1-D min/max tree of each slice (Chen et al. 2011), a heap without its leaves: node j of level k is at
// (columns >> k) + j. A dispatch builds up to four levels, of 16 children an invocation. The leaves are the shadow map's
// own texels along the trace.

struct TreeParams {
    base: u32, // the level of the children
    levels: u32, // 1 to 4
}

// Bounds of columns that no view ray of the slice crosses.
const TREE_NOTHING: vec2f = vec2f(1e30, -1e30);

@group(2) @binding(1) var<uniform> tree_params: TreeParams;
@group(2) @binding(2) var<storage, read> tree_traces: array<Trace>;
// min, max
@group(2) @binding(3) var<storage, read_write> tree_nodes: array<vec2f>;

@compute @workgroup_size(64)
fn tree(@builtin(global_invocation_id) id: vec3u) {
    let parents = epipolar.columns >> (tree_params.base + tree_params.levels);
    if id.x >= parents {
        return;
    }
    let chart = id.y % trace_charts();
    let trace = tree_traces[id.y / trace_charts()];
    let start = id.y * epipolar.columns;
    var nodes: array<vec2f, 16>;
    var count = 1u << tree_params.levels;
    if tree_params.base == 0u {
        for (var i = 0u; i < count; i++) {
            nodes[i] = tree_leaf(trace, chart, id.x * count + i);
        }
    } else {
        let first = start + (epipolar.columns >> tree_params.base) + id.x * count;
        for (var i = 0u; i < count; i++) {
            nodes[i] = tree_nodes[first + i];
        }
    }
    for (var level = 1u; level <= tree_params.levels; level++) {
        count /= 2u;
        let first = start + (epipolar.columns >> (tree_params.base + level)) + id.x * count;
        for (var i = 0u; i < count; i++) {
            let a = nodes[2u * i];
            let b = nodes[2u * i + 1u];
            nodes[i] = vec2f(min(a.x, b.x), max(a.y, b.y));
            tree_nodes[first + i] = nodes[i];
        }
    }
}

fn tree_leaf(trace: Trace, chart: u32, column: u32) -> vec2f {
    if column < trace.columns.x || column >= trace.columns.y {
        return TREE_NOTHING;
    }
    return vec2f(trace_depth(trace, chart, epipolar.axis, column));
}
