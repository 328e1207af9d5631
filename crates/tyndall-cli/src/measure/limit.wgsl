@group(0) @binding(0) var limit_depth: texture_depth_2d;
@group(0) @binding(1) var limit_shadow_map: texture_depth_2d_array;

@vertex
fn limit_full_screen(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index << 1u & 2u), f32(index & 2u));
    return vec4f(2.0 * corner - 1.0, 0.0, 1.0);
}

// Neighbouring pixels read neighbouring texels; all pixels together read every texel once.
@fragment
fn limit_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let size = textureDimensions(limit_depth);
    let side = textureDimensions(limit_shadow_map);
    let face = side.x * side.y;
    let texels = face * textureNumLayers(limit_shadow_map);
    let pixel = vec2u(position.xy);
    var sum = textureLoad(limit_depth, pixel, 0);
    for (var i = pixel.y * size.x + pixel.x; i < texels; i += size.x * size.y) {
        let within = i % face;
        sum += textureLoad(limit_shadow_map, vec2u(within % side.x, within / side.x), i / face, 0);
    }
    return vec4f(sum);
}
