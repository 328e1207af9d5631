// Stages 11 and 13: pixels without fitting sources are marched.

struct CorrectParams {
    list: u32, // which of the counts
    downscale: u32, // of the picture that is corrected
}

@group(2) @binding(4) var<uniform> correct_params: CorrectParams;
@group(2) @binding(5) var<storage, read> correct_list: array<u32>;
@group(2) @binding(6) var<storage, read> correct_counts: array<u32>;
@group(2) @binding(7) var correct_out: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(64)
fn correct(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= correct_counts[SAMPLING_COUNT * correct_params.list] {
        return;
    }
    let packed = correct_list[id.x];
    let target_pixel = vec2u(packed & 0xffffu, packed >> 16u);
    let pixel = select(target_pixel, coarse_pixel(target_pixel), correct_params.downscale > 1u);
    let place = vec2f(pixel) + 0.5;
    let ray = camera_ray_to(place, sampling_view_depth(pixel));
    // Alpha marks it for the debug views.
    textureStore(correct_out, target_pixel, vec4f(march_pixel(place, ray), 0.0));
}
