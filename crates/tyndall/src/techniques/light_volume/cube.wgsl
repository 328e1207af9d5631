// The faces of a cube map.

// The face's u, v and axis (shadow/mod.rs, CUBE_FACES) times (place, 1).
fn light_volume_cube_direction(face: u32, place: vec2f) -> vec3f {
    switch face {
        case 0u: { return vec3f(1.0, -place.y, -place.x); }
        case 1u: { return vec3f(-1.0, -place.y, place.x); }
        case 2u: { return vec3f(place.x, 1.0, place.y); }
        case 3u: { return vec3f(place.x, -1.0, -place.y); }
        case 4u: { return vec3f(place.x, -place.y, 1.0); }
        default: { return vec3f(-place.x, -place.y, -1.0); }
    }
}
