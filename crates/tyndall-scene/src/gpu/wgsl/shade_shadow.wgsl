// Visibility of a light from a surface, from its shadow map or from a texture; shading/shadow_map.rs is the twin and
// shading/mod.rs has the reasons.

@group(1) @binding(1) var shade_shadow_map: texture_depth_2d_array;
@group(1) @binding(2) var shade_glass: texture_2d_array<u32>;
@group(1) @binding(5) var shade_seen: texture_2d<f32>;

// The face whose axis is nearest to the direction from the light.
fn shade_shadow_face(point: vec3f) -> u32 {
    if shade_choice(shade_light.faces) == 1u {
        return 0u;
    }
    let q = point - shade_light.position;
    let a = abs(q);
    if a.x >= a.y && a.x >= a.z {
        return u32(q.x < 0.0);
    }
    if a.y >= a.z {
        return 2u + u32(q.y < 0.0);
    }
    return 4u + u32(q.z < 0.0);
}

// Edge of a texel at a point's distance from the light [m].
fn shade_texel_size(point: vec3f) -> f32 {
    let clip_from_world = shade_light.clip_from_world[shade_shadow_face(point)];
    let rows = transpose(clip_from_world);
    let scale = vec2f(length(rows[0].xyz), length(rows[1].xyz));
    let per_meter = scale * vec2f(textureDimensions(shade_shadow_map));
    return 2.0 * max((clip_from_world * vec4f(point, 1.0)).w, 0.0) / min(per_meter.x, per_meter.y);
}

// True if a held depth is nearer to the light than `depth` (1 nearest); nothing was drawn where it is 0.
fn shade_hides(held: f32, depth: f32) -> bool {
    let stored = select(held, 1.0 - held, shade_light.standard_depth == 1u);
    return stored > 0.0 && depth < stored;
}

// The tint of light that has passed one texel. Beyond a single map's border all is lit; a cube's texels are clamped.
fn shade_texel_tint(face: u32, texel: vec2f, depth: f32) -> vec3f {
    let last = vec2f(textureDimensions(shade_shadow_map)) - 1.0;
    let clamped = clamp(texel, vec2f(0.0), last);
    if shade_choice(shade_light.faces) == 1u && any(clamped != texel) {
        return vec3f(1.0);
    }
    let index = vec2u(clamped);
    if shade_hides(textureLoad(shade_shadow_map, index, face, 0), depth) {
        return vec3f(0.0);
    }
    var tint = vec3f(1.0);
    let layers = shade_choice(shade_light.glass_layers);
    for (var layer = 0u; layer < layers; layer++) {
        let glass = textureLoad(shade_glass, index, face * layers + layer, 0).rg;
        if shade_hides(bitcast<f32>(glass.r), depth) {
            let roots = vec3f((vec3u(glass.g) >> vec3u(0u, 10u, 20u)) & vec3u(1023u)) / 1023.0;
            tint *= roots * roots;
        }
    }
    return tint;
}

// Share of the light that reaches a surface: the visibility texture's, or that of four texels, weighted bilinearly.
fn shade_visibility(pixel: vec2u, surface: vec3f, normal: vec3f) -> vec3f {
    if shade_choice(shade_light.visibility) == 1u {
        return textureLoad(shade_seen, pixel, 0).rgb;
    }
    if shade_choice(shade_light.faces) == 0u {
        return vec3f(1.0);
    }
    let point = surface + shade_view.normal_offset * shade_texel_size(surface) * normal;
    let face = shade_shadow_face(point);
    let clip = shade_light.clip_from_world[face] * vec4f(point, 1.0);
    // Behind the light.
    if clip.w <= 0.0 {
        return vec3f(1.0);
    }
    let ndc = clip.xyz / clip.w;
    let size = vec2f(textureDimensions(shade_shadow_map));
    let place = (vec2f(0.5) + vec2f(0.5, -0.5) * ndc.xy) * size - 0.5;
    let corner = floor(place);
    let share = place - corner;
    let top = mix(
        shade_texel_tint(face, corner, ndc.z),
        shade_texel_tint(face, corner + vec2f(1.0, 0.0), ndc.z),
        share.x,
    );
    let bottom = mix(
        shade_texel_tint(face, corner + vec2f(0.0, 1.0), ndc.z),
        shade_texel_tint(face, corner + vec2f(1.0, 1.0), ndc.z),
        share.x,
    );
    return mix(top, bottom, share.y);
}
