// The material of a surface.

struct Material {
    // Linear RGBA, multiplied into the texture.
    base_color: vec4f,
    // Emitted radiance [W/(m^2 sr)].
    emissive: vec3f,
    // Smallest alpha that blocks, if the material is masked.
    cutoff: f32,
    // Factor on light besides the base colour, if the material is transmissive.
    transmission: f32,
    // 1 if the material is blended, 0 if it is transmissive.
    blended: u32,
}

@group(1) @binding(0) var<uniform> material: Material;
@group(1) @binding(1) var material_texture: texture_2d<f32>;
@group(1) @binding(2) var material_sampler: sampler;

fn material_base_color(uv: vec2f) -> vec4f {
    return material.base_color * textureSample(material_texture, material_sampler, uv);
}

// Samples the finest level: the distance that a surface is seen from must not change its blocking and tint.
fn material_finest_base_color(uv: vec2f) -> vec4f {
    return material.base_color * textureSampleLevel(material_texture, material_sampler, uv, 0.0);
}

fn material_is_hole(uv: vec2f) -> bool {
    return material_finest_base_color(uv).a < material.cutoff;
}

// Factor on light that goes through.
fn material_tint(base_color: vec4f) -> vec3f {
    let blended = 1.0 - base_color.a + base_color.a * base_color.rgb;
    return select(material.transmission * base_color.rgb, blended, material.blended == 1u);
}
