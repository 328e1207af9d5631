// Whether a piece lies in the shadow of something else: what it casts is inside that, and bounds nothing of the union.

// The most texels a side that a piece in the shadow of others has.
const SHADED_TEXELS: f32 = 8.0;
// How much nearer to the light these others are: of the map's depth range (sun), or of the distance (local lights).
const SHADED_APART: f32 = 1e-3;

// Whether every texel of the shadow map on the points and about them holds something that is surely nearer to the light.
// Pieces of many texels are not asked.
fn shaded_surely(a: vec3f, b: vec3f) -> bool {
    if SHADOW_KIND == SHADOW_NONE {
        return false;
    }
    let p = shaded_on_map(a);
    let q = shaded_on_map(b);
    if p.face != q.face {
        return false;
    }
    let size = vec2f(textureDimensions(shadow_map));
    let first = floor(min(p.uv, q.uv) * size) - 1.0;
    let last = floor(max(p.uv, q.uv) * size) + 1.0;
    if !all(first >= vec2f(0.0)) || !all(last < size) || any(last - first >= vec2f(SHADED_TEXELS)) {
        return false;
    }
    let nearest = max(p.depth, q.depth);
    let apart = select(SHADED_APART, SHADED_APART * abs(nearest), light_is_local());
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

fn shaded_on_map(point: vec3f) -> ShadowPoint {
    let map_ray = shadow_ray(Ray(point, 0.0, vec3f(0.0)));
    return shadow_point(map_ray.c0);
}
