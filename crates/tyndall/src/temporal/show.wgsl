// Debug views: the pixels that were computed, or how long ago each was.

@group(2) @binding(3) var show_kept: texture_2d<f32>;
@group(2) @binding(4) var<uniform> show_what: vec4u;

const SHOW_MASK: u32 = 1u;
// Frames until a pixel looks old.
const SHOW_OLD: f32 = 32.0;

@fragment
fn show(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    let kept = textureLoad(show_kept, pixel, 0);
    let before = textureLoad(frame_lights_before, pixel, 0).rgb;
    let age = reuse_age(pixel);
    if show_what.x == SHOW_MASK {
        return vec4f(before + vec3f(f32(age == 0u), 0.0, 0.0), kept.a);
    }
    let old = saturate(f32(age) / SHOW_OLD);
    return vec4f(before + vec3f(old, 1.0 - old, f32(age == 0u)), kept.a);
}
