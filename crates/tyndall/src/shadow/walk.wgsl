// A view ray walked through a picture that the light sees, texel by texel: the exact limit of marching it; see shadow/walk.rs.

// A ray over one face: (column, row, z, w) = c0 + s c1, homogeneous, in texels; w > 0.
struct ShadowWalk {
    c0: vec4f,
    c1: vec4f,
    texel: vec2i, // one beyond the border where it is outside the map
    face: u32,
    size: vec2f, // of the picture, in texels
    next: vec2f, // distances where the next column and the next row begin
}

// A cube's face is left this far beyond its border [texels], for a ray along the border not to go to and fro.
const SHADOW_WALK_RIM: f32 = 0.05;

// Right, down and outwards on a cube's face.
fn shadow_on_face(q: vec3f, face: u32) -> vec3f {
    switch face {
        case 0u: { return vec3f(-q.z, -q.y, q.x); }
        case 1u: { return vec3f(q.z, -q.y, -q.x); }
        case 2u: { return vec3f(q.x, q.z, q.y); }
        case 3u: { return vec3f(q.x, -q.z, -q.y); }
        case 4u: { return vec3f(q.x, -q.y, q.z); }
        default: { return vec3f(-q.x, -q.y, -q.z); }
    }
}

// In the texel that holds the ray's point at distance `probe`.
fn shadow_walk_from(map_ray: ShadowRay, size: vec2f, probe: f32) -> ShadowWalk {
    var c0 = vec4f(map_ray.c0.x, -map_ray.c0.y, map_ray.c0.zw);
    var c1 = vec4f(map_ray.c1.x, -map_ray.c1.y, map_ray.c1.zw);
    var face = 0u;
    if SHADOW_KIND == SHADOW_CUBE {
        face = shadow_cube_point(map_ray.c0.xyz + probe * map_ray.c1.xyz).face;
        let at = shadow_on_face(map_ray.c0.xyz, face);
        let way = shadow_on_face(map_ray.c1.xyz, face);
        c0 = vec4f(at.xy, light.cube_depth.x + light.cube_depth.y * at.z, at.z);
        c1 = vec4f(way.xy, light.cube_depth.y * way.z, way.z);
    }
    c0 = vec4f(0.5 * size * (c0.xy + c0.w), c0.zw);
    c1 = vec4f(0.5 * size * (c1.xy + c1.w), c1.zw);
    let place = c0 + probe * c1;
    var texel = vec2i(clamp(floor(place.xy / max(place.w, 1e-20)), vec2f(-1.0), size));
    if SHADOW_KIND == SHADOW_CUBE {
        texel = clamp(texel, vec2i(0), vec2i(size) - 1);
    }
    let walk = shadow_walk_next(ShadowWalk(c0, c1, texel, face, size, vec2f(0.0)));
    // Whatever rounding says, the way is onwards.
    return ShadowWalk(c0, c1, texel, face, size, max(walk.next, vec2f(probe)));
}

fn shadow_walk_way(walk: ShadowWalk) -> vec2i {
    return vec2i(sign(walk.c1.xy * walk.c0.w - walk.c0.xy * walk.c1.w));
}

// Where a texel's border [texels] is crossed.
fn shadow_walk_border(walk: ShadowWalk, border: vec2f) -> vec2f {
    let rim = select(0.0, SHADOW_WALK_RIM, SHADOW_KIND == SHADOW_CUBE);
    return border + select(vec2f(0.0), vec2f(rim), border >= walk.size) - select(vec2f(0.0), vec2f(rim), border <= vec2f(0.0));
}

fn shadow_walk_next(walk: ShadowWalk) -> ShadowWalk {
    let way = shadow_walk_way(walk);
    let border = shadow_walk_border(walk, vec2f(walk.texel + max(way, vec2i(0))));
    let slope = walk.c1.xy - border * walk.c1.w;
    let crossing = (border * walk.c0.w - walk.c0.xy) / slope;
    // In perspective a ray may end at its vanishing point before it comes to the border.
    let is_ahead = slope * vec2f(way) > vec2f(0.0);
    let is_border = is_ahead & (border >= vec2f(-SHADOW_WALK_RIM)) & (border <= walk.size + SHADOW_WALK_RIM);
    var next = walk;
    next.next = select(vec2f(1e30), crossing, is_border);
    return next;
}

// Distance where the texel ends.
fn shadow_walk_end(walk: ShadowWalk) -> f32 {
    return min(walk.next.x, walk.next.y);
}

// Over the border at distance s.
fn shadow_walk_on(map_ray: ShadowRay, walk: ShadowWalk, s: f32) -> ShadowWalk {
    var on = walk;
    on.texel += select(vec2i(0), shadow_walk_way(walk), walk.next <= vec2f(s));
    on = shadow_walk_next(on);
    if SHADOW_KIND == SHADOW_CUBE && shadow_walk_is_outside(on) {
        return shadow_walk_from(map_ray, walk.size, s * 1.00001 + 1e-6);
    }
    return on;
}

fn shadow_walk_is_outside(walk: ShadowWalk) -> bool {
    return any(walk.texel < vec2i(0)) || any(walk.texel >= vec2i(walk.size));
}

// Depth of the shadow map's texel, 1 nearest to the light; 0 where it holds nothing or lies outside the map.
fn shadow_walk_held(walk: ShadowWalk) -> f32 {
    let texel = clamp(walk.texel, vec2i(0), vec2i(walk.size) - 1);
    let held = textureLoad(shadow_map, texel, walk.face, 0);
    return select(select(held, 1.0 - held, light.standard_depth == 1u), 0.0, shadow_walk_is_outside(walk));
}

// >= 0 where light reaches the ray's point at distance s past this depth.
fn shadow_walk_margin(walk: ShadowWalk, held: f32, s: f32) -> f32 {
    let zw = walk.c0.zw + s * walk.c1.zw;
    return zw.x - held * zw.y;
}
