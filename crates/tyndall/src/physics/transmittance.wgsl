// Extinction along a straight path (Beer 1852) and its integral, per channel.

fn transmittance(sigma_t: vec3f, distance: f32) -> vec3f {
    return exp(-sigma_t * distance);
}

// Integral of the transmittance over the distances a..b [m]. WGSL has no expm1: below an optical depth of 0.01
// three terms of (1 - exp(-x)) / x are exact to f32.
fn transmittance_integral(sigma_t: vec3f, a: f32, b: f32) -> vec3f {
    let depth = sigma_t * (b - a);
    let series = 1.0 - depth * (0.5 - depth * (1.0 / 6.0));
    let closed = (1.0 - exp(-depth)) / max(depth, vec3f(1e-30));
    return transmittance(sigma_t, a) * (b - a) * select(closed, series, depth < vec3f(0.01));
}
