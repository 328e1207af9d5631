// Coloured glass seen from a light, layer by layer (depth peeling: Everitt 2001, "Interactive order-independent
// transparency").

override GLASS_REVERSED_DEPTH: bool;
// The first layer has nothing before it.
override GLASS_FIRST_LAYER: bool;

@group(2) @binding(0) var glass_opaque: texture_depth_2d;
@group(2) @binding(1) var glass_layer_before: texture_2d<u32>;

fn glass_is_nearer(depth: f32, than: f32) -> bool {
    return select((depth < than), (depth > than), GLASS_REVERSED_DEPTH);
}

// Three 10-bit square roots, red lowest.
fn glass_pack_tint(tint: vec3f) -> u32 {
    let roots = vec3u(round(sqrt(clamp(tint, vec3f(0.0), vec3f(1.0))) * 1023.0));
    return roots.r | (roots.g << 10u) | (roots.b << 20u);
}

@fragment
fn glass_fragment(fragment: MeshFragment) -> @location(0) vec2u {
    let texel = vec2u(fragment.position.xy);
    let depth = fragment.position.z;
    let tint = material_tint(material_finest_base_color(fragment.uv));
    let is_clear = all(tint >= vec3f(1.0));
    let is_behind = !glass_is_nearer(depth, textureLoad(glass_opaque, texel, 0));
    var is_peeled = false;
    if !GLASS_FIRST_LAYER {
        is_peeled = !glass_is_nearer(bitcast<f32>(textureLoad(glass_layer_before, texel, 0).r), depth);
    }
    if is_clear || is_behind || is_peeled {
        discard;
    }
    return vec2u(bitcast<u32>(depth), glass_pack_tint(tint));
}
