// The surfaces a camera sees, out of its G-buffer. Space: world, relative to the eye.

const SHADE_PI: f32 = 3.14159265358979;

struct ShadeView {
    // Half the image's width and height as directions: at view depth 1 (perspective) or at any (orthographic) [m].
    right: vec3f,
    near: f32,
    up: vec3f,
    far: f32,
    // Unit viewing direction.
    forward: vec3f,
    // 0: 0 at the near plane, 1: 1 at the near plane, 2: near / view depth.
    depth_range: u32,
    // Offset of the image's centre from the viewing direction or axis, in the units of `right` and `up`.
    center: vec3f,
    orthographic: u32,
    // Extinction coefficient of the medium [1/m].
    sigma_t: vec3f,
    // Irradiance from all around, relative to a light's.
    ambient: f32,
    // Illuminance of all directional lights [W/m^2].
    sun: vec3f,
    // Offset along its normal at which a point's shadow is looked up [texels].
    normal_offset: f32,
    // Radiance of the sky, relative to the sun's illuminance [1/sr].
    sky_horizon: vec3f,
    // A point light's radius, inside which 1 / d^2 grows no further [m].
    light_radius: f32,
    sky_zenith: vec3f,
    // Share of `ambient` that surfaces facing up get more, and surfaces facing down less.
    ambient_tilt: f32,
}

@group(0) @binding(0) var<uniform> shade_view: ShadeView;
@group(0) @binding(1) var shade_depth: texture_depth_2d;
@group(0) @binding(2) var shade_normal: texture_2d<f32>;
@group(0) @binding(3) var shade_base_color: texture_2d<f32>;
@group(0) @binding(4) var shade_emissive: texture_2d<f32>;
@group(0) @binding(5) var shade_view_tint: texture_2d<f32>;

// A small number from a uniform that branches or loops depend on. lavapipe compiles a shader anew, whenever it is bound,
// for the uniforms that all of a branch hangs on; of a texture's size it knows nothing.
fn shade_choice(value: u32) -> u32 {
    return min(value, 0xffffu * textureDimensions(shade_depth).x);
}

// One triangle over the whole image.
@vertex
fn shade_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32(index & 1u), f32(index >> 1u));
    return vec4f(4.0 * corner - 1.0, 0.0, 1.0);
}

// Depth from the far plane's value, 0, to the near plane's, 1.
fn shade_depth_from_far(pixel: vec2u) -> f32 {
    let depth = textureLoad(shade_depth, pixel, 0);
    return select(1.0 - depth, depth, shade_view.depth_range != 0u);
}

// From the viewing axis to the pixel's centre: at view depth 1 (perspective) or at any (orthographic) [m].
fn shade_across(pixel: vec2u) -> vec3f {
    let uv = (vec2f(pixel) + 0.5) / vec2f(textureDimensions(shade_depth));
    let ndc = vec2f(2.0, -2.0) * (uv - 0.5);
    return shade_view.center + ndc.x * shade_view.right + ndc.y * shade_view.up;
}

// Unit direction of the pixel's view ray.
fn shade_direction(pixel: vec2u) -> vec3f {
    let across = select(shade_across(pixel), vec3f(0.0), shade_view.orthographic == 1u);
    return normalize(shade_view.forward + across);
}

// The point that a pixel sees [m].
fn shade_point(pixel: vec2u, from_far: f32) -> vec3f {
    let near = shade_view.near;
    let far = shade_view.far;
    let across = shade_across(pixel);
    if shade_choice(shade_view.orthographic) == 1u {
        return (far + from_far * (near - far)) * shade_view.forward + across;
    }
    let along = shade_view.forward + across;
    if shade_choice(shade_view.depth_range) == 2u {
        return near / max(from_far, near / far) * along;
    }
    return near * far / (near + from_far * (far - near)) * along;
}
