// Stage 9: the samples that were not marched, between their two sources. All go into a picture, a slice a row: the mean
// visibility (rgb) and the view depth [m] (a), -1 outside the picture.

@group(2) @binding(1) var<storage, read> interpolate_sources: array<u32>;
@group(2) @binding(2) var<storage, read> interpolate_depth: array<f32>;
@group(2) @binding(3) var<storage, read> interpolate_marched: array<vec4f>;
@group(2) @binding(4) var interpolate_out: texture_storage_2d<rgba32float, write>;

@compute @workgroup_size(64)
fn interpolate(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= sampling.samples {
        return;
    }
    let start = id.y * sampling.samples;
    let sources = interpolate_sources[start + id.x];
    let first = sources & 0xffffu;
    let second = sources >> 16u;
    // One that is marched is its own source.
    let share = f32(id.x - first) / f32(max(second - first, 1u));
    let value = mix(interpolate_marched[start + first].rgb, interpolate_marched[start + second].rgb, share);
    let depth = interpolate_depth[start + id.x];
    textureStore(interpolate_out, id.xy, select(vec4f(value, depth), vec4f(0.0, 0.0, 0.0, -1.0), depth < 0.0));
}
