// Draws the pixels of a list alone, each a point.

@group(2) @binding(3) var<storage, read> points_list: array<u32>;

@vertex
fn finish_point(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let packed = points_list[vertex];
    let place = vec2f(vec2u(packed & 0xffffu, packed >> 16u)) + 0.5;
    return vec4f(vec2f(2.0, -2.0) * (place / frame.camera.size - 0.5), 0.0, 1.0);
}
