// Radiance without any light: the sky, and the emission of surfaces.

@fragment
fn shade_base_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    var radiance = textureLoad(shade_emissive, pixel, 0).rgb;
    if shade_depth_from_far(pixel) == 0.0 {
        let height = saturate(shade_direction(pixel).y);
        radiance = shade_view.sun * mix(shade_view.sky_horizon, shade_view.sky_zenith, height);
    }
    return vec4f(textureLoad(shade_view_tint, pixel, 0).rgb * radiance, 1.0);
}
