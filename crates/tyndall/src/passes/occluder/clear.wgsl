// What is known of shadows on the screen before any is looked at.

@group(2) @binding(0) var<storage, read_write> clear_eye_in_shadow: u32;
@group(2) @binding(1) var<storage, read_write> clear_tiles: array<vec2f>; // see tile.wgsl

const CLEAR_LANES: u32 = 64u;

@compute @workgroup_size(1)
fn clear_eye() {
    clear_eye_in_shadow = 0u;
}

// Where the eye is in a shadow, every ray begins in it.
@compute @workgroup_size(64)
fn clear_bounds(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let tile = id.y * groups.x * CLEAR_LANES + id.x;
    if tile < arrayLength(&clear_tiles) {
        clear_tiles[tile] = vec2f(select(OCCLUDER_BEYOND, 0.0, clear_eye_in_shadow != 0u), 0.0);
    }
}
