// Builds the rows of tint.wgsl: a workgroup a slice.

@group(2) @binding(0) var<uniform> epipolar: Epipolar;
@group(2) @binding(1) var<storage, read_write> tint_sums: array<vec4f>;
@group(2) @binding(2) var<storage, read_write> tint_nodes: array<u32>;

const TINT_THREADS: u32 = 64u;
const TINT_COLUMNS_A_THREAD: u32 = 16u;

var<workgroup> tint_totals: array<mat2x3f, TINT_THREADS>;

// A light ray without coloured glass: no view ray passes behind any.
const TINT_CLEAR: u32 = 0x0000ffffu;

struct TintColumn {
    tints: mat2x3f, // of the picture, and of picture and glass
    node: u32,
}

fn tint_column(alpha: f32, column: u32) -> TintColumn {
    let e = epipolar;
    let gamma = e.tint_start + (f32(column) + 0.5) * e.tint_step;
    let ray = epipolar_light_ray(e, alpha, epipolar_outward(e, alpha), gamma);
    let picture = light_tint(ray.origin + ray.way);
    if !SHADOW_GLASS {
        return TintColumn(mat2x3f(picture, picture), TINT_CLEAR);
    }
    let line = shadow_line(ray.origin, ray.way);
    let place = line.texel / vec2f(textureDimensions(shadow_map));
    if any(place < vec2f(0.0)) || any(place >= vec2f(1.0)) {
        return TintColumn(mat2x3f(picture, picture), TINT_CLEAR);
    }
    let texel = vec2u(place * vec2f(textureDimensions(shadow_glass)));
    var tint = picture;
    var range = vec2f(65535.0, 0.0);
    for (var layer = 0u; layer < light.glass_layers; layer++) {
        let glass = textureLoad(shadow_glass, texel, line.face * light.glass_layers + layer, 0).xy;
        let held = bitcast<f32>(glass.x);
        let depth = select(held, 1.0 - held, light.standard_depth == 1u);
        let filter_tint = shadow_glass_unpack(glass.y);
        if depth > 0.0 && any(filter_tint != vec3f(1.0)) {
            tint *= filter_tint;
            let s = epipolar_shadow_range(e, vec2f(gamma), vec2f(shadow_line_end(line, depth)));
            range = vec2f(min(range.x, s.x), max(range.y, s.y));
        }
    }
    return TintColumn(mat2x3f(picture, tint), select(TINT_CLEAR, tree_pack(range), range.x <= range.y));
}

@compute @workgroup_size(TINT_THREADS)
fn tint_rows(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let e = epipolar;
    let slice = group.x;
    let alpha = e.alpha_start + (f32(slice) + 0.5) * e.alpha_step;
    let first = TINT_COLUMNS_A_THREAD * thread;
    var total = mat2x3f();
    for (var i = 0u; i < TINT_COLUMNS_A_THREAD; i++) {
        let column = tint_column(alpha, first + i);
        total += column.tints;
        tint_store(slice, first + i + 1u, total);
        if SHADOW_GLASS {
            tint_nodes[tree_node(TINT_COLUMNS, slice, 0u, first + i)] = column.node;
        }
    }
    tint_totals[thread] = total;
    workgroupBarrier();
    var before = mat2x3f();
    for (var i = 0u; i < thread; i++) {
        before += tint_totals[i];
    }
    if thread == 0u {
        tint_store(slice, 0u, mat2x3f());
    }
    for (var i = 1u; i <= TINT_COLUMNS_A_THREAD; i++) {
        let at = tint_index(e, slice, 0u, first + i);
        tint_sums[at] += vec4f(before[0], 0.0);
        if SHADOW_GLASS {
            tint_sums[tint_index(e, slice, 1u, first + i)] += vec4f(before[1], 0.0);
        }
    }
    if SHADOW_GLASS {
        for (var k = 1u; k < TREE_LEVELS; k++) {
            storageBarrier();
            for (var i = thread; i < (TINT_COLUMNS >> k); i += TINT_THREADS) {
                let below = tree_node(TINT_COLUMNS, slice, k - 1u, 2u * i);
                tint_nodes[tree_node(TINT_COLUMNS, slice, k, i)] = tree_unite(tint_nodes[below], tint_nodes[below + 1u]);
            }
        }
    }
}

fn tint_store(slice: u32, border: u32, sums: mat2x3f) {
    tint_sums[tint_index(epipolar, slice, 0u, border)] = vec4f(sums[0], 0.0);
    if SHADOW_GLASS {
        tint_sums[tint_index(epipolar, slice, 1u, border)] = vec4f(sums[1], 0.0);
    }
}
