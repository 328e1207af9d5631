// Stage 7: the 1-D min/max tree of each slice (Chen et al. 2011), a heap without its leaves: node j of level k is at
// (columns >> k) + j. A dispatch builds four levels, of 16 children an invocation. The leaves are the shadow map's own
// texels along the trace.

struct TreeParams {
    base: u32, // the level of the children
}

// Bounds of columns that no view ray of the slice crosses: min, max.
const TREE_NOTHING: vec2f = vec2f(1e30, -1e30);

@group(2) @binding(1) var<uniform> tree_params: TreeParams;
@group(2) @binding(2) var<storage, read> tree_traces: array<Trace>;
@group(2) @binding(3) var<storage, read_write> tree_nodes: array<vec2f>;

@compute @workgroup_size(64)
fn tree(@builtin(global_invocation_id) id: vec3u) {
    if 16u * id.x >= sampling.columns >> tree_params.base {
        return;
    }
    let trace = tree_traces[id.y / trace_charts()];
    var node4 = TREE_NOTHING;
    for (var i = 2u * id.x; i < 2u * id.x + 2u; i++) {
        var node3 = TREE_NOTHING;
        for (var j = 2u * i; j < 2u * i + 2u; j++) {
            var node2 = TREE_NOTHING;
            for (var k = 2u * j; k < 2u * j + 2u; k++) {
                let node1 = tree_union(tree_child(id.y, trace, 2u * k), tree_child(id.y, trace, 2u * k + 1u));
                tree_keep(id.y, 1u, k, node1);
                node2 = tree_union(node2, node1);
            }
            tree_keep(id.y, 2u, j, node2);
            node3 = tree_union(node3, node2);
        }
        tree_keep(id.y, 3u, i, node3);
        node4 = tree_union(node4, node3);
    }
    tree_keep(id.y, 4u, id.x, node4);
}

fn tree_union(a: vec2f, b: vec2f) -> vec2f {
    return vec2f(min(a.x, b.x), max(a.y, b.y));
}

fn tree_child(row: u32, trace: Trace, index: u32) -> vec2f {
    if frame_choice(tree_params.base) > 0u {
        let count = sampling.columns >> tree_params.base;
        return select(TREE_NOTHING, tree_nodes[row * sampling.columns + count + index], index < count);
    }
    if index < trace.columns.x || index >= trace.columns.y {
        return TREE_NOTHING;
    }
    let depths = trace_column(trace, row % trace_charts(), sampling.axis, index).depths;
    return vec2f(min(depths.x, depths.y), max(depths.x, depths.y));
}

// A node of a level above the children's, where the tree goes so high.
fn tree_keep(row: u32, level: u32, index: u32, node: vec2f) {
    let count = sampling.columns >> (tree_params.base + level);
    if index < count {
        tree_nodes[row * sampling.columns + count + index] = node;
    }
}
