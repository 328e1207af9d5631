// Lights: how much of one reaches a point, and from where, if nothing blocks it. Space: world, relative to the eye.

const LIGHT_DIRECTIONAL: u32 = 0u;
const LIGHT_POINT: u32 = 1u;
const LIGHT_SPOT: u32 = 2u;
const LIGHT_RECT: u32 = 3u;

const LIGHT_TEXTURE_NONE: u32 = 0u;
const LIGHT_TEXTURE_AFFINE: u32 = 1u;
const LIGHT_TEXTURE_PROJECTIVE: u32 = 2u;
const LIGHT_TEXTURE_SPHERE: u32 = 3u;

// What the pipeline is made for.
override LIGHT_KIND: u32 = 0u;
override LIGHT_TEXTURE: u32 = 0u;

// Inside this distance [m] of a point light 1 / d^2 grows no further.
const LIGHT_RADIUS: f32 = 1e-3;

struct Light {
    color: vec3f, // illuminance [W/m^2], intensity [W/sr] or, of a rectangle, radiance [W/(m^2 sr)]
    cos_inner: f32,
    position: vec3f, // of a rectangle its middle [m]
    cos_outer: f32,
    direction: vec3f, // the way it travels, the spot's axis, or the rectangle's normal; unit
    texture_rows: array<vec4f, 3>, // products with (point, 1), see LIGHT_TEXTURE
    clip_from_world: mat4x4f, // of a single shadow map; depth 1 at its near plane
    cube_depth: vec2f, // depth = x / (distance along the face's axis) + y, 1 at the near plane
    standard_depth: u32, // 1 where the map itself holds 0 at its near plane
}

struct Incident {
    direction: vec3f, // the way the light travels, unit
    irradiance: vec3f, // [W/m^2] on a surface that faces it
}

@group(1) @binding(0) var<uniform> light: Light;
@group(1) @binding(3) var light_picture: texture_2d<f32>;
@group(1) @binding(4) var light_sampler: sampler;

fn light_is_local() -> bool {
    return LIGHT_KIND != LIGHT_DIRECTIONAL;
}

// The picture's place of a point: (0, 0) top left, (1, 1) bottom right.
fn light_uv(point: vec3f) -> vec2f {
    let p = vec4f(point, 1.0);
    let q = vec3f(
        dot(light.texture_rows[0], p),
        dot(light.texture_rows[1], p),
        dot(light.texture_rows[2], p),
    );
    switch LIGHT_TEXTURE {
        case LIGHT_TEXTURE_PROJECTIVE: { return q.xy / q.z + 0.5; }
        case LIGHT_TEXTURE_SPHERE: {
            let latitude = asin(clamp(q.y / max(length(q), 1e-20), -1.0, 1.0));
            return vec2f(atan2(q.x, q.z) / (2.0 * PI) + 0.5, 0.5 - latitude / PI);
        }
        default: { return q.xy + 0.5; }
    }
}

// The picture's colour at a point: bilinear between texel centres, black outside.
fn light_tint(point: vec3f) -> vec3f {
    if LIGHT_TEXTURE == LIGHT_TEXTURE_NONE {
        return vec3f(1.0);
    }
    let uv = light_uv(point);
    let inside = all(uv >= vec2f(0.0)) && all(uv <= vec2f(1.0));
    return select(vec3f(0.0), textureSampleLevel(light_picture, light_sampler, uv, 0.0).rgb, inside);
}

// The smooth edge of a spot's cone, as KHR_lights_punctual recommends it.
fn light_spot_falloff(cos_angle: f32, cos_inner: f32, cos_outer: f32) -> f32 {
    let t = saturate((cos_angle - cos_outer) / max(cos_inner - cos_outer, 1e-3));
    return t * t;
}

// What the light ray through a point is dimmed and tinted by on its whole length: cone and picture.
fn light_ray_tint(point: vec3f) -> vec3f {
    var falloff = 1.0;
    if LIGHT_KIND == LIGHT_SPOT {
        let way = normalize(point - light.position);
        falloff = light_spot_falloff(dot(way, light.direction), light.cos_inner, light.cos_outer);
    }
    return falloff * light_tint(point);
}

fn light_incident(point: vec3f) -> Incident {
    let color = light.color * light_tint(point);
    if !light_is_local() {
        return Incident(light.direction, color);
    }
    let offset = point - light.position;
    let distance2 = max(dot(offset, offset), LIGHT_RADIUS * LIGHT_RADIUS);
    let distance = sqrt(distance2);
    let direction = offset / distance;
    var falloff = 1.0;
    if LIGHT_KIND == LIGHT_SPOT {
        falloff = light_spot_falloff(dot(direction, light.direction), light.cos_inner, light.cos_outer);
    }
    return Incident(direction, color * transmittance(frame.medium.sigma_t, distance) * (falloff / distance2));
}

// The part of the ray q0 + s v on the side of a plane through the origin that its normal points to, within a span.
fn light_before_plane(q0: vec3f, v: vec3f, normal: vec3f, span: vec2f) -> vec2f {
    let height = dot(q0, normal);
    let slope = dot(v, normal);
    let crossing = -height / select(slope, 1e-30, slope == 0.0);
    if slope > 0.0 {
        return vec2f(max(span.x, crossing), span.y);
    }
    if slope < 0.0 {
        return vec2f(span.x, min(span.y, crossing));
    }
    return select(span.xx, span, height > 0.0);
}

// The part of the ray, as distances [m], that the light can reach at all; empty where x >= y.
fn light_reach(ray: Ray) -> vec2f {
    let all = vec2f(0.0, ray.length);
    if LIGHT_KIND == LIGHT_RECT {
        return light_before_plane(ray.origin - light.position, ray.direction, light.direction, all);
    }
    if LIGHT_KIND != LIGHT_SPOT {
        return all;
    }
    return light_cone_interval(ray.origin - light.position, ray.direction, light.direction, light.cos_outer, all);
}

// The factor that all of a view ray's light shares: of the sun, strength and scattering.
fn light_common(ray: Ray) -> vec3f {
    if light_is_local() {
        return vec3f(1.0);
    }
    return medium_scattering(-dot(light.direction, ray.direction)) * light.color;
}
