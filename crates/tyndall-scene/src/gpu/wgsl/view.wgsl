// The viewpoint: a camera or a light.

struct View {
    // Clip space from world-space offsets from `origin`.
    clip_from_relative: mat4x4f,
    // World-space point that vertices are taken relative to [m].
    origin: vec3f,
    // Direction from a point to the viewer is xyz - w * (point - origin).
    viewer: vec4f,
}

@group(0) @binding(0) var<uniform> view: View;

fn view_direction_to_viewer(relative: vec3f) -> vec3f {
    return view.viewer.xyz - view.viewer.w * relative;
}
