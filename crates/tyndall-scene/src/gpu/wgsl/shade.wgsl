// One light's share of the radiance that surfaces send to the eye: Lambert; shading/light.rs is its twin, shading/mod.rs has
// the formula.

@fragment
fn shade_light_fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    let from_far = shade_depth_from_far(pixel);
    if from_far == 0.0 {
        return vec4f(0.0);
    }
    let point = shade_point(pixel, from_far);
    let normal = textureLoad(shade_normal, pixel, 0).xyz;
    var irradiance = shade_direct(point, normal);
    if any(irradiance > vec3f(0.0)) {
        irradiance *= shade_visibility(pixel, point, normal);
    }
    irradiance += shade_ambient(point, normal);
    let albedo = textureLoad(shade_base_color, pixel, 0).rgb;
    let tint = textureLoad(shade_view_tint, pixel, 0).rgb;
    return vec4f(tint * albedo / SHADE_PI * irradiance, 0.0);
}
