// Lit stretches under the light's picture.

// Change in the light but for its picture over a block: optical depth, or angle at the light [rad].
const TINT_BLOCK_DEPTH: f32 = 0.1;
const TINT_BLOCK_ANGLE: f32 = 0.01;
const TINT_MAX_BLOCKS: f32 = 256.0;

fn tint_row_sum(e: Epipolar, slice: u32, term: u32, column: f32) -> vec3f {
    let border = min(floor(column), f32(e.tint_columns) - 1.0);
    let at = tint_index(e, slice, term, u32(border));
    return mix(tint_sums[at].rgb, tint_sums[at + 1u].rgb, column - border);
}

// Between the middles of two slices.
fn tint_sum(e: Epipolar, r: EpipolarRay, term: u32, column: f32) -> vec3f {
    let place = r.place - 0.5;
    let last = e.slices - 1u;
    let whole_turn = e.turns == 1u;
    let below = select(u32(max(place, 0.0)), last, whole_turn && place < 0.0);
    let above = select(min(u32(max(place + 1.0, 0.0)), last), 0u, whole_turn && place + 1.0 > f32(last) + 0.999999);
    return mix(tint_row_sum(e, below, term, column), tint_row_sum(e, above, term, column), place - floor(place));
}

// The light of a lit stretch, but for the common factor: blocks of gamma, in which the light but for its picture
// changes little, go with the mean of the picture.
fn tint_stretch(e: Epipolar, ray: Ray, r: EpipolarRay, a: f32, b: f32) -> vec3f {
    let gammas = vec2f(epipolar_gamma(r, a), epipolar_gamma(r, b));
    let sigma_t = max(max(frame.medium.sigma_t.r, frame.medium.sigma_t.g), frame.medium.sigma_t.b);
    let angle = select(0.0, (gammas.y - gammas.x) / TINT_BLOCK_ANGLE, light_is_local());
    let blocks = clamp(ceil(max(sigma_t * (b - a) / TINT_BLOCK_DEPTH, angle)), 1.0, TINT_MAX_BLOCKS);
    let columns = clamp((gammas - e.tint_start) / e.tint_step, vec2f(0.0), vec2f(f32(e.tint_columns)));
    let width = (columns.y - columns.x) / blocks;
    // Within a column, along the axis, and where the sums are the svd integrator's: the picture itself.
    let has_slice = r.off_axis > e.least_off_axis;
    let narrow = SVD || width < 1.0 || !has_slice;
    var sum = vec3f(0.0);
    var start = a;
    var below = tint_sum(e, r, 0u, columns.x);
    for (var i = 1.0; i <= blocks; i += 1.0) {
        let column = columns.x + i * width;
        var end = a + (b - a) * i / blocks;
        if light_is_local() && has_slice {
            end = epipolar_crossing(r, mix(gammas.x, gammas.y, i / blocks));
        }
        end = select(clamp(end, start, b), b, i == blocks);
        let above = tint_sum(e, r, 0u, column);
        let middle = light_ray_tint(ray.origin + 0.5 * (start + end) * ray.direction);
        sum += select((above - below) / max(width, 1e-3), middle, narrow) * tint_even(ray, start, end);
        below = above;
        start = end;
    }
    return sum;
}

// The light of a stretch as if nothing dimmed light rays on their whole length: closed, or of the middle.
fn tint_even(ray: Ray, a: f32, b: f32) -> vec3f {
    if !light_is_local() {
        return transmittance_integral(frame.medium.sigma_t, a, b);
    }
    return light.color * stretch_middle(ray, a, b);
}
