// Nearest and farthest depth over squares of the shadow map's texels: a texture whose level k holds, a layer a face,
// (farthest, nearest) of 2^(k+1) x 2^(k+1) texels. Depth as the map's own, 1 nearest to the light.

fn pyramid_unite(a: vec2f, b: vec2f) -> vec2f {
    return vec2f(min(a.x, b.x), max(a.y, b.y));
}
