// Adds up a ray: the light it would get if visibility were what it is at the eye, and all that its jumps change.

@group(2) @binding(0) var light_volume_sum: texture_2d<f32>;

@fragment
fn light_volume_resolve(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let ray = frame_ray(position);
    return frame_output(position, ray, light_volume_light(ray, vec2u(position.xy)));
}

fn light_volume_light(ray: Ray, pixel: vec2u) -> vec3f {
    let unshadowed = stretch_plain(ray, 0.0, ray.length);
    if SHADOW_KIND == SHADOW_NONE {
        return unshadowed;
    }
    let sum = textureLoad(light_volume_sum, pixel, 0);
    // At its end a ray has left a single map's volume, and is outside a cube's.
    let at_end = select(1.0, 0.0, SHADOW_KIND == SHADOW_CUBE);
    var lit = round(at_end - sum.a) * unshadowed + sum.rgb;
    if SHADOW_GLASS {
        lit += light_volume_glass(ray);
    }
    return max(lit, vec3f(0.0));
}
