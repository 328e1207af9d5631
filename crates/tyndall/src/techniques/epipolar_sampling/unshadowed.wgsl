// What interpolated values are shares of: a ray's light if nothing blocked it, but for factors that the sun's rays share. It
// has the peaks of phase function and light in it, and its dependence on depth; a share, the mean visibility, is smooth.

fn unshadowed(ray: Ray) -> vec3f {
    return unshadowed_from(ray, transmittance(frame.medium.sigma_t, ray.length));
}

// The same, where the transmittance of the ray is known.
fn unshadowed_from(ray: Ray, left: vec3f) -> vec3f {
    if !light_is_local() {
        return transmittance_integral_from_eye(frame.medium.sigma_t, ray.length, left);
    }
    let span = light_reach(ray);
    return stretch_plain(ray, span.x, span.y);
}

// The share of it that is seen; all where there is none to see, so that what lies outside a cone does not darken its rim.
fn unshadowed_share(seen: vec3f, all: vec3f) -> vec3f {
    return select(vec3f(1.0), seen / max(all, vec3f(1e-30)), all > vec3f(1e-30));
}
