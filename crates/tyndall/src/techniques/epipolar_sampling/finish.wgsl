// The last stage, where a picture of mean visibilities is there.

@group(2) @binding(1) var finish_shares: texture_2d<f32>;
@group(2) @binding(2) var airlight_table: texture_2d_array<f32>;

@fragment
fn finish(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(position.xy);
    let ray = camera_ray_to(position.xy, sampling_view_depth(pixel));
    return finish_output(pixel, ray, textureLoad(finish_shares, pixel, 0).rgb);
}
