// Compares the shadow map with the one that the frame before saw, remembers it, and marks where visibility changed.

@group(2) @binding(1) var<storage, read_write> change_blocks: array<vec2f>;
@group(2) @binding(2) var<storage, read_write> change_seen: array<f32>;
@group(2) @binding(3) var<uniform> change_level: vec4u;

@compute @workgroup_size(8, 8)
fn change_finest(@builtin(global_invocation_id) id: vec3u) {
    let blocks = blocks_size(0u);
    if any(id.xy >= blocks) {
        return;
    }
    var range = BLOCKS_NOTHING;
    let end = min((id.xy + 1u) * BLOCKS_SIDE, reuse.map);
    for (var y = id.y * BLOCKS_SIDE; y < end.y; y++) {
        for (var x = id.x * BLOCKS_SIDE; x < end.x; x++) {
            let place = (id.z * reuse.map.y + y) * reuse.map.x + x;
            let before = change_seen[place];
            let now = textureLoad(shadow_map, vec2u(x, y), id.z, 0);
            if bitcast<u32>(before) != bitcast<u32>(now) {
                change_seen[place] = now;
                let depths = vec2f(change_depth(before), change_depth(now));
                range = vec2f(min(range.x, min(depths.x, depths.y)), max(range.y, max(depths.x, depths.y)));
            }
        }
    }
    change_blocks[(id.z * blocks.y + id.y) * blocks.x + id.x] = range;
}

// Nearer than this nothing is blocked.
fn change_depth(held: f32) -> f32 {
    let depth = select(held, 1.0 - held, light.standard_depth == 1u);
    return select(depth, BLOCKS_BEYOND, depth <= 0.0);
}

@compute @workgroup_size(8, 8)
fn change_coarser(@builtin(global_invocation_id) id: vec3u) {
    let level = change_level.x;
    let blocks = blocks_size(level);
    if any(id.xy >= blocks) {
        return;
    }
    let finer = blocks_size(level - 1u);
    let finer_start = blocks_start(level - 1u);
    var range = BLOCKS_NOTHING;
    for (var k = 0u; k < 4u; k++) {
        let place = 2u * id.xy + vec2u(k & 1u, k >> 1u);
        if all(place < finer) {
            let found = change_blocks[finer_start + (id.z * finer.y + place.y) * finer.x + place.x];
            range = vec2f(min(range.x, found.x), max(range.y, found.y));
        }
    }
    change_blocks[blocks_start(level) + (id.z * blocks.y + id.y) * blocks.x + id.x] = range;
}
