// Whether the eye is in a shadow: whether a triangle lies between it and the light, or so nearly that rounding decides.

const EYE_SIDE: u32 = 64u;
// Relative to the triangle's size as the eye sees it.
const EYE_ROUNDING: f32 = 1e-4;

@group(2) @binding(4) var<storage, read_write> eye_in_shadow: atomic<u32>;

@compute @workgroup_size(64)
fn eye_triangle(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let triangle = (group.y * occluder_params.columns + group.x) * EYE_SIDE + lane;
    if triangle >= occluder_params.triangles {
        return;
    }
    let p = occluder_triangle(triangle, occluder_params.first_place + group.z);
    if eye_is_behind(p[0], p[1], p[2]) {
        atomicStore(&eye_in_shadow, 1u);
    }
}

// Whether the way from the eye (the origin) to the light passes a triangle.
fn eye_is_behind(a: vec3f, b: vec3f, c: vec3f) -> bool {
    let to_light = select(-light.direction, light.position, light_is_local());
    // Volumes of the tetrahedra over the triangle's edges: of one sign where the line passes.
    let volumes = vec3f(dot(to_light, cross(a, b)), dot(to_light, cross(b, c)), dot(to_light, cross(c, a)));
    let size = max(length(b - a), max(length(c - b), length(a - c)));
    let far = max(length(a), max(length(b), length(c)));
    let rounded = EYE_ROUNDING * length(to_light) * far * size;
    if !(all(volumes >= vec3f(-rounded)) || all(volumes <= vec3f(rounded))) {
        return false;
    }
    let normal = cross(b - a, c - a);
    let height = dot(normal, a);
    let slope = dot(normal, to_light);
    let off = EYE_ROUNDING * (size * size * far + abs(slope));
    // 0 <= height / slope, and <= 1 of a local light, where the division is certain.
    let along = height * sign(slope);
    return along >= -off && (!light_is_local() || along <= abs(slope) + off);
}
