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
    arguments: u32, // of the walls' draw, in words; the caps' follow
    columns: u32, // workgroups a row
}

const OCCLUDER_NONE: u32 = 0xffffffffu;
// Relative error of a corner's place and of a difference of two of them.
const OCCLUDER_ROUNDING: f32 = 2e-7;
// What a ray that meets a piece of the boundary does.
const OCCLUDER_ENTERS: f32 = 1.0; // the shadow, where it runs along the plane's normal
const OCCLUDER_EITHER: f32 = 0.0;

struct OccluderVertex {
    @builtin(position) @invariant position: vec4f,
    @location(0) @interpolate(flat) anchor: vec3f, // a point of the plane
    @location(1) @interpolate(flat) normal: vec3f, // unit, into the shadow
    @location(2) @interpolate(flat) side: f32, // OCCLUDER_ENTERS or OCCLUDER_EITHER
    @location(3) @interpolate(flat) slack: f32, // how far the normal may be off [rad]
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

// On the screen, of a point (1) or a direction (0); wherever along the ray, only what lies behind the eye is clipped.
fn occluder_project(p: vec4f) -> vec4f {
    let camera = frame.camera;
    let on_plane = vec2f(dot(camera.right, p.xyz), dot(camera.up, p.xyz));
    if camera_is_orthographic() {
        return vec4f((on_plane - p.w * camera.center) / camera.half_extent, 0.5 * p.w, p.w);
    }
    let depth = dot(camera.forward, p.xyz);
    return vec4f((on_plane - depth * camera.center) / camera.half_extent, 0.5 * depth, depth);
}

// A wall's plane, and on which side the shadow lies.
struct OccluderWall {
    a: vec3f,
    b: vec3f,
    normal: vec3f,
    side: f32,
    slack: f32,
    is_inside: bool, // of the union of its triangles' volumes
}

fn occluder_wall_of(index: u32, place: u32) -> OccluderWall {
    let edge = 4u * index;
    let a = occluder_corner(occluder_elements[edge], place);
    let b = occluder_corner(occluder_elements[edge + 1u], place);
    let along = b - a;
    let way = occluder_way(a);
    let across = cross(along, way);
    let area = length(across);
    // The sine of the angle between edge and light, and the rounding of what both are differences of, over it.
    let rounded = OCCLUDER_ROUNDING * (length(a) + length(b) + length(way));
    let slack = rounded * (length(along) + length(way)) / max(area, 1e-30);
    var wall = OccluderWall(a, b, across / max(area, 1e-30), OCCLUDER_EITHER, slack, false);
    let c = occluder_elements[edge + 2u];
    let d = occluder_elements[edge + 3u];
    if c != OCCLUDER_NONE {
        let inside = occluder_side(a, wall.normal, slack, occluder_corner(c, place));
        var other = inside;
        if d != OCCLUDER_NONE {
            other = occluder_side(a, wall.normal, slack, occluder_corner(d, place));
        }
        wall.is_inside = inside * other < 0.0;
        if inside * other > 0.0 {
            wall.side = OCCLUDER_ENTERS;
            wall.normal *= inside;
        }
    }
    return wall;
}

// 1 or -1 where a point surely lies before or behind a plane, else 0.
fn occluder_side(anchor: vec3f, normal: vec3f, slack: f32, point: vec3f) -> f32 {
    let offset = point - anchor;
    let rounded = slack * length(offset) + OCCLUDER_ROUNDING * (length(point) + length(anchor));
    let height = dot(normal, offset);
    return select(0.0, sign(height), abs(height) > rounded);
}

fn occluder_triangle(index: u32, place: u32) -> array<vec3f, 3> {
    return array<vec3f, 3>(
        occluder_corner(occluder_elements[3u * index], place),
        occluder_corner(occluder_elements[3u * index + 1u], place),
        occluder_corner(occluder_elements[3u * index + 2u], place),
    );
}
