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

fn camera_view_depth(depth: f32) -> f32 {
    let camera = frame.camera;
    let reversed = (camera.flags & CAMERA_REVERSED_DEPTH) != 0u;
    let from_far = saturate(select(1.0 - depth, depth, reversed));
    if (camera.flags & CAMERA_ORTHOGRAPHIC) != 0u {
        return mix(camera.far, camera.near, from_far);
    }
    if (camera.flags & CAMERA_INFINITE_DEPTH) != 0u {
        return camera.near / max(from_far, camera.near / camera.far);
    }
    return camera.near * camera.far / (camera.near + from_far * (camera.far - camera.near));
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
    if (camera.flags & CAMERA_ORTHOGRAPHIC) != 0u {
        return Ray(offset, max(view_depth, 0.0), camera.forward);
    }
    let along = camera.forward + offset;
    return Ray(vec3f(0.0), view_depth * length(along), normalize(along));
}
