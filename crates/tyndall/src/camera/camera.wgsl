// View rays and the depth buffer: which points of the world a pixel sees. Space: world, relative to the eye.

const CAMERA_REVERSED_DEPTH: u32 = 1u;
const CAMERA_ORTHOGRAPHIC: u32 = 2u;
const CAMERA_INFINITE_DEPTH: u32 = 4u;

struct Camera {
    right: vec3f,
    near: f32, // view depths [m]
    up: vec3f,
    far: f32,
    forward: vec3f,
    flags: u32,
    half_extent: vec2f, // tangents (perspective) or metres (orthographic)
    center: vec2f,
    size: vec2f, // [pixels]
}

struct Ray {
    origin: vec3f, // relative to the eye
    length: f32, // to the first surface or the far plane [m]
    direction: vec3f, // unit
}

fn camera_is_orthographic() -> bool {
    return (frame_choice(frame.camera.flags) & CAMERA_ORTHOGRAPHIC) != 0u;
}

fn camera_view_depth(depth: f32) -> f32 {
    return camera_view_depth_of(frame.camera, depth);
}

// Of another camera with the same kind of projection and depth.
fn camera_view_depth_of(camera: Camera, depth: f32) -> f32 {
    let is_reversed = (camera.flags & CAMERA_REVERSED_DEPTH) != 0u;
    let from_far = saturate(select(1.0 - depth, depth, is_reversed));
    let orthographic = mix(camera.far, camera.near, from_far);
    let finite = camera.near * camera.far / (camera.near + from_far * (camera.far - camera.near));
    let infinite = camera.near / max(from_far, camera.near / camera.far);
    let perspective = select(finite, infinite, (camera.flags & CAMERA_INFINITE_DEPTH) != 0u);
    return select(perspective, orthographic, camera_is_orthographic());
}

// The place in such a camera's picture [pixels] of a point relative to its eye, and the point's view depth [m].
fn camera_project(camera: Camera, point: vec3f) -> vec3f {
    let depth = dot(point, camera.forward);
    let scale = select(depth, 1.0, camera_is_orthographic());
    let on_plane = vec2f(dot(point, camera.right), dot(point, camera.up)) / scale;
    let ndc = (on_plane - camera.center) / camera.half_extent;
    return vec3f((0.5 + vec2f(0.5, -0.5) * ndc) * camera.size, depth);
}

// The ray through a point of the picture [pixels], (0, 0) at the top left corner, that ends at this depth-buffer value.
fn camera_ray(pixel: vec2f, depth: f32) -> Ray {
    return camera_ray_to(pixel, camera_view_depth(depth));
}

// The same, that ends at this view depth [m].
fn camera_ray_to(pixel: vec2f, view_depth: f32) -> Ray {
    let camera = frame.camera;
    let ndc = vec2f(2.0, -2.0) * (pixel / camera.size - 0.5);
    let on_plane = camera.center + camera.half_extent * ndc;
    let offset = on_plane.x * camera.right + on_plane.y * camera.up;
    let is_orthographic = camera_is_orthographic();
    let along = camera.forward + select(offset, vec3f(0.0), is_orthographic);
    let stretch = length(along);
    let origin = select(vec3f(0.0), offset, is_orthographic);
    return Ray(origin, max(view_depth, 0.0) * stretch, along / stretch);
}
