// Factor of the glass and blended surfaces in front of the first opaque surface on its light.

@fragment
fn view_tint_fragment(fragment: MeshFragment) -> @location(0) vec4f {
    return vec4f(material_tint(material_finest_base_color(fragment.uv)), 1.0);
}
