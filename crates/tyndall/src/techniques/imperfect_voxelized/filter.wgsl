// From the gathered picture to the output: as it is, over the nine pixels that share the samples out, or from a coarser
// picture. Pixels count as their depths are alike (a bilateral filter).

// Rays whose lengths differ by this much (relative) count for half.
const IVSV_ALIKE: f32 = 0.05;

// A pixel of the gathered picture, and what it counts for.
struct IvsvTap {
    index: u32,
    weight: f32,
}

// One of the taps of an output's pixel whose ray is so long: of a window of 3 x 3 pixels within the picture, or of the four
// of the coarser picture around, the first of which is the pixel itself where it is as fine.
fn ivsv_tap(pixel: vec2u, length: f32, i: u32) -> IvsvTap {
    let in_turns = ivsv.turns > 1u;
    let corner = vec2u(clamp(vec2i(pixel) - 1, vec2i(0), max(vec2i(ivsv.size) - 3, vec2i(0))));
    let step = vec2u(i & 1u, i >> 1u);
    let place = select(pixel / ivsv.pitch + step, corner + vec2u(i % 3u, i / 3u), in_turns);
    let share = vec2f(pixel % ivsv.pitch) / f32(ivsv.pitch);
    let nearness = select(1.0 - share, share, step == vec2u(1u));
    let held = min(place, ivsv.size - 1u);
    let apart = (ivsv_ray(held).length - length) / (IVSV_ALIKE * length);
    let alike = max(exp2(-apart * apart), 1e-4);
    let counts = select(0.0, 1.0, i < ivsv.taps);
    return IvsvTap(held.y * ivsv.size.x + held.x, counts * alike * select(nearness.x * nearness.y, 1.0, in_turns));
}
