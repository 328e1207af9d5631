// Stage 10: from epipolar coordinates to a rectangular picture, `downscale` times smaller on each side. Pixels that have no
// fitting samples are listed.

@group(2) @binding(1) var unwarp_out: texture_storage_2d<rgba32float, write>;
@group(2) @binding(2) var<storage, read_write> unwarp_list: array<u32>;
@group(2) @binding(3) var<storage, read_write> unwarp_counts: array<atomic<u32>>;
@group(2) @binding(6) var<storage, read_write> unwarp_dispatches: array<atomic<u32>>;

@compute @workgroup_size(16, 8)
fn unwarp(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= sampling.coarse_size) {
        return;
    }
    let pixel = coarse_pixel(id.xy);
    let sum = filter_sum(vec2f(pixel) + 0.5, sampling_view_depth(pixel));
    if sum.w >= SAMPLING_LEAST_WEIGHT {
        textureStore(unwarp_out, id.xy, vec4f(sum.rgb / sum.w, 1.0));
        return;
    }
    let slot = atomicAdd(&unwarp_counts[SAMPLING_COUNT], 1u);
    atomicMax(&unwarp_dispatches[3], slot / MARCH_GROUP + 1u);
    unwarp_list[slot] = id.x | (id.y << 16u);
}
