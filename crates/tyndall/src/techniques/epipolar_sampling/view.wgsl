// One of the debug views in place of the light.

const VIEW_SAMPLES: u32 = 1u;
const VIEW_DEPTH_BREAKS: u32 = 2u;
const VIEW_CORRECTED: u32 = 3u;

@group(2) @binding(1) var view_shares: texture_2d<f32>;
@group(2) @binding(2) var<storage, read> view_lines: array<ScreenLine>;
@group(2) @binding(3) var<storage, read> view_sources: array<u32>;

@fragment
fn view(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    let ray = camera_ray_to(position.xy, sampling_view_depth(pixel));
    let left = transmittance(frame.medium.sigma_t, ray.length);
    return vec4f(view_color(position.xy, textureLoad(view_shares, pixel, 0)), dot(left, vec3f(1.0 / 3.0)));
}

fn view_color(place: vec2f, found: vec4f) -> vec3f {
    let show = frame_choice(sampling.show);
    switch show {
        case VIEW_SAMPLES, VIEW_DEPTH_BREAKS: { return view_sample(place, show); }
        case VIEW_CORRECTED: { return select(vec3f(1.0, 0.0, 0.0), vec3f(0.2), found.a > 0.5); }
        default: { return found.rgb; }
    }
}

// Pixels that hold a sample of the nearest slice: white where it was marched, blue where it was interpolated; of the
// breaks only those that are marched because of one.
fn view_sample(place: vec2f, show: u32) -> vec3f {
    let slices = sampling_slices(place);
    let slice = select(slices.first, slices.second, slices.share >= 0.5);
    let line = view_lines[slice];
    let sample = round(screen_sample(line, place));
    let offset = line.entry + sample * line.step - place;
    if all(line.step == vec2f(0.0)) || any(abs(offset) > vec2f(0.5)) || sample < 0.0 || u32(sample) >= sampling.samples {
        return vec3f(0.0);
    }
    let source = view_sources[slice * sampling.samples + u32(sample)] & 0xffffu;
    let is_marched = source == u32(sample);
    if show == VIEW_DEPTH_BREAKS {
        return vec3f(f32(is_marched && u32(sample) % sampling.initial_step != 0u));
    }
    return select(vec3f(0.0, 0.0, 0.4), vec3f(1.0), is_marched);
}
