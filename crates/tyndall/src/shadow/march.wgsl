// A light along a view ray, step by step: visibility from the shadow map times the rest of the integrand (Chen 2011, eq. 1).

// The integrand at distance s, but for light_common.
fn march_sample(ray: Ray, map_ray: ShadowRay, s: f32) -> vec3f {
    let tint = shadow_tint(map_ray.c0 + s * map_ray.c1);
    if all(tint == vec3f(0.0)) {
        return vec3f(0.0);
    }
    let point = ray.origin + s * ray.direction;
    let reached = tint * transmittance(frame.medium.sigma_t, s);
    if !light_is_local() {
        return reached * light_tint(point);
    }
    let incident = light_incident(point);
    return reached * medium_scattering(-dot(incident.direction, ray.direction)) * incident.irradiance;
}

// The integral over a stretch [m] in equal steps, or none.
fn march_equal(ray: Ray, stretch: vec2f, steps: u32) -> vec3f {
    let map_ray = shadow_ray(ray);
    let step = (stretch.y - stretch.x) / f32(max(steps, 1u));
    var sum = vec3f(0.0);
    for (var i = 0u; i < steps; i++) {
        sum += march_sample(ray, map_ray, stretch.x + (f32(i) + 0.5) * step);
    }
    return sum * step * light_common(ray);
}
