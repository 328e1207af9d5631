// What is gathered, and how. The shader that uses it declares `imperfect_batch` and `ivsv`.

struct IvsvParams {
    size: vec2u, // of the picture that is gathered [pixels]
    pitch: u32, // pixels of the output from one of its pixels to the next
    turns: u32, // 1, or 9: of so many pixels each takes other samples
    weighting: u32,
    taps: u32, // pixels of it that one of the output is made of
    spread: u32, // pixels from one of a workgroup to the next: all of them take the same samples
}

// The pixel of a thread, of workgroups that take tiles of so many pixels each.
fn ivsv_place(group: vec2u, tile: vec2u, local: vec2u) -> vec2u {
    let spread = ivsv.spread;
    return group / spread * (spread * tile) + group % spread + spread * local;
}

// The output's pixel that one of the gathered picture stands for.
fn ivsv_pixel(place: vec2u) -> vec2u {
    return min(place * ivsv.pitch, vec2u(frame.camera.size) - 1u);
}

// The view ray of one of the gathered picture's pixels.
fn ivsv_ray(place: vec2u) -> Ray {
    return frame_ray(vec4f(vec2f(ivsv_pixel(place)) + 0.5, 0.0, 1.0));
}

// The first sample of the batch that a pixel takes; it takes every `turns`-th from there on.
fn ivsv_first(place: vec2u, turns: u32) -> u32 {
    let own = (place.x % 3u + 3u * (place.y % 3u)) % turns;
    return (own + turns - imperfect_batch.first % turns) % turns;
}
