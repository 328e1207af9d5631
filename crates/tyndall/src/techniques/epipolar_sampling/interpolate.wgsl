// Stage 9: the samples that were not marched, between their two sources.

@group(2) @binding(1) var<storage, read> interpolate_sources: array<u32>;
@group(2) @binding(2) var<storage, read_write> interpolate_values: array<vec4f>;

@compute @workgroup_size(64)
fn interpolate(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= epipolar.samples {
        return;
    }
    let start = id.y * epipolar.samples;
    let sources = interpolate_sources[start + id.x];
    let first = sources & 0xffffu;
    let second = sources >> 16u;
    // One that is its own source is there already.
    if first != second {
        let share = f32(id.x - first) / f32(second - first);
        interpolate_values[start + id.x] = mix(interpolate_values[start + first], interpolate_values[start + second], share);
    }
}
