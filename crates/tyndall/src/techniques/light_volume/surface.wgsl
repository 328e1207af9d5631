// Draws the boundary of the shadow volume: each fragment says what the ray's visibility jumps by, and of how much light.

struct LightVolumeVertex {
    @builtin(position) @invariant position: vec4f,
    @location(0) view_depth: f32,
}

// Nearer to the eye than this share of the near plane nothing is drawn.
const LIGHT_VOLUME_NEAREST: f32 = 1e-3;

// On the screen, wherever along the ray: only what lies behind the eye is clipped.
fn light_volume_project(point: vec3f) -> LightVolumeVertex {
    let camera = frame.camera;
    let on_plane = vec2f(dot(camera.right, point), dot(camera.up, point));
    let depth = dot(camera.forward, point);
    if camera_is_orthographic() {
        return LightVolumeVertex(vec4f((on_plane - camera.center) / camera.half_extent, 0.5, 1.0), depth);
    }
    let clip = (on_plane - depth * camera.center) / camera.half_extent;
    return LightVolumeVertex(vec4f(clip, depth - LIGHT_VOLUME_NEAREST * camera.near, depth), depth);
}

fn light_volume_vertex(face: u32, vertex: vec2u, is_far: bool) -> LightVolumeVertex {
    if is_far {
        return light_volume_project(light_volume_point(face, light_volume_place(vertex), 0.0));
    }
    let site = light_volume_site(face, vertex);
    return light_volume_project(light_volume_point(face, site.place, site.depth));
}

// The full mesh: an instance is a row of one face's cells, a triangle strip.
@vertex
fn light_volume_strip(@builtin(vertex_index) i: u32, @builtin(instance_index) strip: u32) -> LightVolumeVertex {
    let rows = light_volume.cells.y;
    return light_volume_vertex(strip / rows, vec2u(i >> 1u, strip % rows + (i & 1u)), false);
}

// The adaptive mesh: triangles as list.wgsl names them.
@group(2) @binding(2) var<storage, read> light_volume_leaves: array<u32>;

@vertex
fn light_volume_leaf(@builtin(vertex_index) i: u32) -> LightVolumeVertex {
    let leaf = light_volume_leaves[i / 3u];
    var vertex = vec2u(leaf, leaf >> 13u) & vec2u(8191u);
    if i % 3u > 0u {
        let spacing = light_volume_spacing(vertex);
        let k = ((leaf >> 26u) & 3u) + i % 3u - 1u;
        let way = light_volume_neighbor(k, spacing, light_volume_is_edge(vertex, spacing));
        vertex = vec2u(vec2i(vertex) + way);
    }
    return light_volume_vertex(leaf >> 28u, vertex, false);
}

// Vertex `i` of a face's border, anticlockwise as the light sees it.
fn light_volume_border(i: u32) -> vec2u {
    let n = light_volume.cells;
    let k = i % (2u * (n.x + n.y));
    if k < n.y {
        return vec2u(0u, k);
    }
    if k < n.y + n.x {
        return vec2u(k - n.y, n.y);
    }
    if k < 2u * n.y + n.x {
        return vec2u(n.x, 2u * n.y + n.x - k);
    }
    return vec2u(2u * (n.x + n.y) - k, 0u);
}

// A single map's sides and far cap: three triangles a cell of the border.
@vertex
fn light_volume_side(@builtin(vertex_index) i: u32) -> LightVolumeVertex {
    let corner = i % 9u;
    if corner == 8u {
        return light_volume_vertex(0u, light_volume.cells / 2u, true);
    }
    // a, b on the border; A, B beyond all that is seen: b a A, b A B, B A.
    let is_first = corner == 1u || corner == 2u || corner == 4u || corner == 7u;
    let is_far = corner == 2u || corner >= 4u;
    return light_volume_vertex(0u, light_volume_border(i / 9u + u32(!is_first)), is_far);
}

// What the ray's visibility jumps by (a), times the light from here to its end (rgb).
@fragment
fn light_volume_surface(in: LightVolumeVertex, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let ray = frame_ray(in.position);
    let s = in.view_depth / dot(frame.camera.forward, ray.direction);
    // Behind the ray's start, or of a projection beyond f32.
    if !(s >= 0.0) {
        discard;
    }
    let jump = select(1.0, -1.0, front != (light_volume.mirrored == 1u));
    return jump * vec4f(stretch_plain(ray, s, ray.length), 1.0);
}
