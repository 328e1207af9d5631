// A view ray through its slice's tree (Chen 2011, fig. 5): without recursion, up at most one level a step, and
// neighbours in the same state are one stretch. Where a leaf holds both light and shadow, the ray is walked through
// the shadow map itself, so that its borders are exact.
//
// Loops that end when there is something rare to do, and then do it once: a processor that runs several rays in step
// pays for the rare work of one with all of them.

@group(2) @binding(0) var<uniform> min_max: MinMax;
@group(2) @binding(1) var<storage, read> min_max_nodes: array<u32>;
@group(2) @binding(2) var airlight_table: texture_2d_array<f32>;

@fragment
fn traverse(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let ray = frame_ray(position);
    let before = textureLoad(frame_lights_before, vec2u(position.xy), 0).rgb;
    let left = transmittance(frame.medium.sigma_t, ray.length);
    return vec4f(before + traverse_light(ray), dot(left, vec3f(1.0 / 3.0)));
}

fn traverse_border(e: Epipolar, r: EpipolarRay, leaf: u32, span: vec2f) -> f32 {
    return clamp(epipolar_crossing(r, e.gamma_start + f32(leaf) * e.gamma_step), span.x, span.y);
}

fn traverse_light(ray: Ray) -> vec3f {
    let e = min_max.epipolar;
    let span = light_reach(ray);
    if span.x >= span.y {
        return vec3f(0.0);
    }
    let r = epipolar_ray(e, ray);
    let ends = (vec2f(epipolar_gamma(r, span.x), epipolar_gamma(r, span.y)) - e.gamma_start) / e.gamma_step;
    // The leaves that lie wholly within the span; none for rays along the axis.
    let last = select(0.0, f32(e.samples), r.off_axis > e.least_off_axis);
    let first = u32(clamp(ceil(ends.x), 0.0, last));
    let end_leaf = max(first, u32(clamp(floor(ends.y), 0.0, last)));

    let map_ray = shadow_ray(ray);
    var sum = vec3f(0.0);
    var lit = false;
    var lit_from = span.x;
    var level = 0u;
    var index = first;
    // What comes before the first leaf is walked, and what comes after the last.
    var walk = shadow_walk_from(map_ray, span.x);
    var s = span.x;
    var walk_end = select(traverse_border(e, r, first, span), span.y, last == 0.0);
    var walking = true;
    var tail = last == 0.0;
    loop {
        var both = false;
        loop {
            if walking || (index << level) >= end_leaf {
                break;
            }
            let node = min_max_nodes[min_max_node(e, r.slice, level, index)];
            let dark = r.b >= f32(node >> 16u);
            let bright = r.b < f32(node & 0xffffu);
            both = !(dark || bright);
            if select(dark, bright, lit) {
                // On in the same state; up where a parent begins.
                index += 1u;
                let up = u32((index & 1u) == 0u && level + 1u < MIN_MAX_LEVELS);
                level += up;
                index = index >> up;
            } else if both && level > 0u {
                level -= 1u;
                index *= 2u;
            } else {
                break;
            }
        }
        let leaf = min(index << level, end_leaf);
        let start = traverse_border(e, r, leaf, span);
        var event = start;
        var changes = !walking && leaf < end_leaf && !both;
        if !walking && !changes {
            if tail {
                break;
            }
            tail = leaf >= end_leaf;
            walking = true;
            s = start;
            walk_end = select(traverse_border(e, r, leaf + 1u, span), span.y, tail);
            walk = shadow_walk_from(map_ray, s);
            index = select(index + 1u, index, tail);
        }
        loop {
            if !walking {
                break;
            }
            if s >= walk_end {
                walking = false;
                break;
            }
            let end = max(s, min(shadow_walk_end(walk), walk_end));
            let held = shadow_walk_held(walk);
            let at = vec2f(shadow_walk_margin(walk, held, s), shadow_walk_margin(walk, held, end));
            let starts_lit = held <= 0.0 || at.x >= 0.0;
            let ends_lit = held <= 0.0 || at.y >= 0.0;
            let now = starts_lit != lit;
            changes = now || ends_lit != lit;
            event = select(clamp(s + (end - s) * at.x / (at.x - at.y), s, end), s, now);
            // Of two changes in one texel the second is left to the next step.
            if !(now && ends_lit == lit) {
                s = end;
                walk = shadow_walk_on(map_ray, walk, end);
            }
            if changes {
                break;
            }
        }
        sum += traverse_stretch(ray, lit_from, select(lit_from, event, changes && lit));
        lit_from = select(lit_from, event, changes);
        lit = lit != changes;
    }
    sum += traverse_stretch(ray, lit_from, select(lit_from, span.y, lit));
    return sum * traverse_common(ray);
}

// The light of a lit stretch, but for the common factor.
fn traverse_stretch(ray: Ray, a: f32, b: f32) -> vec3f {
    if light_is_local() {
        return stretch_plain(ray, a, b);
    }
    return transmittance_integral(frame.medium.sigma_t, a, b);
}

// The factor that all stretches of a ray share.
fn traverse_common(ray: Ray) -> vec3f {
    if light_is_local() {
        return vec3f(1.0);
    }
    return medium_scattering(-dot(light.direction, ray.direction)) * light.color;
}
