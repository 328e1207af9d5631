// The surface where light ends, one vertex a shadow-map texel: see light_volume/mod.rs. Space: world, relative to the eye.
//
// A vertex is named by its face and by its place (column, row) in a grid of `cells + 1` vertices a side: the middle of
// texel (column - 1, row - 1), or the map's border where there is none.

struct LightVolumeParams {
    world_from_clip: mat4x4f, // of a single map; depth 1 at its near plane
    far_plane: vec4f, // single: dot(xyz, point) = w beyond all that is seen; cube: w alone, along a face's axis [m]
    cells: vec2u, // a face: texels + 1
    pitch: u32, // words a row of `light_volume_splits`
    rows: u32, // rows a face of it
    tolerance: f32, // [texels]
    capacity: u32, // triangles that the adaptive mesh may have
    mirrored: u32, // 1 where the map's picture is mirrored
}

@group(2) @binding(0) var<uniform> light_volume: LightVolumeParams;

// A vertex's place on its face, (-1, -1) top left to (1, 1) bottom right; exact mirror images of one another.
fn light_volume_place(vertex: vec2u) -> vec2f {
    let cells = vec2f(light_volume.cells);
    return clamp((2.0 * vec2f(vertex) - cells) / (cells - 1.0), vec2f(-1.0), vec2f(1.0));
}

// Depth of a texel, 1 nearest to the light, 0 for nothing at all.
fn light_volume_texel(face: u32, texel: vec2u) -> f32 {
    let held = textureLoad(shadow_map, texel, face, 0);
    return select(held, 1.0 - held, light.standard_depth == 1u);
}

fn light_volume_beside(face: u32, place: vec2f) -> f32 {
    let beside = shadow_cube_point(light_volume_cube_direction(face, place));
    return light_volume_texel(beside.face, vec2u(beside.uv * vec2f(textureDimensions(shadow_map))));
}

// Depth of a vertex. Where faces of a cube meet, all of them must find the same one from their texels beside it: the
// mean of two, the nearest of three; depth means the same on either side of an edge.
fn light_volume_depth(face: u32, vertex: vec2u) -> f32 {
    let inner = clamp(vertex, vec2u(1u), light_volume.cells - 1u);
    let own = light_volume_texel(face, inner - 1u);
    if SHADOW_KIND != SHADOW_CUBE || all(inner == vertex) {
        return own;
    }
    let place = light_volume_place(inner);
    let beyond = (vec2f(vertex) - vec2f(inner)) * (1.0 + 1.0 / vec2f(light_volume.cells));
    var depths = vec3f(own);
    if inner.x != vertex.x {
        depths.y = light_volume_beside(face, vec2f(beyond.x, place.y));
    }
    if inner.y != vertex.y {
        depths.z = light_volume_beside(face, vec2f(place.x, beyond.y));
    }
    if any(depths <= vec3f(0.0)) {
        return 0.0;
    }
    if all(inner != vertex) {
        return max(depths.x, max(depths.y, depths.z));
    }
    return 0.5 * (own + select(depths.z, depths.y, inner.x != vertex.x));
}

// Where a vertex lies on its face, and how deep.
struct LightVolumeSite {
    place: vec2f,
    depth: f32,
}

// True where the depths of four texels in a row break off between the second and the third: they differ by far more than
// the slopes on either side explain.
fn light_volume_breaks(a: f32, b: f32, c: f32, d: f32) -> bool {
    return abs(b - c) > LIGHT_VOLUME_BREAK * max(abs(b - a), abs(d - c));
}

// Slopes that a step must exceed to be a break.
const LIGHT_VOLUME_BREAK: f32 = 4.0;

// Of a vertex whose texel has these four beside it along one direction: whither it moves, half a texel in depth
// included, so that it comes to lie on its texel's border where the depths break off behind that.
fn light_volume_shift(before: vec2f, own: f32, behind: vec2f) -> vec2f {
    let breaks_before = light_volume_breaks(before.x, before.y, own, behind.x);
    let breaks_behind = light_volume_breaks(before.y, own, behind.x, behind.y);
    if breaks_before == breaks_behind {
        return vec2f(0.0);
    }
    return 0.5 * select(vec2f(1.0, own - before.y), vec2f(-1.0, own - behind.x), breaks_before);
}

fn light_volume_site(face: u32, vertex: vec2u) -> LightVolumeSite {
    let place = light_volume_place(vertex);
    let own = light_volume_depth(face, vertex);
    let last = light_volume.cells - 1u;
    if any(vertex == vec2u(0u)) || any(vertex > last) {
        return LightVolumeSite(place, own);
    }
    let texel = vertex - 1u;
    let low = vec2i(texel);
    let l1 = vec2u(max(low - 1, vec2i(0)));
    let l2 = vec2u(max(low - 2, vec2i(0)));
    let h1 = min(texel + 1u, last - 1u);
    let h2 = min(texel + 2u, last - 1u);
    let sideways = light_volume_shift(
        vec2f(light_volume_texel(face, vec2u(l2.x, texel.y)), light_volume_texel(face, vec2u(l1.x, texel.y))),
        own,
        vec2f(light_volume_texel(face, vec2u(h1.x, texel.y)), light_volume_texel(face, vec2u(h2.x, texel.y))),
    );
    let down = light_volume_shift(
        vec2f(light_volume_texel(face, vec2u(texel.x, l2.y)), light_volume_texel(face, vec2u(texel.x, l1.y))),
        own,
        vec2f(light_volume_texel(face, vec2u(texel.x, h1.y)), light_volume_texel(face, vec2u(texel.x, h2.y))),
    );
    let moved = place + vec2f(sideways.x, down.x) * 2.0 / vec2f(last);
    return LightVolumeSite(moved, max(own + sideways.y + down.y, 0.25 * own));
}

// The point at a depth of the light ray through a place; at depth 0 beyond all that is seen.
fn light_volume_point(face: u32, place: vec2f, depth: f32) -> vec3f {
    if SHADOW_KIND == SHADOW_CUBE {
        let along = select(light.cube_depth.x / (depth - light.cube_depth.y), light_volume.far_plane.w, depth <= 0.0);
        return light.position + along * light_volume_cube_direction(face, place);
    }
    let h = light_volume.world_from_clip * vec4f(place.x, -place.y, depth, 1.0);
    let point = h.xyz / h.w;
    if depth > 0.0 {
        return point;
    }
    let to_depth = light_volume.world_from_clip[2];
    let away = normalize(h.xyz * to_depth.w - to_depth.xyz * h.w);
    let plane = light_volume.far_plane;
    return point + away * (plane.w - dot(plane.xyz, point)) / dot(plane.xyz, away);
}

// The largest power of two that divides both column and row: the vertex halves edges of twice this length.
fn light_volume_spacing(vertex: vec2u) -> u32 {
    let any_bit = vertex.x | vertex.y;
    return any_bit & (~any_bit + 1u);
}

fn light_volume_is_edge(vertex: vec2u, spacing: u32) -> bool {
    return ((vertex.x ^ vertex.y) & spacing) != 0u;
}

// Neighbour k (mod 4) of a vertex, anticlockwise as the light sees it: along the grid where the vertex halves the side
// of squares, else the corners of the square that it is the middle of.
fn light_volume_neighbor(k: u32, spacing: u32, is_edge: bool) -> vec2i {
    var ways = array(vec2i(1, -1), vec2i(-1, -1), vec2i(-1, 1), vec2i(1, 1));
    if is_edge {
        ways = array(vec2i(1, 0), vec2i(0, -1), vec2i(-1, 0), vec2i(0, 1));
    }
    return i32(spacing) * ways[k & 3u];
}
