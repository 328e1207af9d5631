// Second pass of the adaptive mesh, from fine to coarse: a vertex that one of the four smaller edges round it hangs on
// is needed, too.

struct LightVolumeStep {
    spacing: u32, // of the vertices that are looked at: odd multiples of it in one direction or both
    is_edge: u32, // 1: in one direction
}

@group(2) @binding(2) var<uniform> light_volume_step: LightVolumeStep;

@compute @workgroup_size(8, 8)
fn light_volume_grow(@builtin(global_invocation_id) id: vec3u) {
    let s = light_volume_step.spacing;
    if light_volume_step.is_edge == 0u {
        light_volume_grow_one(id.z, s * (2u * id.xy + 1u), array(vec2i(1, 0), vec2i(0, 1)), i32(s));
        return;
    }
    let diagonals = array(vec2i(1, 1), vec2i(1, -1));
    light_volume_grow_one(id.z, s * vec2u(2u * id.x + 1u, 2u * id.y), diagonals, i32(s / 2u));
    light_volume_grow_one(id.z, s * vec2u(2u * id.x, 2u * id.y + 1u), diagonals, i32(s / 2u));
}

fn light_volume_grow_one(face: u32, vertex: vec2u, ways: array<vec2i, 2>, far: i32) {
    if any(vertex >= vec2u(32u * light_volume.pitch, light_volume.rows)) {
        return;
    }
    let v = vec2i(vertex);
    let is_needed = light_volume_is_split(face, v + far * ways[0]) || light_volume_is_split(face, v - far * ways[0])
        || light_volume_is_split(face, v + far * ways[1]) || light_volume_is_split(face, v - far * ways[1]);
    if is_needed {
        atomicOr(&light_volume_splits[light_volume_word(face, vertex)], 1u << (vertex.x & 31u));
    }
}
