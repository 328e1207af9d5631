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
const TILES_LANES: u32 = 16u;
// Pixels an invocation.
const TILES_PIXELS: u32 = TILES_SIDE * TILES_SIDE / TILES_LANES;
const TILES_SLABS: u32 = 16u;
const TILES_PARTS: u32 = 8u;
// While the camera rests, what is not exact is computed again within so many frames.
const TILES_TURNS: u32 = 8u;
// Blocks a side that a slab is held against at most, less one.
const TILES_SPAN: u32 = 3u;
// Rounding of places on the map [texels] and of depths, absolute and relative.
const TILES_TEXELS: f32 = 1.0;
const TILES_DEPTH: vec2f = vec2f(2e-6, 1e-5);

var<workgroup> tiles_farthest: atomic<u32>;
var<workgroup> tiles_near: atomic<u32>; // a bit a slab
var<workgroup> tiles_touched: atomic<u32>;
var<workgroup> tiles_stale: atomic<u32>;

@compute @workgroup_size(16)
fn tiles(@builtin(workgroup_id) tile: vec3u, @builtin(local_invocation_index) lane: u32) {
    var stale = 0u; // a bit a pixel of this invocation's
    var deepest = 0.0;
    for (var i = 0u; i < TILES_PIXELS; i++) {
        let pixel = tiles_pixel(tile.xy, lane, i);
        if all(pixel < reuse.pixels) {
            let place = pixel.y * reuse.pixels.x + pixel.x;
            let depth = textureLoad(frame_depth, pixel, 0);
            deepest = max(deepest, camera_view_depth(depth));
            let is_stale = tiles_pixel_changed(pixel, place, depth) || tiles_memory(tile.xy, place) == REUSE_LOST;
            stale |= u32(is_stale) << i;
        }
    }
    atomicMax(&tiles_farthest, bitcast<u32>(deepest));
    workgroupBarrier();
    let corner = vec2f(TILES_SIDE * tile.xy);
    let farthest = bitcast<f32>(atomicLoad(&tiles_farthest));
    let slabs = select(0u, TILES_SLABS, reuse.mask == REUSE_CHANGE);
    for (var i = lane; i < slabs; i += TILES_LANES) {
        if tiles_slab_changed(corner, farthest * vec2f(f32(i), f32(i + 1u)) / f32(TILES_SLABS)) {
            atomicOr(&tiles_near, 1u << i);
        }
    }
    workgroupBarrier();
    // Once a part meets a change, the whole tile is stale.
    let near = atomicLoad(&tiles_near);
    let parts = TILES_PARTS * countOneBits(near);
    for (var i = lane; i < parts; i += TILES_LANES) {
        let first = f32(TILES_PARTS * tiles_bit(near, i / TILES_PARTS) + i % TILES_PARTS);
        if tiles_slab_changed(corner, farthest * vec2f(first, first + 1.0) / f32(TILES_PARTS * TILES_SLABS)) {
            atomicStore(&tiles_touched, 1u);
        }
    }
    workgroupBarrier();
    var computed = 0u;
    let is_whole = tiles_state.mode < REUSE_MASKED || atomicLoad(&tiles_touched) != 0u;
    for (var i = 0u; i < TILES_PIXELS; i++) {
        let pixel = tiles_pixel(tile.xy, lane, i);
        if all(pixel < reuse.pixels) {
            let is_computed = is_whole || ((stale >> i) & 1u) == 1u;
            tiles_settle(tile.xy, pixel, is_computed);
            computed += u32(is_computed);
        }
    }
    atomicAdd(&tiles_stale, computed);
    workgroupBarrier();
    if lane == 0u && tiles_state.mode >= REUSE_MASKED {
        let stale_in_all = atomicLoad(&tiles_stale);
        if stale_in_all > 0u {
            atomicAdd(&tiles_state.stale, stale_in_all);
        }
    }
}

// An invocation's pixels, two rows of the tile apart.
fn tiles_pixel(tile: vec2u, lane: u32, i: u32) -> vec2u {
    let index = TILES_LANES * i + lane;
    return TILES_SIDE * tile + vec2u(index % TILES_SIDE, index / TILES_SIDE);
}

// Leaves how old a pixel is, and what it was computed from.
fn tiles_settle(tile: vec2u, pixel: vec2u, is_computed: bool) {
    let place = pixel.y * reuse.pixels.x + pixel.x;
    let memory = tiles_memory(tile, place);
    let age = min((memory & REUSE_AGE) + 1u, REUSE_AGE);
    tiles_age[place] = select((memory & REUSE_ERROR) | age, 0u, is_computed);
    tiles_remember(pixel);
}

// The place of a number's bit `index`, of those that are set.
fn tiles_bit(bits: u32, index: u32) -> u32 {
    var left = bits;
    for (var i = 0u; i < index; i++) {
        left &= left - 1u;
    }
    return firstTrailingBit(left);
}

// What is remembered of what the pixel sees.
fn tiles_memory(tile: vec2u, place: u32) -> u32 {
    if tiles_state.mode == REUSE_REPROJECT {
        return tiles_found[place].w;
    }
    let memory = tiles_age[place];
    let is_its_turn = (tile.x + 3u * tile.y + tiles_state.turn) % TILES_TURNS == 0u;
    return select(memory, REUSE_LOST, is_its_turn && memory > REUSE_AGE);
}

// Whether what the pixel's last pass reads of this very pixel has changed, for the same camera; remembers it.
fn tiles_pixel_changed(pixel: vec2u, place: u32, depth: f32) -> bool {
    var is_changed = bitcast<u32>(tiles_depth[place]) != bitcast<u32>(depth);
    tiles_depth[place] = depth;
    let tile = occluder_tile_of(pixel);
    if reuse.mask == REUSE_GEOMETRY {
        return occluder_is_met(tiles_witness[tile]);
    }
    if reuse.has_witness == 1u {
        is_changed = is_changed || any(bitcast<vec2u>(tiles_seen[tile]) != bitcast<vec2u>(tiles_witness[tile]));
    }
    return is_changed && tiles_state.mode != REUSE_REPROJECT;
}

// Remembers the witness, a tile once.
fn tiles_remember(pixel: vec2u) {
    if reuse.has_witness == 1u && all(pixel % OCCLUDER_TILE == vec2u(0u)) {
        let tile = occluder_tile_of(pixel);
        tiles_seen[tile] = tiles_witness[tile];
    }
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
