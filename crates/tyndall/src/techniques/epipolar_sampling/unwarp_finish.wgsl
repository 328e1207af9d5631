// Stage 10 and the phase function in one, where the rectangular picture is as large as the full one: what one hands to the
// other stays in registers. Pixels that have no fitting samples are listed.

@group(2) @binding(1) var<storage, read_write> unwarp_list: array<u32>;
@group(2) @binding(2) var<storage, read_write> unwarp_counts: array<atomic<u32>>;
@group(2) @binding(3) var airlight_table: texture_2d_array<f32>;
@group(2) @binding(6) var<storage, read_write> unwarp_dispatches: array<atomic<u32>>;

@fragment
fn unwarp_finish(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    let depth = sampling_view_depth(pixel);
    let sum = filter_sum(position.xy, depth);
    if sum.w < SAMPLING_LEAST_WEIGHT {
        let slot = atomicAdd(&unwarp_counts[SAMPLING_COUNT], 1u);
        atomicMax(&unwarp_dispatches[3], slot / MARCH_GROUP + 1u);
        unwarp_list[slot] = pixel.x | (pixel.y << 16u);
    }
    let share = sum.rgb / max(sum.w, SAMPLING_LEAST_WEIGHT);
    return finish_output(pixel, camera_ray_to(position.xy, depth), share);
}
