// Shadow maps: what a light sees, looked up by the point it shines on; see shadow/mod.rs. Space: world, relative to the eye.

const SHADOW_NONE: u32 = 0u;
const SHADOW_SINGLE: u32 = 1u;
const SHADOW_CUBE: u32 = 2u;

// What the pipeline is made for.
override SHADOW_KIND: u32 = 0u;
override SHADOW_GLASS: bool = false;

@group(1) @binding(1) var shadow_map: texture_depth_2d_array;
@group(1) @binding(2) var shadow_glass: texture_2d_array<u32>;

// A view ray in the map's own space, c0 + s c1: clip space (single), or relative to the light (cube).
struct ShadowRay {
    c0: vec4f,
    c1: vec4f,
}

// A point on the map: the place, (0, 0) top left to (1, 1) bottom right, and the depth, 1 nearest to the light.
struct ShadowPoint {
    uv: vec2f,
    face: u32,
    depth: f32,
}

fn shadow_ray(ray: Ray) -> ShadowRay {
    if SHADOW_KIND == SHADOW_CUBE {
        return ShadowRay(vec4f(ray.origin - light.position, 1.0), vec4f(ray.direction, 0.0));
    }
    return ShadowRay(
        light.clip_from_world * vec4f(ray.origin, 1.0),
        light.clip_from_world * vec4f(ray.direction, 0.0),
    );
}

fn shadow_point(p: vec4f) -> ShadowPoint {
    if SHADOW_KIND == SHADOW_CUBE {
        return shadow_cube_point(p.xyz);
    }
    // Behind the light there is no map: a place outside it.
    let w = select(1.0, 1.0 / p.w, p.w > 0.0);
    let uv = select(vec2f(-1.0), vec2f(0.5) + vec2f(0.5, -0.5) * p.xy * w, p.w > 0.0);
    return ShadowPoint(uv, 0u, p.z * w);
}

// The face whose axis is nearest to the direction, in the order +X, -X, +Y, -Y, +Z, -Z, and the place on it
// (WebGPU specification, "cube texture view").
fn shadow_cube_point(q: vec3f) -> ShadowPoint {
    let a = abs(q);
    var face = 4u;
    var axis = a.z;
    var s = vec2f(select(q.x, -q.x, q.z < 0.0), -q.y);
    var negative = q.z < 0.0;
    if a.x >= a.y && a.x >= a.z {
        face = 0u;
        axis = a.x;
        negative = q.x < 0.0;
        s = vec2f(select(-q.z, q.z, negative), -q.y);
    } else if a.y >= a.z {
        face = 2u;
        axis = a.y;
        negative = q.y < 0.0;
        s = vec2f(q.x, select(q.z, -q.z, negative));
    }
    let inverse = 1.0 / max(axis, 1e-20);
    return ShadowPoint(0.5 + 0.5 * s * inverse, face + u32(negative), light.cube_depth.x * inverse + light.cube_depth.y);
}

// A light ray on the map: where it falls, (0, 0) top left to (1, 1) bottom right, and the terms of shadow_line_end.
struct ShadowLine {
    uv: vec2f,
    face: u32,
    terms: vec4f,
}

// Of a light ray from `origin`, a local light's position or any point of the sun's ray, that travels along `way`.
fn shadow_line(origin: vec3f, way: vec3f) -> ShadowLine {
    if SHADOW_KIND == SHADOW_CUBE {
        let point = shadow_cube_point(way);
        let axis = light.cube_depth.x / (point.depth - light.cube_depth.y);
        let terms = vec4f(0.0, light.cube_depth.x, light.cube_depth.y * axis, axis);
        return ShadowLine(point.uv, point.face, terms);
    }
    let c0 = light.clip_from_world * vec4f(origin, 1.0);
    let c1 = light.clip_from_world * vec4f(way, 0.0);
    return ShadowLine(shadow_point(c0 + c1).uv, 0u, vec4f(c0.w, c0.z, c1.z, c1.w));
}

// Distance [m] along the light ray to the plane of this depth: z(t) = depth w(t).
fn shadow_line_end(line: ShadowLine, depth: f32) -> f32 {
    return (depth * line.terms.x - line.terms.y) / (line.terms.z - depth * line.terms.w);
}

// The tint of the glass between a point (in the map's own space) and the light.
fn shadow_glass_at(p: vec4f) -> vec3f {
    if SHADOW_KIND == SHADOW_NONE || !SHADOW_GLASS {
        return vec3f(1.0);
    }
    let place = shadow_point(p);
    if any(place.uv < vec2f(0.0)) || any(place.uv >= vec2f(1.0)) {
        return vec3f(1.0);
    }
    return shadow_glass_tint(place);
}

// True iff light reaches a point at this depth past what the map holds; 0 is nothing at all.
fn shadow_reaches(depth: f32, held: f32) -> bool {
    let stored = select(held, 1.0 - held, light.standard_depth == 1u);
    return stored <= 0.0 || depth >= stored;
}

// What light on its way to a point (in the map's own space) is multiplied by: 0 where it is blocked.
fn shadow_tint(p: vec4f) -> vec3f {
    if SHADOW_KIND == SHADOW_NONE {
        return vec3f(1.0);
    }
    let place = shadow_point(p);
    if any(place.uv < vec2f(0.0)) || any(place.uv >= vec2f(1.0)) {
        return vec3f(1.0);
    }
    let texel = vec2u(place.uv * vec2f(textureDimensions(shadow_map)));
    if !shadow_reaches(place.depth, textureLoad(shadow_map, texel, place.face, 0)) {
        return vec3f(0.0);
    }
    if !SHADOW_GLASS {
        return vec3f(1.0);
    }
    return shadow_glass_tint(place);
}

// Layers a face.
fn shadow_glass_layers() -> u32 {
    return textureNumLayers(shadow_glass) / select(1u, 6u, SHADOW_KIND == SHADOW_CUBE);
}

// A tint, from three 10-bit square roots.
fn shadow_glass_unpack(roots: u32) -> vec3f {
    let root = vec3f(vec3u(roots, roots >> 10u, roots >> 20u) & vec3u(1023u)) / 1023.0;
    return root * root;
}

// The product of the tints of the glass between a point and the light. A texel of a layer: depth as the bits of an
// f32, and a tint.
fn shadow_glass_tint(place: ShadowPoint) -> vec3f {
    let texel = vec2u(place.uv * vec2f(textureDimensions(shadow_glass)));
    return shadow_glass_texel_tint(texel, place.face, place.depth);
}

// The same of a point at this depth over a texel. Layers come nearest to the light first, empty ones last.
fn shadow_glass_texel_tint(texel: vec2u, face: u32, depth: f32) -> vec3f {
    var tint = vec3f(1.0);
    for (var layer = 0u; layer < shadow_glass_layers(); layer++) {
        let glass = textureLoad(shadow_glass, texel, face * shadow_glass_layers() + layer, 0).xy;
        if shadow_reaches(depth, bitcast<f32>(glass.x)) {
            break;
        }
        tint *= shadow_glass_unpack(glass.y);
    }
    return tint;
}

// Where a ray of these (z, w) at distance 0 and a metre, over one texel, comes to a depth past what the map holds, after
// distance s; beyond all distances where it does not.
fn shadow_next_depth(zw: vec2f, slope: vec2f, held: f32, s: f32) -> f32 {
    let depth = select(held, 1.0 - held, light.standard_depth == 1u);
    let divisor = slope.x - depth * slope.y;
    let crossing = (depth * zw.y - zw.x) / divisor;
    return select(1e30, crossing, divisor != 0.0 && crossing > s);
}

// Where it passes a layer of glass.
fn shadow_glass_next(texel: vec2u, face: u32, zw: vec2f, slope: vec2f, s: f32) -> f32 {
    let layers = shadow_glass_layers();
    var next = 1e30;
    for (var layer = 0u; layer < layers; layer++) {
        let glass = textureLoad(shadow_glass, texel, face * layers + layer, 0).x;
        next = min(next, shadow_next_depth(zw, slope, bitcast<f32>(glass), s));
    }
    return next;
}

// Depth of the nearest layer that tints, 1 nearest to the light; 0 where none does.
fn shadow_glass_nearest(texel: vec2u, face: u32) -> f32 {
    for (var layer = 0u; layer < shadow_glass_layers(); layer++) {
        let glass = textureLoad(shadow_glass, texel, face * shadow_glass_layers() + layer, 0).xy;
        let held = bitcast<f32>(glass.x);
        let depth = select(held, 1.0 - held, light.standard_depth == 1u);
        if depth <= 0.0 || any(shadow_glass_unpack(glass.y) != vec3f(1.0)) {
            return max(depth, 0.0);
        }
    }
    return 0.0;
}

// The part of the span [m] of a ray that a single map covers, empty where x >= y; beyond it everything is lit.
fn shadow_covered(map_ray: ShadowRay, span: vec2f) -> vec2f {
    // w - x, w + x, w - y, w + y >= 0, each linear in s.
    let constant = vec4f(map_ray.c0.w) + map_ray.c0.xxyy * vec4f(-1.0, 1.0, -1.0, 1.0);
    let slope = vec4f(map_ray.c1.w) + map_ray.c1.xxyy * vec4f(-1.0, 1.0, -1.0, 1.0);
    var covered = span;
    for (var i = 0; i < 4; i++) {
        let crossing = -constant[i] / select(slope[i], 1e-30, slope[i] == 0.0);
        if slope[i] > 0.0 {
            covered.x = max(covered.x, crossing);
        } else if slope[i] < 0.0 {
            covered.y = min(covered.y, crossing);
        } else if constant[i] < 0.0 {
            covered.y = covered.x;
        }
    }
    return covered;
}
