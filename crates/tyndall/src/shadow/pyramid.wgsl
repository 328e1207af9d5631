// Nearest and farthest depth over squares of the shadow map's texels: levels of half the resolution each, from 2 x 2
// texels on. Depth as the map's own, 1 nearest to the light; (farthest, nearest).

const PYRAMID_LEVELS: u32 = 12u;

struct Pyramid {
    levels: array<vec4u, PYRAMID_LEVELS>, // of level k + 1: first texel, width, height, texels a face
    faces: u32,
    first: u32, // the level that is read, 0 for the map itself
}

fn pyramid_unite(a: vec2f, b: vec2f) -> vec2f {
    return vec2f(min(a.x, b.x), max(a.y, b.y));
}
