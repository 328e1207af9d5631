// The first opaque surface that each pixel sees.

override G_BUFFER_MASKED: bool;

struct GBufferTexel {
    // World space, unit length, facing the viewer.
    @location(0) normal: vec4f,
    // Linear.
    @location(1) base_color: vec4f,
    @location(2) emissive: vec4f,
}

@fragment
fn g_buffer_fragment(fragment: MeshFragment) -> GBufferTexel {
    let base_color = material_base_color(fragment.uv);
    if G_BUFFER_MASKED && material_is_hole(fragment.uv) {
        discard;
    }
    let normal = mesh_normalize(fragment.normal);
    let away = dot(normal, view_direction_to_viewer(fragment.relative)) < 0.0;
    var texel: GBufferTexel;
    texel.normal = vec4f(select(normal, -normal, away), 0.0);
    texel.base_color = vec4f(base_color.rgb, 1.0);
    texel.emissive = vec4f(material.emissive, 1.0);
    return texel;
}
