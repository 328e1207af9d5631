// A level of the pyramid from the one above it, or its first from the shadow map itself.

struct PyramidFace {
    layer: u32,
}

@group(2) @binding(0) var<uniform> pyramid_face: PyramidFace;
@group(2) @binding(1) var pyramid_above: texture_2d<f32>;

override PYRAMID_FIRST: bool = false;

fn pyramid_read(at: vec2u) -> vec2f {
    if PYRAMID_FIRST {
        let held = textureLoad(shadow_map, at, pyramid_face.layer, 0);
        return vec2f(select(held, 1.0 - held, light.standard_depth == 1u));
    }
    return textureLoad(pyramid_above, at, 0).rg;
}

@fragment
fn pyramid_build(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let size = select(textureDimensions(pyramid_above), textureDimensions(shadow_map), PYRAMID_FIRST);
    let first = 2u * vec2u(position.xy);
    let last = size - 1u;
    let top = pyramid_unite(
        pyramid_read(min(first, last)),
        pyramid_read(min(first + vec2u(1u, 0u), last)),
    );
    let bottom = pyramid_unite(
        pyramid_read(min(first + vec2u(0u, 1u), last)),
        pyramid_read(min(first + vec2u(1u, 1u), last)),
    );
    return vec4f(pyramid_unite(top, bottom), 0.0, 0.0);
}
