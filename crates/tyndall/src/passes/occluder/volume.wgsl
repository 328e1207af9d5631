// Boundaries of shadow volumes: see occluder/mod.rs. Space: world, relative to the eye.

@group(2) @binding(0) var<storage, read> occluder_places: array<mat4x4f>; // world (relative to the eye) from mesh
@group(2) @binding(1) var<storage, read> occluder_corners: array<f32>;
@group(2) @binding(2) var<storage, read> occluder_elements: array<u32>; // edges of four, or triangles of three corners
@group(2) @binding(3) var<uniform> occluder_params: OccluderParams;

// Places of one mesh that stand side by side.
struct OccluderParams {
    first_place: u32,
    places: u32,
    edges: u32,
    triangles: u32,
    least: vec3f, // the mesh's box, in its own space
    walls: u32, // where they begin in the list
    most: vec3f,
    caps: u32,
    counts: u32, // where the number of walls listed stands; that of the caps follows
    columns: u32, // workgroups a row
}

const OCCLUDER_NONE: u32 = 0xffffffffu;
// Relative error of a corner's place and of a difference of two of them.
const OCCLUDER_ROUNDING: f32 = 2e-7;
// What a ray that meets a piece of the boundary does.
const OCCLUDER_ENTERS: f32 = 1.0; // the shadow, where it runs along the plane's normal
const OCCLUDER_EITHER: f32 = 0.0;

// A piece's plane, and on which side the shadow lies.
struct OccluderPlane {
    anchor: vec3f, // a point of it
    normal: vec3f, // unit, into the shadow
    side: f32, // OCCLUDER_ENTERS or OCCLUDER_EITHER
    slack: f32, // how far the normal may be off [rad]
}

fn occluder_corner(index: u32, place: u32) -> vec3f {
    let p = vec3f(occluder_corners[3u * index], occluder_corners[3u * index + 1u], occluder_corners[3u * index + 2u]);
    return (occluder_places[place] * vec4f(p, 1.0)).xyz;
}

// The way light travels at a point; not of unit length.
fn occluder_way(point: vec3f) -> vec3f {
    if LIGHT_KIND == LIGHT_DIRECTIONAL {
        return light.direction;
    }
    return point - light.position;
}

// On the screen, of a point (1) or a direction (0): (x, y, w, q), where (x, y) / w is the place [pixels], w > 0 what lies before
// the eye, and q / w what is linear on the screen: the inverse of the view depth, or of an orthographic camera the view depth.
fn occluder_on_screen(p: vec4f) -> vec4f {
    let camera = frame.camera;
    let on_plane = vec2f(dot(camera.right, p.xyz), dot(camera.up, p.xyz));
    let depth = dot(camera.forward, p.xyz);
    let wq = select(vec2f(depth, p.w), vec2f(p.w, depth), camera_is_orthographic());
    let ndc = (on_plane - wq.x * camera.center) / camera.half_extent;
    return vec4f((0.5 * wq.x + vec2f(0.5, -0.5) * ndc) * camera.size, wq);
}

// What an edge sweeps out away from the light.
struct OccluderWall {
    a: vec3f,
    b: vec3f,
    plane: OccluderPlane,
    is_inside: bool, // of the union of its triangles' volumes
}

fn occluder_edge(index: u32, place: u32) -> array<vec3f, 2> {
    let edge = 4u * index;
    return array<vec3f, 2>(
        occluder_corner(occluder_elements[edge], place),
        occluder_corner(occluder_elements[edge + 1u], place),
    );
}

fn occluder_wall_of(index: u32, place: u32) -> OccluderWall {
    let edge = occluder_edge(index, place);
    let a = edge[0];
    let b = edge[1];
    let along = b - a;
    let way = occluder_way(a);
    let across = cross(along, way);
    let area = length(across);
    // The sine of the angle between edge and light, and the rounding of what both are differences of, over it.
    let rounded = OCCLUDER_ROUNDING * (length(a) + length(b) + length(way));
    let slack = rounded * (length(along) + length(way)) / max(area, 1e-30);
    var plane = OccluderPlane(a, across / max(area, 1e-30), OCCLUDER_EITHER, slack);
    var is_inside = false;
    let c = occluder_elements[4u * index + 2u];
    let d = occluder_elements[4u * index + 3u];
    if c != OCCLUDER_NONE {
        let inside = occluder_side(plane, occluder_corner(c, place));
        var other = inside;
        if d != OCCLUDER_NONE {
            other = occluder_side(plane, occluder_corner(d, place));
        }
        is_inside = inside * other < 0.0;
        if inside * other > 0.0 {
            plane.side = OCCLUDER_ENTERS;
            plane.normal *= inside;
        }
    }
    return OccluderWall(a, b, plane, is_inside);
}

// 1 or -1 where a point surely lies before or behind a plane, else 0.
fn occluder_side(plane: OccluderPlane, point: vec3f) -> f32 {
    let offset = point - plane.anchor;
    let rounded = plane.slack * length(offset) + OCCLUDER_ROUNDING * (length(point) + length(plane.anchor));
    let height = dot(plane.normal, offset);
    return select(0.0, sign(height), abs(height) > rounded);
}

// The plane of a triangle.
fn occluder_cap_of(p: array<vec3f, 3>) -> OccluderPlane {
    let across = cross(p[1] - p[0], p[2] - p[0]);
    let area = length(across);
    let longest = max(length(p[1] - p[0]), length(p[2] - p[0]));
    let rounded = OCCLUDER_ROUNDING * (length(p[0]) + length(p[1]) + length(p[2]));
    let slack = 2.0 * rounded * longest / max(area, 1e-30);
    let normal = across / max(area, 1e-30);
    let way = occluder_way(p[0]);
    let inwards = dot(normal, way);
    if abs(inwards) > slack * length(way) {
        return OccluderPlane(p[0], normal * sign(inwards), OCCLUDER_ENTERS, slack);
    }
    return OccluderPlane(p[0], normal, OCCLUDER_EITHER, slack);
}

// What rays from the eye do that meet a piece: whether they may enter the shadow, and whether they may leave it.
fn occluder_facing(plane: OccluderPlane) -> vec2<bool> {
    let is_flat = camera_is_orthographic();
    let towards = select(plane.anchor, frame.camera.forward, is_flat);
    let slope = dot(plane.normal, towards);
    let rounding = select(2.0 * OCCLUDER_ROUNDING, 0.0, is_flat);
    let is_certain = plane.side == OCCLUDER_ENTERS && abs(slope) > (plane.slack + rounding) * length(towards);
    return vec2<bool>(!is_certain || slope > 0.0, !is_certain || slope < 0.0);
}

fn occluder_triangle(index: u32, place: u32) -> array<vec3f, 3> {
    return array<vec3f, 3>(
        occluder_corner(occluder_elements[3u * index], place),
        occluder_corner(occluder_elements[3u * index + 1u], place),
        occluder_corner(occluder_elements[3u * index + 2u], place),
    );
}
