// The mean tint of a stretch of a view ray.

// How many blocks a lit stretch is taken apart into.
fn tint_blocks(ray: Ray, r: EpipolarRay, a: f32, b: f32) -> f32 {
    let sigma_t = max(max(frame.medium.sigma_t.r, frame.medium.sigma_t.g), frame.medium.sigma_t.b);
    var blocks = sigma_t * (b - a) / TINT_BLOCK_DEPTH;
    if light_is_local() {
        blocks = max(blocks, (epipolar_gamma(r, b) - epipolar_gamma(r, a)) / TINT_BLOCK_ANGLE);
    }
    return clamp(ceil(blocks), 1.0, 64.0);
}

fn tint_row_sum(e: Epipolar, slice: u32, with_glass: u32, column: f32) -> vec3f {
    let border = min(floor(column), f32(TINT_COLUMNS) - 1.0);
    let at = tint_index(e, slice, with_glass, u32(border));
    return mix(tint_sums[at].rgb, tint_sums[at + 1u].rgb, column - border);
}

// Between the middles of two slices.
fn tint_sum(e: Epipolar, r: EpipolarRay, with_glass: u32, column: f32) -> vec3f {
    let place = r.place - 0.5;
    let last = e.slices - 1u;
    let whole_turn = e.turns == 1u;
    let below = select(u32(max(place, 0.0)), last, whole_turn && place < 0.0);
    let above = select(min(u32(max(place + 1.0, 0.0)), last), 0u, whole_turn && place + 1.0 > f32(last) + 0.999999);
    return mix(
        tint_row_sum(e, below, with_glass, column),
        tint_row_sum(e, above, with_glass, column),
        place - floor(place),
    );
}

// Of the stretch a..b.
fn tint_mean(e: Epipolar, ray: Ray, r: EpipolarRay, a: f32, b: f32) -> vec3f {
    let columns = vec2f(tint_place(e, epipolar_gamma(r, a)), tint_place(e, epipolar_gamma(r, b)));
    let middle = ray.origin + 0.5 * (a + b) * ray.direction;
    let narrow = columns.y - columns.x < 1.0 || r.off_axis <= e.least_off_axis;
    var at_middle = light_tint(middle);
    if SHADOW_GLASS {
        let map_ray = shadow_ray(ray);
        at_middle *= shadow_glass_tint(shadow_point(map_ray.c0 + 0.5 * (a + b) * map_ray.c1));
    }
    var sum = vec3f(0.0);
    if SHADOW_GLASS {
        sum = tint_through_glass(e, ray, r, columns);
    } else {
        sum = tint_sum(e, r, 0u, columns.y) - tint_sum(e, r, 0u, columns.x);
    }
    return select(sum / max(columns.y - columns.x, 1e-3), at_middle, narrow);
}

// The sum over columns of which some may lie behind glass: as in traverse.wgsl, neighbours in the same state are one.
fn tint_through_glass(e: Epipolar, ray: Ray, r: EpipolarRay, columns: vec2f) -> vec3f {
    let slice = epipolar_slice(e, r);
    let end = u32(ceil(columns.y));
    var index = u32(columns.x);
    var level = 0u;
    var sum = vec3f(0.0);
    var start = columns.x;
    var behind = false;
    loop {
        var both = false;
        loop {
            if (index << level) >= end {
                break;
            }
            let node = tint_nodes[tree_node(TINT_COLUMNS, slice, level, index)];
            let before = r.b < tree_minimum(node);
            let past = r.b >= tree_maximum(node);
            both = !(before || past);
            if select(before, past, behind) {
                let next = tree_next(level, index);
                level = next.x;
                index = next.y;
            } else if both && level > 0u {
                level -= 1u;
                index *= 2u;
            } else {
                break;
            }
        }
        let leaf = min(index << level, end);
        let stop = clamp(f32(leaf), columns.x, columns.y);
        let glass = u32(behind);
        sum += tint_sum(e, r, glass, stop) - tint_sum(e, r, glass, start);
        start = stop;
        if leaf >= end {
            break;
        }
        if both {
            // Behind some of the layers on this light ray.
            let next = min(f32(leaf + 1u), columns.y);
            let s = epipolar_crossing(r, e.tint_start + 0.5 * (stop + next) * e.tint_step);
            let map_ray = shadow_ray(ray);
            let tint = shadow_glass_tint(shadow_point(map_ray.c0 + s * map_ray.c1));
            sum += (next - stop) * tint * light_tint(ray.origin + s * ray.direction);
            start = next;
            index = leaf + 1u;
            level = 0u;
        } else {
            behind = !behind;
        }
    }
    return sum;
}
