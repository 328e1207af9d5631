// Lists the walls that are silhouettes, and the triangles that any pixel sees. What lies in the shadow of something else casts
// its own inside that: nothing of it bounds the union.

@group(2) @binding(4) var<storage, read_write> list_entries: array<vec2u>; // an element's index and its place's
@group(2) @binding(5) var<storage, read_write> list_counts: array<atomic<u32>>; // of walls and caps, run by run

const LIST_GROUP: u32 = 64u;
// Rasterisers keep places in a pixel as whole numbers of 1/256 at least [pixels].
const LIST_ROOM: f32 = 1.0 / 64.0;

// The most texels a side that a piece in the shadow of others has.
const LIST_TEXELS: f32 = 8.0;
// How much nearer to the light these others are: of the map's depth range (sun), or of the distance (local lights).
const LIST_APART: f32 = 1e-3;

@compute @workgroup_size(1)
fn list_clear() {
    atomicStore(&list_counts[occluder_params.counts], 0u);
    atomicStore(&list_counts[occluder_params.counts + 1u], 0u);
}

@compute @workgroup_size(64)
fn list_walls(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let edge = (group.y * occluder_params.columns + group.x) * LIST_GROUP + lane;
    if edge >= occluder_params.edges {
        return;
    }
    let place = occluder_params.first_place + group.z;
    let wall = occluder_wall_of(edge, place);
    if !wall.is_inside && !list_is_shaded(wall.a, wall.b, wall.b) {
        let index = atomicAdd(&list_counts[occluder_params.counts], 1u);
        list_entries[occluder_params.walls + index] = vec2u(edge, place);
    }
}

@compute @workgroup_size(64)
fn list_caps(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let triangle = (group.y * occluder_params.columns + group.x) * LIST_GROUP + lane;
    if triangle >= occluder_params.triangles {
        return;
    }
    let place = occluder_params.first_place + group.z;
    let p = occluder_triangle(triangle, place);
    if list_is_seen(p) && !list_is_shaded(p[0], p[1], p[2]) {
        let index = atomicAdd(&list_counts[occluder_params.counts + 1u], 1u);
        list_entries[occluder_params.caps + index] = vec2u(triangle, place);
    }
}

// Whether a pixel's centre may lie in the triangle.
fn list_is_seen(p: array<vec3f, 3>) -> bool {
    var least = vec2f(1e30);
    var most = vec2f(-1e30);
    var nearest = 1e30;
    for (var i = 0u; i < 3u; i++) {
        let on_screen = occluder_on_screen(vec4f(p[i], 1.0));
        let pixel = on_screen.xy / on_screen.z;
        least = min(least, pixel);
        most = max(most, pixel);
        nearest = min(nearest, on_screen.z);
    }
    // Through the eye's plane: anywhere.
    if !(nearest > 0.0) {
        return true;
    }
    let room = LIST_ROOM + 1e-6 * max(abs(least), abs(most));
    let first = ceil(max(least - room, vec2f(0.0)) - 0.5);
    let last = floor(min(most + room, frame.camera.size) - 0.5);
    return all(first <= last);
}

// Whether every texel of the shadow map on the points and about them holds something that is surely nearer to the light.
// Pieces of many texels are not asked.
fn list_is_shaded(a: vec3f, b: vec3f, c: vec3f) -> bool {
    if SHADOW_KIND == SHADOW_NONE {
        return false;
    }
    let p = list_on_map(a);
    let q = list_on_map(b);
    let r = list_on_map(c);
    if p.face != q.face || p.face != r.face {
        return false;
    }
    let size = vec2f(textureDimensions(shadow_map));
    let first = floor(min(p.uv, min(q.uv, r.uv)) * size) - 1.0;
    let last = floor(max(p.uv, max(q.uv, r.uv)) * size) + 1.0;
    if !all(first >= vec2f(0.0)) || !all(last < size) || any(last - first >= vec2f(LIST_TEXELS)) {
        return false;
    }
    let nearest = max(p.depth, max(q.depth, r.depth));
    let apart = select(LIST_APART, LIST_APART * abs(nearest), light_is_local());
    for (var y = i32(first.y); y <= i32(last.y); y++) {
        for (var x = i32(first.x); x <= i32(last.x); x++) {
            let held = textureLoad(shadow_map, vec2i(x, y), p.face, 0);
            let depth = select(held, 1.0 - held, light.standard_depth == 1u);
            if depth <= nearest + apart {
                return false;
            }
        }
    }
    return true;
}

fn list_on_map(point: vec3f) -> ShadowPoint {
    let map_ray = shadow_ray(Ray(point, 0.0, vec3f(0.0)));
    return shadow_point(map_ray.c0);
}
