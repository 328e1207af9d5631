// The vertices of each face's grid that the adaptive mesh needs, a bit each: see light_volume/tessellation.rs.

@group(2) @binding(1) var<storage, read_write> light_volume_splits: array<atomic<u32>>;

fn light_volume_word(face: u32, vertex: vec2u) -> u32 {
    return (face * light_volume.rows + vertex.y) * light_volume.pitch + (vertex.x >> 5u);
}

fn light_volume_is_split(face: u32, vertex: vec2i) -> bool {
    if any(vertex < vec2i(0)) || vertex.y >= i32(light_volume.rows) || vertex.x >= i32(32u * light_volume.pitch) {
        return false;
    }
    let place = vec2u(vertex);
    let word = atomicLoad(&light_volume_splits[light_volume_word(face, place)]);
    return ((word >> (place.x & 31u)) & 1u) == 1u;
}
