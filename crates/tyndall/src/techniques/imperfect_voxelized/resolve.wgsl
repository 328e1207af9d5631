// What was gathered, to the output: as it is, over the nine pixels that share the samples out, or from a coarser picture.
// Pixels count as their depths are alike (a bilateral filter).

@group(2) @binding(0) var<uniform> imperfect_batch: ImperfectBatch;
@group(2) @binding(1) var<uniform> ivsv: IvsvParams;
@group(2) @binding(2) var<storage, read> ivsv_sums: array<vec4f>;

// Rays whose lengths differ by this much (relative) count for half.
const IVSV_ALIKE: f32 = 0.05;

@fragment
fn ivsv_resolve(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let ray = frame_ray(position);
    let pixel = vec2u(position.xy);
    var sum = ivsv_sums[min(pixel.y, ivsv.size.y - 1u) * ivsv.size.x + min(pixel.x, ivsv.size.x - 1u)];
    if ivsv.turns > 1u {
        sum = ivsv_of_window(pixel, ray.length);
    } else if ivsv.pitch > 1u {
        sum = ivsv_between(pixel, ray.length);
    }
    return frame_output(position, ray, sum.rgb * (f32(imperfect_batch.total) / max(sum.a, 1e-20)));
}

// How alike the ray of a pixel of the gathered picture is.
fn ivsv_weight(place: vec2u, length: f32) -> f32 {
    let pixel = min(place * ivsv.pitch, vec2u(frame.camera.size) - 1u);
    let other = frame_ray(vec4f(vec2f(pixel) + 0.5, 0.0, 1.0)).length;
    let apart = (other - length) / (IVSV_ALIKE * length);
    return max(exp2(-apart * apart), 1e-4);
}

// A window of 3 x 3 pixels within the picture.
fn ivsv_of_window(pixel: vec2u, length: f32) -> vec4f {
    let corner = vec2u(clamp(vec2i(pixel) - 1, vec2i(0), max(vec2i(ivsv.size) - 3, vec2i(0))));
    var sum = vec4f(0.0);
    for (var i = 0u; i < 9u; i++) {
        let place = min(corner + vec2u(i % 3u, i / 3u), ivsv.size - 1u);
        sum += ivsv_weight(place, length) * ivsv_sums[place.y * ivsv.size.x + place.x];
    }
    return sum;
}

// The four pixels of the coarser picture around.
fn ivsv_between(pixel: vec2u, length: f32) -> vec4f {
    let low = pixel / ivsv.pitch;
    let share = vec2f(pixel % ivsv.pitch) / f32(ivsv.pitch);
    var sum = vec4f(0.0);
    for (var i = 0u; i < 4u; i++) {
        let step = vec2u(i & 1u, i >> 1u);
        let place = min(low + step, ivsv.size - 1u);
        let nearness = select(1.0 - share, share, step == vec2u(1u));
        let weight = nearness.x * nearness.y * ivsv_weight(place, length);
        sum += weight * ivsv_sums[place.y * ivsv.size.x + place.x];
    }
    return sum;
}
