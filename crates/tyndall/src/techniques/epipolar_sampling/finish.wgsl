// The unshadowed light and the phase function, at full resolution; or one of the debug views in its place.

const FINISH_LIGHT: u32 = 0u;
const FINISH_SAMPLES: u32 = 1u;
const FINISH_DEPTH_BREAKS: u32 = 2u;
const FINISH_CORRECTED: u32 = 3u;

@group(2) @binding(1) var finish_in_scatter: texture_2d<f32>;
@group(2) @binding(2) var finish_linear_depth: texture_2d<f32>;
@group(2) @binding(3) var<storage, read> finish_lines: array<ScreenLine>;
@group(2) @binding(4) var<storage, read> finish_sources: array<u32>;
@group(2) @binding(5) var airlight_table: texture_2d_array<f32>;

@fragment
fn finish(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    let ray = camera_ray_to(position.xy, textureLoad(finish_linear_depth, pixel, 0).r);
    let left = transmittance(frame.medium.sigma_t, ray.length);
    let mean_left = dot(left, vec3f(1.0 / 3.0));
    let found = textureLoad(finish_in_scatter, pixel, 0);
    let show = frame_choice(sampling.show);
    if show != FINISH_LIGHT {
        return vec4f(finish_view(position.xy, found, show), mean_left);
    }
    var radiance = found.rgb * unshadowed_from(ray, left);
    if !light_is_local() {
        radiance *= medium_scattering(-dot(light.direction, ray.direction)) * light.color;
    }
    return vec4f(textureLoad(frame_lights_before, pixel, 0).rgb + radiance, mean_left);
}

fn finish_view(place: vec2f, found: vec4f, show: u32) -> vec3f {
    switch show {
        case FINISH_SAMPLES, FINISH_DEPTH_BREAKS: { return finish_sample_view(place, show); }
        case FINISH_CORRECTED: { return select(vec3f(1.0, 0.0, 0.0), vec3f(0.2), found.a > 0.5); }
        default: { return found.rgb; }
    }
}

// Pixels that hold a sample of the nearest slice: white where it was marched, blue where it was interpolated; of the
// breaks only those that are marched because of one.
fn finish_sample_view(place: vec2f, show: u32) -> vec3f {
    let slices = sampling_slices(place);
    let slice = select(slices.first, slices.second, slices.share >= 0.5);
    let line = finish_lines[slice];
    let sample = round(screen_sample(line, place));
    let offset = line.entry + sample * line.step - place;
    if all(line.step == vec2f(0.0)) || any(abs(offset) > vec2f(0.5)) || sample < 0.0 || u32(sample) >= sampling.samples {
        return vec3f(0.0);
    }
    let source = finish_sources[slice * sampling.samples + u32(sample)] & 0xffffu;
    let is_marched = source == u32(sample);
    if show == FINISH_DEPTH_BREAKS {
        return vec3f(f32(is_marched && u32(sample) % sampling.initial_step != 0u));
    }
    return select(vec3f(0.0, 0.0, 0.4), vec3f(1.0), is_marched);
}
