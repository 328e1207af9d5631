// Stage 12: to full resolution, with the same filter: bilinear as far as depths are alike, the other pixels are listed.

@group(2) @binding(1) var upscale_coarse: texture_2d<f32>;
@group(2) @binding(2) var upscale_out: texture_storage_2d<rgba32float, write>;
@group(2) @binding(3) var<storage, read_write> upscale_list: array<u32>;
@group(2) @binding(4) var<storage, read_write> upscale_counts: array<atomic<u32>>;
@group(2) @binding(5) var<storage, read_write> upscale_dispatches: array<atomic<u32>>;

@compute @workgroup_size(16, 8)
fn upscale(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= vec2u(frame.camera.size)) {
        return;
    }
    let depth = sampling_view_depth(id.xy);
    let place = (vec2f(id.xy) - f32(sampling.downscale / 2u)) / f32(sampling.downscale);
    let base = vec2i(floor(place));
    let share = place - floor(place);
    var sum = vec4f(0.0);
    for (var i = 0; i < 4; i++) {
        let corner = vec2i(i & 1, i >> 1);
        let coarse = vec2u(clamp(base + corner, vec2i(0), vec2i(sampling.coarse_size) - 1));
        let source = sampling_view_depth(coarse_pixel(coarse));
        let weights = select(1.0 - share, share, corner == vec2i(1));
        let weight = weights.x * weights.y * sampling_similarity(depth, source);
        sum += weight * vec4f(textureLoad(upscale_coarse, coarse, 0).rgb, 1.0);
    }
    if sum.w >= SAMPLING_LEAST_WEIGHT {
        textureStore(upscale_out, id.xy, vec4f(sum.rgb / sum.w, 1.0));
        return;
    }
    let slot = atomicAdd(&upscale_counts[2u * SAMPLING_COUNT], 1u);
    atomicMax(&upscale_dispatches[6], slot / MARCH_GROUP + 1u);
    upscale_list[slot] = id.x | (id.y << 16u);
}
