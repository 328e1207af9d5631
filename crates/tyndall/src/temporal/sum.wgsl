// Adds a light's kept picture to the lights before.

@group(2) @binding(0) var sum_kept: texture_2d<f32>;

@fragment
fn sum(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    let kept = textureLoad(sum_kept, pixel, 0);
    return vec4f(textureLoad(frame_lights_before, pixel, 0).rgb + kept.rgb, kept.a);
}
