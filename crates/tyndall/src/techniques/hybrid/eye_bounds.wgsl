// Where the eye is in a shadow, every ray begins in one.

@group(2) @binding(0) var<storage, read> eye_bounds_in_shadow: u32;

@fragment
fn eye_bounds() -> @location(0) vec4f {
    // More than 1, as bounds.wgsl rounds outwards.
    return vec4f(select(0.0, 1.01, eye_bounds_in_shadow != 0u), 0.0, 0.0, 0.0);
}
