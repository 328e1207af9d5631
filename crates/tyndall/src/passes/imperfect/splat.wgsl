// Points of the cloud onto the maps of all samples of a batch.

@group(2) @binding(0) var<uniform> imperfect_batch: ImperfectBatch;
@group(2) @binding(1) var<storage, read> imperfect_samples: array<ImperfectSample>;
@group(2) @binding(2) var<storage, read> imperfect_cloud: array<vec4f>;
@group(2) @binding(3) var<storage, read_write> imperfect_maps: array<atomic<u32>>;

// A thread takes every so many-th of the points of a sample's map.
@compute @workgroup_size(64)
fn imperfect_splat(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let sample = imperfect_samples[imperfect_batch.first + id.y];
    for (var i = id.x; i < imperfect_batch.points; i += 64u * groups.x) {
        // No map has more points than there are.
        let turn = sample.first_point + i;
        let point = imperfect_cloud[select(turn, turn - imperfect_batch.cloud, turn >= imperfect_batch.cloud)];
        imperfect_splat_point(sample, id.y, point);
    }
}

fn imperfect_splat_point(sample: ImperfectSample, tile: u32, point: vec4f) {
    let batch = imperfect_batch;
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
    let map = tile * batch.side * batch.side;
    for (var y = low.y; y <= high.y; y++) {
        for (var x = low.x; x <= high.x; x++) {
            atomicMin(&imperfect_maps[map + u32(y * side + x)], bitcast<u32>(distance));
        }
    }
}
