// A level of a pyramid from the one above it, or its first from the shadow map, or from coloured glass: of that, the
// nearest layer that tints, and nothing as the farthest.

struct PyramidFace {
    layer: u32,
}

@group(2) @binding(0) var<uniform> pyramid_face: PyramidFace;
@group(2) @binding(1) var pyramid_above: texture_2d<f32>;

const PYRAMID_FROM_PYRAMID: u32 = 0u;
const PYRAMID_FROM_MAP: u32 = 1u;
const PYRAMID_FROM_GLASS: u32 = 2u;

override PYRAMID_SOURCE: u32 = 0u;

fn pyramid_source_size() -> vec2u {
    switch PYRAMID_SOURCE {
        case PYRAMID_FROM_MAP: { return textureDimensions(shadow_map); }
        case PYRAMID_FROM_GLASS: { return textureDimensions(shadow_glass); }
        default: { return textureDimensions(pyramid_above); }
    }
}

fn pyramid_read(at: vec2u) -> vec2f {
    switch PYRAMID_SOURCE {
        case PYRAMID_FROM_MAP: {
            let held = textureLoad(shadow_map, at, pyramid_face.layer, 0);
            return vec2f(select(held, 1.0 - held, light.standard_depth == 1u));
        }
        case PYRAMID_FROM_GLASS: { return vec2f(0.0, shadow_glass_nearest(at, pyramid_face.layer)); }
        default: { return textureLoad(pyramid_above, at, 0).rg; }
    }
}

@fragment
fn pyramid_build(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let first = 2u * vec2u(position.xy);
    let last = pyramid_source_size() - 1u;
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
