// What every pass of a frame reads.

struct Frame {
    camera: Camera,
    medium: Medium,
}

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var frame_depth: texture_depth_2d;
// In-scattered light of the lights before this one (rgb).
@group(0) @binding(2) var frame_lights_before: texture_2d<f32>;

// A triangle that covers the picture.
@vertex
fn frame_full_screen(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let corner = vec2f(vec2u((vertex << 1u) & 2u, vertex & 2u));
    return vec4f(2.0 * corner - 1.0, 0.0, 1.0);
}

// The view ray through a pixel's centre, up to its first surface.
fn frame_ray(position: vec4f) -> Ray {
    return camera_ray(position.xy, textureLoad(frame_depth, vec2u(position.xy), 0));
}
