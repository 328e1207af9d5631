// The sums of a rectangular light to the output.

@group(2) @binding(0) var<storage, read> ray_march_sums: array<vec4f>;

@fragment
fn ray_march_resolve(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    let sum = ray_march_sums[pixel.y * u32(frame.camera.size.x) + pixel.x].rgb;
    return frame_output(position, frame_ray(position), sum);
}
