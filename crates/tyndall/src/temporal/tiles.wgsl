// Which pixels are stale. A tile of 8 x 8 pixels is asked as one: 16 slabs of the beam that its rays fill are held against the
// blocks of the shadow map that changed, then each of the eight parts of those that meet a change. Depth is compared pixel
// by pixel; after another camera's frame those pixels are stale instead that were not found in its picture.

@group(2) @binding(1) var<storage, read_write> tiles_state: ReuseState;
@group(2) @binding(2) var<storage, read> tiles_blocks: array<vec2f>;
@group(2) @binding(3) var<storage, read_write> tiles_depth: array<f32>;
@group(2) @binding(4) var<storage, read_write> tiles_age: array<u32>; // see REUSE_AGE
@group(2) @binding(5) var<storage, read_write> tiles_seen: array<vec2f>; // the witness of the frame before
@group(2) @binding(6) var<storage, read> tiles_witness: array<vec2f>; // see occluder/tile.wgsl
@group(2) @binding(7) var<storage, read> tiles_found: array<vec4u>; // see reproject.wgsl

const TILES_SIDE: u32 = 8u;
const TILES_SLABS: u32 = 16u;
const TILES_PARTS: u32 = 8u;
// While the camera rests, what is not exact is computed again within so many frames.
const TILES_TURNS: u32 = 8u;
// Blocks a side that a slab is held against at most, less one.
const TILES_SPAN: u32 = 3u;
// Rounding of places on the map [texels] and of depths, absolute and relative.
const TILES_TEXELS: f32 = 1.0;
const TILES_DEPTH: vec2f = vec2f(2e-6, 1e-5);

// A tile an invocation: none waits for another.
@compute @workgroup_size(8, 8)
fn tiles(@builtin(global_invocation_id) id: vec3u) {
    let corner = TILES_SIDE * id.xy;
    if any(corner >= reuse.pixels) {
        return;
    }
    let end = min(corner + TILES_SIDE, reuse.pixels);
    let mode = tiles_state.mode;
    let asks_for_change = frame_choice(reuse.mask) == REUSE_CHANGE;
    let is_its_turn = (id.x + 3u * id.y + tiles_state.turn) % TILES_TURNS == 0u;
    var farthest = 0.0;
    var computed = 0u;
    let witnessed = tiles_witness_changed(corner, mode);
    for (var y = corner.y; y < end.y; y++) {
        for (var x = corner.x; x < end.x; x++) {
            let place = y * reuse.pixels.x + x;
            let depth = textureLoad(frame_depth, vec2u(x, y), 0);
            farthest = max(farthest, camera_view_depth(depth));
            let memory = tiles_memory(place, mode, is_its_turn);
            let is_seen_changed = tiles_is_in(witnessed, vec2u(x, y) - corner);
            let is_depth_changed = tiles_depth_changed(place, depth) && asks_for_change && mode != REUSE_REPROJECT;
            let is_stale = is_depth_changed || is_seen_changed || memory == REUSE_LOST;
            tiles_age[place] = select(tiles_older(memory), 0u, is_stale);
            computed += u32(is_stale);
        }
    }
    let is_whole = mode < REUSE_MASKED || (asks_for_change && tiles_beam_changed(vec2f(corner), farthest));
    if is_whole {
        for (var y = corner.y; y < end.y; y++) {
            for (var x = corner.x; x < end.x; x++) {
                tiles_age[y * reuse.pixels.x + x] = 0u;
            }
        }
        computed = (end.x - corner.x) * (end.y - corner.y);
    }
    if mode >= REUSE_MASKED && computed > 0u {
        atomicAdd(&tiles_state.stale, computed);
    }
}

// What is remembered of what the pixel sees.
fn tiles_memory(place: u32, mode: u32, is_its_turn: bool) -> u32 {
    if mode == REUSE_REPROJECT {
        return tiles_found[place].w;
    }
    let memory = tiles_age[place];
    return select(memory, REUSE_LOST, is_its_turn && memory > REUSE_AGE);
}

// The same a frame later.
fn tiles_older(memory: u32) -> u32 {
    return (memory & REUSE_ERROR) | min((memory & REUSE_AGE) + 1u, REUSE_AGE);
}

// Whether the pixel's depth has changed; remembers it.
fn tiles_depth_changed(place: u32, depth: f32) -> bool {
    let is_changed = bitcast<u32>(tiles_depth[place]) != bitcast<u32>(depth);
    if is_changed {
        tiles_depth[place] = depth;
    }
    return is_changed;
}

// The quarters of a tile, a bit each, that what the last pass reads besides has changed of, for the same camera; remembers it.
fn tiles_witness_changed(corner: vec2u, mode: u32) -> u32 {
    var changed = 0u;
    for (var i = 0u; i < 4u * frame_choice(reuse.has_witness); i++) {
        let pixel = corner + OCCLUDER_TILE * vec2u(i & 1u, i >> 1u);
        if all(pixel < reuse.pixels) {
            let place = occluder_tile_of(pixel);
            let witness = tiles_witness[place];
            let is_other = any(bitcast<vec2u>(tiles_seen[place]) != bitcast<vec2u>(witness));
            tiles_seen[place] = witness;
            let is_stale = select(
                is_other && mode != REUSE_REPROJECT,
                occluder_is_met(witness),
                reuse.mask == REUSE_GEOMETRY,
            );
            changed |= u32(is_stale) << i;
        }
    }
    return changed;
}

// Whether a pixel of a tile is in one of these quarters.
fn tiles_is_in(quarters: u32, local: vec2u) -> bool {
    let quarter = local / OCCLUDER_TILE;
    return ((quarters >> (2u * quarter.y + quarter.x)) & 1u) == 1u;
}

// Whether any ray of a tile passes a change of the shadow map.
fn tiles_beam_changed(corner: vec2f, farthest: f32) -> bool {
    var is_changed = false;
    for (var i = 0u; i < TILES_SLABS && !is_changed; i++) {
        let slab = farthest * vec2f(f32(i), f32(i + 1u)) / f32(TILES_SLABS);
        let parts = select(0u, TILES_PARTS, tiles_slab_changed(corner, slab));
        for (var k = 0u; k < parts && !is_changed; k++) {
            let part = mix(vec2f(slab.x), vec2f(slab.y), vec2f(f32(k), f32(k + 1u)) / f32(TILES_PARTS));
            is_changed = tiles_slab_changed(corner, part);
        }
    }
    return is_changed;
}

// Eight corners of a slab of the beam: four rays round the tile, at two view depths.
fn tiles_slab_changed(corner: vec2f, depths: vec2f) -> bool {
    var points: array<vec3f, 8>;
    for (var i = 0u; i < 4u; i++) {
        let side = vec2f(f32(i & 1u), f32(i >> 1u));
        let place = corner + mix(vec2f(-reuse.margin), vec2f(f32(TILES_SIDE) + reuse.margin), side);
        let ray = tiles_ray(place);
        points[i] = ray.origin + depths.x * ray.direction;
        points[i + 4u] = ray.origin + depths.y * ray.direction;
    }
    for (var face = 0u; face < reuse.faces; face++) {
        if tiles_face_changed(points, face) {
            return true;
        }
    }
    return false;
}

// A ray by view depth: its direction is not of unit length.
fn tiles_ray(place: vec2f) -> Ray {
    let camera = frame.camera;
    let on_plane = camera.center + camera.half_extent * vec2f(2.0, -2.0) * (place / camera.size - 0.5);
    let offset = on_plane.x * camera.right + on_plane.y * camera.up;
    if camera_is_orthographic() {
        return Ray(offset, 1.0, camera.forward);
    }
    return Ray(vec3f(0.0), 1.0, camera.forward + offset);
}

// A point in a face's clip space, depth 1 nearest to the light; of a cube's faces see shadow_cube_point.
fn tiles_clip(point: vec3f, face: u32) -> vec4f {
    if SHADOW_KIND != SHADOW_CUBE {
        return light.clip_from_world * vec4f(point, 1.0);
    }
    let q = point - light.position;
    var p = vec3f(q.x, q.y, q.z);
    switch face {
        case 0u: { p = vec3f(-q.z, q.y, q.x); }
        case 1u: { p = vec3f(q.z, q.y, -q.x); }
        case 2u: { p = vec3f(q.x, -q.z, q.y); }
        case 3u: { p = vec3f(q.x, q.z, -q.y); }
        case 5u: { p = vec3f(-q.x, q.y, -q.z); }
        default: {}
    }
    return vec4f(p.xy, light.cube_depth.x + light.cube_depth.y * p.z, p.z);
}

fn tiles_face_changed(points: array<vec3f, 8>, face: u32) -> bool {
    var least = vec3f(1e30);
    var most = vec3f(-1e30);
    var nearest_w = 1e30;
    // On which side of the face's four planes all points lie.
    var outside = vec4<bool>(true);
    for (var i = 0u; i < 8u; i++) {
        let clip = tiles_clip(points[i], face);
        let room = TILES_TEXELS * 2.0 / vec2f(reuse.map) * abs(clip.w) + abs(clip.w) * 1e-6;
        outside = outside & (vec4f(clip.xy, -clip.xy) > vec4f(clip.w + room, clip.w + room));
        let on_map = vec3f(0.5 + vec2f(0.5, -0.5) * clip.xy / clip.w, clip.z / clip.w);
        least = min(least, on_map);
        most = max(most, on_map);
        nearest_w = min(nearest_w, clip.w);
    }
    if any(outside) {
        return false;
    }
    let size = vec2f(reuse.map);
    // Through the light's own plane: anywhere on the face, at any depth.
    let is_whole = !(nearest_w > 0.0);
    let first = select(floor(least.xy * size - TILES_TEXELS), vec2f(0.0), is_whole);
    let last = select(floor(most.xy * size + TILES_TEXELS), size, is_whole);
    let depths = select(vec2f(least.z, most.z), vec2f(-1e30, 1e30), is_whole);
    return tiles_blocks_changed(
        vec2u(clamp(first, vec2f(0.0), size - 1.0)),
        vec2u(clamp(last, vec2f(0.0), size - 1.0)),
        depths,
        face,
    );
}

// Whether texels from first to last changed visibility between these depths.
fn tiles_blocks_changed(first: vec2u, last: vec2u, depths: vec2f, face: u32) -> bool {
    let blocks = vec4u(first, last) / BLOCKS_SIDE;
    let span = max(blocks.z - blocks.x, blocks.w - blocks.y);
    var level = 0u;
    while (span >> level) >= TILES_SPAN && level + 1u < reuse.levels {
        level++;
    }
    let size = blocks_size(level);
    let start = blocks_start(level) + face * size.x * size.y;
    let at = blocks >> vec4u(level);
    var range = BLOCKS_NOTHING;
    for (var y = at.y; y <= at.w; y++) {
        for (var x = at.x; x <= at.z; x++) {
            let found = tiles_blocks[start + y * size.x + x];
            range = vec2f(min(range.x, found.x), max(range.y, found.y));
        }
    }
    let room = TILES_DEPTH.x + TILES_DEPTH.y * abs(depths);
    return range.x <= range.y && depths.y + room.y >= range.x && depths.x - room.x <= range.y;
}
