// Stages 11 and 13: pixels without fitting sources are marched, in the two slices they lie between; where those are not on
// the picture, in a slice of their own, without a tree.

struct CorrectParams {
    list: u32, // which of the counts
    downscale: u32, // of the picture that is corrected
}

@group(2) @binding(1) var<uniform> correct_params: CorrectParams;
@group(2) @binding(2) var correct_linear_depth: texture_2d<f32>;
@group(2) @binding(3) var<storage, read> correct_lines: array<ScreenLine>;
@group(2) @binding(4) var<storage, read> correct_traces: array<Trace>;
@group(2) @binding(5) var<storage, read> march_nodes: array<vec2f>;
@group(2) @binding(6) var<storage, read> correct_list: array<u32>;
@group(2) @binding(7) var<storage, read> correct_counts: array<u32>;
@group(2) @binding(8) var correct_out: texture_storage_2d<rgba32float, write>;
@group(2) @binding(9) var airlight_table: texture_2d_array<f32>;

@compute @workgroup_size(64)
fn correct(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= correct_counts[correct_params.list] {
        return;
    }
    let packed = correct_list[id.x];
    let target_pixel = vec2u(packed & 0xffffu, packed >> 16u);
    var pixel = target_pixel;
    if correct_params.downscale > 1u {
        pixel = coarse_pixel(target_pixel);
    }
    let place = vec2f(pixel) + 0.5;
    let ray = camera_ray_to(place, textureLoad(correct_linear_depth, pixel, 0).r);
    // Alpha marks it for the debug views.
    textureStore(correct_out, target_pixel, vec4f(correct_ray(place, ray), 0.0));
}

fn correct_ray(place: vec2f, ray: Ray) -> vec3f {
    let slices = epipolar_slices(place);
    var sum = vec4f(0.0);
    for (var i = 0u; i < 3u && (i < 2u || sum.w < EPIPOLAR_LEAST_WEIGHT); i++) {
        var slice = select(slices.first, slices.second, i == 1u);
        var weight = select(1.0 - slices.share, slices.share, i == 1u);
        var levels = epipolar.levels;
        var trace = correct_traces[slice];
        if i == 2u {
            trace = trace_slice(place, screen_direction(epipolar.epipole, place), epipolar.axis);
            levels = 0u;
            weight = 1.0;
        } else if all(correct_lines[slice].step == vec2f(0.0)) {
            continue;
        }
        sum += weight * vec4f(march(slice, trace, levels, ray), 1.0);
    }
    return sum.rgb / sum.w;
}
