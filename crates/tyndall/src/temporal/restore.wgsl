// Pixels of another camera's picture take their places; those that were not found are computed afterwards.

@group(2) @binding(1) var<storage, read> restore_found: array<vec4u>; // see reproject.wgsl

@fragment
fn restore(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    let found = restore_found[pixel.y * reuse.pixels.x + pixel.x];
    return frame_output(position, frame_ray(position), bitcast<vec3f>(found.xyz));
}
