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

// What the last pass of a light leaves in its pixel: the lights before this one and this one's radiance, and the mean
// transmittance of the pixel's ray.
fn frame_output(position: vec4f, ray: Ray, radiance: vec3f) -> vec4f {
    let before = textureLoad(frame_lights_before, vec2u(position.xy), 0).rgb;
    let left = transmittance(frame.medium.sigma_t, ray.length);
    return vec4f(before + radiance, dot(left, vec3f(1.0 / 3.0)));
}
