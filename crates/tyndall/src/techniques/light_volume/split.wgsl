// First pass of the adaptive mesh: the vertices that stand out, and the whole border.

// From a vertex to one end of the edge that it halves; the other end is opposite.
fn light_volume_half_edge(vertex: vec2u, spacing: u32) -> vec2i {
    let s = i32(spacing);
    if light_volume_is_edge(vertex, spacing) {
        return select(vec2i(0, s), vec2i(s, 0), (vertex.x & spacing) != 0u);
    }
    // The middle of a square: its diagonal ends in the middle of the square twice as large.
    let up = ((vertex - spacing) / (2u * spacing)) & vec2u(1u);
    return select(vec2i(s, s), vec2i(s, -s), up.x != up.y);
}

// How far the surface at a vertex lies from the edge that it halves, along the light [widths of a texel]. Planes are
// planes in clip space, too.
fn light_volume_bump(face: u32, vertex: vec2u) -> f32 {
    let half_edge = light_volume_half_edge(vertex, light_volume_spacing(vertex));
    let last = vec2i(light_volume.cells);
    let a = vec2u(clamp(vec2i(vertex) - half_edge, vec2i(0), last));
    let b = vec2u(clamp(vec2i(vertex) + half_edge, vec2i(0), last));
    let depths = vec3f(
        light_volume_depth(face, a),
        light_volume_depth(face, vertex),
        light_volume_depth(face, b),
    );
    if all(depths <= vec3f(0.0)) {
        return 0.0;
    }
    if any(depths <= vec3f(0.0)) {
        return 1e30;
    }
    let place = light_volume_place(vertex);
    let start = light_volume_place(a);
    let edge = light_volume_place(b) - start;
    let merged = mix(depths.x, depths.z, dot(place - start, edge) / dot(edge, edge));
    let point = light_volume_point(face, place, depths.y);
    let beside = place + vec2f(2.0 / f32(light_volume.cells.x - 1u), 0.0);
    let width = distance(point, light_volume_point(face, beside, depths.y));
    return distance(point, light_volume_point(face, place, merged)) / width;
}

// The bits of 32 vertices.
@compute @workgroup_size(64)
fn light_volume_split(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= light_volume.pitch {
        return;
    }
    let last = light_volume.cells;
    var word = 0u;
    for (var bit = 0u; bit < 32u; bit++) {
        let vertex = vec2u(32u * id.x + bit, id.y);
        if any(vertex > last) {
            break;
        }
        var stands_out = any(vertex == vec2u(0u)) || any(vertex == last);
        if !stands_out {
            stands_out = light_volume_bump(id.z, vertex) > light_volume.tolerance;
        }
        word |= u32(stands_out) << bit;
    }
    atomicStore(&light_volume_splits[light_volume_word(id.z, vec2u(32u * id.x, id.y))], word);
}
