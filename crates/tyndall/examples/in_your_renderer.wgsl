// The example's own renderer: boxes in the sun, with one shadow map.

struct View {
    clip_from_world: mat4x4f,
}

struct Sun {
    clip_from_world: mat4x4f,
    to_light: vec3f,
    illuminance: f32, // [W/m^2]
}

@group(0) @binding(0) var<uniform> view: View;
@group(1) @binding(0) var<uniform> sun: Sun;
@group(1) @binding(1) var shadow_map: texture_depth_2d;
@group(1) @binding(2) var shadow_sampler: sampler_comparison;

struct Box {
    @location(0) x: vec4f,
    @location(1) y: vec4f,
    @location(2) z: vec4f,
    @location(3) center: vec4f,
    @location(4) color: vec3f,
}

struct Surface {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) color: vec3f,
}

const CORNERS = array(vec2f(-1, -1), vec2f(1, -1), vec2f(1, 1), vec2f(-1, -1), vec2f(1, 1), vec2f(-1, 1));

// Two triangles a face, six faces a box.
@vertex
fn box_vertex(@builtin(vertex_index) index: u32, box: Box) -> Surface {
    let face = index / 6u;
    let corner = CORNERS[index % 6u];
    let side = select(-1.0, 1.0, face % 2u == 1u);
    let axes = array(vec3f(side, corner), vec3f(corner.y, side, corner.x), vec3f(corner, side));
    let local = axes[face / 2u];
    let world_from_local = mat4x4f(box.x, box.y, box.z, box.center);
    let position = world_from_local * vec4f(local, 1.0);
    let normal = side * world_from_local[face / 2u].xyz;
    return Surface(view.clip_from_world * position, position.xyz, normalize(normal), box.color);
}

@fragment
fn lit_fragment(surface: Surface) -> @location(0) vec4f {
    // Off the surface, so that it doesn't shade itself.
    let point = surface.position + 0.06 * surface.normal;
    let clip = sun.clip_from_world * vec4f(point, 1.0);
    let uv = vec2f(0.5, -0.5) * clip.xy + 0.5;
    let visibility = textureSampleCompareLevel(shadow_map, shadow_sampler, uv, clip.z);
    let direct = visibility * max(dot(surface.normal, sun.to_light), 0.0);
    let irradiance = sun.illuminance * (direct + 0.03);
    return vec4f(surface.color / 3.14159265 * irradiance, 1.0);
}
