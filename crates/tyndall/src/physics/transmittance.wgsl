// Extinction along a straight path (Beer 1852) and its integral, per channel.

fn transmittance(sigma_t: vec3f, distance: f32) -> vec3f {
    return exp(-sigma_t * distance);
}

// Integral of the transmittance over the distances a..b [m]. WGSL has no expm1: below an optical depth of 0.01
// three terms of (1 - exp(-x)) / x are exact to f32.
fn transmittance_integral(sigma_t: vec3f, a: f32, b: f32) -> vec3f {
    let length = b - a;
    return transmittance(sigma_t, a) * transmittance_integral_from_eye(sigma_t, length, transmittance(sigma_t, length));
}

// Of a path that starts at the eye, where the transmittance at its end is known.
fn transmittance_integral_from_eye(sigma_t: vec3f, length: f32, left: vec3f) -> vec3f {
    let depth = sigma_t * length;
    let series = 1.0 - depth * (0.5 - depth * (1.0 / 6.0));
    let closed = (1.0 - left) / max(depth, vec3f(1e-30));
    return length * select(closed, series, depth < vec3f(0.01));
}
