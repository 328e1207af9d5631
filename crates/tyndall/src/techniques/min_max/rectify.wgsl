// The shadow map rectified to slices, and a tree of (min, max) over each (Chen 2011, sections 3.2 and 3.3), in one go.
//
// Of coloured glass the same with its nearest layer that tints: before the least S of that there is no tint.
//
// A leaf is a cell of light rays, as wide as the slice: it holds the least and the greatest S of all of them, so that
// a view ray anywhere in the slice that passes the test at a node is lit, or dark, all along it.

@group(2) @binding(0) var<uniform> epipolar: Epipolar;
@group(2) @binding(1) var pyramid: texture_2d_array<f32>;
@group(2) @binding(2) var<storage, read_write> min_max_nodes: array<u32>;

override RECTIFY_GLASS: bool = false;

// Leaves a thread takes, and levels it builds of them.
const RECTIFY_LEAVES: u32 = 8u;
const RECTIFY_THREADS: u32 = 64u;

var<workgroup> rectify_largest: atomic<u32>;

// What covers everything: no view ray passes the test.
const RECTIFY_UNKNOWN: u32 = 0xffff0000u;
// Lit for every view ray.
const RECTIFY_LIT: u32 = 0xffffffffu;

// Farthest and nearest depth of the texels first..last (inclusive) of a face, read in squares of a level.
fn rectify_depths(first: vec2u, last: vec2u, face: u32, level: u32) -> vec2f {
    let size = textureDimensions(pyramid, level);
    let a = min(first >> vec2u(level + 1u), size - 1u);
    let b = min(last >> vec2u(level + 1u), size - 1u);
    var range = vec2f(1e30, -1e30);
    for (var y = a.y; y <= b.y; y++) {
        for (var x = a.x; x <= b.x; x++) {
            range = pyramid_unite(range, textureLoad(pyramid, vec2u(x, y), face, level).rg);
        }
    }
    return range;
}

// The level of which two squares a side hold a cell of this many texels.
fn rectify_level(texels: u32) -> u32 {
    return min(firstLeadingBit(max(texels, 1u)), textureNumLevels(pyramid) - 1u);
}

fn rectify_size() -> vec2f {
    if RECTIFY_GLASS {
        return vec2f(textureDimensions(shadow_glass));
    }
    return vec2f(textureDimensions(shadow_map));
}

struct RectifySide {
    gamma: f32,
    first: ShadowLine,
    second: ShadowLine,
}

fn rectify_side(outward: mat2x3f, alphas: vec2f, gamma: f32) -> RectifySide {
    let e = epipolar;
    let a = epipolar_light_ray(e, alphas.x, outward[0], gamma);
    let b = epipolar_light_ray(e, alphas.y, outward[1], gamma);
    return RectifySide(gamma, shadow_line(a.origin, a.way), shadow_line(b.origin, b.way));
}

fn rectify_cell(a: RectifySide, b: RectifySide, level: u32) -> u32 {
    let e = epipolar;
    let size = rectify_size();
    let lowest = size * min(min(a.first.uv, a.second.uv), min(b.first.uv, b.second.uv));
    let highest = size * max(max(a.first.uv, a.second.uv), max(b.first.uv, b.second.uv));
    // The cell's ends are arcs, which bulge beyond their chords.
    let chord = max(distance(size * a.first.uv, size * a.second.uv), distance(size * b.first.uv, size * b.second.uv));
    let margin = 0.02 + 0.25 * chord * min(abs(e.alpha_step), 1.0);
    let low = floor(lowest - margin);
    let high = floor(highest + margin);
    let face = a.first.face;
    let one_face = a.second.face == face && b.first.face == face && b.second.face == face;
    // Beyond a few squares a cell is not worth its reads: behind the light it may stretch over the whole map.
    let squares = (high - low) / f32(2u << level);
    if !one_face || any(squares > vec2f(8.0)) {
        return RECTIFY_UNKNOWN;
    }
    if any(high < vec2f(0.0)) || any(low >= size) {
        return RECTIFY_LIT;
    }
    let depths = rectify_depths(vec2u(max(low, vec2f(0.0))), vec2u(min(high, size - 1.0)), face, level);
    if depths.y <= 0.0 {
        return RECTIFY_LIT;
    }
    let near = vec4f(
        shadow_line_end(a.first, depths.y),
        shadow_line_end(a.second, depths.y),
        shadow_line_end(b.first, depths.y),
        shadow_line_end(b.second, depths.y),
    );
    let far = vec4f(
        shadow_line_end(a.first, depths.x),
        shadow_line_end(a.second, depths.x),
        shadow_line_end(b.first, depths.x),
        shadow_line_end(b.second, depths.x),
    );
    var ends = vec2f(min(min(near.x, near.y), min(near.z, near.w)), max(max(far.x, far.y), max(far.z, far.w)));
    let beside_map = any(low < vec2f(0.0)) || any(high >= size);
    if light_is_local() {
        // Distance to a plane of constant depth is convex over the cell: its middle may be nearer than its corners.
        let width = abs(b.gamma - a.gamma) + abs(e.alpha_step);
        ends *= vec2f(1.0 - width * width, 1.0 + width * width);
    }
    if depths.x <= 0.0 || beside_map {
        ends.y = 1e30;
    }
    return tree_pack(epipolar_shadow_range(e, vec2f(a.gamma, b.gamma), ends));
}

@compute @workgroup_size(RECTIFY_THREADS)
fn rectify(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let e = epipolar;
    let slice = group.y;
    let first = RECTIFY_LEAVES * (RECTIFY_THREADS * group.x + thread);
    let alphas = e.alpha_start + e.alpha_step * vec2f(f32(slice), f32(slice + 1u));
    let outward = mat2x3f(epipolar_outward(e, alphas.x), epipolar_outward(e, alphas.y));
    var side = rectify_side(outward, alphas, e.gamma_start + f32(first) * e.gamma_step);
    // One level for all: cells differ little, and not every driver takes a level of each thread's own.
    let middle = e.gamma_start + (f32(first) + 0.5 * f32(RECTIFY_LEAVES)) * e.gamma_step;
    let one_on = rectify_side(outward, alphas, middle + e.gamma_step);
    let here = rectify_side(outward, alphas, middle);
    if first < e.samples && here.first.face == one_on.second.face {
        let across = rectify_size() * max(abs(one_on.first.uv - here.second.uv), abs(one_on.second.uv - here.first.uv));
        atomicMax(&rectify_largest, u32(min(max(across.x, across.y), 16384.0)));
    }
    workgroupBarrier();
    let level = rectify_level(workgroupUniformLoad(&rectify_largest));
    if first < e.samples {
        for (var i = 0u; i < RECTIFY_LEAVES; i++) {
            let next = rectify_side(outward, alphas, e.gamma_start + f32(first + i + 1u) * e.gamma_step);
            min_max_nodes[tree_node(e.samples, slice, 0u, first + i)] = rectify_cell(side, next, level);
            side = next;
        }
    }
    let group_first = RECTIFY_LEAVES * RECTIFY_THREADS * group.x;
    let count = min(RECTIFY_LEAVES * RECTIFY_THREADS, e.samples - group_first);
    for (var k = 1u; k < TREE_LEVELS; k++) {
        storageBarrier();
        for (var i = thread; i < (count >> k); i += RECTIFY_THREADS) {
            let index = (group_first >> k) + i;
            let below = tree_node(e.samples, slice, k - 1u, 2u * index);
            min_max_nodes[tree_node(e.samples, slice, k, index)] = tree_unite(min_max_nodes[below], min_max_nodes[below + 1u]);
        }
    }
}
