// Stage 8: ray marching of the listed samples.

@group(2) @binding(4) var<storage, read> samples_lines: array<ScreenLine>;
@group(2) @binding(5) var<storage, read> samples_depth: array<f32>;
@group(2) @binding(6) var<storage, read> samples_list: array<u32>;
@group(2) @binding(7) var<storage, read> samples_counts: array<u32>;
@group(2) @binding(8) var<storage, read_write> samples_values: array<vec4f>;

@compute @workgroup_size(64)
fn march_samples(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= samples_counts[0] {
        return;
    }
    let here = samples_list[id.x];
    let slice = here / sampling.samples;
    let line = samples_lines[slice];
    let place = line.entry + f32(here % sampling.samples) * line.step;
    let ray = camera_ray_to(place, samples_depth[here]);
    samples_values[here] = vec4f(march_sample(slice, ray), 1.0);
}
