// Samples as a pixel sees them: bilinear between the two nearest samples of the two nearest slices, as far as their depths
// are like the pixel's (Yusov 2012, section 6.6).

@group(2) @binding(4) var<storage, read> filter_lines: array<ScreenLine>;
@group(2) @binding(5) var filter_samples: texture_2d<f32>;

// The weighted values about a place on the picture [pixels] of this view depth [m], and their weight.
fn filter_sum(place: vec2f, depth: f32) -> vec4f {
    let slices = sampling_slices(place);
    return filter_slice(slices.first, place, depth) * (1.0 - slices.share)
        + filter_slice(slices.second, place, depth) * slices.share;
}

// Weighted values of two samples of a slice, and their weight.
fn filter_slice(slice: u32, place: vec2f, depth: f32) -> vec4f {
    let line = filter_lines[slice];
    let sample = clamp(screen_sample(line, place), 0.0, f32(sampling.samples - 1u));
    let first = min(u32(sample), sampling.samples - 2u);
    let share = sample - f32(first);
    let here = textureLoad(filter_samples, vec2u(first, slice), 0);
    let next = textureLoad(filter_samples, vec2u(first + 1u, slice), 0);
    let a = (1.0 - share) * sampling_similarity(depth, here.a);
    let b = share * sampling_similarity(depth, next.a);
    return a * vec4f(here.rgb, 1.0) + b * vec4f(next.rgb, 1.0);
}
