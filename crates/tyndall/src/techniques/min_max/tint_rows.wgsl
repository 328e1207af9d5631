// Builds the rows of tint.wgsl: a workgroup a slice and term. Sampled on light rays in the middle of slice and column.

@group(2) @binding(0) var<uniform> epipolar: Epipolar;
@group(2) @binding(1) var<uniform> svd: Svd;
@group(2) @binding(2) var<storage, read> svd_factors: array<vec4f>;
@group(2) @binding(3) var<storage, read_write> tint_sums: array<vec4f>;

const TINT_THREADS: u32 = 64u;

var<workgroup> tint_totals: array<vec3f, TINT_THREADS>;

fn tint_column(alpha: f32, outward: vec3f, term: u32, column: u32) -> vec3f {
    let gamma = epipolar.tint_start + (f32(column) + 0.5) * epipolar.tint_step;
    let ray = epipolar_light_ray(epipolar, alpha, outward, gamma);
    let tint = light_ray_tint(ray.origin + ray.way);
    if SVD {
        return tint * svd_at(term, SVD_GAMMA, svd_place(svd, gamma));
    }
    return tint;
}

@compute @workgroup_size(TINT_THREADS)
fn tint_rows(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let slice = group.x;
    let row = tint_index(epipolar, slice, group.y, 0u);
    let alpha = epipolar.alpha_start + (f32(slice) + 0.5) * epipolar.alpha_step;
    let outward = epipolar_outward(epipolar, alpha);
    let count = frame_choice(epipolar.tint_columns / TINT_THREADS);
    let first = count * thread;
    var total = vec3f(0.0);
    for (var i = 0u; i < count; i++) {
        total += tint_column(alpha, outward, group.y, first + i);
        tint_sums[row + first + i + 1u] = vec4f(total, 0.0);
    }
    tint_totals[thread] = total;
    workgroupBarrier();
    var before = vec3f(0.0);
    for (var i = 0u; i < thread; i++) {
        before += tint_totals[i];
    }
    for (var i = 1u; i <= count; i++) {
        tint_sums[row + first + i] += vec4f(before, 0.0);
    }
    if thread == 0u {
        tint_sums[row] = vec4f(0.0);
    }
}
