// What a surface is made of.

struct Material {
    // Linear RGBA, multiplied into the texture.
    base_color: vec4f,
    // Radiance it gives off by itself [W/(m^2 sr)].
    emissive: vec3f,
    // Smallest alpha that blocks, where the material is masked.
    cutoff: f32,
    // What light is multiplied by besides the base colour, where the material is transmissive.
    transmission: f32,
    // 1 where the material is blended, 0 where it is transmissive.
    blended: u32,
}

@group(1) @binding(0) var<uniform> material: Material;
@group(1) @binding(1) var material_texture: texture_2d<f32>;
@group(1) @binding(2) var material_sampler: sampler;

fn material_base_color(uv: vec2f) -> vec4f {
    return material.base_color * textureSample(material_texture, material_sampler, uv);
}

// The finest level: how far away a surface is seen from must not change what it blocks and tints.
fn material_finest_base_color(uv: vec2f) -> vec4f {
    return material.base_color * textureSampleLevel(material_texture, material_sampler, uv, 0.0);
}

fn material_is_hole(uv: vec2f) -> bool {
    return material_finest_base_color(uv).a < material.cutoff;
}

// What light that goes through is multiplied by.
fn material_tint(base_color: vec4f) -> vec3f {
    let blended = 1.0 - base_color.a + base_color.a * base_color.rgb;
    return select(material.transmission * base_color.rgb, blended, material.blended == 1u);
}
