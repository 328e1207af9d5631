// Lists the walls that are silhouettes, and the triangles that many pixels see; those that few see are written to the screen at
// once.

@group(2) @binding(4) var<storage, read_write> list_entries: array<vec2u>; // an element's index and its place's
@group(2) @binding(5) var<storage, read_write> list_counts: array<atomic<u32>>; // of walls and caps, run by run

const LIST_GROUP: u32 = 64u;
// Rasterisers keep places in a pixel as whole numbers of 1/256 at least [pixels].
const LIST_ROOM: f32 = 1.0 / 64.0;
// Pixels a side of what is seen by few.
const LIST_SMALL: i32 = 3;
// Relative rounding of its depths.
const LIST_DEPTH: f32 = 1e-5;

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
    if !occluder_wall_of(edge, place).is_inside {
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
    let seen = list_seen(p);
    let spans = seen.pixels.zw - seen.pixels.xy;
    if any(spans < vec2i(0)) {
        return;
    }
    if any(spans >= vec2i(LIST_SMALL)) {
        let index = atomicAdd(&list_counts[occluder_params.counts + 1u], 1u);
        list_entries[occluder_params.caps + index] = vec2u(triangle, place);
        return;
    }
    let facing = occluder_facing(occluder_cap_of(p));
    for (var y = seen.pixels.y; y <= seen.pixels.w; y++) {
        for (var x = seen.pixels.x; x <= seen.pixels.z; x++) {
            write_depths(occluder_tile_of(vec2u(vec2i(x, y))), seen.depths, facing);
        }
    }
}

// Where a triangle is on the screen: the first and the last pixel whose centres may lie in it, and between which depths [m].
struct ListSeen {
    pixels: vec4i,
    depths: vec2f,
}

fn list_seen(p: array<vec3f, 3>) -> ListSeen {
    var least = vec3f(1e30);
    var most = vec3f(-1e30);
    var nearest = 1e30;
    for (var i = 0u; i < 3u; i++) {
        let on_screen = occluder_on_screen(vec4f(p[i], 1.0));
        let place = vec3f(on_screen.xy / on_screen.z, dot(frame.camera.forward, p[i]));
        least = min(least, place);
        most = max(most, place);
        nearest = min(nearest, on_screen.z);
    }
    // Through the eye's plane: anywhere.
    if !(nearest > 0.0) {
        return ListSeen(vec4i(0, 0, vec2i(frame.camera.size)), vec2f(0.0));
    }
    let room = LIST_ROOM + 1e-6 * max(abs(least.xy), abs(most.xy));
    let first = ceil(max(least.xy - room, vec2f(0.0)) - 0.5);
    let last = floor(min(most.xy + room, frame.camera.size) - 0.5);
    let rounding = LIST_DEPTH * max(abs(least.z), abs(most.z));
    return ListSeen(vec4i(vec2i(first), vec2i(last)), vec2f(least.z - rounding, most.z + rounding));
}
