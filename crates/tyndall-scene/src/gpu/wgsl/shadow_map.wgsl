// Depth seen from a light; only masked surfaces need a fragment stage.

@fragment
fn shadow_map_masked_fragment(fragment: MeshFragment) {
    if material_is_hole(fragment.uv) {
        discard;
    }
}
