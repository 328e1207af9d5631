// Builds the rows of tint.wgsl: a workgroup a slice. Sampled on light rays in the middle of slice and column.

@group(2) @binding(0) var<uniform> epipolar: Epipolar;
@group(2) @binding(1) var<storage, read_write> tint_sums: array<vec4f>;

const TINT_THREADS: u32 = 64u;

var<workgroup> tint_totals: array<vec3f, TINT_THREADS>;

fn tint_store(slice: u32, border: u32, sum: vec3f) {
    tint_sums[tint_index(epipolar, slice, border)] = vec4f(sum, 0.0);
}

fn tint_column(alpha: f32, outward: vec3f, column: u32) -> vec3f {
    let gamma = epipolar.tint_start + (f32(column) + 0.5) * epipolar.tint_step;
    let ray = epipolar_light_ray(epipolar, alpha, outward, gamma);
    return light_ray_tint(ray.origin + ray.way);
}

@compute @workgroup_size(TINT_THREADS)
fn tint_rows(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) thread: u32) {
    let slice = group.x;
    let alpha = epipolar.alpha_start + (f32(slice) + 0.5) * epipolar.alpha_step;
    let outward = epipolar_outward(epipolar, alpha);
    let count = epipolar.tint_columns / TINT_THREADS;
    let first = count * thread;
    var total = vec3f(0.0);
    for (var i = 0u; i < count; i++) {
        total += tint_column(alpha, outward, first + i);
        tint_store(slice, first + i + 1u, total);
    }
    tint_totals[thread] = total;
    workgroupBarrier();
    var before = vec3f(0.0);
    for (var i = 0u; i < thread; i++) {
        before += tint_totals[i];
    }
    for (var i = 1u; i <= count; i++) {
        tint_sums[tint_index(epipolar, slice, first + i)] += vec4f(before, 0.0);
    }
    if thread == 0u {
        tint_store(slice, 0u, vec3f(0.0));
    }
}
