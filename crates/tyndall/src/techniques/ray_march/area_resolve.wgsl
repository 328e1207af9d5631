// The sums of a rectangular light to the output.

@group(2) @binding(0) var<storage, read> ray_march_sums: array<vec4f>;

@fragment
fn ray_march_resolve(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    let before = textureLoad(frame_lights_before, pixel, 0).rgb;
    let left = transmittance(frame.medium.sigma_t, frame_ray(position).length);
    let sum = ray_march_sums[pixel.y * u32(frame.camera.size.x) + pixel.x].rgb;
    return vec4f(before + sum, dot(left, vec3f(1.0 / 3.0)));
}
