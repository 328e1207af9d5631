// The rectangular picture at 1 / `downscale` of the resolution: each of its pixels stands at one of the full picture's.

fn coarse_pixel(coarse: vec2u) -> vec2u {
    let middle = coarse * sampling.downscale + sampling.downscale / 2u;
    return min(middle, vec2u(frame.camera.size) - 1u);
}
