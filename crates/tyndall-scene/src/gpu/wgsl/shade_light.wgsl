// A light as surfaces see it, unblocked. Space: world, relative to the eye.

const SHADE_DIRECTIONAL: u32 = 0u;
const SHADE_POINT: u32 = 1u;
const SHADE_SPOT: u32 = 2u;
const SHADE_RECT: u32 = 3u;

const SHADE_PICTURE_NONE: u32 = 0u;
const SHADE_PICTURE_AFFINE: u32 = 1u;
const SHADE_PICTURE_PROJECTIVE: u32 = 2u;
const SHADE_PICTURE_SPHERE: u32 = 3u;

struct ShadeLight {
    // Illuminance [W/m^2], intensity [W/sr] or radiance [W/(m^2 sr)].
    color: vec3f,
    kind: u32,
    // Position of a point or spot light, or the middle of a rectangle [m].
    position: vec3f,
    cos_inner: f32,
    // Unit vector: the direction light travels in, a spot's axis, or a rectangle's normal on its bright side.
    direction: vec3f,
    cos_outer: f32,
    // A rectangle's edges [m].
    edge_x: vec3f,
    // Number of points that stand for a rectangle.
    samples: u32,
    edge_y: vec3f,
    // One of SHADE_PICTURE_*.
    picture: u32,
    // Products with (point, 1) that give the texture coordinates.
    picture_rows: array<vec4f, 3>,
    // World space to clip space of each face of the shadow map, 1 at its near plane.
    clip_from_world: array<mat4x4f, 6>,
    // 0 if nothing blocks the light, 1 for a single map, 6 for a cube.
    faces: u32,
    // 1 if the map itself holds 0 at its near plane.
    standard_depth: u32,
    // Layers a face; 0 without glass.
    glass_layers: u32,
    // 1 if a texture holds each pixel's visibility of the light.
    visibility: u32,
}

struct ShadeIncident {
    // The direction the light travels in, unit length.
    direction: vec3f,
    // On a surface that faces it [W/m^2].
    irradiance: vec3f,
}

@group(1) @binding(0) var<uniform> shade_light: ShadeLight;
@group(1) @binding(3) var shade_picture: texture_2d<f32>;
@group(1) @binding(4) var shade_picture_sampler: sampler;

// The light's texture, bilinear between texel centres and black outside.
fn shade_picture_color(uv: vec2f) -> vec3f {
    let inside = all(uv >= vec2f(0.0)) && all(uv <= vec2f(1.0));
    return select(vec3f(0.0), textureSampleLevel(shade_picture, shade_picture_sampler, uv, 0.0).rgb, inside);
}

// Texture coordinates that a point is lit through, (0, 0) top left.
fn shade_picture_place(point: vec3f) -> vec2f {
    let p = vec4f(point, 1.0);
    let rows = shade_light.picture_rows;
    let q = vec3f(dot(rows[0], p), dot(rows[1], p), dot(rows[2], p));
    switch shade_choice(shade_light.picture) {
        case SHADE_PICTURE_PROJECTIVE: {
            return q.xy / q.z + 0.5;
        }
        case SHADE_PICTURE_SPHERE: {
            let latitude = asin(clamp(q.y / length(q), -1.0, 1.0));
            return vec2f(0.5 + 0.5 * atan2(q.x, q.z) / SHADE_PI, 0.5 - latitude / SHADE_PI);
        }
        default: {
            return q.xy + 0.5;
        }
    }
}

fn shade_tint(point: vec3f) -> vec3f {
    if shade_choice(shade_light.picture) == SHADE_PICTURE_NONE {
        return vec3f(1.0);
    }
    return shade_picture_color(shade_picture_place(point));
}

// KHR_lights_punctual's recommended smooth edge of a cone.
fn shade_spot_falloff(cos_angle: f32) -> f32 {
    let width = max(shade_light.cos_inner - shade_light.cos_outer, 1e-3);
    let t = saturate((cos_angle - shade_light.cos_outer) / width);
    return t * t;
}

// Light of 1 W/sr from a position, attenuated up to the point.
fn shade_from(position: vec3f, point: vec3f) -> ShadeIncident {
    let offset = point - position;
    let distance2 = max(dot(offset, offset), shade_view.light_radius * shade_view.light_radius);
    let distance = sqrt(distance2);
    return ShadeIncident(offset / distance, exp(-shade_view.sigma_t * distance) / distance2);
}

fn shade_cosine(normal: vec3f, direction: vec3f) -> f32 {
    return max(-dot(normal, direction), 0.0);
}

// A rectangle is the Hammersley points on it (Van der Corput's sequence along one edge).
fn shade_rect_irradiance(point: vec3f, normal: vec3f) -> vec3f {
    let count = shade_choice(shade_light.samples);
    let area = length(cross(shade_light.edge_x, shade_light.edge_y));
    var sum = vec3f(0.0);
    for (var i = 0u; i < count; i++) {
        let uv = vec2f((f32(i) + 0.5) / f32(count), f32(reverseBits(i)) / 4294967296.0);
        let position = shade_light.position
            + (uv.x - 0.5) * shade_light.edge_x
            + (uv.y - 0.5) * shade_light.edge_y;
        let incident = shade_from(position, point);
        let emitted = max(dot(incident.direction, shade_light.direction), 0.0);
        var tint = vec3f(1.0);
        if shade_choice(shade_light.picture) != SHADE_PICTURE_NONE {
            tint = shade_picture_color(uv);
        }
        sum += tint * incident.irradiance * emitted * shade_cosine(normal, incident.direction);
    }
    return shade_light.color * sum * (area / f32(count));
}

// Irradiance of an unblocked surface [W/m^2].
fn shade_direct(point: vec3f, normal: vec3f) -> vec3f {
    if shade_choice(shade_light.kind) == SHADE_RECT {
        return shade_rect_irradiance(point, normal);
    }
    let color = shade_light.color * shade_tint(point);
    if shade_choice(shade_light.kind) == SHADE_DIRECTIONAL {
        return color * shade_cosine(normal, shade_light.direction);
    }
    let incident = shade_from(shade_light.position, point);
    var falloff = shade_cosine(normal, incident.direction);
    if shade_choice(shade_light.kind) == SHADE_SPOT {
        falloff *= shade_spot_falloff(dot(incident.direction, shade_light.direction));
    }
    return color * incident.irradiance * falloff;
}

// Irradiance from all around: the light without its cone, texture and shadow, dimmed [W/m^2].
fn shade_ambient(point: vec3f, normal: vec3f) -> vec3f {
    let ambient = shade_view.ambient * (1.0 + shade_view.ambient_tilt * normal.y);
    let color = ambient * shade_light.color;
    if shade_choice(shade_light.kind) == SHADE_DIRECTIONAL {
        return color;
    }
    let area = length(cross(shade_light.edge_x, shade_light.edge_y));
    let strength = select(1.0, area, shade_light.kind == SHADE_RECT);
    return color * strength * shade_from(shade_light.position, point).irradiance;
}
