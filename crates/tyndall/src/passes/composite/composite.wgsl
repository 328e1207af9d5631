// The picture behind the medium: background * transmittance + in-scattered light, as two blended draws, so that
// transmittance may differ by channel (Yusov 2012, eq. 1).

// Blended as destination * source.
@fragment
fn composite_attenuate(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(transmittance(frame.medium.sigma_t, frame_ray(position).length), 1.0);
}

// Blended as destination + source.
@fragment
fn composite_in_scatter(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(textureLoad(frame_lights_before, vec2u(position.xy), 0).rgb, 0.0);
}
