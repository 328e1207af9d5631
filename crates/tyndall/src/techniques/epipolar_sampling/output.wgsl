// The unshadowed light and the phase function, at full resolution.

// What is left in a pixel, of this mean visibility.
fn finish_output(pixel: vec2u, ray: Ray, share: vec3f) -> vec4f {
    let left = transmittance(frame.medium.sigma_t, ray.length);
    var radiance = share * unshadowed_from(ray, left);
    if !light_is_local() {
        radiance *= medium_scattering(-dot(light.direction, ray.direction)) * light.color;
    }
    return vec4f(textureLoad(frame_lights_before, pixel, 0).rgb + radiance, dot(left, vec3f(1.0 / 3.0)));
}
