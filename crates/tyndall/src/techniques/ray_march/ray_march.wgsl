// Brute force: N steps a ray, each looked up in the shadow map (Chen 2011, eq. 1, as a Riemann sum).

@group(2) @binding(0) var<uniform> ray_march_params: RayMarchParams;

@fragment
fn ray_march(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let ray = frame_ray(position);
    return frame_output(position, ray, ray_march_light(ray));
}

fn ray_march_light(ray: Ray) -> vec3f {
    let span = light_reach(ray);
    if span.x >= span.y {
        return vec3f(0.0);
    }
    if light_is_local() && ray_march_params.spacing == RAY_MARCH_EQUIANGULAR {
        return ray_march_equiangular(ray, span);
    }
    return march_equal(ray, span, ray_march_params.steps);
}

// Kulla & Fajardo 2012: s = t_p + h tan(xi), equal steps in xi, ds = h (1 + tan^2) d xi.
fn ray_march_equiangular(ray: Ray, span: vec2f) -> vec3f {
    let map_ray = shadow_ray(ray);
    let to_light = light.position - ray.origin;
    let projection = dot(to_light, ray.direction);
    let height = max(length(to_light - projection * ray.direction), LIGHT_RADIUS);
    let angles = atan((span - projection) / height);
    let step = (angles.y - angles.x) / f32(ray_march_params.steps);
    var sum = vec3f(0.0);
    for (var i = 0u; i < ray_march_params.steps; i++) {
        let slope = tan(angles.x + (f32(i) + 0.5) * step);
        let s = projection + height * slope;
        sum += march_sample(ray, map_ray, s) * (1.0 + slope * slope);
    }
    return sum * step * height * light_common(ray);
}
