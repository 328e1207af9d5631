// Marks the pixels that this frame computes, for the stencil test of a technique's last pass.

@group(2) @binding(1) var<storage, read> stencil_state: ReuseSettled;
@group(2) @binding(2) var<storage, read> stencil_age: array<u32>;

@fragment
fn stencil(@builtin(position) position: vec4f) {
    if reuse_age(vec2u(position.xy)) > 0u {
        discard;
    }
}

// Frames since the pixel was computed.
fn reuse_age(pixel: vec2u) -> u32 {
    let is_whole = reuse.reach == REUSE_PICTURE && stencil_state.stale > 0u;
    if stencil_state.mode < REUSE_MASKED || is_whole {
        return 0u;
    }
    return stencil_age[pixel.y * reuse.pixels.x + pixel.x] & REUSE_AGE;
}
