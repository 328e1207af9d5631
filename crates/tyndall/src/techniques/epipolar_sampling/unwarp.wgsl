// Stage 10: from epipolar coordinates to a rectangular picture, `downscale` times smaller on each side. Bilinear between the
// two nearest samples of the two nearest slices, as far as their depths are like the pixel's; pixels that have no such
// samples are listed.

@group(2) @binding(1) var unwarp_linear_depth: texture_2d<f32>;
@group(2) @binding(2) var<storage, read> unwarp_lines: array<ScreenLine>;
@group(2) @binding(3) var unwarp_samples: texture_2d<f32>;
@group(2) @binding(4) var unwarp_out: texture_storage_2d<rgba32float, write>;
@group(2) @binding(5) var<storage, read_write> unwarp_list: array<u32>;
@group(2) @binding(6) var<storage, read_write> unwarp_counts: array<atomic<u32>>;
@group(2) @binding(7) var<storage, read_write> unwarp_dispatches: array<atomic<u32>>;

@compute @workgroup_size(16, 8)
fn unwarp(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= sampling.coarse_size) {
        return;
    }
    let pixel = coarse_pixel(id.xy);
    let place = vec2f(pixel) + 0.5;
    let depth = textureLoad(unwarp_linear_depth, pixel, 0).r;
    let slices = sampling_slices(place);
    let sum = unwarp_slice(slices.first, place, depth) * (1.0 - slices.share)
        + unwarp_slice(slices.second, place, depth) * slices.share;
    if sum.w >= SAMPLING_LEAST_WEIGHT {
        textureStore(unwarp_out, id.xy, vec4f(sum.rgb / sum.w, 1.0));
        return;
    }
    let slot = atomicAdd(&unwarp_counts[1], 1u);
    atomicMax(&unwarp_dispatches[3], slot / MARCH_GROUP + 1u);
    unwarp_list[slot] = id.x | (id.y << 16u);
}

// Weighted values of two samples of a slice, and their weight.
fn unwarp_slice(slice: u32, place: vec2f, depth: f32) -> vec4f {
    let line = unwarp_lines[slice];
    let sample = clamp(screen_sample(line, place), 0.0, f32(sampling.samples - 1u));
    let first = min(u32(sample), sampling.samples - 2u);
    let share = sample - f32(first);
    let here = textureLoad(unwarp_samples, vec2u(first, slice), 0);
    let next = textureLoad(unwarp_samples, vec2u(first + 1u, slice), 0);
    let a = (1.0 - share) * sampling_similarity(depth, here.a);
    let b = share * sampling_similarity(depth, next.a);
    return a * vec4f(here.rgb, 1.0) + b * vec4f(next.rgb, 1.0);
}
