// A view ray through its slice's tree (Chen 2011, fig. 5): without recursion, up at most one level a step, and
// neighbours in the same state are one stretch. Where a leaf holds both light and shadow, the ray is walked through
// the shadow map itself, so that the borders are exact.
//
// Loops end when there is something rare to do, which is then done once; and lit stretches are found first, integrated
// after. A processor that runs several rays in step pays for the rare work of one with all of them.

@group(2) @binding(0) var<uniform> epipolar: Epipolar;
@group(2) @binding(1) var<storage, read> min_max_nodes: array<u32>;
@group(2) @binding(2) var airlight_table: texture_2d_array<f32>;
@group(2) @binding(3) var<storage, read> tint_sums: array<vec4f>;
@group(2) @binding(4) var<storage, read> glass_nodes: array<u32>;
@group(2) @binding(5) var<uniform> svd: Svd;
@group(2) @binding(6) var<storage, read> svd_factors: array<vec4f>;

// Lit stretches that are kept before they are integrated.
const TRAVERSE_STRETCHES: u32 = 8u;

// What does not change along a view ray.
struct TraverseRay {
    ray: Ray,
    span: vec2f, // that the light reaches [m]
    place: EpipolarRay,
    slice: u32,
    has_leaves: bool, // none along the axis, or where there are no shadows: rays are walked from end to end
    first_leaf: u32, // that lies wholly within the span
    end_leaf: u32, // one past the last
    map_ray: ShadowRay,
}

// How far a traversal has come.
struct Traversal {
    lit: bool,
    lit_from: f32, // distance [m], where it is lit
    level: u32,
    index: u32, // of the node that is next
    walking: bool, // through the map, from s to walk_end, before the node that is next
    last_walk: bool, // nothing comes after this walk
    s: f32,
    walk_end: f32,
    walk: ShadowWalk,
    nodes: u32, // visited so far
    texels: u32,
}

// Where light turns to shadow or shadow to light.
struct TraverseBorder {
    is_found: bool,
    s: f32,
}

@fragment
fn traverse(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let ray = frame_ray(position);
    return frame_output(position, ray, traverse_light(ray));
}

// The leaves that lie wholly within a span: the first, and one past the last.
fn traverse_leaves(place: EpipolarRay, has_leaves: bool, span: vec2f) -> vec2u {
    let leaves = select(0.0, f32(epipolar.samples), has_leaves);
    let gammas = vec2f(epipolar_gamma(place, span.x), epipolar_gamma(place, span.y));
    let ends = (gammas - epipolar.gamma_start) / epipolar.gamma_step;
    let first = u32(clamp(ceil(ends.x), 0.0, leaves));
    return vec2u(first, max(first, u32(clamp(floor(ends.y), 0.0, leaves))));
}

// Of a ray that the light reaches over a span.
fn traverse_view(ray: Ray, span: vec2f) -> TraverseRay {
    let place = epipolar_ray(epipolar, ray);
    let has_leaves = SHADOW_KIND != SHADOW_NONE && place.off_axis > epipolar.least_off_axis;
    let leaves = traverse_leaves(place, has_leaves, span);
    let slice = epipolar_slice(epipolar, place);
    return TraverseRay(ray, span, place, slice, has_leaves, leaves.x, leaves.y, shadow_ray(ray));
}

// What comes before the first leaf is walked.
fn traverse_start(view: TraverseRay) -> Traversal {
    let start = view.span.x;
    let walk_end = select(view.span.y, traverse_leaf(view, view.first_leaf), view.has_leaves);
    let walk = shadow_walk_from(view.map_ray, traverse_map_size(), start);
    return Traversal(false, start, 0u, view.first_leaf, true, !view.has_leaves, start, walk_end, walk, 0u, 0u);
}

fn traverse_light(ray: Ray) -> vec3f {
    let span = light_reach(ray);
    if span.x >= span.y {
        return vec3f(0.0);
    }
    let view = traverse_view(ray, span);
    var t = traverse_start(view);
    var stretches = array<vec2f, TRAVERSE_STRETCHES>();
    var sum = vec3f(0.0);
    var is_done = false;
    loop {
        var count = 0u;
        loop {
            if is_done || count == TRAVERSE_STRETCHES {
                break;
            }
            let border = traverse_next(view, &t);
            is_done = !border.is_found;
            stretches[count] = vec2f(t.lit_from, border.s);
            count += u32(t.lit);
            t.lit_from = border.s;
            t.lit = !t.lit;
        }
        for (var i = 0u; i < count; i++) {
            sum += traverse_stretch(view, stretches[i].x, stretches[i].y);
        }
        if is_done {
            break;
        }
    }
    return sum * light_common(ray);
}

// Distance where a leaf begins.
fn traverse_leaf(view: TraverseRay, leaf: u32) -> f32 {
    let gamma = epipolar.gamma_start + f32(leaf) * epipolar.gamma_step;
    return clamp(epipolar_crossing(view.place, gamma), view.span.x, view.span.y);
}

// On to the next border; to the end of the span where there is none.
fn traverse_next(view: TraverseRay, t: ptr<function, Traversal>) -> TraverseBorder {
    let none = TraverseBorder(false, view.span.y);
    var border = none;
    loop {
        let both = traverse_nodes(view, t);
        let leaf = min((*t).index << (*t).level, view.end_leaf);
        let start = traverse_leaf(view, leaf);
        if !(*t).walking && leaf < view.end_leaf && !both {
            border = TraverseBorder(true, start);
            break;
        }
        if !(*t).walking {
            if (*t).last_walk {
                border = none;
                break;
            }
            // A leaf that cannot tell, or what comes after the last.
            (*t).last_walk = leaf >= view.end_leaf;
            (*t).walking = true;
            (*t).s = start;
            (*t).walk_end = select(traverse_leaf(view, leaf + 1u), view.span.y, (*t).last_walk);
            (*t).walk = shadow_walk_from(view.map_ray, traverse_map_size(), start);
            (*t).index += u32(!(*t).last_walk);
        }
        border = traverse_texels(view, t);
        if border.is_found {
            break;
        }
    }
    return border;
}

// Past the nodes in the state the ray is in. True where it comes to a leaf that cannot tell.
fn traverse_nodes(view: TraverseRay, t: ptr<function, Traversal>) -> bool {
    var both = false;
    loop {
        if (*t).walking || ((*t).index << (*t).level) >= view.end_leaf {
            break;
        }
        (*t).nodes += 1u;
        let node = min_max_nodes[tree_node(epipolar.samples, view.slice, (*t).level, (*t).index)];
        let bright = view.place.b < tree_minimum(node);
        let dark = view.place.b >= tree_maximum(node);
        both = !(dark || bright);
        if select(dark, bright, (*t).lit) {
            let next = tree_next((*t).level, (*t).index);
            (*t).level = next.x;
            (*t).index = next.y;
        } else if both && (*t).level > 0u {
            (*t).level -= 1u;
            (*t).index *= 2u;
        } else {
            break;
        }
    }
    return both;
}

// Past the texels in the state the ray is in.
fn traverse_texels(view: TraverseRay, t: ptr<function, Traversal>) -> TraverseBorder {
    var border = TraverseBorder(false, view.span.y);
    loop {
        if border.is_found || !(*t).walking {
            break;
        }
        let s = (*t).s;
        if s >= (*t).walk_end {
            (*t).walking = false;
            break;
        }
        (*t).texels += 1u;
        let end = max(s, min(shadow_walk_end((*t).walk), (*t).walk_end));
        let held = shadow_walk_held((*t).walk);
        let margins = vec2f(shadow_walk_margin((*t).walk, held, s), shadow_walk_margin((*t).walk, held, end));
        let starts_lit = held <= 0.0 || margins.x >= 0.0;
        let ends_lit = held <= 0.0 || margins.y >= 0.0;
        let at_start = starts_lit != (*t).lit;
        let inside = clamp(s + (end - s) * margins.x / (margins.x - margins.y), s, end);
        border = TraverseBorder(at_start || ends_lit != (*t).lit, select(inside, s, at_start));
        // Of two borders in one texel the second is left to the next step.
        if !(at_start && ends_lit == (*t).lit) {
            (*t).s = end;
            (*t).walk = shadow_walk_on(view.map_ray, (*t).walk, end);
        }
    }
    return border;
}

fn traverse_map_size() -> vec2f {
    return vec2f(textureDimensions(shadow_map));
}

// The light of a lit stretch, but for the common factor.
fn traverse_stretch(view: TraverseRay, a: f32, b: f32) -> vec3f {
    if SHADOW_GLASS {
        return glass_stretch(view, a, b);
    }
    return traverse_clear(view, a, b);
}

// The same where there is no coloured glass before it.
fn traverse_clear(view: TraverseRay, a: f32, b: f32) -> vec3f {
    if SVD && view.place.off_axis > max(SVD_LEAST_SINE, epipolar.least_off_axis) {
        return svd_stretch(epipolar, view.place, a, b);
    }
    if tint_is_summed() {
        return tint_stretch(epipolar, view.ray, view.place, a, b);
    }
    if light_is_local() {
        return stretch_plain(view.ray, a, b);
    }
    return transmittance_integral(frame.medium.sigma_t, a, b);
}
