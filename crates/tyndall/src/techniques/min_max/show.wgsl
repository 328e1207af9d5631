// What a view ray's search looked like, in place of its light.

const SHOW_SLICES: u32 = 1u;
const SHOW_SEGMENTS: u32 = 2u;
const SHOW_NODES: u32 = 3u;
const SHOW_MAP: u32 = 4u;

@group(2) @binding(7) var<uniform> show_what: vec4u;

@fragment
fn show(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let ray = frame_ray(position);
    let span = light_reach(ray);
    if show_what.x == SHOW_MAP {
        return vec4f(show_map(position.xy / frame.camera.size), 1.0);
    }
    let view = traverse_view(ray, span);
    if span.x >= span.y {
        return vec4f(0.0, 0.0, 0.0, 1.0);
    }
    if show_what.x == SHOW_SLICES {
        return vec4f(show_slice(view), 1.0);
    }
    var t = traverse_start(view);
    var lit = 0u;
    loop {
        let border = traverse_next(view, &t);
        lit += u32(t.lit);
        if !border.is_found {
            break;
        }
        t.lit = !t.lit;
    }
    if show_what.x == SHOW_SEGMENTS {
        return vec4f(show_scale(f32(lit) / 16.0), 1.0);
    }
    // Red: nodes; green: texels walked.
    return vec4f(vec2f(vec2u(t.nodes, t.texels)) / 128.0, 0.0, 1.0);
}

// Neighbours in different colours; black where a ray has no slice.
fn show_slice(view: TraverseRay) -> vec3f {
    let hash = vec3u(view.slice * 2654435761u) >> vec3u(8u, 14u, 20u);
    return select(vec3f(0.0), vec3f(hash & vec3u(63u)) / 63.0, view.has_leaves);
}

// The rectified map: slices from top to bottom, light rays from left to right; S from black, on the axis towards the
// light, to white, away from it. Red where light never ends.
fn show_map(place: vec2f) -> vec3f {
    let slice = u32(place.y * f32(epipolar.slices));
    let node = min_max_nodes[tree_node(epipolar.samples, slice, 0u, u32(place.x * f32(epipolar.samples)))];
    return select(vec3f(tree_minimum(node) / 65535.0), vec3f(1.0, 0.0, 0.0), tree_minimum(node) >= 65535.0);
}

// Black, blue, red, yellow, white from 0 to 1.
fn show_scale(x: f32) -> vec3f {
    return saturate(vec3f(3.0 * x - 0.5, 3.0 * x - 1.5, select(1.0 - abs(4.0 * x - 1.0), 4.0 * x - 3.0, x > 0.5)));
}
