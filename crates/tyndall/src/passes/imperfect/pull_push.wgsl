// Fills the holes of imperfect shadow maps: pulls means of what is near to the light up to blocks of 2 x 2 and of 4 x 4
// texels, and pushes them down to texels that hold nothing. No block reaches beyond 4 x 4, so that a thread does one.

@group(2) @binding(0) var<uniform> imperfect_batch: ImperfectBatch;
@group(2) @binding(1) var<storage, read_write> imperfect_maps: array<u32>;

// Texels of two means this much apart (relative) are of different surfaces.
const PULL_APART: f32 = 0.1;
// Cells of the four below that must hold something for theirs to.
const PULL_LEAST: u32 = 2u;

// The mean of those of four cells that are about as near to the light as the nearest; 1e30 is nothing.
fn pull_mean(cells: vec4f) -> f32 {
    let count = dot(vec4u(cells < vec4f(1e30)), vec4u(1u));
    let nearest = min(min(cells.x, cells.y), min(cells.z, cells.w));
    let near = vec4f(cells <= vec4f(nearest * (1.0 + PULL_APART)));
    let mean = dot(near, min(cells, vec4f(1e20))) / dot(near, vec4f(1.0));
    return select(1e30, mean, count >= PULL_LEAST);
}

// The index of a block's texel, of four blocks of 2 x 2: block `k / 4`, texel `k % 4` of it.
fn pull_texel(block: vec3u, k: u32) -> vec2u {
    return 4u * block.xy + vec2u(2u * (k >> 2u & 1u) + (k & 1u), 2u * (k >> 3u) + (k >> 1u & 1u));
}

@compute @workgroup_size(8, 8)
fn pull_push(@builtin(global_invocation_id) block: vec3u) {
    let side = imperfect_batch.side;
    let map = block.z * side * side;
    // Loops are unrolled: these stay in registers.
    var texels: array<vec4f, 4>;
    var twos = vec4f(1e30);
    for (var quad = 0u; quad < 4u; quad++) {
        var cells = vec4f(1e30);
        for (var i = 0u; i < 4u; i++) {
            let texel = pull_texel(block, 4u * quad + i);
            if all(texel < vec2u(side)) {
                let stored = imperfect_maps[map + texel.y * side + texel.x];
                cells[i] = select(bitcast<f32>(stored), 1e30, stored == IMPERFECT_NOTHING);
            }
        }
        texels[quad] = cells;
        twos[quad] = pull_mean(cells);
    }
    let four = pull_mean(twos);
    for (var quad = 0u; quad < 4u; quad++) {
        let pushed = select(twos[quad], four, twos[quad] >= 1e30);
        for (var i = 0u; i < 4u; i++) {
            let texel = pull_texel(block, 4u * quad + i);
            if all(texel < vec2u(side)) && pushed < 1e30 && texels[quad][i] >= 1e30 {
                imperfect_maps[map + texel.y * side + texel.x] = bitcast<u32>(pushed);
            }
        }
    }
}
