// Fills the holes of imperfect shadow maps, in blocks of 16 x 16 texels: pulls means of what is near to the light up to
// blocks of 4, and pushes them down to texels that hold nothing.

@group(2) @binding(0) var<uniform> imperfect_batch: ImperfectBatch;
@group(2) @binding(1) var<storage, read_write> imperfect_maps: array<u32>;

// Texels of two means this much apart (relative) are of different surfaces.
const PULL_APART: f32 = 0.1;
// Cells of the four below that must hold something for theirs to.
const PULL_LEAST: u32 = 2u;

// Texels, cells of 2 x 2 and cells of 4 x 4, one level after the other; 1e30 is nothing.
var<workgroup> pull_cells: array<f32, 336>;

// The mean of those of four cells that are about as near to the light as the nearest.
fn pull_mean(cells: vec4f) -> f32 {
    let holds = cells < vec4f(1e30);
    let count = dot(vec4u(holds), vec4u(1u));
    let nearest = min(min(cells.x, cells.y), min(cells.z, cells.w));
    let near = vec4f(cells <= vec4f(nearest * (1.0 + PULL_APART)));
    let mean = dot(near, min(cells, vec4f(1e20))) / dot(near, vec4f(1.0));
    return select(1e30, mean, count >= PULL_LEAST);
}

fn pull_four(first: u32, width: u32, cell: vec2u) -> vec4f {
    let corner = first + 2u * cell.y * width + 2u * cell.x;
    return vec4f(pull_cells[corner], pull_cells[corner + 1u], pull_cells[corner + width], pull_cells[corner + width + 1u]);
}

@compute @workgroup_size(16, 16)
fn pull_push(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_id) texel: vec3u,
    @builtin(local_invocation_index) thread: u32,
) {
    let side = imperfect_batch.side;
    let is_inside = all(id.xy < vec2u(side));
    let index = (id.z * side + min(id.y, side - 1u)) * side + min(id.x, side - 1u);
    let stored = imperfect_maps[index];
    pull_cells[thread] = select(1e30, bitcast<f32>(stored), is_inside && stored != IMPERFECT_NOTHING);
    workgroupBarrier();
    if thread < 64u {
        pull_cells[256u + thread] = pull_mean(pull_four(0u, 16u, vec2u(thread % 8u, thread / 8u)));
    }
    workgroupBarrier();
    if thread < 16u {
        pull_cells[320u + thread] = pull_mean(pull_four(256u, 8u, vec2u(thread % 4u, thread / 4u)));
    }
    workgroupBarrier();
    let by_two = pull_cells[256u + (texel.y / 2u) * 8u + texel.x / 2u];
    let by_four = pull_cells[320u + (texel.y / 4u) * 4u + texel.x / 4u];
    let pushed = select(by_two, by_four, by_two >= 1e30);
    if is_inside && stored == IMPERFECT_NOTHING && pushed < 1e30 {
        imperfect_maps[index] = bitcast<u32>(pushed);
    }
}
