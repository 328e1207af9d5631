// The intensity of each sample along the light's normal [W/sr]: its share of the light, in the colour of its picture.

@group(2) @binding(0) var<uniform> imperfect_batch: ImperfectBatch;
@group(2) @binding(1) var<storage, read> imperfect_samples: array<ImperfectSample>;
@group(2) @binding(2) var<storage, read_write> imperfect_colors: array<vec4f>;

@compute @workgroup_size(64)
fn imperfect_color(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= imperfect_batch.total {
        return;
    }
    let tint = light_tint(imperfect_samples[id.x].position);
    imperfect_colors[id.x] = vec4f(light.color * tint * imperfect_batch.share, 0.0);
}
