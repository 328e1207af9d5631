// What was gathered, to the output.

@group(2) @binding(0) var<uniform> imperfect_batch: ImperfectBatch;
@group(2) @binding(1) var<uniform> ivsv: IvsvParams;
@group(2) @binding(2) var<storage, read> ivsv_sums: array<vec4f>;

@fragment
fn ivsv_resolve(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let ray = frame_ray(position);
    var sum = vec4f(0.0);
    for (var i = 0u; i < 9u; i++) {
        let tap = ivsv_tap(vec2u(position.xy), ray.length, i);
        sum += tap.weight * ivsv_sums[tap.index];
    }
    return frame_output(position, ray, sum.rgb * (f32(imperfect_batch.total) / max(sum.a, 1e-20)));
}
