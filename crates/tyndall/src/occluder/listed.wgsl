// What list.wgsl listed: an element's index and its place's.

@group(2) @binding(4) var<storage, read> occluder_list: array<vec2u>;

// The wall of an edge: a, b and their images at infinity.
@vertex
fn occluder_wall(@builtin(vertex_index) i: u32) -> OccluderVertex {
    let listed = occluder_list[occluder_params.walls + i / 6u];
    let wall = occluder_wall_of(listed.x, listed.y);
    // a b A, b B A
    let corner = i % 6u;
    let is_a = corner == 0u || corner == 2u || corner == 5u;
    let is_far = corner == 2u || corner >= 4u;
    let point = select(wall.b, wall.a, is_a);
    let place_of = select(vec4f(point, 1.0), vec4f(occluder_way(point), 0.0), is_far);
    return OccluderVertex(occluder_project(place_of), wall.a, wall.normal, wall.side, wall.slack);
}

// The triangles themselves.
@vertex
fn occluder_cap(@builtin(vertex_index) i: u32) -> OccluderVertex {
    let listed = occluder_list[occluder_params.caps + i / 3u];
    let p = occluder_triangle(listed.x, listed.y);
    let across = cross(p[1] - p[0], p[2] - p[0]);
    let area = length(across);
    let longest = max(length(p[1] - p[0]), length(p[2] - p[0]));
    let rounded = OCCLUDER_ROUNDING * (length(p[0]) + length(p[1]) + length(p[2]));
    let slack = 2.0 * rounded * longest / max(area, 1e-30);
    var normal = across / max(area, 1e-30);
    let way = occluder_way(p[0]);
    let inwards = dot(normal, way);
    var side = OCCLUDER_EITHER;
    if abs(inwards) > slack * length(way) {
        side = OCCLUDER_ENTERS;
        normal *= sign(inwards);
    }
    return OccluderVertex(occluder_project(vec4f(p[i % 3u], 1.0)), p[0], normal, side, slack);
}

// The mesh's box at infinity, towards which all rays run that stay in its shadow: 12 triangles.
@vertex
fn occluder_far_cap(@builtin(vertex_index) i: u32, @builtin(instance_index) place: u32) -> @builtin(position) vec4f {
    let triangle = i / 3u;
    let axis = triangle / 4u;
    // Corners of a face's two triangles: 0 1 3, 0 3 2.
    let second = (triangle & 1u) != 0u;
    let corner = i % 3u;
    let at = select(select(corner, 3u, corner == 2u), select(corner, select(3u, 2u, corner == 2u), corner > 0u), second);
    var share = vec3f(0.0);
    share[axis] = f32((triangle >> 1u) & 1u);
    share[(axis + 1u) % 3u] = f32(at & 1u);
    share[(axis + 2u) % 3u] = f32(at >> 1u);
    let p = mix(occluder_params.least, occluder_params.most, share);
    let point = (occluder_places[occluder_params.first_place + place] * vec4f(p, 1.0)).xyz;
    return occluder_project(vec4f(occluder_way(point), 0.0));
}
