// Points of the cloud onto the maps of all samples of a batch.

@group(2) @binding(0) var<uniform> imperfect_batch: ImperfectBatch;
@group(2) @binding(1) var<storage, read> imperfect_samples: array<ImperfectSample>;
@group(2) @binding(2) var<storage, read> imperfect_cloud: array<vec4f>;
@group(2) @binding(3) var<storage, read_write> imperfect_maps: array<atomic<u32>>;

@compute @workgroup_size(64)
fn imperfect_splat(@builtin(global_invocation_id) id: vec3u) {
    let batch = imperfect_batch;
    if id.x >= batch.points {
        return;
    }
    let sample = imperfect_samples[batch.first + id.y];
    let point = imperfect_cloud[(sample.first_point + id.x) % batch.cloud];
    let offset = point.xyz - sample.world;
    let local = imperfect_local(sample, offset);
    if local.z <= 0.0 {
        return;
    }
    let distance = length(offset);
    let side = i32(batch.side);
    let place = vec2i(imperfect_place(local) * f32(side));
    let reach = imperfect_reach(batch.side, point.w * batch.spread, distance);
    let low = clamp(place - reach, vec2i(0), vec2i(side - 1));
    let high = clamp(place + reach, vec2i(0), vec2i(side - 1));
    let map = id.y * batch.side * batch.side;
    for (var y = low.y; y <= high.y; y++) {
        for (var x = low.x; x <= high.x; x++) {
            atomicMin(&imperfect_maps[map + u32(y * side + x)], bitcast<u32>(distance));
        }
    }
}
