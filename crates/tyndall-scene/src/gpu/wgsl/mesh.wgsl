// Mesh vertices, placed in the world and projected into the view.

struct MeshVertex {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,
    // Rows of the instance's world_from_local.
    @location(3) world_x: vec4f,
    @location(4) world_y: vec4f,
    @location(5) world_z: vec4f,
}

struct MeshFragment {
    // Invariant: glass is compared with depths that another pipeline wrote.
    @invariant @builtin(position) position: vec4f,
    // World space, from the view's origin [m].
    @location(0) relative: vec3f,
    // World space, of unit length at the vertices.
    @location(1) normal: vec3f,
    @location(2) uv: vec2f,
}

// Zero stays zero.
fn mesh_normalize(v: vec3f) -> vec3f {
    return v * inverseSqrt(max(dot(v, v), 1e-37));
}

@vertex
fn mesh_vertex(vertex: MeshVertex) -> MeshFragment {
    let local = vec4f(vertex.position, 1.0);
    let world = vec3f(
        dot(vertex.world_x, local),
        dot(vertex.world_y, local),
        dot(vertex.world_z, local),
    );
    let relative = world - view.origin;
    // The cofactor matrix turns normals like the inverse transpose, but for scale and, if mirrored, sign.
    let normal_from_local = transpose(mat3x3f(
        cross(vertex.world_y.xyz, vertex.world_z.xyz),
        cross(vertex.world_z.xyz, vertex.world_x.xyz),
        cross(vertex.world_x.xyz, vertex.world_y.xyz),
    ));
    var fragment: MeshFragment;
    fragment.position = view.clip_from_relative * vec4f(relative, 1.0);
    fragment.relative = relative;
    fragment.normal = mesh_normalize(normal_from_local * vertex.normal);
    fragment.uv = vertex.uv;
    return fragment;
}
