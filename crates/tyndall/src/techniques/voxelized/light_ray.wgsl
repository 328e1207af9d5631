// Where light rays end in the shadow map.

// Distance [m] to the surface that a light ray ends on; 1e30 where the map holds none.
fn light_ray_end(line: ShadowLine) -> f32 {
    if SHADOW_KIND == SHADOW_NONE || any(line.uv < vec2f(0.0)) || any(line.uv >= vec2f(1.0)) {
        return 1e30;
    }
    let texel = vec2u(line.uv * vec2f(textureDimensions(shadow_map)));
    let stored = textureLoad(shadow_map, texel, line.face, 0);
    let held = select(stored, 1.0 - stored, light.standard_depth == 1u);
    return select(shadow_line_end(line, held), 1e30, held <= 0.0);
}
